/* Waves that advance by tents: their convergence, media, and how long they stay bounded. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/meshes.h"
#include "support/suite.h"
#include "support/field/tents.h"

static const double pi = 3.14159265358979323846;

/* ---- waves ---- */

/* Returns the largest error of a sine that has gone once around a circle of random edges. */
static double error_of_sine(int points, double least)
{
  pitched p = tents_over(ring_mesh(points, 0.2, 5), 0, NULL, NULL,
                         (dvi__tents_options){.least = least, .seed = 7});
  set_sine(&p, 1);
  double *u = calloc((size_t)points, sizeof *u);
  memcpy(u, p.A, (size_t)points * sizeof *u);
  start_tents(&p);
  advance_tents(&p, 1);
  sample_tents(&p);
  const double error = largest_error(points, p.A, u);
  free(u);
  strike_tents(&p);
  return error;
}

/* The order is 2 on smooth meshes, and a little less on random ones. */
START_TEST(a_travelling_sine_converges)
{
  for (int random = 0; random < 2; random++) {
    const double least = random ? 0.5 : 1, coarse = error_of_sine(16, least),
                 fine = error_of_sine(128, least), slope = log2(coarse / fine) / 3;
    ck_assert_double_le(coarse, 0.056);
    ck_assert_double_le(fine, 1.3e-3);
    ck_assert_double_ge(slope, 1.7);
    ck_assert_double_le(slope, 2.1);
  }
}
END_TEST

/* Returns the relative error of E and B of a plane wave, E along y, that has gone around once. */
static double error_of_light(dvi_mesh *mesh, double least)
{
  pitched p = tents_over(mesh, 1, NULL, NULL, (dvi__tents_options){.least = least, .seed = 7});
  double *E = calloc((size_t)p.size, sizeof *E), *B = calloc((size_t)p.above, sizeof *B), error = 0,
         square = 0;
  integrate_wave(&p, 1, (plane_wave){.factor = {0, 1}}, E);
  integrate_wave(&p, 2, (plane_wave){.factor = {1}}, B);
  dvi__tents_start(p.tents, &(dvi_march_state){.E = E, .B = B});
  advance_tents(&p, 1);
  sample_tents(&p);
  const double *M1 = p.star->diagonal[1], *M2 = p.star->diagonal[2];
  for (int64_t i = 0; i < p.size; i++) {
    error += M1[i] * pow(p.E[i] - E[i], 2);
    square += M1[i] * E[i] * E[i];
  }
  for (int64_t i = 0; i < p.above; i++) {
    error += M2[i] * pow(p.B[i] - B[i], 2);
    square += M2[i] * B[i] * B[i];
  }
  ck_assert_double_le(dvi__tents_charge_error(p.tents), 1e-13);
  free(E);
  free(B);
  strike_tents(&p);
  return sqrt(error / square);
}

/* The measured errors of random tents are 0.15, 0.040, 0.019. */
START_TEST(light_converges_on_triangles)
{
  static const int cells[] = {4, 8, 12}, rows[] = {4, 10, 14};
  static const double most[] = {0.18, 0.05, 0.025};
  for (int random = 0; random < 2; random++)
    for (int i = 0; i < (is_short_run() ? 2 : 3); i++)
      ck_assert_double_le(error_of_light(equilateral_torus(cells[i], rows[i]), random ? 0.5 : 1),
                          most[i]);
}
END_TEST

START_TEST(light_converges_on_tetrahedra)
{
  double error[2];
  for (int i = 0; i < 2; i++) {
    const int n = 3 + 2 * i;
    dvi_mesh *mesh = mesh_at(&(tent_place){"bcc-torus", 3, n, n});
    error[i] = error_of_light(mesh, 1);
  }
  ck_assert_double_le(error[0], 0.4);
  ck_assert_double_ge(log(error[0] / error[1]) / log(5.0 / 3), 1.5);
}
END_TEST

/* ---- order ---- */

typedef struct cavity_errors {
  double place, mode; /* of E: in the mean square over vertices, and of the amplitude */
} cavity_errors;

/* The errors of E = sin(pi x) cos(pi t) at t = 1.3. */
static cavity_errors errors_of_cavity(int cells, double least, uint64_t seed)
{
  int8_t held[161] = {1};
  held[cells] = 1;
  pitched p = tents_over(mesh_at(&(tent_place){"interval", 1, cells, 0}), 0, NULL, held,
                         (dvi__tents_options){.least = least, .seed = seed});
  for (int i = 1; i < cells; i++) p.E[i] = sin(pi * i / cells);
  start_tents(&p);
  advance_tents(&p, 1.3);
  sample_tents(&p);
  cavity_errors sum = {0};
  for (int i = 0; i <= cells; i++) {
    const double shape = sin(pi * i / cells), error = p.E[i] - shape * cos(pi * 1.3);
    sum.place += error * error / cells;
    sum.mode += 2 * error * shape / cells;
  }
  strike_tents(&p);
  return (cavity_errors){sqrt(sum.place), fabs(sum.mode)};
}

