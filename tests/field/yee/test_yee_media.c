/* labels: unit */
/* Materials on boxes: layers, surfaces between the nodes, losses, and the averages behind them. */
#include <dvi/yee.h>
#include <math.h>
#include <stdlib.h>

#include "field/yee/average.h"
#include "support/waves/boxes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- averages ---- */

/* eps = 4 below a plane n.x = d, and 1 above it. */
typedef struct plane {
  double n[3], d;
} plane;

static int plane_eps(const double *x, double *value, void *user)
{
  const plane *p = user;
  *value = p->n[0] * x[0] + p->n[1] * x[1] + p->n[2] * x[2] < p->d ? 4 : 1;
  return 0;
}

static int ramp_eps(const double *x, double *value, void *user)
{
  (void)user;
  *value = 1 + x[0];
  return 0;
}

static int negative_eps(const double *x, double *value, void *user)
{
  (void)user;
  *value = x[0] < 0.4 ? 1 : -2;
  return 0;
}

static const dvi__average_box box = {3, {0.1, 0.2, 0.3}, {0.5, 0.5, 0.5}, NULL}; /* .4 x .3 x .2 */

/* Surfaces are found to 1e-4 of a box or better. */
START_TEST(layers_have_the_averages_of_their_normals)
{
  plane across = {{1, 0, 0}, 0.2}, beside = {{0, 1, 0}, 0.41};
  const dvi__average eps_across = {plane_eps, &across, "eps"},
                     eps_beside = {plane_eps, &beside, "eps"};
  double star = 0;
  ck_assert_int_eq(dvi__average_edge(&eps_across, &box, 0, &star), DVI_OK);
  ck_assert_double_eq_tol(star, 0.06 / (0.1 / 4 + 0.3), 4e-5);
  star = 0;
  ck_assert_int_eq(dvi__average_edge(&eps_beside, &box, 0, &star), DVI_OK);
  ck_assert_double_eq_tol(star, (0.21 * 4 + 0.09) * 0.2 / 0.4, 1e-4);
  star = 0;
  ck_assert_int_eq(dvi__average_face(&eps_across, &box, 0, &star), DVI_OK);
  ck_assert_double_eq_tol(star, (0.1 / 4 + 0.3) / 0.06, 1e-3);
  star = 0;
  ck_assert_int_eq(dvi__average_face(&eps_beside, &box, 0, &star), DVI_OK);
  ck_assert_double_eq_tol(star, 0.4 / (0.2 * (0.21 * 4 + 0.09)), 1e-3);
}
END_TEST

START_TEST(averages_of_smooth_and_slanted_media)
{
  plane slanted = {{1, 2, 0}, 1.1}; /* halves the face across z */
  const dvi__average ramp = {ramp_eps, NULL, "eps"}, half = {plane_eps, &slanted, "mu"};
  double star = 0;
  ck_assert_int_eq(dvi__average_edge(&ramp, &box, 0, &star), DVI_OK);
  ck_assert_double_eq_tol(star, 0.06 / log(1.5 / 1.1), 1e-5);
  star = 0;
  ck_assert_int_eq(dvi__average_face(&half, &box, 2, &star), DVI_OK);
  /* the plane leaves (0.1, 0.5) to (0.5, 0.3): 4 in a trapezium of mean height 0.2 of 0.3 */
  ck_assert_double_eq_tol(star, 0.2 / (0.4 * (0.2 * 4 + 0.1)), 1e-3 * star);
}
END_TEST

START_TEST(losses_have_the_field_of_the_permittivity)
{
  plane across = {{1, 0, 0}, 0.2}, far = {{1, 0, 0}, 9};
  const dvi__average eps = {plane_eps, &across, "eps"}, sigma = {plane_eps, &far, "sigma"},
                     vacuum = {NULL, NULL, "eps"};
  const double resistance = 0.1 / 4 + 0.3;
  double star = 0;
  ck_assert_int_eq(dvi__average_loss(&eps, &sigma, &box, 0, &star), DVI_OK);
  ck_assert_double_eq_tol(star, 0.06 * 4 * (0.1 / 16 + 0.3) / (resistance * resistance), 1e-3);
  star = 0;
  ck_assert_int_eq(dvi__average_loss(&vacuum, &sigma, &box, 0, &star), DVI_OK);
  ck_assert_double_eq_tol(star, 4 * 0.06 / 0.4, 1e-14);
}
END_TEST

