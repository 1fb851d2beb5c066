/* Compares members of an ensemble that are side by side with runs alone, bit by bit. */
#ifndef TESTS_INTEGRATOR_TWINS_H
#define TESTS_INTEGRATOR_TWINS_H
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { MEMBERS = 21, BLOCK = 8, NUMBERS = 24 };

/* Members start at q [nq] with multiples of v [nv], and take steps of these lengths [steps]. */
typedef struct twins {
  const dvi_system *system;
  const char *method;
  int nq, nv;
  const double *q, *v;
  int steps;
  const double *length;
} twins;

static inline double speed_of(int k)
{
  return 0.08 * (1 + 8 * k % MEMBERS);
}

static inline void start_members(dvi_ensemble *e, const twins *all)
{
  double q[NUMBERS * MEMBERS], v[NUMBERS * MEMBERS];
  for (int k = 0; k < MEMBERS; k++) {
    for (int i = 0; i < all->nq; i++) q[i * MEMBERS + k] = all->q[i];
    for (int i = 0; i < all->nv; i++) v[i * MEMBERS + k] = speed_of(k) * all->v[i];
  }
  ck_assert_msg(dvi_ensemble_start_velocity(e, 0, q, v) == DVI_OK, "%s", dvi_last_error());
}

/* Returns the gradients that the run alone takes. */
static inline long same_as_alone(dvi_ensemble *e, const twins *all, int k)
{
  double t[MEMBERS], q[NUMBERS * MEMBERS], p[NUMBERS * MEMBERS], start[NUMBERS];
  dvi_counters counters;
  dvi_integrator *alone = create_integrator(all->system, all->method);
  for (int i = 0; i < all->nv; i++) start[i] = speed_of(k) * all->v[i];
  dvi_status status = dvi_integrator_start_velocity(alone, 0, all->q, start);
  for (int i = 0; i < all->steps; i++) status = dvi_integrator_step(alone, all->length[i]);
  ck_assert_int_eq(dvi_ensemble_status(e, k), status);
  ck_assert_int_eq(dvi_ensemble_state(e, t, q, p), DVI_OK);
  for (int i = 0; i < all->nq; i++)
    ck_assert_mem_eq(&q[i * MEMBERS + k], dvi_integrator_q(alone) + i, sizeof(double));
  for (int i = 0; i < all->nv; i++)
    ck_assert_mem_eq(&p[i * MEMBERS + k], dvi_integrator_p(alone) + i, sizeof(double));
  ck_assert_double_eq(t[k], dvi_integrator_time(alone));
  dvi_integrator_counters(alone, &counters);
  dvi_integrator_destroy(&alone);
  return counters.gradients;
}

static inline int goes_side_by_side(const dvi_ensemble *e)
{
  char text[4096];
  (void)dvi_ensemble_explain(e, text, sizeof text);
  return strstr(text, "side by side as lanes") != NULL;
}

/* Compares states, statuses, times and gradients. Returns how many steps fail. */
static inline long compare_members(const twins *all, int threads)
{
  const dvi_ensemble_options options = {.members = MEMBERS, .threads = threads, .block = BLOCK};
  dvi_counters counters;
  dvi_ensemble *e = create_ensemble(all->system, all->method, options);
  ck_assert_msg(goes_side_by_side(e), "%s", all->method);
  start_members(e, all);
  for (int i = 0; i < all->steps; i++) (void)dvi_ensemble_step(e, all->length[i]);
  long gradients = 0;
  for (int k = 0; k < MEMBERS; k++) gradients += same_as_alone(e, all, k);
  dvi_ensemble_counters(e, &counters);
  ck_assert_int_eq(counters.gradients, gradients);
  dvi_ensemble_destroy(&e);
  return counters.failed_steps;
}

#endif