/* Equal tents are of second order everywhere. The shifts of momentum between neighbours by random
 * ones leave an order of 1/2 at a place, and second order in the amplitude of a mode. */
START_TEST(random_tents_lose_order_at_places_but_not_in_modes)
{
  const cavity_errors coarse = errors_of_cavity(40, 1, 0), fine = errors_of_cavity(160, 1, 0);
  cavity_errors rough = {0}, smooth = {0};
  ck_assert_double_eq_tol(log2(coarse.place / fine.place) / 2, 2, 0.02);
  ck_assert_double_eq_tol(log2(coarse.mode / fine.mode) / 2, 2, 0.02);
  for (int seed = 1; seed <= 12; seed++) {
    const cavity_errors a = errors_of_cavity(40, 0.5, (uint64_t)seed),
                        b = errors_of_cavity(160, 0.5, (uint64_t)seed);
    rough.place += a.place * a.place;
    rough.mode += a.mode * a.mode;
    smooth.place += b.place * b.place;
    smooth.mode += b.mode * b.mode;
  }
  ck_assert_double_eq_tol(log2(rough.place / smooth.place) / 4, 0.45, 0.15);
  ck_assert_double_eq_tol(log2(rough.mode / smooth.mode) / 4, 2, 0.05);
}
END_TEST

/* ---- media ---- */

/* A wave with the speed 1/2, and one as fast as light with a high impedance, which no wave in one
 * medium shows. */
START_TEST(a_medium_has_its_speed_of_light)
{
  enum { N = 64 };
  static const double eps[] = {4, 5}, nu[] = {1, 5};
  for (int i = 0; i < 2; i++) {
    double mass[N], stiffness[N], u[N];
    const double *factor[] = {mass, stiffness, NULL}, c = sqrt(nu[i] / eps[i]);
    for (int cell = 0; cell < N; cell++) {
      mass[cell] = eps[i];
      stiffness[cell] = nu[i];
    }
    pitched p = tents_over(ring_mesh(N, 0.1, 3), 0, factor, NULL, (dvi__tents_options){0});
    set_sine(&p, c);
    memcpy(u, p.A, sizeof u);
    start_tents(&p);
    advance_tents(&p, 1 / c);
    sample_tents(&p);
    ck_assert_double_le(largest_error(N, p.A, u), 0.01);
    strike_tents(&p);
  }
}
END_TEST

/* A pulse in a medium with n = 1 meets one with n = 2 at x = 1/2: it returns with the height -1/3,
 * and goes on with 2/3 (Fresnel). The second pulse is 16 edges wide. */
START_TEST(a_pulse_is_reflected_at_an_interface)
{
  enum { N = 400 };
  double eps[N];
  const double *factor[] = {eps, NULL, NULL};
  for (int c = 0; c < N; c++) eps[c] = c < N / 2 ? 1 : 4;
  pitched p = tents_over(mesh_at(&(tent_place){"interval", 1, N, 0}), 0, factor, NULL,
                         (dvi__tents_options){0});
  const double width = 0.04;
  for (int i = 0; i <= N; i++) {
    const double s = ((double)i / N - 0.25) / width;
    p.A[i] = exp(-s * s);
    p.E[i] = -2 * s / width * exp(-s * s);
  }
  start_tents(&p);
  advance_tents(&p, 0.4);
  sample_tents(&p);
  double least = 0, most = 0;
  for (int i = 0; i < N / 2; i++) least = fmin(least, p.A[i]);
  for (int i = N / 2; i <= N; i++) most = fmax(most, p.A[i]);
  ck_assert_double_eq_tol(least, -1.0 / 3, 0.01);
  ck_assert_double_eq_tol(most, 2.0 / 3, 0.01);
  strike_tents(&p);
}
END_TEST

/* Media of any kind keep a constant field with its charges. */
START_TEST(charges_stay_in_random_media)
{
  dvi_mesh *mesh = staggered_mesh(5, 5);
  const int64_t cells = dvi_mesh_count(mesh, 2);
  double *eps = calloc((size_t)cells, sizeof *eps), *nu = calloc((size_t)cells, sizeof *nu);
  const double *factor[] = {NULL, eps, nu};
  unsigned long long seed = 3;
  for (int64_t c = 0; c < cells; c++) {
    eps[c] = 1 + 3 * random_number(&seed);
    nu[c] = 0.3 + random_number(&seed);
  }
  pitched p = tents_over(mesh, 1, factor, NULL, (dvi__tents_options){.least = 0.5, .seed = 4});
  fill_at_random(p.size, 1, 6, p.E);
  start_tents(&p);
  const double before = energy_of_tents(&p);
  advance_tents(&p, 2);
  ck_assert_double_le(dvi__tents_charge_error(p.tents), 1e-13);
  ck_assert_double_eq_tol(energy_of_tents(&p) / before, 1, 0.1);
  free(eps);
  free(nu);
  strike_tents(&p);
}
END_TEST

/* ---- stability ---- */

