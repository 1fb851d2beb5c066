/* labels: unit */
/* Currents, dipoles, probes, fluxes, and the charges that currents leave. */
#include <dvi/yee.h>
#include <math.h>
#include <stdlib.h>

#include "support/waves/boxes.h"
#include "support/suite.h"

/* ---- signals ---- */

static int cosine(double t, double *value, void *user)
{
  (void)user;
  *value = cos(t);
  return 0;
}

static int pulse(double t, double *value, void *user)
{
  (void)user;
  t = (t - 2) / 0.4;
  *value = exp(-t * t / 2);
  return 0;
}

static int step_up(double t, double *value, void *user)
{
  (void)user;
  *value = 0.5 * (1 + tanh(4 * (t - 2)));
  return 0;
}

/* Its sum over steps of 1/2 vanishes but for 1e-7, so that no charge is left. */
static int doublet(double t, double *value, void *user)
{
  (void)user;
  t = (t - 12) / 2;
  *value = t * exp(-t * t / 2);
  return 0;
}

/* Another number from -1 to 1 at each time. */
static int noise(double t, double *value, void *user)
{
  const double *seed = user;
  *value = sin(1e5 * (t + *seed) * (t + *seed));
  return 0;
}

static int failing(double t, double *value, void *user)
{
  (void)user;
  *value = t;
  return t > 1 ? 3 : 0;
}

static int uniform(const double *x, double *value, void *user)
{
  const double *J = user;
  (void)x;
  for (int c = 0; c < 3; c++) value[c] = J[c];
  return 0;
}

static int swirl(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = sin(3 * x[1]) + x[2];
  value[1] = cos(2 * x[0] + x[2]);
  value[2] = x[0] * x[1];
  return 0;
}

static dvi_yee_terms cube(int cells, dvi_yee_boundary kind)
{
  dvi_yee_terms terms = {.size = sizeof terms, .axes = 3, .degree = 1};
  for (int l = 0; l < 3; l++)
    terms.axis[l] = (dvi_yee_axis){.cells = cells + l, .end = {{.kind = kind}, {.kind = kind}}};
  return terms;
}

/* ---- currents ---- */

/* Without walls, E' = -J. Steps take dt J^n, and half of it at the start. */
START_TEST(a_uniform_current_moves_all_of_E)
{
  double J[3] = {1, -2, 0.5}, sum = 0;
  const dvi_yee_current current = {.density = uniform, .density_user = J, .signal = cosine};
  dvi_yee_terms terms = cube(3, DVI_YEE_PERIODIC);
  terms.current = &current;
  terms.currents = 1;
  terms.step = 0.1;
  dvi_march *march = box_march(&terms);
  start_boxes(march, NULL, NULL);
  advance_march(march, 5);
  for (int n = 0; n <= 50; n++) sum += 0.1 * cos(0.1 * n) * (n == 0 || n == 50 ? 0.5 : 1);
  double *E = sample_march(march, DVI_FORM_E);
  for (int c = 0; c < 3; c++) {
    const int place[3] = {1, 2, 0};
    const int64_t edge = dvi_yee_place(&terms, DVI_FORM_E, c, place);
    ck_assert_double_eq_tol(E[edge], -J[c] * sum / terms.axis[c].cells, 1e-14);
  }
  free(E);
  dvi_march_destroy(&march);
}
END_TEST

