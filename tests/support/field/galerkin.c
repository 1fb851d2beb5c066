#include "galerkin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "field/algebra/definite.h"
#include "field/space/space.h"
#include "support/suite.h"

/* Give the products w g at the points of a space. `g` may be NULL for 1. */
static double *weighted(const dvi_space *space, function_of_place *g, void *user)
{
  const double *x, *weight;
  const int64_t points = dvi_space_points(space, &x, &weight);
  double *values = malloc((size_t)points * sizeof *values);
  for (int64_t i = 0; i < points; i++) values[i] = 1;
  if (g != NULL) ck_assert_int_eq(g(points, x, values, user), 0);
  for (int64_t i = 0; i < points; i++) values[i] *= weight[i];
  return values;
}

static dvi__space_operator derivative(const dvi_space *space, int axis)
{
  int order[DVI_AXES_MAX] = {0};
  dvi__space_operator B;
  if (axis >= 0) order[axis] = 1;
  ck_assert_msg(dvi__operator_make(space, order, &B) == DVI_OK, "%s", dvi_last_error());
  return B;
}

/* Make B^T diag(weight) B for the functions inside. */
static dvi__csr square(const galerkin *g, const dvi__csr *B, const double *weight)
{
  const dvi_matrix W = {B->rows, B->rows, 1, 1, NULL, NULL, NULL, weight};
  const dvi__selection inside = {g->number, g->number, g->inside, g->inside};
  const dvi_matrix view = dvi__csr_view(B, 0);
  dvi__csr all, part;
  ck_assert_int_eq(dvi__csr_square(&view, &W, &all), DVI_OK);
  const dvi_matrix whole = dvi__csr_view(&all, 1);
  ck_assert_int_eq(dvi__csr_select(&whole, &inside, &part), DVI_OK);
  dvi__csr_clear(&all);
  return part;
}

static void number_inside(const dvi_space *space, galerkin *g)
{
  int64_t count = 0;
  const int *at = dvi_space_boundary(space, "boundary", &count);
  g->functions = dvi_space_functions(space);
  g->number = calloc((size_t)g->functions, sizeof *g->number);
  for (int64_t i = 0; i < count; i++) g->number[at[i]] = -1;
  for (int64_t i = 0; i < g->functions; i++)
    if (g->number[i] == 0) g->number[i] = (int)g->inside++;
}

static void set_stiffness(const dvi_space *space, const double *weight, galerkin *g)
{
  for (int d = 0; d < dvi_space_dimension(space); d++) {
    dvi__space_operator B = derivative(space, d);
    dvi__csr part = square(g, &B.matrix, weight), sum;
    if (d > 0) {
      const dvi_matrix before = dvi__csr_view(&g->stiffness, 1), own = dvi__csr_view(&part, 1);
      ck_assert_int_eq(dvi__csr_sum(&before, &own, &sum), DVI_OK);
      dvi__csr_clear(&g->stiffness);
      dvi__csr_clear(&part);
      part = sum;
    }
    g->stiffness = part;
    dvi__operator_clear(&B);
  }
}

/* Set the load of the functions inside. Their numbers ascend, so that it is done in place. */
static void set_load(const dvi__csr *B, const double *weight, galerkin *g)
{
  const dvi_matrix view = dvi__csr_view(B, 0);
  g->load = malloc((size_t)g->functions * sizeof *g->load);
  dvi_matrix_multiply(&view, 1, weight, g->load);
  for (int64_t i = 0; i < g->functions; i++)
    if (g->number[i] >= 0) g->load[g->number[i]] = g->load[i];
}

galerkin galerkin_of(const dvi_space *space, function_of_place *a, function_of_place *f, void *user)
{
  galerkin g = {.inside = 0};
  double *wa = weighted(space, a, user), *w = weighted(space, NULL, NULL);
  double *wf = weighted(space, f, user);
  number_inside(space, &g);
  set_stiffness(space, wa, &g);
  dvi__space_operator B = derivative(space, -1);
  g.mass = square(&g, &B.matrix, w);
  set_load(&B.matrix, wf, &g);
  dvi__operator_clear(&B);
  free(wa);
  free(wf);
  free(w);
  return g;
}

void galerkin_clear(galerkin *problem)
{
  dvi__csr_clear(&problem->stiffness);
  dvi__csr_clear(&problem->mass);
  free(problem->load);
  free(problem->number);
}

void galerkin_solve(const galerkin *problem, double *U)
{
  const dvi_matrix K = dvi__csr_view(&problem->stiffness, 1);
  double *x = malloc((size_t)problem->inside * sizeof *x);
  dvi__definite solver;
  ck_assert_msg(dvi__definite_create(&K, 2, &solver) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi__definite_solve(&solver, problem->load, x, NULL), DVI_OK);
  for (int64_t i = 0; i < problem->functions; i++)
    U[i] = problem->number[i] >= 0 ? x[problem->number[i]] : 0;
  dvi__definite_clear(&solver);
  free(x);
}

void galerkin_frequencies(const galerkin *problem, double *omega)
{
  const dvi_matrix K = dvi__csr_view(&problem->stiffness, 1), M = dvi__csr_view(&problem->mass, 1);
  const dvi_modes_options options = {.size = sizeof options, .count = (int)problem->inside};
  ck_assert_msg(dvi_matrix_modes(&K, &M, &options, omega, NULL) == DVI_OK, "%s", dvi_last_error());
  for (int64_t i = 0; i < problem->inside; i++) omega[i] = sqrt(omega[i]);
}
