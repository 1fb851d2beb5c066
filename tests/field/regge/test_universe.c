/* labels: order */
/* Universes of equal sections: orders against the exact limit of short struts, ends, refusals. */
#include <dvi/regge.h>
#include <math.h>
#include <stdlib.h>

#include "support/suite.h"

static dvi_regge *sections_of(const char *name, double lambda)
{
  dvi_mesh *mesh = NULL;
  dvi_regge *regge = NULL;
  ck_assert_int_eq(dvi_mesh_generate(name, NULL, &mesh), DVI_OK);
  const dvi_regge_terms terms = {.size = sizeof terms, .mesh = mesh, .lambda = lambda};
  ck_assert_int_eq(dvi_regge_create(&terms, &regge), DVI_OK);
  dvi_mesh_destroy(&mesh);
  return regge;
}

/* Short struts have the constraint
 *
 *     l^2 = N_1 (2 pi - n theta) sqrt(1 - 3 s v^2/8) / (Lambda N_3 (sqrt(2)/12) sqrt(1 - s v^2/4))
 *
 * with the rate v = dl/dt, so that t = int dl/v is an integral over v. These lengths at T are
 * mpmath's, by quadrature. Lambda = 3 stands for a universe of radius 1 at rest. */
static const struct {
  const char *name;
  int euclidean;
  double T, start, end;
} exact[] = {{"cell-600", 0, 0.5, 0.66012428401754866, 0.74290045289269778},
             {"cell-600", 1, 0.5, 0.66012428401754866, 0.58206025264600634},
             {"cell-600", 0, 1.0, 0.66012428401754866, 1.0268721333834841},
             {"cell-600", 1, 1.0, 0.66012428401754866, 0.37165277206747911},
             {"cell-16", 0, 0.5, 2.4015044443306202, 2.6452278410163712},
             {"cell-16", 1, 0.5, 2.4015044443306202, 2.1967274985010943},
             {"simplex-4", 0, 0.5, 3.8279223440995317, 4.1107381714184401},
             {"simplex-4", 1, 0.5, 3.8279223440995317, 3.5990151358834356}};

/* Give the error of the last length, and the largest constraint. */
static double run(int i, int steps, double *constraint)
{
  dvi_regge *regge = sections_of(exact[i].name, 3);
  double *length = calloc((size_t)steps + 1, sizeof *length),
         *defect = calloc((size_t)steps, sizeof *defect), worst = 0;
  const dvi_regge_universe_options options = {.size = sizeof options,
                                              .strut = exact[i].T / steps,
                                              .steps = steps,
                                              .euclidean = exact[i].euclidean};
  ck_assert_int_eq(dvi_regge_universe(regge, &options, length, defect), DVI_OK);
  ck_assert_double_eq_tol(length[0], exact[i].start, 2e-14);
  const double error = length[steps] - exact[i].end;
  for (int k = 0; k < steps; k++) worst = fmax(worst, fabs(defect[k]));
  free(length);
  free(defect);
  dvi_regge_destroy(&regge);
  *constraint = worst;
  return fabs(error);
}

START_TEST(lengths_and_constraint_have_order_2)
{
  double before = 0, defect_before = 0;
  for (int steps = 20; steps <= 160; steps *= 2) {
    double defect;
    const double error = run(_i, steps, &defect);
    if (steps > 20) {
      ck_assert_double_eq_tol(log2(before / error), 2, 0.03);
      ck_assert_double_eq_tol(log2(defect_before / defect), 2, 0.1);
    }
    before = error;
    defect_before = defect;
  }
}
END_TEST

/* de Sitter's universe has cosh t, and Euclid's sphere cos t. 600 tetrahedra are 1.3 % off. */
START_TEST(the_600_cell_is_near_de_sitter)
{
  for (int i = 2; i < 4; i++) {
    const double growth = exact[i].end / exact[i].start,
                 expected = exact[i].euclidean ? cos(1) : cosh(1);
    ck_assert_double_eq_tol(growth / expected, 1, exact[i].euclidean ? 0.05 : 0.01);
  }
}
END_TEST

/* Euclid's sphere of 600-cells has a pole, where struts lead to a vertex. */
START_TEST(a_universe_ends_at_its_pole)
{
  dvi_regge *regge = sections_of("cell-600", 3);
  double length[201];
  const dvi_regge_universe_options options = {
      .size = sizeof options, .strut = 0.01, .steps = 200, .euclidean = 1};
  ck_assert_int_eq(dvi_regge_universe(regge, &options, length, NULL), DVI_STEP_TOO_LARGE);
  check_words("does not exist with struts of length 0.01");
  ck_assert_double_le(length[0], 0.7);
  ck_assert(length[200] == 0);
  dvi_regge_destroy(&regge);
}
END_TEST

START_TEST(other_sections_are_refused)
{
  const dvi_regge_universe_options options = {.size = sizeof options, .strut = 0.1, .steps = 1};
  const dvi_generator_options cells = {.size = sizeof cells, .cells = {3, 3, 3}};
  double length[2];
  dvi_mesh *mesh = NULL;
  dvi_regge *regge = sections_of("simplex-4", 0);
  ck_assert_int_eq(dvi_regge_universe(regge, &options, length, NULL), DVI_BAD_ARGUMENT);
  check_words("Lambda is 0");
  dvi_regge_destroy(&regge);
  regge = sections_of("simplex-5", 1);
  ck_assert_int_eq(dvi_regge_universe(regge, &options, length, NULL), DVI_UNSUPPORTED);
  check_words("closed complexes of tetrahedra");
  dvi_regge_destroy(&regge);
  ck_assert_int_eq(dvi_mesh_generate("kuhn-torus", &cells, &mesh), DVI_OK);
  const dvi_regge_terms terms = {.size = sizeof terms, .mesh = mesh, .lambda = 1};
  ck_assert_int_eq(dvi_regge_create(&terms, &regge), DVI_OK);
  ck_assert_int_eq(dvi_regge_universe(regge, &options, length, NULL), DVI_UNSUPPORTED);
  check_words("alike everywhere");
  dvi_mesh_destroy(&mesh);
  dvi_regge_destroy(&regge);
}
END_TEST

START_TEST(options_are_checked)
{
  dvi_regge *regge = sections_of("simplex-4", 1);
  dvi_regge_universe_options options = {.size = sizeof options, .strut = -1, .steps = 1};
  double length[2];
  ck_assert_int_eq(dvi_regge_universe(regge, &options, length, NULL), DVI_BAD_ARGUMENT);
  check_words("length -1");
  options.strut = 1;
  options.steps = 0;
  ck_assert_int_eq(dvi_regge_universe(regge, &options, length, NULL), DVI_BAD_ARGUMENT);
  check_words("0 steps");
  ck_assert_int_eq(dvi_regge_universe(regge, NULL, length, NULL), DVI_BAD_ARGUMENT);
  dvi_regge_destroy(&regge);
}
END_TEST

SUITE(universe)
{
  tcase_add_loop_test(tests, lengths_and_constraint_have_order_2, 0, 8);
  tcase_add_test(tests, the_600_cell_is_near_de_sitter);
  tcase_add_test(tests, a_universe_ends_at_its_pole);
  tcase_add_test(tests, other_sections_are_refused);
  tcase_add_test(tests, options_are_checked);
}