/* A dipole's current is shared by four edges around it, by Whitney's weights. */
START_TEST(a_dipole_acts_by_whitney_weights)
{
  const dvi_yee_dipole dipole = {.at = {0.3, 0.55, 0.81}, .along = {0, 0, 2}, .signal = cosine};
  dvi_yee_terms terms = cube(5, DVI_YEE_PEC);
  double *none = random_values(dvi_yee_size(&terms, DVI_FORM_E), 1);
  terms.dipole = &dipole;
  terms.dipoles = 1;
  terms.step = 0.05;
  dvi_march *march = box_march(&terms);
  start_boxes(march, NULL, NULL);
  advance_march(march, 0.075); /* the time of E^{3/2} */
  for (int64_t i = 0; i < dvi_yee_size(&terms, DVI_FORM_E); i++) none[i] = 0;
  box_judge judge = make_judge(&terms);
  double *B = random_values(judge.faces, 1);
  for (int64_t f = 0; f < judge.faces; f++) B[f] = 0;
  start_judge(&judge, none, B, 0.05);
  /* x = 0.3 is 1.5 boxes, y = 0.55 is 3.3 boxes, z = 0.81 is in box 5 of 7 */
  for (int step = 0; step < 2; step++) {
    if (step > 0) step_judge(&judge, 0.05);
    for (int far = 0; far < 4; far++) {
      const int place[3] = {1 + far % 2, 3 + far / 2, 5};
      const int64_t edge = dvi_yee_place(&terms, DVI_FORM_E, 2, place);
      const double weight = 0.5 * (far / 2 ? 0.3 : 0.7) * 7 * 2,
                   impulse = 0.05 * (step == 0 ? 0.5 : cos(0.05));
      judge.E[edge] -= impulse * weight / judge.M1[edge];
    }
  }
  double *E = sample_march(march, DVI_FORM_E);
  for (int64_t e = 0; e < judge.edges; e++) ck_assert_double_eq_tol(E[e], judge.E[e], 1e-14);
  free(E), free(none), free(B);
  free_judge(&judge);
  dvi_march_destroy(&march);
}
END_TEST

/* A probe is a dipole transposed: what one sees of the other is what the other sees of it. */
static double seen(const double *from, const double *along, const double *at, const double *by)
{
  dvi_yee_dipole dipole = {.signal = pulse};
  dvi_yee_probe probe = {.name = "p", .form = DVI_FORM_E};
  double eps[5 * 6 * 7];
  dvi_yee_terms terms = cube(5, DVI_YEE_PEC);
  for (int i = 0; i < 210; i++) eps[i] = 1 + i % 4;
  for (int l = 0; l < 3; l++) {
    dipole.at[l] = from[l], dipole.along[l] = along[l];
    probe.at[l] = at[l], probe.along[l] = by[l];
  }
  terms.axis[1].end[1].kind = DVI_YEE_PMC;
  terms.eps.cell = eps;
  terms.dipole = &dipole, terms.dipoles = 1;
  terms.probe = &probe, terms.probes = 1;
  terms.step = 0.05;
  dvi_march *march = box_march(&terms);
  start_boxes(march, NULL, NULL);
  advance_march(march, 4);
  const double value = observe_march(march, "p");
  dvi_march_destroy(&march);
  return value;
}

START_TEST(dipoles_and_probes_are_reciprocal)
{
  const double a[3] = {0.31, 0.52, 0.4}, b[3] = {0.77, 0.9, 0.23}, p[3] = {1, 2, -1},
               q[3] = {0.3, -1, 0.5};
  const double one = seen(a, p, b, q), other = seen(b, q, a, p);
  ck_assert_double_gt(fabs(one), 0.1);
  ck_assert_double_eq_tol(one, other, 1e-13 * fabs(one));
}
END_TEST

/* B's probe sees Whitney's interpolation of fluxes, which is exact for a uniform field. */
START_TEST(probes_see_uniform_fields)
{
  double field[3] = {1, -2, 0.5};
  const dvi_yee_probe probe[] = {{"B", DVI_FORM_B, .at = {0.1, 0.99, 1}, .along = {1, 1, 2}},
                                 {"E", DVI_FORM_E, .at = {0, 0.3, 0.7}, .along = {0, 3, 1}}};
  dvi_yee_terms terms = cube(4, DVI_YEE_PERIODIC);
  terms.probe = probe;
  terms.probes = 2;
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_yee_size(&terms, DVI_FORM_E), 1),
         *B = random_values(dvi_yee_size(&terms, DVI_FORM_B), 1);
  ck_assert_int_eq(dvi_yee_integrate(&terms, DVI_FORM_E, uniform, field, E), DVI_OK);
  ck_assert_int_eq(dvi_yee_integrate(&terms, DVI_FORM_B, uniform, field, B), DVI_OK);
  start_boxes(march, E, B);
  advance_march(march, 0.333);
  ck_assert_double_eq_tol(observe_march(march, "B"), 1 - 2 + 1, 1e-13);
  ck_assert_double_eq_tol(observe_march(march, "E"), -6 + 0.5, 1e-13);
  free(E), free(B);
  dvi_march_destroy(&march);
}
END_TEST

