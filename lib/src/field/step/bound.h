/* How steps are chosen, and where they are bounded. */
#ifndef DVI_FIELD_STEP_BOUND_H
#define DVI_FIELD_STEP_BOUND_H
#include "field/model/field.h"
#include "march/kind.h"

enum { DVI__MARCH_THREADS = 256 };

/* What a march is asked for. */
typedef struct dvi__march_plan {
  double step;     /* 0 to take the fraction */
  double fraction; /* of stable steps */
  double span;     /* which steps divide, or 0 */
  int threads;
  int potential;       /* A is kept, too */
  const char *options; /* of the method, "key=value,...", or "" */
} dvi__march_plan;

/* Check the numbers of options, and set the plan to them. Options of the method are left out. */
dvi_status dvi__plan_march(const dvi_march_options *options, dvi__march_plan *plan);

/* Choose the step of all cells, and give the bound below which steps are stable. A step beyond it
 * is refused with the bound and the place of the stiffest (k+1)-cell. */
dvi_status dvi__choose_step(const dvi_field *field, const dvi__march_plan *plan, double *step,
                            double *bound);

/* Refuse options of a method that has none. */
dvi_status dvi__refuse_options(const char *name, const dvi__march_plan *plan);

#endif