static pitched random_ring(double fraction)
{
  return tents_over(ring_mesh(32, 0.2, 5), 0, NULL, NULL,
                    (dvi__tents_options){.fraction = fraction, .least = 0.5, .seed = 7});
}

/* Random tents drift like random steps: they are stable for a while only. */
START_TEST(half_of_the_local_step_is_bounded_and_nine_tenths_grow)
{
  pitched half = random_ring(0.5), most = random_ring(0.9);
  double largest = 0;
  set_sine(&half, 1);
  start_tents(&half);
  advance_tents(&half, 20);
  sample_tents(&half);
  for (int64_t i = 0; i < half.size; i++) largest = fmax(largest, fabs(half.A[i]));
  ck_assert_double_le(largest, 1.06);
  fill_at_random(most.size, 1, 8, most.E);
  start_tents(&most);
  const double before = energy_of_tents(&most);
  advance_tents(&most, 60);
  ck_assert_double_ge(energy_of_tents(&most), 100 * before);
  strike_tents(&half);
  strike_tents(&most);
}
END_TEST

/* All frequencies are in a random start. Regular tents of half the local step keep the energy. */
START_TEST(the_energy_of_random_fields_is_bounded)
{
  for (int i = 0; i < TENT_PLACES; i++)
    for (int k = 0; k < tent_places[i].n && k < 2; k++) {
      pitched p = tents_over(mesh_at(tent_places + i), k, NULL, NULL, (dvi__tents_options){0});
      fill_at_random(p.size, 1, 8, p.E);
      start_tents(&p);
      const double before = energy_of_tents(&p);
      for (int t = 1; t <= repeats(10); t++) {
        advance_tents(&p, t);
        ck_assert_double_eq_tol(energy_of_tents(&p) / before, 1, 0.2);
      }
      strike_tents(&p);
    }
}
END_TEST

/* The front is never steeper than the fraction of light's slope, on its edges and in its cells. */
START_TEST(fronts_are_not_steeper_than_light)
{
  for (int i = 0; i < TENT_PLACES; i++) {
    pitched p = tents_over(mesh_at(tent_places + i), 0, NULL, NULL,
                           (dvi__tents_options){.fraction = 0.9, .least = 0.3, .seed = 1});
    const dvi_mesh *mesh = p.star->mesh;
    const double *time = p.tents->front.time;
    for (int tent = 0; tent < repeats(2000); tent++) {
      int v;
      double top;
      ck_assert_msg(dvi__tents_pitch(p.tents, &v, &top) == DVI_OK, "%s", dvi_last_error());
      for (int64_t e = 0; e < mesh->count[1]; e++) {
        double d[DVI_MESH_SPACE_MAX], square = 0;
        const int *end = mesh->corner[1] + 2 * e;
        dvi__mesh_difference(mesh, end[0], end[1], d);
        for (int l = 0; l < mesh->space; l++) square += d[l] * d[l];
        ck_assert_double_le(fabs(time[end[0]] - time[end[1]]), 0.9 * (1 + 1e-12) * sqrt(square));
      }
    }
    strike_tents(&p);
  }
}
END_TEST

/* On a triangle the steepest front has the slope 1/cos(theta/2) with the largest angle theta. */
START_TEST(the_steepest_front_of_a_triangle_is_known)
{
  for (unsigned seed = 1; seed <= 100; seed++) {
    dvi_mesh *mesh = random_simplex(2, 2 + seed % 2, NULL, seed);
    double d[3][DVI_MESH_SPACE_MAX] = {{0}}, least = 1;
    for (int i = 0; i < 3; i++) dvi__mesh_difference(mesh, i, (i + 1) % 3, d[i]);
    for (int i = 0; i < 3; i++) {
      const double *u = d[i], *v = d[(i + 2) % 3];
      double dot = 0, u2 = 0, v2 = 0;
      for (int l = 0; l < mesh->space; l++) {
        dot -= u[l] * v[l];
        u2 += u[l] * u[l];
        v2 += v[l] * v[l];
      }
      least = fmin(least, sqrt((1 + dot / sqrt(u2 * v2)) / 2));
    }
    ck_assert_double_eq_tol(dvi__steepest(mesh, 0) * least, 1, 1e-9 / least);
    dvi_mesh_destroy(&mesh);
  }
}
END_TEST

SUITE(tent_waves)
{
  tcase_add_test(tests, a_travelling_sine_converges);
  tcase_add_test(tests, light_converges_on_triangles);
  tcase_add_test(tests, light_converges_on_tetrahedra);
  tcase_add_test(tests, random_tents_lose_order_at_places_but_not_in_modes);
  tcase_add_test(tests, a_medium_has_its_speed_of_light);
  tcase_add_test(tests, a_pulse_is_reflected_at_an_interface);
  tcase_add_test(tests, charges_stay_in_random_media);
  tcase_add_test(tests, half_of_the_local_step_is_bounded_and_nine_tenths_grow);
  tcase_add_test(tests, the_energy_of_random_fields_is_bounded);
  tcase_add_test(tests, fronts_are_not_steeper_than_light);
  tcase_add_test(tests, the_steepest_front_of_a_triangle_is_known);
}