/* A film across an axis, on the surface between two materials. */
typedef struct film {
  int axis;
  double at, thick, below, inside, above;
} film;

static int film_value(const double *x, double *value, void *user)
{
  const film *f = user;
  const double depth = x[f->axis] - f->at;
  *value = depth < 0 ? f->below : depth < f->thick ? f->inside : f->above;
  return 0;
}

static double side(int axis)
{
  return box.upper[axis] - box.lower[axis];
}

/* Set star[0] to that of an edge along an axis, star[1] to that of a face, and star[2] to that of
 * the losses with eps = 1. */
static void find_stars(film *f, int axis, double star[3])
{
  const dvi__average medium = {film_value, f, "eps"}, vacuum = {NULL, NULL, "eps"};
  star[0] = star[1] = star[2] = 0;
  ck_assert_int_eq(dvi__average_edge(&medium, &box, axis, &star[0]), DVI_OK);
  ck_assert_int_eq(dvi__average_face(&medium, &box, axis, &star[1]), DVI_OK);
  ck_assert_int_eq(dvi__average_loss(&vacuum, &medium, &box, axis, &star[2]), DVI_OK);
}

/* Films are found wherever they are in a box, if they are thicker than an eighth of it. */
START_TEST(films_of_an_eighth_of_a_box_are_seen)
{
  static const double above[] = {1, 2};
  for (int i = 0; i < 60; i++) {
    const int axis = i % 3;
    const double length = side(axis), part = 0.126, first = 0.01 + 0.014 * i;
    film f = {axis, box.lower[axis] + first * length, part * length, 1, 100, above[_i]};
    const double rest = (1 - first - part), parallel = first + part * 100 + rest * f.above,
                 series = first + part / 100 + rest / f.above;
    for (int along = 0; along < 3; along++) {
      double star[3], area = 1;
      for (int l = 0; l < 3; l++) area *= l == along ? 1 : side(l);
      const double vacuum = area / side(along);
      find_stars(&f, along, star);
      ck_assert_double_eq_tol(star[0] / vacuum, along == axis ? 1 / series : parallel,
                              1e-3 * (along == axis ? 1 / series : parallel));
      ck_assert_double_eq_tol(star[1] * vacuum, along == axis ? series : 1 / parallel,
                              1e-3 * (along == axis ? series : 1 / parallel));
      ck_assert_double_eq_tol(star[2] / vacuum, parallel, 1e-3 * parallel);
    }
  }
}
END_TEST

/* Give the sum of eps E^2 over the unit square, with the mean 1 of E along an axis in each box. */
static double energy_of_film(const film *f, int cells, int along)
{
  const double h = 1. / cells;
  double sum = 0;
  for (int i = 0; i < cells; i++) {
    const double low = fmax(f->at, i * h), high = fmin(f->at + f->thick, (i + 1) * h),
                 part = fmax(high - low, 0) / h;
    sum += along == f->axis ? h / (1 - part + part / f->inside) : h * (1 - part + part * f->inside);
  }
  return sum;
}

static int unit_along(const double *x, double *value, void *user)
{
  (void)x;
  value[0] = *(int *)user == 0;
  value[1] = *(int *)user == 1;
  return 0;
}

