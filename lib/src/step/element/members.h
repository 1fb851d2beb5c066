/* Fixed-point iteration on the elements of several members of an ensemble side by side.
 *
 * Members differ in the start of their element. The step is the same. Each lane holds one member
 * that still iterates, and lanes whose members are done are closed up. Every member sees the
 * operations of fixed_point.h in their order, and its digits are those of an element alone. An
 * element without that iteration, such as that of a general Lagrangian, iterates on the paths by
 * the chord of action.h (chord_members.c). */
#ifndef DVI_STEP_ELEMENT_MEMBERS_H
#define DVI_STEP_ELEMENT_MEMBERS_H
#include "num/simd/members_chord.h"
#include "step/element/action.h"

typedef struct dvi__action_members {
  dvi__action *action;
  dvi__evaluator *evaluator;
  int count;   /* number of members */
  int width;   /* number of lanes */
  int *member; /* [width] member of a lane */
  int *going;  /* [width] lanes that go on */
  /* [width] results of the last iteration, as dvi__action_iterate gives them */
  double *change, *largest;
  /* Numbers of the lanes, which are times, offsets, places and forces of the nodes, and the start
   * of the element. */
  double *t, *Z, *Q, *force;          /* [r*width], [n*stages*width], fixed_point.h */
  const double *start, *low, *origin; /* [n*width] p0 takes the place of start with `chord` */
  /* [n*width] copies of these once lanes are closed up */
  double *packed_start, *packed_low, *packed_origin;
  /* Numbers of all members. */
  double *all_start, *all_low; /* [n*count] */
  const double *t0, *p;        /* [count], [n*count] times and momenta at the step's start */
  /* [n*stages*count] forces of the last step, then those of each member's last iteration, and
   * `lagged` factors behind them. With `chord` paths [n*s*count] */
  double *forces;
  double *dq, *dq_low, *dp; /* [n*count] */
  /* With a vector potential, batches of places, velocities, V_q and A [n*r*width], and p0 - sum_j
   * a_j [n*count], else NULL. */
  double *batch[4], *kinetic;
  /* With a preconditioner Phi(Z) - Z and its product with the inverse [n*r*width], and the places
   * of each member's last iteration [n*r*count], else NULL. */
  double *rest, *moved, *kept_Q;
  struct dvi__lagged *lagged;       /* of slow potentials beside fast ones, else NULL */
  struct dvi__chord_members *chord; /* of an iteration on paths, else NULL */
} dvi__action_members;

/* Tell whether elements of this action can be iterated side by side, and whether on the paths. */
int dvi__action_has_members(const dvi__action *action);
int dvi__action_has_chord_members(const dvi__action *action);

/* Set the sizes and tables of an iteration on paths, for the action's h. */
void dvi__action_members_tables(const dvi__action *action, dvi__members_chord *loops);

/* Continue paths [n*s*width] of the last step, `ratio` times as long, as dvi__action_continue. */
void dvi__action_continue_members(dvi__action *action, double ratio, int width, const double *last,
                                  double *Y);

/* Create the lanes of up to `capacity` members, for an action that has them. */
dvi_status dvi__action_members_create(dvi__action *action, int capacity,
                                      dvi__action_members *members);
void dvi__action_members_clear(dvi__action_members *members);

/* Put every member's element at t [count], q, p [n*count], with step h. The nodes are those that
 * the continued forces [n*stages*count] of the last step, last_h long, make, or they are on its
 * continued paths [n*s*count]. t, q and p must stay as they are until the ends are read. `keep`
 * replaces the forces, or the path, of a member. */
void dvi__action_members_place(dvi__action_members *members, int count, double h, double last_h,
                               const double *t, const double *q, const double *p, double *last);

/* Go on with the marked lanes, whose numbers are then in members->going. */
void dvi__action_members_close_up(dvi__action_members *members, const char *marked);

/* Pack rows of numbers of the lanes before close_up to those of the lanes that go on. In place if
 * both arrays are the same. */
void dvi__action_members_pack(const dvi__action_members *members, int rows, int before,
                              const double *x, double *packed);

/* Make one iteration of every lane. */
dvi_status dvi__action_members_iterate(dvi__action_members *members);

/* Keep the forces of the last iteration, or the paths, of the members in lane[lanes], which are
 * done. */
void dvi__action_members_keep(dvi__action_members *members, int lanes, const int *lane);

/* Give the unknowns Y [n*s*count] and the increments dq + dq_low, dp of all members from the forces
 * kept, which then lose the part of a preconditioner's potentials, as those of dvi__action_forces.
 * Y may be NULL. With `chord` the paths are kept, and Y is not written. The numbers of members of
 * which nothing is kept mean nothing. */
void dvi__action_members_ends(dvi__action_members *members, double *Y);

/* The parts of these functions for an iteration on paths (chord_members.c). */
dvi_status dvi__chord_members_create(dvi__action_members *members, size_t capacity);
void dvi__chord_members_clear(dvi__action_members *members);
void dvi__chord_members_place(dvi__action_members *members, double ratio);
void dvi__chord_members_pack(dvi__action_members *members, int before);
dvi_status dvi__chord_members_iterate(dvi__action_members *members);
void dvi__chord_members_keep(dvi__action_members *members, int lane);

#endif