/* Between the last node and the end of an axis that repeats itself, E is interpolated with that of
 * node 0 times the phase, whose real part a probe sees. */
START_TEST(probes_see_over_the_end_of_an_axis)
{
  const double phase = _i == 0 ? 0 : 0.7, part = 0.75;
  const dvi_yee_boundary kind = _i == 0 ? DVI_YEE_PERIODIC : DVI_YEE_BLOCH;
  const dvi_yee_probe probe[] = {{"x", DVI_FORM_E, .at = {0.3, (2 + part) / 3}, .along = {1}},
                                 {"y", DVI_FORM_E, .at = {(3 + part) / 4, 0.5}, .along = {0, 1}}};
  dvi_yee_terms terms = {.size = sizeof terms, .axes = 2, .degree = 1, .probe = probe, .probes = 2};
  for (int l = 0; l < 2; l++)
    terms.axis[l] = (dvi_yee_axis){
        .cells = 4 - l, .end = {{.kind = kind}, {.kind = kind}}, .phase = phase};
  dvi_march *march = box_march(&terms);
  const int64_t edges = dvi_yee_size(&terms, DVI_FORM_E);
  double *E = random_values(2 * edges, 1);
  start_boxes(march, E, NULL);
  for (int c = 0; c < 2; c++) {
    const int last[2] = {c == 0 ? 1 : 3, c == 0 ? 2 : 1}, first[2] = {c == 0 ? 1 : 0, c};
    const int64_t one = dvi_yee_place(&terms, DVI_FORM_E, c, last),
                  other = dvi_yee_place(&terms, DVI_FORM_E, c, first);
    const double turned = _i == 0 ? E[other]
                                  : cos(phase) * E[other] - sin(phase) * E[edges + other];
    ck_assert_double_eq_tol(observe_march(march, probe[c].name),
                            (4 - c) * ((1 - part) * E[one] + part * turned), 1e-14);
  }
  free(E);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- charge ---- */

/* A moment that comes to 1 leaves two charges 1/h apart, and their field's energy is static. The
 * charges are exact: moments are differences. */
START_TEST(a_moment_leaves_its_charges)
{
  const dvi_yee_dipole dipole = {
      .at = {0.5, 0.5, 0.5}, .along = {1, 0, 0}, .signal = step_up, .is_moment = 1};
  dvi_yee_terms terms = {.size = sizeof terms, .axes = 3, .degree = 1};
  for (int l = 0; l < 3; l++) terms.axis[l] = (dvi_yee_axis){.cells = 7};
  terms.dipole = &dipole;
  terms.dipoles = 1;
  dvi_march *march = box_march(&terms);
  start_boxes(march, NULL, NULL);
  advance_march(march, 40);
  ck_assert_double_eq_tol(observe_march(march, "charge"), 0, 1e-12);
  ck_assert_double_le(observe_march(march, "gauss"), 1e-13);
  /* D through the plane x = 1/2: the moment's own edge and the static field, together 0 in a cavity
   * of which nothing but the dipole breaks the symmetry. The four nodes at its right end hold 7/4
   * each. */
  double *E = sample_march(march, DVI_FORM_E), node = 0;
  const double h = 1. / 7;
  for (int c = 0; c < 3; c++) {
    int place[3] = {4, 3, 3};
    node += h * E[dvi_yee_place(&terms, DVI_FORM_E, c, place)];
    place[c]--;
    node -= h * E[dvi_yee_place(&terms, DVI_FORM_E, c, place)];
  }
  double before;
  (void)step_up(0, &before, NULL);
  ck_assert_double_eq_tol(node, 7. / 4 * (1 - before), 1e-12);
  free(E);
  dvi_march_destroy(&march);
}
END_TEST

/* Random currents over 1e5 steps: charges are what the currents brought, to roundings. */
START_TEST(charges_are_those_of_the_currents)
{
  double seed[2] = {0.1, 0.7};
  const dvi_yee_current current = {.density = swirl, .signal = noise, .signal_user = &seed[0]};
  const dvi_yee_dipole dipole = {.at = {0.4, 0.6, 0.2},
                                 .along = {1, 2, 3},
                                 .signal = noise,
                                 .user = &seed[1],
                                 .is_moment = _i};
  dvi_yee_terms terms = cube(4, _i == 0 ? DVI_YEE_PEC : DVI_YEE_PERIODIC);
  terms.current = &current, terms.currents = 1;
  terms.dipole = &dipole, terms.dipoles = 1;
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 3);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  start_boxes(march, E, NULL);
  const double step = facts.step;
  advance_march(march, step * repeats(100000));
  ck_assert_double_le(observe_march(march, "gauss"), 1e-12);
  ck_assert_double_le(observe_march(march, "divergence"), 1e-12);
  free(E);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- fluxes ---- */

/* What a dipole gives away flows through any box around it. On equal boxes the sum over steps is
 * exact: the flux pairs E^n with the mean H of both sides. */
START_TEST(the_power_of_a_dipole_flows_through_boxes)
{
  const dvi_yee_dipole dipole = {.at = {5.3, 4.8, 5.1}, .along = {1, 2, -1}, .signal = doublet};
  const dvi_yee_probe probe = {"power", DVI_FORM_E, .at = {5.3, 4.8, 5.1}, .along = {-1, -2, 1}};
  const dvi_yee_flux flux[] = {{"near", {4, 3, 4}, {7, 6, 7}},  {"far", {2.1, 3, 2}, {8, 8, 7.9}},
                               {"right", {8, 3, 2}, {8, 8, 8}}, {"left", {2, 3, 2}, {2, 8, 8}},
                               {"top", {2, 8, 2}, {8, 8, 8}},   {"bottom", {2, 3, 2}, {8, 3, 8}},
                               {"front", {2, 3, 8}, {8, 8, 8}}, {"back", {2, 3, 2}, {8, 8, 2}}};
  enum { FLUXES = sizeof flux / sizeof *flux };
  double sum[FLUXES] = {0}, power = 0;
  dvi_yee_terms terms = {.size = sizeof terms, .axes = 3, .degree = 1, .step = 0.5};
  for (int l = 0; l < 3; l++) {
    terms.axis[l] = (dvi_yee_axis){.cells = 26, .lower = -8, .upper = 18};
    terms.axis[l].end[0] = terms.axis[l].end[1] = (dvi_yee_end){
        .kind = DVI_YEE_CPML, .layers = 8, .reflection = 1e-5};
  }
  terms.dipole = &dipole, terms.dipoles = 1;
  terms.probe = &probe, terms.probes = 1;
  terms.flux = flux, terms.fluxes = FLUXES;
  dvi_march *march = box_march(&terms);
  start_boxes(march, NULL, NULL);
  for (int n = 0; n < 300; n++) {
    double g;
    advance_march(march, 0.5 * n);
    (void)doublet(0.5 * n, &g, NULL);
    power += g * observe_march(march, "power");
    for (int i = 0; i < FLUXES; i++) sum[i] += observe_march(march, flux[i].name);
  }
  ck_assert_double_gt(power, 0.01);
  ck_assert_double_eq_tol(sum[0], power, 1e-6 * power);
  ck_assert_double_eq_tol(sum[1], power, 1e-6 * power);
  ck_assert_double_eq_tol(sum[2] - sum[3] + sum[4] - sum[5] + sum[6] - sum[7], sum[1],
                          1e-12 * power);
  dvi_march_destroy(&march);
}
END_TEST

/* At both ends of an axis that repeats itself stands the same plane. */
START_TEST(fluxes_are_those_of_the_other_end)
{
  const dvi_yee_flux flux[] = {{"lower", {0, 0.25}, {0, 1}}, {"upper", {1, 0.25}, {1, 1}}};
  dvi_yee_terms terms = {
      .size = sizeof terms, .axes = 2, .degree = _i, .flux = flux, .fluxes = 2, .step = 0.1};
  for (int l = 0; l < 2; l++)
    terms.axis[l] = (dvi_yee_axis){.cells = 5 - l,
                                   .end = {{.kind = DVI_YEE_PERIODIC}, {.kind = DVI_YEE_PERIODIC}}};
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 1),
         *B = random_values(dvi_march_size(march, DVI_FORM_B), 2);
  start_boxes(march, E, B);
  advance_march(march, 0.23);
  const double lower = observe_march(march, "lower");
  ck_assert_double_gt(fabs(lower), 0.01);
  ck_assert_double_eq_tol(observe_march(march, "upper"), lower, 1e-13 * fabs(lower));
  free(E), free(B);
  dvi_march_destroy(&march);
}
END_TEST

