/* Stationary states of Schroedinger's equation, against exact energies and those of an independent
 * program, and ground states of Gross and Pitaevskii. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/field/function_spaces.h"
#include "support/field/marches.h"
#include "support/field/schroedinger.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- potentials ---- */

static int mathieu(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = cos(2 * x[i]);
  return 0;
}

static int double_well(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = pow(x[i] * x[i] - 4, 2) / 8;
  return 0;
}

static int wide_double_well(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = pow(x[i] * x[i] - 9, 2) / 18;
  return 0;
}

static int soft_coulomb_2(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = -1 / sqrt(x[i] * x[i] + 2);
  return 0;
}

static int soft_coulomb_1(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = -1 / sqrt(x[i] * x[i] + 1);
  return 0;
}

static int sech_squared(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = -6 / pow(cosh(x[i]), 2);
  return 0;
}

static int coulomb(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = -1 / x[i];
  return 0;
}

/* ---- modes ---- */

enum { MODES_MOST = 6 };

static void check_modes(quantum q, int count, const double *expected, double tolerance)
{
  double energy[MODES_MOST];
  ck_assert_msg(dvi_schroedinger_modes(q.equation, count, energy, NULL) == DVI_OK, "%s",
                dvi_last_error());
  for (int i = 0; i < count; i++)
    ck_assert_msg(fabs(energy[i] - expected[i]) < tolerance, "energy %d is %.15g", i, energy[i]);
  free_quantum(&q);
}

/* The digits are those that the literature, or a program with 400 modes, gives. */
START_TEST(energies_have_the_digits_of_independent_computations)
{
  check_modes(quantum_on_line("fourier:modes=16", 0, 2 * pi, 1, mathieu, 0), 3,
              (double[]){-.2275693020538, -.0551244084961, .9295540362572}, 1e-13);
  check_modes(quantum_on_line("fem:degree=8,cells=48", -8, 8, 0, double_well, 0), 2,
              (double[]){.900406747310, .948252691166}, 2e-12);
  check_modes(quantum_on_line("fem:degree=8,cells=48", -9, 9, 0, wide_double_well, 0), 2,
              (double[]){.970130862374, .970238245927}, 2e-12);
  check_modes(quantum_on_line("fem:degree=8,cells=150", -90, 90, 0, soft_coulomb_2, 0), 3,
              (double[]){-.5, -.232903337378, -.13382885914}, 2e-12);
  check_modes(quantum_on_line("fem:degree=8,cells=180", -60, 60, 0, soft_coulomb_1, 0), 2,
              (double[]){-.669777138214, -.274891348768}, 1e-11);
  check_modes(quantum_on_line("fem:degree=8,cells=160", -30, 30, 0, sech_squared, 0), 3,
              (double[]){-4.5, -2, -.5}, 1e-11);
}
END_TEST

START_TEST(splitting_of_a_double_well_has_its_digits)
{
  quantum q = quantum_on_line("fourier:modes=80", -8, 8, 1, double_well, 0);
  double energy[2];
  ck_assert(dvi_schroedinger_modes(q.equation, 2, energy, NULL) == DVI_OK);
  ck_assert(fabs(energy[1] - energy[0] - .04784594386) < 1e-11);
  free_quantum(&q);
}
END_TEST

/* Errors of Mathieu's characteristic number a_0(1)/2 with 2K+1 functions, as an independent program
 * finds them: Galerkin's method from above, and collocation from below. */