/* The same on a grid, whose boxes are looked at as a whole, and in pieces where there is a film. */
START_TEST(films_on_a_grid_have_their_energy)
{
  enum { CELLS = 5 };
  for (int i = 0; i < 40; i++) {
    film f = {.axis = i % 2, .at = 0.1 + 0.0093 * i, .below = 1, .inside = 100, .above = 1};
    f.thick = 0.126 / CELLS;
    dvi_yee_terms terms = {
        .size = sizeof terms, .axes = 2, .degree = 1, .eps = {.at = film_value, .user = &f}};
    for (int l = 0; l < 2; l++)
      terms.axis[l] = (dvi_yee_axis){.cells = CELLS,
                                     .end = {{.kind = DVI_YEE_PMC}, {.kind = DVI_YEE_PMC}}};
    dvi_march *march = box_march(&terms);
    double *E = random_values(dvi_yee_size(&terms, DVI_FORM_E), 1);
    for (int along = 0; along < 2; along++) {
      const double expected = energy_of_film(&f, CELLS, along);
      ck_assert_int_eq(dvi_yee_integrate(&terms, DVI_FORM_E, unit_along, &along, E), DVI_OK);
      start_boxes(march, E, NULL);
      ck_assert_double_eq_tol(2 * observe_march(march, "energy"), expected, 1e-3 * expected);
    }
    free(E);
    dvi_march_destroy(&march);
  }
}
END_TEST

START_TEST(bad_media_are_named)
{
  const dvi__average eps = {negative_eps, NULL, "eps"};
  double star = 0;
  ck_assert_int_eq(dvi__average_edge(&eps, &box, 0, &star), DVI_BAD_ARGUMENT);
  check_words("yee: eps = -2 at (0.5");
}
END_TEST

/* ---- frequencies ---- */

/* Give the size of the sum of p_n exp(i omega n T) in Blackman's window, which lets through other
 * frequencies only close by. */
static double transform(int count, const double *p, double T, double omega)
{
  double re = 0, im = 0;
  for (int n = 0; n < count; n++) {
    const double phase = 2 * pi * (n + 0.5) / count,
                 weight = 0.42 - 0.5 * cos(phase) + 0.08 * cos(2 * phase);
    re += weight * p[n] * cos(omega * n * T);
    im += weight * p[n] * sin(omega * n * T);
  }
  return hypot(re, im);
}

/* Find the frequency of the largest sum near a guess, by golden sections. */
static double frequency(int count, const double *p, double T, double guess)
{
  double low = guess - 0.15, high = guess + 0.15;
  for (int i = 0; i < 60; i++) {
    const double left = high - 0.618033988749895 * (high - low),
                 right = low + 0.618033988749895 * (high - low);
    if (transform(count, p, T, left) > transform(count, p, T, right))
      high = right;
    else
      low = left;
  }
  return 0.5 * (low + high);
}

/* Start with a mode's B, and return the frequency of its projection on the start. */
static double mode_frequency(const dvi_yee_terms *terms, dvi_form_function *mode, void *user,
                             double guess)
{
  enum { COUNT = 400 };
  const double T = 0.15;
  dvi_march *march = box_march(terms);
  const int64_t faces = dvi_march_size(march, DVI_FORM_B);
  double *B = random_values(faces, 1), p[COUNT];
  ck_assert_int_eq(dvi_yee_integrate(terms, DVI_FORM_B, mode, user, B), DVI_OK);
  start_boxes(march, NULL, B);
  for (int n = 0; n < COUNT; n++) {
    advance_march(march, n * T);
    double *now = sample_march(march, DVI_FORM_B);
    p[n] = 0;
    for (int64_t i = 0; i < faces; i++) p[n] += B[i] * now[i];
    free(now);
  }
  free(B);
  dvi_march_destroy(&march);
  return frequency(COUNT, p, T, guess);
}

/* Layers of a cavity: eps = 4 and 1, joined at `at`. Modes in x with k_y = `across`, after
 * H = cos(a x) on the left and C cos(b (1 - x)) on the right, a^2 = 4 w^2 - k^2, b^2 = w^2 -
 * k^2. */
typedef struct layers {
  double at, across, omega;
} layers;

static int layers_eps(const double *x, double *value, void *user)
{
  const layers *l = user;
  *value = x[0] < l->at ? 4 : 1;
  return 0;
}

static double shape(double squared, double x)
{
  return squared >= 0 ? cos(sqrt(squared) * x) : cosh(sqrt(-squared) * x);
}