/* Nothing flows through magnetic conductors, beside which H is not 0. */
START_TEST(no_power_flows_through_magnetic_conductors)
{
  const dvi_yee_flux flux[] = {{"left", {0, 0.25}, {0, 1}}, {"right", {1, 0}, {1, 1}},
                               {"top", {0.2, 1}, {1, 1}},   {"all", {0, 0}, {1, 1}},
                               {"part", {0, 0}, {1, 0.5}},  {"inside", {0, 0.5}, {1, 0.5}}};
  enum { FLUXES = sizeof flux / sizeof *flux };
  double value[FLUXES];
  dvi_yee_terms terms = {
      .size = sizeof terms, .axes = 2, .degree = _i, .flux = flux, .fluxes = FLUXES, .step = 0.1};
  for (int l = 0; l < 2; l++)
    terms.axis[l] = (dvi_yee_axis){.cells = 5 - l,
                                   .end = {{.kind = DVI_YEE_PMC}, {.kind = DVI_YEE_PMC}}};
  dvi_march *march = box_march(&terms);
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 1),
         *B = random_values(dvi_march_size(march, DVI_FORM_B), 2);
  start_boxes(march, E, B);
  advance_march(march, 0.23);
  for (int i = 0; i < FLUXES; i++) value[i] = observe_march(march, flux[i].name);
  for (int i = 0; i < 4; i++) ck_assert_double_eq(value[i], 0);
  ck_assert_double_gt(fabs(value[5]), 0.01);
  ck_assert_double_eq(value[4], value[5]);
  free(E), free(B);
  dvi_march_destroy(&march);
}
END_TEST

