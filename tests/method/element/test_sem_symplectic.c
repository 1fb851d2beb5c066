/* labels: invariant */
/* sem is symplectic in (t,E,q,p): dq ^ dp - dt ^ dE is the same before a step and after it.
 *
 * The starts (t0,h0,q0,p0) are mapped by one ordinary step to F = (t,E,q,p), where E is the energy
 * E+ that the method carries, and by more steps, whose lengths the method chooses, to G. The form,
 * pulled back by F and by G to the starts, must be the same numbers. Derivatives are differenced by
 * order 8. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/runs.h"
#include "support/suite.h"

enum { N_MOST = 2, COLUMNS_MOST = 2 * N_MOST + 2 };

/* Indices of a point's numbers t, E, q, p. */
typedef struct point {
  double x[COLUMNS_MOST];
} point;

typedef struct place {
  const char *problem, *setting, *method;
  double h, apart;
  int steps;
} place;

static void point_of(dvi_integrator *integrator, int n, point *at)
{
  dvi_energy_balance energy;
  ck_assert_int_eq(dvi_integrator_energy_balance(integrator, &energy), DVI_OK);
  ck_assert_msg(energy.fallbacks == 0, "a fallback is no map of this kind");
  at->x[0] = dvi_integrator_time(integrator);
  at->x[1] = energy.energy;
  memcpy(at->x + 2, dvi_integrator_q(integrator), (size_t)n * sizeof(double));
  memcpy(at->x + 2 + n, dvi_integrator_p(integrator), (size_t)n * sizeof(double));
}

/* From a start (t0, h0, q0, p0) to F and G. */
static void run_from(dvi_integrator *integrator, const place *at, int n, const double *start,
                     point *F, point *G)
{
  ck_assert_msg(dvi_integrator_start(integrator, start[0], start + 2, start + 2 + n) == DVI_OK,
                "%s", dvi_last_error());
  advance(integrator, start[1], 1);
  point_of(integrator, n, F);
  advance(integrator, start[1], at->steps - 1);
  point_of(integrator, n, G);
}

/* Columns j of dF and dG. */
static void differentiate(dvi_integrator *integrator, const place *at, int n, const double *start,
                          int j, point *dF, point *dG)
{
  static const double weight[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  double moved[COLUMNS_MOST];
  point F[2], G[2];
  *dF = *dG = (point){{0}};
  memcpy(moved, start, sizeof moved);
  for (int m = 1; m <= 4; m++) {
    for (int side = 0; side < 2; side++) {
      moved[j] = start[j] + (side == 0 ? m : -m) * at->apart;
      run_from(integrator, at, n, moved, &F[side], &G[side]);
    }
    for (int i = 0; i < 2 * n + 2; i++) {
      dF->x[i] += weight[m - 1] * (F[0].x[i] - F[1].x[i]) / at->apart;
      dG->x[i] += weight[m - 1] * (G[0].x[i] - G[1].x[i]) / at->apart;
    }
  }
}

/* (dq ^ dp - dt ^ dE)(a, b) */
static double form(int n, const point *a, const point *b)
{
  double sum = -(a->x[0] * b->x[1] - a->x[1] * b->x[0]);
  for (int i = 2; i < 2 + n; i++) sum += a->x[i] * b->x[i + n] - a->x[i + n] * b->x[i];
  return sum;
}

/* The higher the degree, the less h changes the energy, and the more roundings move it. High
 * degrees need long steps. */
static const place places[] = {
    {"kepler", "e=0.2", "sem:degree=1", 0.5, 1e-3, 4},
    {"kepler", "e=0.2", "sem:degree=1,quadrature=lobatto", 0.5, 1e-3, 4},
    {"kepler", "e=0.2", "sem:degree=2", 0.5, 1e-3, 4},
    {"kepler", "e=0.2", "sem:degree=2,quadrature=lobatto", 0.8, 1e-3, 4},
    {"kepler", "e=0.2", "sem:degree=3", 0.8, 5e-4, 2},
    {"driven-pendulum", NULL, "sem:degree=1", 0.5, 1e-3, 4},
    {"driven-pendulum", NULL, "sem:degree=2", 0.5, 1e-3, 4},
    {"driven-pendulum", NULL, "sem:degree=2,quadrature=lobatto", 0.5, 1e-3, 2},
    {"driven-pendulum", NULL, "sem:degree=3", 1.3, 1e-3, 2},
    {"driven-pendulum", NULL, "sem:degree=3,quadrature=lobatto", 1.3, 1e-3, 2},
    {"driven-pendulum", NULL, "sem:degree=4", 1.3, 1e-3, 2},
    {"driven-pendulum", NULL, "sem:degree=4,quadrature=lobatto", 1.3, 1e-3, 2},
};
enum { PLACES = sizeof places / sizeof *places };

START_TEST(the_form_is_the_same_before_and_after)
{
  const place *at = &places[_i];
  problem *model = create_problem(at->problem, at->setting);
  const int n = model->nq, columns = 2 * n + 2;
  dvi_integrator *integrator = create_integrator(model->system, at->method);
  double start[COLUMNS_MOST] = {0.3, at->h}, worst = 0, largest = 0;
  point dF[COLUMNS_MOST], dG[COLUMNS_MOST];
  memcpy(start + 2, model->q, (size_t)n * sizeof(double));
  memcpy(start + 2 + n, model->p, (size_t)n * sizeof(double));
  for (int j = 0; j < columns; j++) differentiate(integrator, at, n, start, j, &dF[j], &dG[j]);
  for (int i = 0; i < columns; i++)
    for (int j = 0; j < i; j++) {
      const double before = form(n, &dF[i], &dF[j]), after = form(n, &dG[i], &dG[j]);
      worst = fmax(worst, fabs(after - before));
      largest = fmax(largest, fabs(before));
    }
  if (getenv("DVI_SHOW_ORDERS"))
    printf("%s %s: %.2e of %.2e\n", at->problem, at->method, worst, largest);
  ck_assert_msg(worst <= 1e-10 * largest, "%s %s: the form changes by %g of %g", at->problem,
                at->method, worst, largest);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* dq ^ dp at a fixed h belongs to the ordinary step that begins a run. dvi_symplecticity measures
 * it, wherever the integrator stands. */
START_TEST(the_first_step_is_symplectic_in_q_and_p_alone)
{
  problem *kepler = create_problem("kepler", "e=0.2");
  dvi_integrator *integrator = start_integrator(kepler, "sem:degree=2");
  double defect;
  advance(integrator, 0.5, 3);
  ck_assert_int_eq(dvi_symplecticity(integrator, 0, dvi_integrator_q(integrator),
                                     dvi_integrator_p(integrator), 0.5, &defect),
                   DVI_OK);
  ck_assert_double_le(defect, 1e-11);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&kepler);
}
END_TEST

SUITE(sem_symplectic)
{
  tcase_add_loop_test(tests, the_form_is_the_same_before_and_after, 0, PLACES);
  tcase_add_test(tests, the_first_step_is_symplectic_in_q_and_p_alone);
}