START_TEST(fourier_converges_faster_than_any_power)
{
  static const struct {
    const char *kind;
    double error;
  } cases[] = {{"fourier:modes=4", 4.762275e-6},
               {"fourier:modes=6", 2.030475e-9},
               {"fourier:modes=8", 3.18e-13},
               {"fourier:modes=4,points=9", -1.451598e-5},
               {"fourier:modes=6,points=13", -3.135931e-9},
               {"fourier:modes=8,points=17", -3.20e-13}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    check_modes(quantum_on_line(cases[i].kind, 0, 2 * pi, 1, mathieu, 0), 1,
                (double[]){-.22756930205370714 + cases[i].error},
                1e-6 * fabs(cases[i].error) + 1e-14);
}
END_TEST

static double error_of_oscillator(const char *kind)
{
  quantum q = quantum_on_line(kind, -8, 8, 0, harmonic, 0);
  double energy;
  ck_assert(dvi_schroedinger_modes(q.equation, 1, &energy, NULL) == DVI_OK);
  free_quantum(&q);
  return energy - 0.5;
}

/* Ritz's values are above the true ones, which end at 1e-13 here. */
START_TEST(elements_converge_with_order_two_k)
{
  for (int degree = 1; degree <= 3; degree++) {
    double before = 0;
    for (int cells = 32; cells <= 128; cells *= 2) {
      char kind[64];
      (void)snprintf(kind, sizeof kind, "fem:degree=%d,cells=%d", degree, cells);
      const double error = error_of_oscillator(kind);
      ck_assert(error > 0);
      if (before > 0) ck_assert(fabs(log2(before / error) - 2 * degree) < 0.15);
      before = error;
    }
  }
}
END_TEST

/* LOBPCG beyond 400 functions, beside exact energies and the full matrix. */
START_TEST(many_fourier_modes_are_found_without_a_matrix)
{
  check_modes(quantum_on_line("fourier:modes=300", -30, 30, 1, sech_squared, 0), 3,
              (double[]){-4.5, -2, -.5}, 1e-12);
  check_modes(quantum_on_square("fourier:modes=14", -7, 7, 1, harmonic_square, 0), 6,
              (double[]){1, 2, 2, 3, 3, 3}, 1e-6);
}
END_TEST

/* A step of 1e16 leaves one digit of energies near 1. */
static int cliff(int64_t count, double t, const double *x, double *V, void *user)
{
  (void)t, (void)user;
  for (int64_t i = 0; i < count; i++) V[i] = x[i] > 0 ? 1e16 : 0;
  return 0;
}

START_TEST(states_that_roundings_hide_are_not_given)
{
  quantum q = quantum_on_line("fourier:modes=16", -5, 5, 1, cliff, 0);
  double energy;
  ck_assert(dvi_schroedinger_modes(q.equation, 1, &energy, NULL) == DVI_NOT_CONVERGED);
  check_words("is not resolved");
  free_quantum(&q);
}
END_TEST

/* The lowest state has no energy at all. */
START_TEST(free_particles_on_a_circle_are_found_by_both_ways)
{
  check_modes(quantum_on_line("fourier:modes=20", 0, 2 * pi, 1, NULL, 0), 3,
              (double[]){0, 0.5, 0.5}, 1e-14);
  check_modes(quantum_on_line("fourier:modes=250", 0, 2 * pi, 1, NULL, 0), 3,
              (double[]){0, 0.5, 0.5}, 1e-14);
}
END_TEST

/* ---- a mesh ---- */

/* A square box of side 1 has pi^2 (k^2 + l^2)/2. Quadratic triangles are of order 4. */
START_TEST(triangles_have_the_energies_of_a_box)
{
  double before = 0;
  for (int cells = 4; cells <= 16; cells *= 2) {
    dvi_mesh *mesh = jittered_mesh(2, 2, cells, 0, 1);
    const dvi_schroedinger_terms terms = {0};
    quantum q = quantum_with(space_on_mesh("fem:degree=2", mesh), &terms);
    double energy;
    ck_assert(dvi_schroedinger_modes(q.equation, 1, &energy, NULL) == DVI_OK);
    const double error = energy - pi * pi;
    ck_assert(error > 0);
    if (before > 0) ck_assert(fabs(log2(before / error) - 4) < 0.2);
    before = error;
    free_quantum(&q);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

/* ---- radius ---- */

static quantum on_radius(int radial, potential_of_points *V)
{
  const dvi_schroedinger_terms terms = {.potential = V, .radial = radial, .fixed = "right"};
  return quantum_with(space_on_line("fem:degree=8,cells=24", 0, 10, 0), &terms);
}

/* States without angular momentum: 2 n + 1 in two and 2 n + 3/2 in three dimensions. */
START_TEST(oscillators_of_a_radius_have_their_energies)
{
  check_modes(on_radius(2, harmonic), 3, (double[]){1, 3, 5}, 1e-11);
  check_modes(on_radius(3, harmonic), 3, (double[]){1.5, 3.5, 5.5}, 1e-11);
}
END_TEST

/* Hydrogen's s states, by R in three dimensions and by u = r R on the half line. */
START_TEST(hydrogen_has_its_energies_in_both_forms)
{
  const double expected[] = {-0.5, -0.125};
  const dvi_schroedinger_terms terms = {.potential = coulomb, .radial = 3, .fixed = "right"};
  check_modes(quantum_with(space_on_line("fem:degree=8,cells=40", 0, 50, 0), &terms), 2, expected,
              1e-9);
  check_modes(quantum_on_line("fem:degree=8,cells=40", 0, 50, 0, coulomb, 0), 2, expected, 1e-9);
}
END_TEST

/* ---- states ---- */

START_TEST(states_are_orthonormal_and_stay_up_to_a_phase)
{
  quantum q = quantum_on_line("spline:degree=6,cells=50", -9, 9, 0, harmonic, 0);
  double energy[3], *psi = calloc(6 * (size_t)q.functions, sizeof *psi);
  ck_assert(dvi_schroedinger_modes(q.equation, 3, energy, psi) == DVI_OK);
  dvi_march *march = quantum_march(&q, "gauss:stages=3", 0.1);
  dvi_schroedinger_values values;
  double *state = calloc(2 * (size_t)q.functions, sizeof *state);
  for (int64_t i = 0; i < q.functions; i++) state[i] = psi[2 * q.functions + i];
  const dvi_march_state start = {.size = sizeof start, .A = state};
  ck_assert(dvi_schroedinger_measure(q.equation, 0, state, &values) == DVI_OK);
  ck_assert(fabs(values.norm - 1) < 1e-13 && fabs(values.energy - 2.5) < 1e-9);
  ck_assert(fabs(values.kinetic - values.potential) < 1e-8);
  ck_assert(dvi_march_start(march, &start) == DVI_OK);
  advance_march(march, 2);
  double *now = sample_march(march, DVI_FORM_A), turn = 2 * energy[2];
  for (int64_t i = 0; i < q.functions; i++) {
    ck_assert(fabs(now[i] - cos(turn) * state[i]) < 1e-7);
    ck_assert(fabs(now[q.functions + i] + sin(turn) * state[i]) < 1e-7);
  }
  free(now);
  free(psi);
  free(state);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

/* ---- Gross and Pitaevskii ---- */

typedef struct condensate {
  double mu, energy, virial;
} condensate;

static condensate ground_of(quantum q, int axes, double norm)
{
  condensate found;
  dvi_schroedinger_ground_report state;
  dvi_schroedinger_values v;
  double *psi = calloc(2 * (size_t)q.functions, sizeof *psi);
  ck_assert_msg(dvi_schroedinger_ground(q.equation, norm, &state, psi) == DVI_OK, "%s",
                dvi_last_error());
  found.mu = state.mu;
  found.energy = state.energy;
  ck_assert(dvi_schroedinger_measure(q.equation, 0, psi, &v) == DVI_OK);
  ck_assert(fabs(v.norm - norm) < 1e-13 && fabs(v.energy - found.energy) < 1e-12 * fabs(v.energy));
  found.virial = 2 * v.kinetic - 2 * v.potential + axes * v.interaction;
  free(psi);
  free_quantum(&q);
  return found;
}

static const struct {
  double beta, mu, energy;
} condensates[] = {{10, 3.107243089426, 1.947127215052},
                   {100, 14.134287086585, 8.508526756217},
                   {400, 35.577460889225, 21.360069696058}};

/* All digits of an independent program. The virial theorem has roundings alone. */
START_TEST(condensates_have_the_digits_of_an_independent_program)
{
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 2; k++) {
      const condensate found = ground_of(
          k == 0
              ? quantum_on_line("fem:degree=8,cells=40", -12, 12, 0, harmonic, condensates[i].beta)
              : quantum_on_line("fourier:modes=110", -14, 14, 1, harmonic, condensates[i].beta),
          1, 1);
      ck_assert(fabs(found.mu - condensates[i].mu) < 2e-12);
      ck_assert(fabs(found.energy - condensates[i].energy) < 2e-12);
      ck_assert(fabs(found.virial) < 1e-13 * (1 + condensates[i].energy / 10));
    }
}
END_TEST

START_TEST(condensates_in_two_dimensions_have_their_digits)
{
  const condensate fourier = ground_of(
      quantum_on_square("fourier:modes=24", -8, 8, 1, harmonic_square, 50), 2, 1);
  ck_assert(fabs(fourier.mu - 4.14300593) < 1e-8 && fabs(fourier.energy - 2.89603185) < 1e-8);
  const dvi_schroedinger_terms terms = {
      .potential = harmonic, .radial = 2, .fixed = "right", .interaction = 50};
  const condensate radial = ground_of(
      quantum_with(space_on_line("fem:degree=8,cells=20", 0, 8, 0), &terms), 2, 1);
  ck_assert(fabs(radial.mu - 4.14300593) < 1e-8 && fabs(radial.energy - 2.89603185) < 1e-8);
  ck_assert(fabs(radial.virial) < 1e-12);
}
END_TEST

static int tenfold(int64_t count, const double *x, double *beta, void *user)
{
  (void)x, (void)user;
  for (int64_t i = 0; i < count; i++) beta[i] = 10;
  return 0;
}

/* H(psi) psi = mu M psi makes psi exp(-i mu t/hbar). A step of order 8 has no other error here. */
START_TEST(condensates_turn_by_their_chemical_potential)
{
  const dvi_schroedinger_terms terms = {.potential = harmonic, .interaction_at = tenfold};
  quantum q = quantum_with(space_on_line("fem:degree=8,cells=20", -9, 9, 0), &terms);
  double *psi = calloc(2 * (size_t)q.functions, sizeof *psi);
  dvi_schroedinger_ground_report state;
  ck_assert(dvi_schroedinger_ground(q.equation, 1, &state, psi) == DVI_OK);
  const double mu = state.mu;
  ck_assert(fabs(mu - condensates[0].mu) < 1e-9);
  dvi_march *march = quantum_march(&q, "gauss:stages=4", 0.05);
  const dvi_march_state start = {.size = sizeof start, .A = psi};
  ck_assert(dvi_march_start(march, &start) == DVI_OK);
  advance_march(march, 1);
  double *now = sample_march(march, DVI_FORM_A);
  for (int64_t i = 0; i < q.functions; i++) {
    ck_assert(fabs(now[i] - cos(mu) * psi[i]) < 1e-11);
    ck_assert(fabs(now[q.functions + i] + sin(mu) * psi[i]) < 1e-11);
  }
  free(now);
  free(psi);
  dvi_march_destroy(&march);
  free_quantum(&q);
}
END_TEST

/* norm beta alone counts: psi/sqrt(norm) has the interaction norm beta. */
START_TEST(norm_scales_the_interaction)
{
  const condensate found = ground_of(
      quantum_on_line("fem:degree=8,cells=40", -12, 12, 0, harmonic, 25), 1, 4);
  ck_assert(fabs(found.mu - condensates[1].mu) < 2e-12);
  ck_assert(fabs(found.energy / 4 - condensates[1].energy) < 2e-12);
}
END_TEST

/* Half of the soliton sech(x/2)/2 with mu = -1/8 for beta = -1. The whole one could be anywhere,
 * and Newton's method would not know where. */
START_TEST(attraction_makes_a_soliton)
{
  const dvi_schroedinger_terms terms = {.interaction = -1, .fixed = "right"};
  const condensate found = ground_of(
      quantum_with(space_on_line("fem:degree=8,cells=60", 0, 60, 0), &terms), 1, 0.5);
  ck_assert(fabs(found.mu + 0.125) < 1e-10 && fabs(found.energy + 1.0 / 48) < 1e-10);
}
END_TEST

/* A sinc collocation of an independent program gives the pitchfork at beta = -0.0912775, and these
 * states beyond it, where the even ones have E = 0.888277082 and 0.775507855. */
static const struct {
  double beta, followed, mu, energy, place;
} wells[] = {{-0.02, 1, 0.8955655280, 0.8979868942, 0},
             {-0.1, 0.912775, 0.873719253145, 0.888172885827, 0.729757626},
             {-1, 0.0912775, 0.368701131475, 0.653829135802, 1.800216002}};

START_TEST(attraction_leads_to_one_side_of_a_double_well)
{
  static const char *const kinds[] = {"fem:degree=8,cells=40", "fourier:modes=64"};
  const int well = _i / 2;
  quantum q = quantum_on_line(kinds[_i % 2], -7, 7, _i % 2, double_well, wells[well].beta);
  dvi_schroedinger_ground_report state;
  dvi_schroedinger_values v;
  double *psi = calloc(2 * (size_t)q.functions, sizeof *psi);
  ck_assert_msg(dvi_schroedinger_ground(q.equation, 1, &state, psi) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert(dvi_schroedinger_measure(q.equation, 0, psi, &v) == DVI_OK);
  ck_assert_double_eq_tol(state.mu, wells[well].mu, well == 0 ? 1e-9 : 1e-11);
  ck_assert_double_eq_tol(state.energy, wells[well].energy, well == 0 ? 1e-9 : 1e-11);
  ck_assert_double_eq_tol(fabs(v.position[0]), wells[well].place, 1e-8);
  ck_assert_double_eq_tol(state.followed, wells[well].followed, 1e-3);
  free(psi);
  free_quantum(&q);
}
END_TEST

static dvi_schroedinger_ground_report ground_beside(quantum q, dvi_status expected)
{
  dvi_schroedinger_ground_report state = {0};
  ck_assert_int_eq(dvi_schroedinger_ground(q.equation, 1, &state, NULL), expected);
  free_quantum(&q);
  return state;
}

/* Townes' soliton has norm 5.850448. Below it there is a state, whatever the trap. */
START_TEST(attraction_collapses_in_two_dimensions)
{
  const dvi_schroedinger_terms terms = {
      .potential = harmonic, .radial = 2, .fixed = "right", .interaction = -5.86};
  ck_assert(
      ground_beside(quantum_on_square("fourier:modes=10", -5, 5, 1, harmonic_square, -3), DVI_OK)
          .followed == 1);
  (void)ground_beside(quantum_on_square("fourier:modes=10", -5, 5, 1, harmonic_square, -5.86),
                      DVI_NOT_CONVERGED);
  check_words("has to be below 5.85");
  (void)ground_beside(quantum_with(space_on_line("fem:degree=4,cells=9", 0, 6, 0), &terms),
                      DVI_NOT_CONVERGED);
  check_words("attraction lets all states collapse");
}
END_TEST

/* In three dimensions metastable states end at |beta| = 4 pi 0.57497 = 7.2253 (Ruprecht et al.
 * 1995; Gammal, Frederico and Tomio 2001). */
START_TEST(attraction_collapses_in_three_dimensions_later)
{
  dvi_schroedinger_terms terms = {
      .potential = harmonic, .radial = 3, .fixed = "right", .interaction = -7.2};
  ck_assert(
      ground_beside(quantum_with(space_on_line("fem:degree=6,cells=20", 0, 7, 0), &terms), DVI_OK)
          .followed == 1);
  terms.interaction = -10;
  (void)ground_beside(quantum_with(space_on_line("fem:degree=6,cells=20", 0, 7, 0), &terms),
                      DVI_NOT_CONVERGED);
  check_words("lost at 0.7225");
}
END_TEST

SUITE(stationary)
{
  tcase_add_test(tests, energies_have_the_digits_of_independent_computations);
  tcase_add_test(tests, splitting_of_a_double_well_has_its_digits);
  tcase_add_test(tests, fourier_converges_faster_than_any_power);
  tcase_add_test(tests, elements_converge_with_order_two_k);
  tcase_add_test(tests, many_fourier_modes_are_found_without_a_matrix);
  tcase_add_test(tests, states_that_roundings_hide_are_not_given);
  tcase_add_test(tests, free_particles_on_a_circle_are_found_by_both_ways);
  tcase_add_test(tests, triangles_have_the_energies_of_a_box);
  tcase_add_test(tests, oscillators_of_a_radius_have_their_energies);
  tcase_add_test(tests, hydrogen_has_its_energies_in_both_forms);
  tcase_add_test(tests, states_are_orthonormal_and_stay_up_to_a_phase);
  tcase_add_test(tests, condensates_have_the_digits_of_an_independent_program);
  tcase_add_test(tests, condensates_in_two_dimensions_have_their_digits);
  tcase_add_test(tests, condensates_turn_by_their_chemical_potential);
  tcase_add_test(tests, norm_scales_the_interaction);
  tcase_add_test(tests, attraction_makes_a_soliton);
  tcase_add_loop_test(tests, attraction_leads_to_one_side_of_a_double_well, 0, 6);
  tcase_add_test(tests, attraction_collapses_in_two_dimensions);
  tcase_add_test(tests, attraction_collapses_in_three_dimensions_later);
}
