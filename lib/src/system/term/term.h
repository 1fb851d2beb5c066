/* One term at a batch of points, by its callback in the declared shape, or by differences if it is
 * missing.
 *
 * The evaluator and the derivative check alone use this. */
#ifndef DVI_SYSTEM_TERM_TERM_H
#define DVI_SYSTEM_TERM_TERM_H
#include "system/system.h"

/* Memory of one level of differencing, for moved points and the function on both sides. Each array
 * is [n*capacity], or NULL if nothing is differenced at this level. */
typedef struct dvi__differences {
  double *moved, *step, *plus, *minus, *plus_v, *minus_v;
  long points; /* count of points at which the function was evaluated */
  int shorter; /* count of halvings of the steps over which columns are differenced */
} dvi__differences;

typedef struct dvi__scratch {
  int n, nv, capacity;
  double *point_q, *point_v; /* one point [n], for one-point callbacks */
  double *result[3];         /* results at that point, each as long as the longest Hessian */
  double *vector_q;          /* gradients of a vector potential at all points, or NULL */
  /* Two levels. A missing gradient under a missing Hessian uses both. */
  dvi__differences of_value, of_gradient;
} dvi__scratch;

/* Allocate n*capacity numbers in each array. Return 0 if there is no memory, and let clear free the
 * rest. */
int dvi__differences_allocate(size_t numbers, dvi__differences *d);
void dvi__differences_clear(dvi__differences *d);

/* Create scratch memory. `hessians` says that potentials' Hessians will be evaluated, for which the
 * system must be prepared. */
dvi_status dvi__scratch_create(const dvi_system *system, int capacity, int hessians,
                               dvi__scratch *scratch);
void dvi__scratch_clear(dvi__scratch *scratch);

/* Return the status of a callback's return value and its results, `entries` at each of `count`
 * points. `in` names the result. */
dvi_status dvi__verdict(int returned, int entries, int count, const double *result,
                        const char *name, const char *what, const char *in);

/* Copy point k of a batch of n numbers each, and the results at one point into a batch. */
void dvi__gather_point(int n, int count, int k, const double *batch, double *point);
void dvi__scatter_result(int entries, int count, int k, const double *point, double *batch);

/* Group the columns of a Lagrangian's patterns, or of a function's in its place, for differences.
 * The second function frees the memory of the term. */
dvi_status dvi__general_group(dvi__lagrangian_term *term);
void dvi__general_clear(dvi__lagrangian_term *term);

/* All of these check the callback's return and that every number is finite. Shapes are as in
 * evaluator.h. */
dvi_status dvi__potential_value(const dvi__potential_term *p, dvi__scratch *s, int count,
                                const double *t, const double *q, double *V);
dvi_status dvi__potential_gradient(const dvi__potential_term *p, dvi__scratch *s, int count,
                                   const double *t, const double *q, double *V_q);
dvi_status dvi__potential_hessian(const dvi__potential_term *p, dvi__scratch *s, int count,
                                  const double *t, const double *q, double *V_qq);
dvi_status dvi__potential_rate(const dvi__potential_term *p, dvi__scratch *s, int count,
                               const double *t, const double *q, double *V_t);
dvi_status dvi__general_value(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                              const double *t, const double *q, const double *v, double *L);
dvi_status dvi__general_gradient(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                                 const double *t, const double *q, const double *v, double *L_q,
                                 double *L_v);
dvi_status dvi__general_hessian(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                                const double *t, const double *q, const double *v, double *L_qq,
                                double *L_qv, double *L_vv);
dvi_status dvi__general_rate(const dvi__lagrangian_term *l, dvi__scratch *s, int count,
                             const double *t, const double *q, const double *v, double *L_t);

/* Tell if a Lagrangian is defined at q. */
dvi_status dvi__general_admit(const dvi__lagrangian_term *l, double t, const double *q);

/* Compute alpha [n] of a one-form at one point, its gauge included, and the gradients of its
 * components in the order of the term's qv. `work` is as long as the longest Hessian. */
dvi_status dvi__form_value(const dvi__lagrangian_term *l, const double *q, double *alpha,
                           double *work);
dvi_status dvi__form_gradients(const dvi__lagrangian_term *l, const double *q, double *alpha_q,
                               double *work);

/* A potential as a function of q alone, in the shapes of system/term/difference.h. `function` is a
 * dvi__potential_at. */
typedef struct dvi__potential_at {
  const dvi__potential_term *term;
  dvi__scratch *scratch;
  const double *t;
} dvi__potential_at;

dvi_status dvi__potential_value_of_q(const void *function, int count, const double *q, double *V);
dvi_status dvi__potential_gradient_of_q(const void *function, int count, const double *q,
                                        double *V_q, double *none);

/* A Lagrangian as a function of q alone (v is fixed) or of v alone. `function` is a
 * dvi__general_at. */
typedef struct dvi__general_at {
  const dvi__lagrangian_term *term;
  dvi__scratch *scratch;
  const double *t, *q, *v;
} dvi__general_at;

dvi_status dvi__general_value_of_q(const void *function, int count, const double *q, double *L);
dvi_status dvi__general_value_of_v(const void *function, int count, const double *v, double *L);
dvi_status dvi__general_gradient_of_q(const void *function, int count, const double *q, double *L_q,
                                      double *L_v);
dvi_status dvi__general_gradient_of_v(const void *function, int count, const double *v, double *L_q,
                                      double *L_v);

/* Return 1 if nothing but potentials depends on the coordinates. Single points then need no
 * scratch memory but that of differences and Hessians. */
int dvi__only_potentials(const dvi_system *system);

/* Return 1 if a gradient is differenced from values. */
int dvi__lacks_gradient(const dvi_system *system);

/* Return the length of the longest Hessian block that the scratch memory above serves, at least
 * n. */
int dvi__longest_hessian(const dvi_system *system, int hessians);

int dvi__potential_has_gradient(const dvi__potential_term *p);
int dvi__potential_has_hessian(const dvi__potential_term *p);
int dvi__potential_has_rate(const dvi__potential_term *p);
int dvi__general_has_gradient(const dvi__lagrangian_term *l);
int dvi__general_has_hessian(const dvi__lagrangian_term *l);
int dvi__general_has_rate(const dvi__lagrangian_term *l);

#endif