static int layers_mode(const double *x, double *value, void *user)
{
  const layers *l = user;
  const double k2 = l->across * l->across, w2 = l->omega * l->omega, a2 = 4 * w2 - k2, b2 = w2 - k2;
  const double C = shape(a2, l->at) / shape(b2, 1 - l->at);
  *value = x[0] < l->at ? shape(a2, x[0]) : C * shape(b2, 1 - x[0]);
  if (l->across > 0) *value *= cos(l->across * x[1]);
  return 0;
}

/* Find the frequency of the continuum near a guess: a tan(a at)/4 = -b tan(b (1 - at)). */
static double mismatch(const layers *l, double w)
{
  const double k2 = l->across * l->across, a2 = 4 * w * w - k2, b2 = w * w - k2, a = sqrt(fabs(a2)),
               b = sqrt(fabs(b2));
  const double left = a2 > 0 ? a * tan(a * l->at) : -a * tanh(a * l->at);
  const double right = b2 > 0 ? b * tan(b * (1 - l->at)) : -b * tanh(b * (1 - l->at));
  return left / 4 + right;
}

static double continuum(const layers *l, double low, double high)
{
  for (int i = 0; i < 100; i++) {
    const double middle = 0.5 * (low + high);
    *((mismatch(l, low) < 0) == (mismatch(l, middle) < 0) ? &low : &high) = middle;
  }
  return low;
}

static double error_of_layers(layers *l, int cells, const double *cell)
{
  const dvi_yee_terms terms = {
      .size = sizeof terms,
      .axes = l->across > 0 ? 2 : 1,
      .degree = l->across > 0,
      .axis = {{.cells = cells}, {.cells = cells}},
      .eps = {.cell = cell, .at = cell != NULL ? NULL : layers_eps, .user = l},
      .fraction = 0.7};
  return fabs(mode_frequency(&terms, layers_mode, l, l->omega) - l->omega);
}

/* The numbers have 12 digits. */
START_TEST(layers_on_one_axis_have_order_two)
{
  static const double omega[] = {1.910633236249, 4.372552070931};
  layers l = {.at = 0.5};
  l.omega = continuum(&l, omega[_i] - 0.05, omega[_i] + 0.05);
  ck_assert_double_eq_tol(l.omega, omega[_i], 1e-11);
  const double coarse = error_of_layers(&l, 32, NULL), fine = error_of_layers(&l, 64, NULL),
               slope = log2(coarse / fine);
  ck_assert_msg(fabs(slope - 2) < 0.1, "%g and %g: slope %g", coarse, fine, slope);
}
END_TEST

/* Surfaces between nodes keep the order. Errors depend on the part of a box at which the surface
 * is, so both grids have it at the same part. */
START_TEST(surfaces_off_the_grid_have_order_two)
{
  static const struct {
    double at;
    int coarse, fine, axes;
    double omega; /* known to 12 digits, or 0 */
  } kinds[] = {{0.5, 17, 51, 1, 1.910633236249}, {0.53, 20, 120, 1, 0},
               {7 / 15., 16, 61, 1, 0},          {8 / 13., 14, 53, 1, 0},
               {0.5, 17, 51, 2, 2.017363293304}, {0.5, 17, 51, 2, 3.262537303543},
               {0.5, 16, 48, 2, 3.262537303543}, {7 / 15., 16, 46, 2, 0}};
  const int coarse_cells = kinds[_i].coarse, fine_cells = kinds[_i].fine;
  const double omega = kinds[_i].omega;
  layers l = {.at = kinds[_i].at, .across = kinds[_i].axes > 1 ? pi : 0};
  l.omega = omega > 0      ? continuum(&l, omega - 0.05, omega + 0.05)
            : l.across > 0 ? continuum(&l, 1.9, 2.2)
                           : continuum(&l, pi / 4 / l.at + 0.01, 2.4);
  if (omega > 0) ck_assert_double_eq_tol(l.omega, omega, 1e-11);
  const double coarse = error_of_layers(&l, coarse_cells, NULL),
               fine = error_of_layers(&l, fine_cells, NULL),
               slope = log(coarse / fine) / log((double)fine_cells / coarse_cells);
  ck_assert_msg(fabs(slope - 2) < 0.1, "at %g: %g and %g: slope %g", l.at, coarse, fine, slope);
}
END_TEST

