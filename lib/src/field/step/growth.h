/* The growth of a field under the steps of a march, whichever they are. */
#ifndef DVI_FIELD_STEP_GROWTH_H
#define DVI_FIELD_STEP_GROWTH_H
#include <dvi/march.h>

#include "core/status.h"

/* A field with a diagonal star, and the steps that carry it. Its free k-cells have the numbers from
 * 0 to n - 1. A code is the number of a cell, or its complement if the sign is negative. */
typedef struct dvi__flow {
  int64_t n, faces;           /* free k-cells, and (k+1)-cells */
  int width;                  /* k-cells of a (k+1)-cell */
  const int *facet;           /* [faces*width] codes. Numbers beyond n are held at 0 */
  const double *M1, *inverse; /* [n] M_k and its inverse */
  const double *M2;           /* [faces] */
  double bound;               /* a stable step, which tells how large A is beside D = M_k E */
  double *A, *D;              /* [n] the state */
  double *bias;               /* [faces] B - dA, which stays. 0 at first */
  int has_losses;             /* some of which take energy away */
  double *work;               /* [faces] room */
  /* Carry the state from the time 0 to t, at which all steps meet again. */
  dvi_status (*carry)(void *of, double t);
  /* Give the energy at t of the state at 0. Calls begin with t = 0, and times ascend. */
  dvi_status (*energy)(void *of, double t, double *energy);
  void *of;
} dvi__flow;

/* The steps. */
typedef struct dvi__schedule {
  int64_t count;
  const double *step; /* [count] */
  double longest;
  double events; /* that a search may cost, unless the user asks for a span */
} dvi__schedule;

/* Find the growth as dvi_field_stability does. `period` of the report is that of the steps, or 0.
 * The schedule's words are left to the march. */
dvi_status dvi__find_growth(const dvi__flow *flow, const dvi__schedule *schedule, double span,
                            dvi_stability *report);

/* Give the largest size of an eigenvalue of the monodromy matrix of a period, or of some power of
 * it, whose time is *span, by all modes of the field. */
dvi_status dvi__all_multipliers(const dvi__flow *flow, double period, dvi_stability *report);

/* The same by Arnoldi's method. */
dvi_status dvi__largest_multipliers(const dvi__flow *flow, double period, double span,
                                    dvi_stability *report);

/* Write the steps in words. */
void dvi__say_schedule(dvi_stability *report, const char *format, ...) DVI_PRINTF(2, 3);

/* Refuse a size that has grown beyond all numbers within some time. */
dvi_status dvi__check_size(double size, double time);

/* Set A and D to a random field without a static part, whose energy is 1/2. */
void dvi__scatter(const dvi__flow *flow);

/* Give the number behind a code. */
static inline int dvi__flow_number(int code)
{
  return code < 0 ? ~code : code;
}

/* Give B on a (k+1)-cell. */
static inline double dvi__flow_field(const dvi__flow *flow, int64_t face)
{
  const int *code = flow->facet + face * flow->width;
  double sum = flow->bias[face];
  for (int c = 0; c < flow->width; c++) {
    const int i = dvi__flow_number(code[c]);
    if (i < flow->n) sum += code[c] < 0 ? -flow->A[i] : flow->A[i];
  }
  return sum;
}

#endif
