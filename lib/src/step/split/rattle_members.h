/* The forces of holonomic constraints in steps of Verlet's method (method/split/rattle.h) for
 * members of an ensemble side by side, with masses on the diagonal.
 *
 * Every member sees the operations of method/split/rattle.c in their order. Newton's iteration goes
 * on for all lanes until the last one has settled, and those that have keep what they found. A
 * member is left to its step alone where its matrix is nearly singular, or does not serve all of
 * its iteration, or a callback fails. */
#ifndef DVI_STEP_SPLIT_RATTLE_MEMBERS_H
#define DVI_STEP_SPLIT_RATTLE_MEMBERS_H
#include "system/evaluate/evaluator.h"

/* The matrix G M^-1 G^T. Entry e is the sum of the products of the entries left[k] of G and
 * right[k] of G M^-1, k from first[e] to first[e+1]-1. */
typedef struct dvi__rattle_matrix {
  const dvi__pattern *pattern;
  const int *first, *left, *right;
} dvi__rattle_matrix;

/* A correction of Newton's iteration, the one before, and the size of the numbers that they are
 * added to. Tells whether corrections are roundings, or will be after this one, or no longer
 * shrink. The first one has HUGE_VAL before it, and is settled only if it is a rounding. */
int dvi__rattle_is_settled(double moved, double last, double size);

/* Iterations at most. A matrix is kept while corrections shrink at least by the factor, and one of
 * a smaller condition is tested for a rank that drops within the step. What a correction leaves at
 * the end is of the size of its own roundings, unless it changes the multipliers by more than the
 * last of these. */
enum { DVI__RATTLE_ITERATIONS = 50 };
#define DVI__RATTLE_FAST_CHANGE 0.25
#define DVI__RATTLE_SUSPICIOUS 1e-2
#define DVI__RATTLE_SMALL_CHANGE 1e-3

typedef struct dvi__rattle_members dvi__rattle_members;

/* The state of the members of a step, number i of member k at [i*count + k], as in dvi__members. */
typedef struct dvi__rattle_lanes {
  int count;
  const double *t, *q, *q_compensation; /* [count], [n*count] */
  double *p, *p_compensation;           /* [n*count] */
  double *lambda, *trend; /* [rows*count], [2 rows*count], as in method/split/rattle.h */
  char *left;
  long *residuals, *gradients; /* [count] */
} dvi__rattle_lanes;

/* Tell whether a system is so small that members as lanes gain. As many rows as coordinates, or
 * more, depend on others if anything moves, and such members would all be left. */
int dvi__rattle_members_pay(const dvi_system *system);

/* Create the lanes of up to `capacity` members. They count what dvi__rattle_lanes does not. */
dvi_status dvi__rattle_members_create(const dvi_system *system, const dvi__rattle_matrix *matrix,
                                      int capacity, dvi_counters *counters,
                                      dvi__rattle_members **members);
void dvi__rattle_members_destroy(dvi__rattle_members **members);

/* Do what dvi__rattle_begin and dvi__rattle_end do, for all members that are not left. */
void dvi__rattle_members_begin(dvi__rattle_members *members, const dvi__rattle_lanes *lanes,
                               double h);
void dvi__rattle_members_end(dvi__rattle_members *members, const dvi__rattle_lanes *lanes,
                             double h);

#endif
