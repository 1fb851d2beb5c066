/* labels: judge */
/* Complexes of random lengths against quadruple precision. */
#include <dvi/regge.h>
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/quad/quad_regge.h"
#include "support/suite.h"

enum { COMPLEXES = 8 };

typedef struct judged {
  dvi_mesh *mesh;
  dvi_regge *regge;
  int64_t edges, hinges;
  double *length;
  quad *exact; /* the same lengths */
} judged;

static dvi_mesh *generated(const char *name)
{
  dvi_mesh *mesh = NULL;
  ck_assert_int_eq(dvi_mesh_generate(name, NULL, &mesh), DVI_OK);
  return mesh;
}

static dvi_mesh *mesh_of_case(int i)
{
  switch (i) {
  case 0: return random_simplex(3, 3, NULL, 5);
  case 1: return random_simplex(4, 4, NULL, 6);
  case 2: return jittered_mesh(3, 3, 2, 0.25, 7);
  case 3: return jittered_mesh(4, 4, 1, 0, 8);
  case 4: return generated("simplex-4");
  case 5: return generated("cell-16");
  case 6: return generated("simplex-5");
  default: return generated("cross-5");
  }
}

/* A random simplex is thin, and stays as it is. Other lengths are changed by up to a hundredth,
 * those of equilateral simplices by a tenth. */
static judged judged_of(int i)
{
  judged c = {.mesh = mesh_of_case(i)};
  unsigned long long seed = (unsigned)i + 17;
  const double change = i < 2 ? 0 : i < 4 ? 0.01 : 0.1;
  const dvi_regge_terms terms = {.size = sizeof terms, .mesh = c.mesh, .lambda = 0.75};
  ck_assert_int_eq(dvi_regge_create(&terms, &c.regge), DVI_OK);
  c.edges = dvi_mesh_count(c.mesh, 1);
  c.hinges = dvi_mesh_count(c.mesh, dvi_mesh_dimension(c.mesh) - 2);
  c.length = calloc((size_t)c.edges, sizeof *c.length);
  c.exact = calloc((size_t)c.edges, sizeof *c.exact);
  ck_assert_int_eq(dvi_regge_lengths(c.regge, c.length), DVI_OK);
  for (int64_t e = 0; e < c.edges; e++) {
    c.length[e] *= 1 + change * (2 * random_number(&seed) - 1);
    c.exact[e] = c.length[e];
  }
  return c;
}

static void end_judged(judged *c)
{
  dvi_regge_destroy(&c->regge);
  dvi_mesh_destroy(&c->mesh);
  free(c->length), free(c->exact);
}

START_TEST(deficits_volumes_and_actions_have_their_digits)
{
  judged c = judged_of(_i);
  double action, *deficit = calloc((size_t)c.hinges, sizeof *deficit),
                 *volume = calloc((size_t)c.hinges, sizeof *volume);
  quad *exact = calloc((size_t)c.hinges, sizeof *exact),
       *size = calloc((size_t)c.hinges, sizeof *size);
  ck_assert_int_eq(dvi_regge_hinges(c.regge, c.length, volume, deficit), DVI_OK);
  (void)quad_hinges(c.mesh, c.exact, exact, size);
  for (int64_t h = 0; h < c.hinges; h++) {
    ck_assert_double_eq_tol(deficit[h], (double)exact[h], 1e-13);
    ck_assert_double_eq_tol(volume[h], (double)size[h], 1e-14);
  }
  const double expected = (double)quad_regge_action(c.mesh, 0.75, c.exact);
  ck_assert_int_eq(dvi_regge_action(c.regge, c.length, &action, NULL), DVI_OK);
  ck_assert_double_eq_tol(action, expected, 1e-13 * (1 + fabs(expected)));
  free(deficit), free(volume), free(exact), free(size);
  end_judged(&c);
}
END_TEST

static quad changed(const judged *c, int64_t e, quad by_e, int64_t f, quad by_f)
{
  const quad at_e = c->exact[e], at_f = c->exact[f];
  c->exact[e] += by_e;
  c->exact[f] += by_f;
  const quad action = quad_regge_action(c->mesh, 0.75, c->exact);
  c->exact[f] = at_f;
  c->exact[e] = at_e;
  return action;
}

/* Differences of 1e-11 have errors of some 1e-20. */
START_TEST(gradients_are_those_of_the_action)
{
  judged c = judged_of(_i);
  const quad h = quad_parse("1e-11", NULL);
  double *gradient = calloc((size_t)c.edges, sizeof *gradient);
  ck_assert_int_eq(dvi_regge_action(c.regge, c.length, NULL, gradient), DVI_OK);
  for (int64_t e = 0; e < c.edges; e += 1 + c.edges / 30) {
    const quad slope = (changed(&c, e, h, e, 0) - changed(&c, e, -h, e, 0)) / (2 * h);
    ck_assert_double_eq_tol(gradient[e], (double)slope, 1e-12);
  }
  free(gradient);
  end_judged(&c);
}
END_TEST

/* Second differences of 1e-10 have errors of 1e-20 times fourth derivatives and roundings of
 * 1e-33/1e-20. */
START_TEST(hessians_are_those_of_the_action)
{
  judged c = judged_of(_i);
  const quad h = quad_parse("1e-10", NULL);
  unsigned long long seed = 3;
  dvi_matrix *hessian = NULL;
  ck_assert_int_eq(dvi_regge_hessian_create(c.regge, c.length, &hessian), DVI_OK);
  for (int k = 0; k < 30; k++) {
    const int64_t e = (int64_t)(random_number(&seed) * (double)c.edges);
    const int64_t width = hessian->start[e + 1] - hessian->start[e],
                  at = hessian->start[e] + (int64_t)(random_number(&seed) * (double)width);
    const int64_t f = hessian->column[at];
    const quad mixed = (changed(&c, e, h, f, h) - changed(&c, e, h, f, -h) -
                        changed(&c, e, -h, f, h) + changed(&c, e, -h, f, -h)) /
                       (4 * h * h);
    ck_assert_double_eq_tol(hessian->value[at], (double)mixed, 1e-11 * (1 + fabs((double)mixed)));
  }
  dvi_matrix_destroy(&hessian);
  end_judged(&c);
}
END_TEST

/* The judge itself knows nothing of Schlaefli. Differences of thin simplices err by 1e-16. */
START_TEST(changes_of_angles_drop_out)
{
  judged c = judged_of(_i);
  dvi_regge_measures measures;
  for (int64_t e = 0; e < c.edges; e += 1 + c.edges / 10)
    ck_assert_double_le((double)quad_abs(quad_schlaefli(c.mesh, c.exact, e)), 1e-15);
  ck_assert_int_eq(dvi_regge_measure(c.regge, c.length, &measures), DVI_OK);
  ck_assert_double_le(measures.schlaefli, 1e-13);
  end_judged(&c);
}
END_TEST

SUITE(regge_judge)
{
  tcase_add_loop_test(tests, deficits_volumes_and_actions_have_their_digits, 0, COMPLEXES);
  tcase_add_loop_test(tests, gradients_are_those_of_the_action, 0, COMPLEXES);
  tcase_add_loop_test(tests, hessians_are_those_of_the_action, 0, COMPLEXES);
  tcase_add_loop_test(tests, changes_of_angles_drop_out, 0, COMPLEXES);
}