/* ---- failures ---- */

START_TEST(a_failing_signal_leaves_the_last_good_time)
{
  const dvi_yee_dipole dipole = {.at = {0.5, 0.5, 0.5}, .along = {1, 0, 0}, .signal = failing};
  dvi_yee_terms terms = cube(4, DVI_YEE_PEC);
  terms.dipole = &dipole, terms.dipoles = 1;
  terms.step = 0.08;
  terms.together = _i;
  dvi_march *march = box_march(&terms), *short_one = box_march(&terms);
  start_boxes(march, NULL, NULL);
  start_boxes(short_one, NULL, NULL);
  ck_assert_int_eq(dvi_march_advance(march, 2), DVI_CALLBACK_FAILED);
  check_words("yee: a signal returned 3 at t = 1.04");
  ck_assert_double_eq_tol(dvi_march_time(march), 0.96, 1e-15);
  advance_march(short_one, 0.96);
  double *E = sample_march(march, DVI_FORM_E), *other = sample_march(short_one, DVI_FORM_E);
  for (int64_t i = 0; i < dvi_march_size(march, DVI_FORM_E); i++) ck_assert(E[i] == other[i]);
  free(E), free(other);
  dvi_march_destroy(&march);
  dvi_march_destroy(&short_one);
}
END_TEST

SUITE(yee_sources)
{
  tcase_add_test(tests, a_uniform_current_moves_all_of_E);
  tcase_add_test(tests, a_dipole_acts_by_whitney_weights);
  tcase_add_test(tests, dipoles_and_probes_are_reciprocal);
  tcase_add_test(tests, probes_see_uniform_fields);
  tcase_add_loop_test(tests, probes_see_over_the_end_of_an_axis, 0, 2);
  tcase_add_test(tests, a_moment_leaves_its_charges);
  tcase_add_loop_test(tests, charges_are_those_of_the_currents, 0, 2);
  tcase_add_test(tests, the_power_of_a_dipole_flows_through_boxes);
  tcase_add_loop_test(tests, fluxes_are_those_of_the_other_end, 0, 2);
  tcase_add_loop_test(tests, no_power_flows_through_magnetic_conductors, 0, 2);
  tcase_add_loop_test(tests, a_failing_signal_leaves_the_last_good_time, 0, 5);
}
