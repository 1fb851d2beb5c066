/* Fixed point iteration (sweep.h) on the elements of several members of an ensemble side by side.
 *
 * Members differ in where their element begins; the step is the same. Each lane holds one member
 * that still iterates; lanes whose members are done are closed up. Every member sees the operations
 * of sweep.h in their order: its digits are those of an element alone. */
#ifndef DVI_ACTION_MEMBERS_H
#define DVI_ACTION_MEMBERS_H
#include "step/element/action.h"

typedef struct dvi__action_members {
  dvi__action *action;
  dvi__evaluator *evaluator;
  int count;                /* members */
  int width;                /* lanes */
  int *member;              /* [width] of a lane */
  int *going;               /* [width] lanes that go on */
  double *change, *largest; /* [width] of the last sweep: as dvi__action_sweep gives them */
  /* What belongs to the lanes: times, offsets, places and forces of the nodes, and where the
   * element begins. */
  double *t, *Z, *Q, *force;                         /* [r*width], [n*r*width] */
  const double *start, *low, *origin;                /* [n*width] */
  double *packed_start, *packed_low, *packed_origin; /* where they stand once lanes are closed up */
  /* Of all members. */
  double *all_start, *all_low; /* [n*count] */
  const double *p;             /* [n*count] at the step's start */
  /* [n*r*count] of the last step; then those that ended a member's iteration */
  double *forces;
  double *dq, *dq_low, *dp; /* [n*count] */
} dvi__action_members;

/* For an element that can sweep, and up to so many members. */
dvi_status dvi__action_members_create(dvi__action *action, int capacity,
                                      dvi__action_members *members);
void dvi__action_members_clear(dvi__action_members *members);

/* Put every member's element at t [count], q, p [n*count], with step h, and the nodes where the
 * forces [n*r*count] of the last step, last_h long, continued, make them. q and p must stay as they
 * are until the ends are asked for; the forces of a member are replaced by `keep`. */
void dvi__action_members_place(dvi__action_members *members, int count, double h, double last_h,
                               const double *t, const double *q, const double *p, double *forces);

/* Go on with the lanes that are marked, whose numbers are then in members->going. */
void dvi__action_members_close_up(dvi__action_members *members, const char *marked);

/* Rows of numbers that lanes had before they were closed up: those of the lanes that went on. In
 * place if both are the same. */
void dvi__action_members_pack(const dvi__action_members *members, int rows, int before,
                              const double *x, double *packed);

/* One iteration of every lane. */
dvi_status dvi__action_members_sweep(dvi__action_members *members);

/* The member in this lane is done with its last iteration's forces. */
void dvi__action_members_keep(dvi__action_members *members, int lane);

/* From the forces kept: the unknowns Y [n*s*count] and the increments dq + dq_low, dp of all
 * members; of those that kept none they mean nothing. */
void dvi__action_members_ends(dvi__action_members *members, double *Y);

#endif
