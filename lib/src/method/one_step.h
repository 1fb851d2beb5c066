/* A step by the stationarity conditions of a kind of step that is not one element of the action.
 * The file element_step.h has the steps by elements. This file owns the vectors, the guess, the
 * solution, the new state and the memory of the next guess.
 *
 * The kind (step/degenerate/partitioned.h and its neighbours) has the equations. To add a kind,
 * write `place`, DVI__STEP_KIND(foo, place, explain), a step of four lines (darboux_step.c), and
 * the operations below in the initialisers of the methods. */
#ifndef DVI_METHOD_ONE_STEP_H
#define DVI_METHOD_ONE_STEP_H
#include "core/status.h"
#include "method/predictor.h"
#include "method/stationary.h"

/* The memory starts with the length of the last step (0 before the first step). The carried numbers
 * of the method follow. Behind them is what the guess continues, as many numbers as unknowns.
 * Before the first step the velocity of the start stands there. The predictor's numbers and
 * DVI__LADDER numbers come last. */
enum { DVI__LENGTH, DVI__CARRIED };

typedef struct dvi__step_kind {
  dvi_status (*residual)(void *of, const double *x, double *R);
  dvi_status (*jacobian)(void *of, const double *x, double *values);
  /* The Jacobian in parts, as in dvi__equations; NULL if it is a matrix alone */
  dvi_status (*invert)(void *of, const double *x, int *inverted);
  void (*correct)(void *of, double *r);
  void (*fill)(void *of, double *values);
  dvi_status (*row_scale)(void *of, double *scale, int *unchanged);
  void (*straight)(const void *of, const double *v, double *x);
  void (*continued)(void *of, double ratio, const double *last, double *x);
  const dvi__pattern *(*pattern)(const void *of);
  dvi__evaluator *(*evaluator)(const void *of);
  void (*destroy)(void *of);
  void (*explain)(const dvi__stepper *self, dvi__text *text); /* explains the part of this kind */
  /* Signature as in dvi__stationary_step. */
  dvi_status (*place)(dvi__stepper *self, const dvi__state *state, double h, double part);
  /* The time that passes in the step with the solution x, for kinds that accept time-transformed
   * systems. NULL selects h. */
  dvi_status (*duration)(void *of, const double *x, double *duration);
  /* Fixed-point iteration, as the members of dvi__equations with these names (nonlinear.h). It
   * serves if `has_iteration` says so. All are NULL if there is none. */
  int (*has_iteration)(const void *of);
  void (*fixed_point_begin)(void *of, const double *x);
  dvi_status (*fixed_point_iterate)(void *of, double *change, double *largest);
  void (*fixed_point_end)(void *of, double *x);
  int fixed_point_frozen; /* that iteration is simplified Newton's method */
  /* Newton's method factors each Jacobian, because forces cost more than factors, and the step
   * corrects increments from the last point */
  int renewed;
  int inexact; /* the Jacobian is not that of all rows */
} dvi__step_kind;

/* The own struct of a stepper begins with this struct. */
typedef struct dvi__one_step {
  const dvi__step_kind *kind;
  void *of; /* the step, of this kind */
  dvi__stationary equations;
  size_t last; /* place in the memory where the numbers for the next guess begin */
  dvi__predictor predictor;
  double *x, *work; /* [unknowns] the solution, and work for the kind */
  double *dq, *dp;  /* [n] */
  double *carried;  /* [2 n] jump of the node, scaled to a part of the step */
} dvi__one_step;

/* Make self->own, of `size` bytes, and the memory with `carried` numbers of the method. The stepper
 * owns the step from here on, also on failure. */
dvi_status dvi__one_step_create(dvi__stepper *self, size_t size, const dvi__step_kind *kind,
                                void *of, size_t carried);

/* Solve a step of length h from the state for x. The first guess is a straight line along the
 * velocity at the start. Later guesses continue the remembered numbers. */
dvi_status dvi__one_step_solve(dvi__stepper *self, const dvi__state *state, double h);

/* Tell whether the last solution is that of fixed-point iteration. */
int dvi__one_step_is_iterated(const dvi__stepper *self);

/* The momentum [n] from which a part of the step starts. Where a method leaves p = alpha(q), the
 * distance from alpha(q) belongs to the length of the steps, and is scaled with the part. Without
 * this scaling there would be no velocities. */
dvi_status dvi__one_step_momentum(dvi__stepper *self, const dvi__state *state, double part,
                                  const double **p);

/* Move q by dq and t by the duration at x, and remember `last` [unknowns]. To be called after the
 * ends are computed. */
dvi_status dvi__one_step_move(dvi__stepper *self, dvi__state *state, double h, const double *last);

/* Set p = alpha(q), to the last bit. */
dvi_status dvi__one_step_constrain(dvi__stepper *self, dvi__state *state);

/* Operations of dvi__method, and their entries in its initialiser. */
void dvi__one_step_destroy(dvi__stepper *self);
void dvi__one_step_start(dvi__stepper *self, const double *v);
void dvi__one_step_explain(const dvi__stepper *self, dvi__text *text);

#define DVI__ONE_STEP_OPERATIONS \
  .destroy = dvi__one_step_destroy, .start = dvi__one_step_start, .explain = dvi__one_step_explain

/* Define the parts of the Jacobian of a step whose functions are dvi__foo_..., which are further
 * members of its kind. */
#define DVI__STEP_PARTS(foo)                                            \
  static dvi_status invert_of(void *of, const double *x, int *inverted) \
  {                                                                     \
    return dvi__##foo##_invert(of, x, inverted);                        \
  }                                                                     \
  static void correct_of(void *of, double *r)                           \
  {                                                                     \
    dvi__##foo##_correct(of, r);                                        \
  }                                                                     \
  static void fill_of(void *of, double *values)                         \
  {                                                                     \
    dvi__##foo##_fill(of, values);                                      \
  }
#define DVI__STEP_PART_MEMBERS .invert = invert_of, .correct = correct_of, .fill = fill_of

/* Define `kind` for a step whose functions are dvi__foo_..., with the functions `place` and
 * `explain`. Further members may follow. */
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

/* Define the functions of a kind's iteration, dvi__foo_has_iteration, _begin, _iterate and _finish,
 * and give the entries for them in DVI__STEP_KIND. */
#define DVI__STEP_ITERATION(foo)                                          \
  static int has_iteration_of(const void *of)                             \
  {                                                                       \
    return dvi__##foo##_has_iteration(of);                                \
  }                                                                       \
  static void begin_of(void *of, const double *x)                         \
  {                                                                       \
    dvi__##foo##_begin(of, x);                                            \
  }                                                                       \
  static dvi_status iterate_of(void *of, double *change, double *largest) \
  {                                                                       \
    return dvi__##foo##_iterate(of, change, largest);                     \
  }                                                                       \
  static void finish_of(void *of, double *x)                              \
  {                                                                       \
    dvi__##foo##_finish(of, x);                                           \
  }

#define DVI__STEP_ITERATES                                          \
  .has_iteration = has_iteration_of, .fixed_point_begin = begin_of, \
  .fixed_point_iterate = iterate_of, .fixed_point_end = finish_of

#endif