/* Boxes of one material each lose an order where the surface is not at a node. */
START_TEST(stairs_have_order_one)
{
  double cell[65];
  layers l = {.at = 0.5};
  l.omega = continuum(&l, 1.7, 2.2);
  for (int n = 17; n <= 65; n += 48) {
    for (int i = 0; i < n; i++) cell[i] = (i + 0.5) / n <= 0.5 ? 4 : 1;
    const double stairs = error_of_layers(&l, n, cell), smooth = error_of_layers(&l, n, NULL);
    ck_assert_double_gt(stairs, 0.2 / n);
    ck_assert_double_lt(smooth, 3. / n / n);
  }
}
END_TEST

/* eps = mu = 2 halve the speed, and double the bound. */
START_TEST(a_uniform_medium_slows_waves)
{
  double *cell = random_values(20 * 20, 1);
  for (int i = 0; i < 400; i++) cell[i] = 2;
  dvi_yee_terms terms = {.size = sizeof terms,
                         .axes = 2,
                         .degree = 1,
                         .axis = {{.cells = 20}, {.cells = 20}},
                         .eps.cell = cell,
                         .mu.cell = cell,
                         .step = 0.04};
  dvi_march *slow = box_march(&terms);
  dvi_march_facts facts, vacuum;
  dvi_march_facts_of(slow, &facts);
  dvi_march_destroy(&slow);
  terms.eps.cell = terms.mu.cell = NULL;
  terms.step = 0;
  dvi_march *fast = box_march(&terms);
  dvi_march_facts_of(fast, &vacuum);
  dvi_march_destroy(&fast);
  ck_assert_double_eq_tol(facts.bound, 2 * vacuum.bound, 1e-12);
  free(cell);
}
END_TEST

/* ---- losses ---- */

static int sine(const double *x, double *value, void *user)
{
  (void)user;
  *value = sin(pi * x[0]);
  return 0;
}

/* N = 20, dt = 0.8 h, sigma = 0.7: E^n is the real part of exp(s t) with s of the page. */
START_TEST(losses_damp_as_the_grid_says)
{
  const double h = 0.05, dt = 0.8 * h, decay = -0.350022869356, omega = 3.120964341326;
  double sigma[20], *E = random_values(21, 1), last[3] = {0};
  for (int i = 0; i < 20; i++) sigma[i] = 0.7;
  const dvi_yee_terms terms = {
      .size = sizeof terms, .axes = 1, .axis = {{.cells = 20}}, .sigma.cell = sigma, .step = dt};
  dvi_march *march = box_march(&terms);
  ck_assert_int_eq(dvi_yee_integrate(&terms, DVI_FORM_E, sine, NULL, E), DVI_OK);
  start_boxes(march, E, NULL);
  for (int n = 0; n < 100; n++) {
    advance_march(march, n * dt);
    double *now = sample_march(march, DVI_FORM_E);
    last[0] = last[1], last[1] = last[2], last[2] = now[10];
    free(now);
    if (n == 0) ck_assert_double_eq_tol(last[2], 1, 1e-15);
    if (n < 2) continue;
    const double rest = last[2] - 2 * exp(decay * dt) * cos(omega * dt) * last[1] +
                        exp(2 * decay * dt) * last[0];
    ck_assert_double_eq_tol(rest, 0, 1e-13); /* 12 digits of s times dt */
  }
  free(E);
  dvi_march_destroy(&march);
}
END_TEST

/* Conducted charge counts: Gauss's law holds with losses. */
START_TEST(losses_keep_the_charge)
{
  double *sigma = random_values(6 * 5 * 4, 8), *eps = random_values(6 * 5 * 4, 9);
  for (int i = 0; i < 120; i++) sigma[i] = fabs(sigma[i]), eps[i] = 2 + eps[i];
  const dvi_yee_terms terms = {.size = sizeof terms,
                               .axes = 3,
                               .degree = 1,
                               .axis = {{.cells = 6}, {.cells = 5}, {.cells = 4}},
                               .eps.cell = eps,
                               .sigma.cell = sigma};
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 3);
  start_boxes(march, E, NULL);
  const double energy = observe_march(march, "energy");
  advance_march(march, 3);
  ck_assert_double_le(observe_march(march, "gauss"), 1e-14);
  ck_assert_double_lt(observe_march(march, "energy"), 0.5 * energy);
  free(sigma), free(eps), free(E);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- bound and energy ---- */

