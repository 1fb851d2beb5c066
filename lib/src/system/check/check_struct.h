/* The state of the derivative check, for check.c, check_ranges.c and check_report.c. */
#ifndef DVI_SYSTEM_CHECK_CHECK_STRUCT_H
#define DVI_SYSTEM_CHECK_CHECK_STRUCT_H
#include "system/term/difference.h"

/* One entry at which callback and difference disagree. */
typedef struct dvi__disagreement {
  /* error beyond the differences' own noise, absolute while a block is compared, then relative to
   * the largest entry of the block */
  double error;
  double given, differenced;
  int row, column;
} dvi__disagreement;

/* The worst disagreement of one kind over all blocks, with the names of its block. */
typedef struct dvi__finding {
  dvi__disagreement worst;
  const char *term, *owner, *block;
  const char *kind; /* of a named term, such as "potential" */
  int constraint;
} dvi__finding;

/* The first gradient_range that breaks its promise, at coordinate `row` (-1 for none) of the range
 * from first to last-1. */
typedef struct dvi__broken_range {
  const dvi__potential_term *term;
  /* outside is 0, or -1 or 1 if the callback writes before its first or behind its last
   * coordinate */
  int row, outside, first, last;
  double whole, part;
} dvi__broken_range;

typedef struct dvi__check {
  const char *kinetic; /* name of the part that holds the velocities or momenta */
  int constraint;      /* number of the constraint that is compared, counted from 1, or 0 */
  dvi__scratch scratch;
  dvi__differences differences;
  int n, nv;
  double t;
  const double *q, *v;
  double *gradient[2], *column[2]; /* work [n] */
  double *hessian[3];              /* each as long as the longest pattern */
  double gradient_noise;           /* noise of the current term */
  dvi__finding of_gradient, of_hessian, of_pattern;
  dvi__broken_range range;
} dvi__check;

/* c->n is given. Free also after a failure. */
dvi_status dvi__check_allocate(dvi__check *c, const dvi_system *system);
void dvi__check_clear(dvi__check *c);

/* Check gradient_range against the whole gradient, for ranges of one coordinate, of three, of half
 * of the coordinates and one more, and of all. */
dvi_status dvi__check_ranges(dvi__check *c, const dvi__potential_term *p, const double *whole);

/* Report the worst disagreement. A wrong gradient makes its ranges and its Hessian look wrong too,
 * so it is named first. Entries that a pattern misses come next. */
dvi_status dvi__check_report(const dvi__check *c, double tolerance, dvi_derivative_check *result);

#endif
