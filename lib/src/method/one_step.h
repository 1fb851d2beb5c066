/* A step by the stationarity conditions of a kind of step that is not one element of the action
 * (element_step.h has those): the vectors, the guess, the solution, the new state and what is
 * remembered for the next guess.
 *
 * The kind (step/degenerate/partitioned.h and its neighbours) has the equations. To add one:
 * `place`, DVI__STEP_KIND(foo, place, explain), a step of four lines (darboux_step.c), and the
 * operations below in the methods' initialiser. */
#ifndef DVI_METHOD_ONE_STEP_H
#define DVI_METHOD_ONE_STEP_H
#include "core/status.h"
#include "method/stationary.h"

/* The memory: the length of the last step (0: none); what the method carries of its own; what the
 * guess continues, as many numbers as unknowns (before the first step, the start's velocity in
 * their place). */
enum { DVI__LENGTH, DVI__CARRIED };

typedef struct dvi__step_kind {
  dvi_status (*residual)(void *of, const double *x, double *R);
  dvi_status (*jacobian)(void *of, const double *x, double *values);
  dvi_status (*row_scale)(void *of, double *scale, int *unchanged);
  void (*straight)(const void *of, const double *v, double *x);
  void (*continued)(void *of, double ratio, const double *last, double *x);
  const dvi__pattern *(*pattern)(const void *of);
  dvi__evaluator *(*evaluator)(const void *of);
  void (*destroy)(void *of);
  void (*explain)(const dvi__stepper *self, dvi__text *text); /* what is its own */
  /* dvi__stationary_step's. */
  dvi_status (*place)(dvi__stepper *self, const dvi__state *state, double h, double part);
  /* How much time passes in the step with the solution x, of kinds that time-transformed systems
   * may have; NULL: h. */
  dvi_status (*duration)(void *of, const double *x, double *duration);
  /* Newton's method factors each Jacobian: forces cost more than factors; and the step corrects
   * what it takes from the last point */
  int renewed;
} dvi__step_kind;

/* A stepper's own struct begins with it. */
typedef struct dvi__one_step {
  const dvi__step_kind *kind;
  void *of; /* the step, of this kind */
  dvi__stationary equations;
  size_t last;      /* where in the memory stands what the guess continues */
  double *x, *work; /* [unknowns] the solution; room for the kind */
  double *dq, *dp;  /* [n] */
  double *carried;  /* [2 n] of the node, in a part of the step */
} dvi__one_step;

/* Make self->own, `size` bytes, and the memory with `carried` numbers of the method's own. The step
 * is owned from here on, also on failure. */
dvi_status dvi__one_step_create(dvi__stepper *self, size_t size, const dvi__step_kind *kind,
                                void *of, size_t carried);

/* Solve a step of length h from the state: x, from the guess that is a straight line along the
 * velocity at the start, and later what was remembered, continued. */
dvi_status dvi__one_step_solve(dvi__stepper *self, const dvi__state *state, double h);

/* The momentum [n] from which a part of the step starts: where a method leaves p = alpha(q), what
 * keeps them apart belongs to the length of its steps, and without it there are no velocities. */
dvi_status dvi__one_step_momentum(dvi__stepper *self, const dvi__state *state, double part,
                                  const double **p);

/* Move q by dq and t by the duration at x, and remember `last` [unknowns]. After the ends are
 * taken. */
dvi_status dvi__one_step_move(dvi__stepper *self, dvi__state *state, double h, const double *last);

/* p = alpha(q), to the last bit. */
dvi_status dvi__one_step_constrain(dvi__stepper *self, dvi__state *state);

/* Operations of dvi__method, and what goes into its initialiser for them. */
void dvi__one_step_destroy(dvi__stepper *self);
void dvi__one_step_start(dvi__stepper *self, const double *v);
void dvi__one_step_explain(const dvi__stepper *self, dvi__text *text);

#define DVI__ONE_STEP_OPERATIONS \
  .destroy = dvi__one_step_destroy, .start = dvi__one_step_start, .explain = dvi__one_step_explain

/* The kind whose functions are dvi__foo_..., as `kind`; then its `place` and `explain`, and what
 * else it wants to set. */
#define DVI__STEP_KIND(foo, placed, ...)                                          \
  static dvi_status residual_of(void *of, const double *x, double *R)             \
  {                                                                               \
    return dvi__##foo##_residual(of, x, R);                                       \
  }                                                                               \
  static dvi_status jacobian_of(void *of, const double *x, double *values)        \
  {                                                                               \
    return dvi__##foo##_jacobian(of, x, values);                                  \
  }                                                                               \
  static dvi_status row_scale_of(void *of, double *scale, int *unchanged)         \
  {                                                                               \
    (void)unchanged;                                                              \
    return dvi__##foo##_scale(of, scale);                                         \
  }                                                                               \
  static void straight_of(const void *of, const double *v, double *x)             \
  {                                                                               \
    dvi__##foo##_straight(of, v, x);                                              \
  }                                                                               \
  static void continued_of(void *of, double ratio, const double *last, double *x) \
  {                                                                               \
    dvi__##foo##_continue(of, ratio, last, x);                                    \
  }                                                                               \
  static const dvi__pattern *pattern_of(const void *of)                           \
  {                                                                               \
    return dvi__##foo##_pattern(of);                                              \
  }                                                                               \
  static dvi__evaluator *evaluator_of(const void *of)                             \
  {                                                                               \
    return dvi__##foo##_evaluator(of);                                            \
  }                                                                               \
  static void destroy_of(void *of)                                                \
  {                                                                               \
    dvi__##foo *step = of;                                                        \
    dvi__##foo##_destroy(&step);                                                  \
  }                                                                               \
  static const dvi__step_kind kind = {.residual = residual_of,                    \
                                      .jacobian = jacobian_of,                    \
                                      .row_scale = row_scale_of,                  \
                                      .straight = straight_of,                    \
                                      .continued = continued_of,                  \
                                      .pattern = pattern_of,                      \
                                      .evaluator = evaluator_of,                  \
                                      .destroy = destroy_of,                      \
                                      .place = placed,                            \
                                      .explain = __VA_ARGS__}

#endif
