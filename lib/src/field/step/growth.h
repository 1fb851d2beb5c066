/* The growth of a field under the steps of a march, whichever they are. */
#ifndef DVI_FIELD_STEP_GROWTH_H
#define DVI_FIELD_STEP_GROWTH_H
#include <dvi/march.h>

#include "core/status.h"

typedef struct dvi__flow dvi__flow;

/* What of a field has potential energy. A search follows numbers in its place, here called strains,
 * because A may have parts without any energy, which only grow. */
typedef struct dvi__flow_strain {
  void (*stiffness)(const dvi__flow *flow, double *K); /* add the stiffness [n*n] */
  /* Set A and D to a random field without a static part, whose energy is 1/2. */
  void (*scatter)(const dvi__flow *flow);
  void (*put)(const dvi__flow *flow, const double *strain); /* before a passage */
  void (*take)(const dvi__flow *flow, double *strain);      /* after it. Nothing of it stays */
  /* Give the derivatives of half a square, such as the potential energy [strains]. */
  void (*weigh)(const dvi__flow *flow, const double *strain, double *image);
} dvi__flow_strain;

/* A field with a diagonal star or mass, and the steps that carry it. Its free numbers, such as
 * those of k-cells, are 0 to n - 1. */
struct dvi__flow {
  int64_t n;
  const double *M1, *inverse; /* [n] M_k and its inverse */
  double *A, *D;              /* [n] the state, D = M_k E */
  int has_losses;             /* some of which take energy away */
  int has_memory;             /* A and D are not all of the state, as strains and D are */
  int64_t strains;
  const dvi__flow_strain *strain;
  /* Carry the state from the time 0 to t, at which all steps meet again. */
  dvi_status (*carry)(void *of, double t);
  /* Give the energy at t of the state at 0. Calls begin with t = 0, and times ascend. */
  dvi_status (*energy)(void *of, double t, double *energy);
  void *of;
  /* Of a k-form, whose strains are B on the (k+1)-cells. A code is the number of a k-cell, or its
   * complement if the sign is negative. */
  int width;        /* k-cells of a (k+1)-cell */
  const int *facet; /* [strains*width] codes. Numbers beyond n are held at 0 */
  const double *M2; /* [strains] */
  double bound;     /* a stable step, which tells how large A is beside D */
  double *bias;     /* [strains] B - dA, which stays. 0 at first */
  double *work;     /* [strains] room */
};

/* The strains of a k-form. */
extern const dvi__flow_strain dvi__strain_of_forms;

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

/* Write asynchronous steps in words, with the number of classes, or 0 for free steps. */
void dvi__say_steps(dvi_stability *report, double shortest, double longest, int classes);

/* Refuse a size that has grown beyond all numbers within some time. */
dvi_status dvi__check_size(double size, double time);

/* Give a random number from -1 to 1, of a number. */
double dvi__random_between(uint64_t number);

/* Give the number behind a code. */
static inline int dvi__flow_number(int code)
{
  return code < 0 ? ~code : code;
}

#endif
