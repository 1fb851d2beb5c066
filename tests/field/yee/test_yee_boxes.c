/* Cavities on boxes: the dispersion of Yee's grid is known exactly. */
#include <dvi/yee.h>
#include <math.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static dvi_march *created(const dvi_yee_terms *terms)
{
  dvi_march *march = NULL;
  ck_assert_msg(dvi_yee_create(terms, &march) == DVI_OK, "%s", dvi_last_error());
  return march;
}

static double *zeros(int64_t count)
{
  return calloc((size_t)count, sizeof(double));
}

static double *sampled(const dvi_march *march, dvi_march_form form)
{
  double *values = zeros(dvi_march_size(march, form));
  ck_assert_msg(dvi_march_sample(march, form, 0, NULL, values) == DVI_OK, "%s", dvi_last_error());
  return values;
}

/* Mode (l, m, n) of a box with conducting walls: E_x = a_0 cos(k_0 x) sin(k_1 y) sin(k_2 z) and so
 * on, with a.k = 0 as the grid sees it. */
typedef struct mode {
  double k[3], a[3];
} mode;

static int mode_field(const double *x, double *value, void *user)
{
  const mode *m = user;
  for (int c = 0; c < 3; c++) {
    value[c] = m->a[c];
    for (int l = 0; l < 3; l++) value[c] *= l == c ? cos(m->k[l] * x[l]) : sin(m->k[l] * x[l]);
  }
  return 0;
}

START_TEST(modes_of_a_box_have_the_frequencies_of_the_grid)
{
  /* fields-forms 5: box 1 x 0.8 x 0.6 of 5 x 4 x 3 cubes, step 0.9 h/sqrt(3) */
  static const double omega[3] = {4.973909883247, 5.973299740175, 6.414511709401};
  static const int number[3][3] = {{1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  const double h = 0.2, dt = 0.9 * h / sqrt(3), size[3] = {1, 0.8, 0.6};
  dvi_yee_terms terms = {.size = sizeof terms,
                         .axes = 3,
                         .degree = 1,
                         .axis = {{.cells = 5, .upper = 1},
                                  {.cells = 4, .upper = 0.8},
                                  {.cells = 3, .upper = 0.6}},
                         .step = dt};
  for (int which = 0; which < 3; which++) {
    mode m = {{0}, {0}};
    for (int l = 0; l < 3; l++) {
      m.k[l] = pi * number[which][l] / size[l];
      m.a[l] = number[which][l] == 0;
    }
    dvi_march *march = created(&terms);
    const int64_t edges = dvi_march_size(march, DVI_FORM_E);
    double *E = zeros(edges), most = 0;
    ck_assert_int_eq(dvi_yee_integrate(&terms, DVI_FORM_E, mode_field, &m, E), DVI_OK);
    const dvi_march_state state = {.size = sizeof state, .E = E};
    ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
    for (int n = 0; n <= 200; n++) {
      const double t = n * dt;
      ck_assert_int_eq(dvi_march_advance(march, t), DVI_OK);
      double *now = sampled(march, DVI_FORM_E);
      /* at whole steps a sample is the mean of two half steps */
      for (int64_t i = 0; i < edges; i++)
        most = fmax(most, fabs(now[i] - cos(omega[which] * t) * E[i]));
      free(now);
    }
    printf("mode %d: %g\n", which, most);
    /* 12 digits of omega over 23 times: 1e-11 */
    ck_assert_double_le(most, 2e-11 * h);
    dvi_march_destroy(&march);
    free(E);
  }
}
END_TEST

SUITE(yee_boxes)
{
  tcase_add_test(tests, modes_of_a_box_have_the_frequencies_of_the_grid);
}