/* Random media: the bound is between the true one, which growth beyond it would show, and 0.5
 * percent below. Energy is kept at 0.99 of it, and grows at 1.02. */
START_TEST(energy_stays_in_media)
{
  double *eps = random_values(6 * 5 * 4, 9), *mu = random_values(6 * 5 * 4, 10);
  for (int i = 0; i < 120; i++) eps[i] = 2.5 + 2 * eps[i], mu[i] = 1.5 + mu[i];
  dvi_yee_terms terms = {.size = sizeof terms,
                         .axes = 3,
                         .degree = 1,
                         .axis = {{.cells = 6}, {.cells = 5}, {.cells = 4}},
                         .eps.cell = eps,
                         .mu.cell = mu,
                         .fraction = 0.99};
  terms.axis[_i].end[0].kind = terms.axis[_i].end[1].kind = DVI_YEE_PERIODIC;
  terms.axis[(_i + 1) % 3].end[1].kind = DVI_YEE_PMC;
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 3),
         *B = random_values(dvi_march_size(march, DVI_FORM_B), 4);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  start_boxes(march, E, B);
  const double start = observe_march(march, "energy");
  advance_march(march, facts.step * repeats(20000));
  ck_assert_double_eq_tol(observe_march(march, "energy") / start, 1, 1e-13);
  dvi_march_destroy(&march);
  terms.step = 1.02 * facts.bound;
  ck_assert_int_eq(dvi_yee_create(&terms, &march), DVI_BAD_ARGUMENT);
  check_words("is not below the bound");
  check_words("at (");
  free(eps), free(mu), free(E), free(B);
}
END_TEST

/* A single box that repeats itself has no differences, with any material, and no bound of steps. */
START_TEST(a_box_without_differences_has_no_bound)
{
  static const double eps = 2;
  const int axes = _i + 1;
  dvi_yee_terms terms = {
      .size = sizeof terms, .axes = axes, .degree = axes == 3, .eps = {.cell = &eps}};
  dvi_march *march = NULL;
  dvi_march_facts facts;
  for (int l = 0; l < axes; l++) {
    terms.axis[l].cells = 1;
    terms.axis[l].end[0].kind = terms.axis[l].end[1].kind = DVI_YEE_PERIODIC;
  }
  ck_assert_int_eq(dvi_yee_create(&terms, &march), DVI_BAD_ARGUMENT);
  check_words("nothing moves");
  terms.step = 0.5;
  march = box_march(&terms);
  dvi_march_facts_of(march, &facts);
  ck_assert(isinf(facts.bound));
  dvi_march_destroy(&march);
}
END_TEST

SUITE(yee_media)
{
  tcase_add_loop_test(tests, a_box_without_differences_has_no_bound, 0, 3);
  tcase_add_test(tests, layers_have_the_averages_of_their_normals);
  tcase_add_test(tests, averages_of_smooth_and_slanted_media);
  tcase_add_test(tests, losses_have_the_field_of_the_permittivity);
  tcase_add_loop_test(tests, films_of_an_eighth_of_a_box_are_seen, 0, 2);
  tcase_add_test(tests, films_on_a_grid_have_their_energy);
  tcase_add_test(tests, bad_media_are_named);
  tcase_add_loop_test(tests, layers_on_one_axis_have_order_two, 0, 2);
  tcase_add_loop_test(tests, surfaces_off_the_grid_have_order_two, 0, 8);
  tcase_add_test(tests, stairs_have_order_one);
  tcase_add_test(tests, a_uniform_medium_slows_waves);
  tcase_add_test(tests, losses_damp_as_the_grid_says);
  tcase_add_test(tests, losses_keep_the_charge);
  tcase_add_loop_test(tests, energy_stays_in_media, 0, 3);
}
