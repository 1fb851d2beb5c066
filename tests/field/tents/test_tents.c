/* Forms that advance by tents: leapfrog and exact solutions as judges, walls, and refusals. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/meshes.h"
#include "support/suite.h"
#include "support/field/tents.h"

static const double pi = 3.14159265358979323846;

/* ---- leapfrog ---- */

/* Default tents on a circle of equal edges rise by half an edge from left to right. Their right
 * triangles have the weights of leapfrog, and both schemes add the same terms. */
START_TEST(tents_of_equal_edges_are_leapfrog)
{
  enum { N = 16, STEPS = 40 };
  const double h = 1.0 / N, dt = h / 2;
  pitched p = tents_over(ring_mesh(N, 0, 1), 0, NULL, NULL, (dvi__tents_options){0});
  double u[N], v[N];
  fill_at_random(N, 1, 3, p.A);
  fill_at_random(N, 1, 4, p.E);
  memcpy(u, p.A, sizeof u);
  for (int i = 0; i < N; i++) v[i] = -p.E[i];
  start_tents(&p);
  for (int step = 0; step < STEPS; step++) {
    double pull[N];
    for (int kick = 0; kick < 2; kick++) {
      for (int i = 0; i < N; i++)
        pull[i] = ((u[(i + 1) % N] - u[i]) - (u[i] - u[(i + N - 1) % N])) / (h * h);
      for (int i = 0; i < N; i++) v[i] += dt / 2 * pull[i];
      for (int i = 0; i < N && kick == 0; i++) u[i] += dt * v[i];
    }
    advance_tents(&p, (step + 1) * dt);
    sample_tents(&p);
    for (int i = 0; i < N; i++) {
      ck_assert_double_eq_tol(p.A[i], u[i], 1e-15 * (step + 4));
      ck_assert_double_eq_tol(-p.E[i], v[i], 1e-15 * (step + 4) / dt);
    }
  }
  ck_assert_int_eq(p.tents->front.tents, N * STEPS);
  strike_tents(&p);
}
END_TEST

/* One step of velocity Verlet for M E' = d^T M' B, B' = -d E, which is leapfrog with E and B at one
 * time. */
static void leap(const pitched *p, double dt, double *E, double *B, double *work)
{
  dvi_matrix d;
  const double *mass = p->star->diagonal[p->k], *stiffness = p->star->diagonal[p->k + 1];
  double *H = work, *curl = work + p->above;
  ck_assert_int_eq(dvi_mesh_incidence(dvi_star_mesh(p->star), p->k, &d), DVI_OK);
  for (int kick = 0; kick < 2; kick++) {
    for (int64_t f = 0; f < p->above; f++) H[f] = stiffness[f] * B[f];
    dvi_matrix_multiply(&d, 1, H, curl);
    for (int64_t e = 0; e < p->size; e++) E[e] += dt / 2 * curl[e] / mass[e];
    dvi_matrix_multiply(&d, 0, E, H);
    for (int64_t f = 0; f < p->above && kick == 0; f++) B[f] -= dt * H[f];
  }
}

/* A level front over equal cells rises in layers. The corners of each prism lie on one sphere, so
 * that the faces inside of it have no duals, and the others those of the prism: the scheme is that
 * of Bossavit and Kettunen. Steps and duals are rounded otherwise, and fields grow no errors. */
START_TEST(tents_of_equal_cells_are_leapfrog)
{
  for (int n = 2; n <= 3; n++)
    for (int k = 0; k < 2; k++) {
      dvi_generator_options options = {.size = sizeof options, .cells = {3, 3, 3}};
      dvi_mesh *mesh = NULL;
      if (n == 2)
        mesh = equilateral_torus(6, 6);
      else
        ck_assert_int_eq(dvi_mesh_generate("bcc-torus", &options, &mesh), DVI_OK);
      pitched p = tents_over(mesh, k, NULL, NULL, (dvi__tents_options){0});
      double *E = calloc((size_t)p.size, sizeof *E), *B = calloc((size_t)p.above, sizeof *B),
             *work = calloc((size_t)(p.size + p.above), sizeof *work), dt;
      int vertex;
      ck_assert_int_eq(dvi__tents_pitch(p.tents, &vertex, &dt), DVI_OK);
      fill_at_random(p.size, 1, 5, p.E);
      memcpy(E, p.E, (size_t)p.size * sizeof *E);
      start_tents(&p);
      for (int step = 0; step < 20; step++) leap(&p, dt, E, B, work);
      advance_tents(&p, 20 * dt);
      sample_tents(&p);
      ck_assert_double_le(largest_error(p.size, p.E, E), 1e-12);
      ck_assert_double_le(largest_error(p.above, p.B, B), 1e-12);
      free(E);
      free(B);
      free(work);
      strike_tents(&p);
    }
}
END_TEST

/* ---- exact solutions ---- */

/* On free boundaries, whose duals are cut off, too. The rows of an affine function are exact, and
 * roundings add up over the some hundred tents of a vertex. Those of E are divided by the
 * smallest mass. */
START_TEST(a_function_that_grows_evenly_is_exact)
{
  for (int i = 0; i < TENT_PLACES; i++)
    for (int random = 0; random < 2; random++) {
      pitched p = tents_over(mesh_at(tent_places + i), 0, NULL, NULL,
                             (dvi__tents_options){.least = random ? 0.1 : 1, .seed = 9});
      for (int64_t v = 0; v < p.size; v++) {
        p.A[v] = 1;
        p.E[v] = -2;
      }
      start_tents(&p);
      advance_tents(&p, 1);
      sample_tents(&p);
      for (int64_t v = 0; v < p.size; v++) {
        ck_assert_double_eq_tol(p.A[v], 3, tent_places[i].n == 1 ? 7e-15 : 1.5e-14);
        ck_assert_double_eq_tol(p.E[v], -2, 3e-13);
      }
      strike_tents(&p);
    }
}
END_TEST

/* E = dx + 0.3 dy - 0.7 dz on meshes that repeat themselves. No charge moves. */
START_TEST(a_constant_field_stays_constant)
{
  static const int torus[] = {1, 6};
  for (int i = 0; i < 2; i++) {
    pitched p = tents_over(mesh_at(tent_places + torus[i]), 1, NULL, NULL,
                           (dvi__tents_options){.least = 0.1, .seed = 2});
    double *E = calloc((size_t)p.size, sizeof *E);
    const dvi_mesh *mesh = dvi_star_mesh(p.star);
    int width;
    const int *end = dvi_mesh_vertices(mesh, 1, &width);
    for (int64_t e = 0; e < p.size; e++) {
      double d[DVI_MESH_SPACE_MAX] = {0};
      dvi__mesh_difference(mesh, end[2 * e], end[2 * e + 1], d);
      E[e] = p.E[e] = d[0] + 0.3 * d[1] - 0.7 * d[2];
    }
    start_tents(&p);
    advance_tents(&p, 1);
    sample_tents(&p);
    ck_assert_double_le(largest_error(p.size, p.E, E), 1e-14);
    ck_assert_double_le(dvi__tents_charge_error(p.tents), 1e-14);
    ck_assert_int_gt(p.tents->front.tents, 10 * dvi_mesh_count(mesh, 0));
    free(E);
    strike_tents(&p);
  }
}
END_TEST

/* A magnetic flux through a torus has no potential A. It is taken as B at the start. */
START_TEST(a_constant_flux_stays_constant)
{
  for (int k = 0; k < 2; k++) {
    pitched p = tents_over(equilateral_torus(6, 6), k, NULL, NULL, (dvi__tents_options){0});
    double *B = calloc((size_t)p.above, sizeof *B);
    const dvi_mesh *mesh = dvi_star_mesh(p.star);
    const int8_t *orientation = dvi_mesh_orientation(mesh);
    int width;
    const int *end = dvi_mesh_vertices(mesh, 1, &width);
    for (int64_t i = 0; i < p.above; i++) {
      double d[DVI_MESH_SPACE_MAX];
      if (k == 0) dvi__mesh_difference(mesh, end[2 * i], end[2 * i + 1], d);
      B[i] = k == 0 ? d[0] : 0.7 * orientation[i];
    }
    dvi__tents_start(p.tents, &(dvi_march_state){.B = B});
    advance_tents(&p, 1);
    sample_tents(&p);
    ck_assert_double_le(largest_error(p.above, p.B, B), 1e-14);
    for (int64_t i = 0; i < p.size; i++) ck_assert_double_eq_tol(p.E[i], 0, 1e-13);
    free(B);
    strike_tents(&p);
  }
}
END_TEST

/* ---- walls ---- */

/* cos(pi x) cos(pi t) with free ends and sin(pi x) sin(pi t) with held ones, at x = i/N on an
 * interval. Leapfrog with dt = h/2 has the frequency w of sin(w dt/2) = sin(pi h/2)/2. */
START_TEST(ends_are_free_or_held)
{
  enum { N = 16 };
  const double h = 1.0 / N, w = 4 / h * asin(sin(pi * h / 2) / 2), t = 40 * h / 2;
  for (int is_held = 0; is_held < 2; is_held++) {
    int8_t held[N + 1] = {0};
    held[0] = held[N] = (int8_t)is_held;
    pitched p = tents_over(mesh_at(&(tent_place){"interval", 1, N, 0}), 0, NULL, held,
                           (dvi__tents_options){0});
    double shape[N + 1];
    for (int i = 0; i <= N; i++)
      shape[i] = p.A[i] = is_held ? (i % N ? sin(pi * i * h) : 0) : cos(pi * i * h);
    start_tents(&p);
    advance_tents(&p, t);
    sample_tents(&p);
    for (int i = 0; i <= N; i++) ck_assert_double_eq_tol(p.A[i], shape[i] * cos(w * t), 1e-13);
    strike_tents(&p);
  }
}
END_TEST

static void hold_boundary(const dvi_mesh *mesh, int k, int8_t *held)
{
  int64_t count;
  const int *cell = dvi_mesh_part_cells(mesh, "boundary", k, &count);
  for (int64_t i = 0; i < count; i++) held[cell[i]] = 1;
}

/* The lowest modes of light in a square cavity, E = (0, sin(pi x)) cos(pi t), at t = 1. The second
 * order leaves an error below that of the mesh's frequency, (3.1320 - pi) t = 0.01. */
START_TEST(a_cavity_of_conductors_has_its_modes)
{
  dvi_mesh *mesh = staggered_mesh(8, 8);
  int8_t *held = calloc((size_t)dvi_mesh_count(mesh, 1), 1);
  hold_boundary(mesh, 1, held);
  pitched p = tents_over(mesh, 1, NULL, held, (dvi__tents_options){0});
  double *E = calloc((size_t)p.size, sizeof *E), error = 0, square = 0;
  const dvi_mesh *shared = dvi_star_mesh(p.star);
  int width;
  const int *end = dvi_mesh_vertices(shared, 1, &width);
  const double *x = dvi_mesh_points(shared);
  for (int64_t e = 0; e < p.size; e++) {
    const double *a = x + (ptrdiff_t)end[2 * e] * 2, *b = x + (ptrdiff_t)end[2 * e + 1] * 2,
                 slope = fabs(b[0] - a[0]) > 1e-12
                             ? (cos(pi * a[0]) - cos(pi * b[0])) / (pi * (b[0] - a[0]))
                             : sin(pi * a[0]);
    E[e] = p.E[e] = held[e] ? 0 : slope * (b[1] - a[1]);
  }
  start_tents(&p);
  advance_tents(&p, 1);
  sample_tents(&p);
  for (int64_t e = 0; e < p.size; e++) {
    error += p.star->diagonal[1][e] * pow(p.E[e] + E[e], 2);
    square += p.star->diagonal[1][e] * E[e] * E[e];
    if (held[e]) ck_assert_double_eq(p.E[e], 0);
  }
  ck_assert_double_le(sqrt(error / square), 0.01);
  ck_assert_double_le(dvi__tents_charge_error(p.tents), 1e-13);
  free(E);
  free(held);
  strike_tents(&p);
}
END_TEST

/* ---- refusals ---- */

static void check_refusal(dvi_mesh *mesh, dvi_star_kind kind, int k, dvi__tents_options options,
                          dvi_status status, const char *words)
{
  dvi_star *star = NULL;
  dvi__tents *tents = NULL;
  const dvi_star_options of_star = {.size = sizeof of_star, .kind = kind};
  ck_assert_msg(dvi_star_create(mesh, &of_star, &star) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi__tents_create(&(dvi__tents_terms){.star = star, .k = k}, &options, &tents),
                   status);
  ck_assert_ptr_null(tents);
  check_words(words);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}

START_TEST(what_has_no_tents_is_refused)
{
  static const double metric[] = {1, -1};
  const dvi__tents_options plain = {0};
  check_refusal(staggered_mesh(3, 3), DVI_WHITNEY, 1, plain, DVI_UNSUPPORTED, "not circumcentric");
  check_refusal(mesh_at(&(tent_place){"box", 2, 3, 3}), DVI_CIRCUMCENTRIC, 1, plain,
                DVI_UNSUPPORTED, "boxes");
  check_refusal(random_simplex(2, 2, metric, 1), DVI_CIRCUMCENTRIC, 0, plain, DVI_UNSUPPORTED,
                "axis 1 of the mesh is timelike");
  check_refusal(staggered_mesh(3, 3), DVI_CIRCUMCENTRIC, 2, plain, DVI_BAD_ARGUMENT, "degree 2");
  check_refusal(staggered_mesh(3, 3), DVI_CIRCUMCENTRIC, 1, (dvi__tents_options){.fraction = 1},
                DVI_BAD_ARGUMENT, "the fraction is 1");
  check_refusal(staggered_mesh(3, 3), DVI_CIRCUMCENTRIC, 1, (dvi__tents_options){.least = -0.1},
                DVI_BAD_ARGUMENT, "least rise is -0.1");
  check_refusal(jittered_mesh(2, 2, 3, 0, 1), DVI_CIRCUMCENTRIC, 1, plain, DVI_SINGULAR,
                "M_1 has the entry 0 at edge");
}
END_TEST

/* The state stays what it was, to the last bit. */
START_TEST(a_failed_advance_changes_nothing)
{
  pitched p = tents_over(ring_mesh(16, 0.2, 2), 0, NULL, NULL,
                         (dvi__tents_options){.fraction = 0.95, .least = 0.2, .seed = 3});
  fill_at_random(p.size, 1e300, 1, p.A);
  start_tents(&p);
  double t = 0;
  dvi_status status = DVI_OK;
  for (; status == DVI_OK && t < 1000; t += status == DVI_OK) {
    sample_tents(&p);
    status = dvi__tents_advance(p.tents, t + 1);
  }
  ck_assert_int_eq(status, DVI_NOT_FINITE);
  check_words("is not finite at t =");
  ck_assert_double_eq(p.tents->t, t);
  double *A = calloc((size_t)p.size, sizeof *A);
  memcpy(A, p.A, (size_t)p.size * sizeof *A);
  sample_tents(&p);
  ck_assert_mem_eq(A, p.A, (size_t)p.size * sizeof *A);
  free(A);
  strike_tents(&p);
}
END_TEST

/* Pitched by hand, tents can be too high. With neighbours at t = 0 at the distance h, a vertex at t
 * may rise to t' only if its row has a negative weight, -(h^2 - t t')/(h (t' - t)). At t' = h an
 * edge is null. */
START_TEST(tents_that_are_too_high_are_refused)
{
  const double h = 0.125;
  pitched p = tents_over(ring_mesh(8, 0, 1), 0, NULL, NULL, (dvi__tents_options){0});
  dvi__front *front = &p.tents->front;
  ck_assert_int_eq(dvi__tent_pitch(p.tents, front, 3, h), DVI_SINGULAR);
  check_words("tents: over edge");
  check_words("between t = 0 and 0.125, a face of spacetime has no volume");
  ck_assert_int_eq(dvi__tent_pitch(p.tents, front, 3, 0.8 * h), DVI_OK);
  for (int i = 0; i < 2; i++) {
    ck_assert_int_eq(dvi__tent_pitch(p.tents, front, 3, (1.25 + 0.25 * i) * h), DVI_SINGULAR);
    check_words("tents: over vertex 3, between t = 0.1 and 0.1");
    check_words("which should be below 0: take a mesh with acute angles, or a smaller fraction");
  }
  ck_assert_int_eq(dvi__tent_pitch(p.tents, front, 3, 1.2 * h), DVI_OK);
  ck_assert_double_eq(front->time[3], 1.2 * h);
  strike_tents(&p);
}
END_TEST

/* At t = 1e16 the next number is 2 later. */
START_TEST(tents_that_cannot_rise_are_refused)
{
  pitched p = tents_over(ring_mesh(8, 0, 1), 0, NULL, NULL, (dvi__tents_options){0});
  dvi__tents_start(p.tents, &(dvi_march_state){.t = 1e16});
  ck_assert_int_eq(dvi__tents_advance(p.tents, 1e16 + 4), DVI_SINGULAR);
  check_words("vertex 0");
  check_words("cannot rise at t = 10000000000000000");
  strike_tents(&p);
}
END_TEST

/* Every allocation of a creation may fail. None is made later. */
START_TEST(memory_is_asked_for_at_creation_only)
{
  dvi_mesh *mesh = staggered_mesh(3, 3);
  dvi_star *star = NULL;
  dvi__tents *tents = NULL;
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  dvi_status status = DVI_NO_MEMORY;
  int failures = 0;
  for (; status == DVI_NO_MEMORY; failures += status == DVI_NO_MEMORY) {
    dvi__fail_allocations_after(failures);
    status = dvi__tents_create(&(dvi__tents_terms){.star = star, .k = 1}, NULL, &tents);
    dvi__fail_allocations_after(-1);
  }
  ck_assert_int_eq(status, DVI_OK);
  ck_assert_int_gt(failures, 20);
  const long before = dvi__allocation_count();
  double energy;
  ck_assert_int_eq(dvi__tents_advance(tents, 1), DVI_OK);
  ck_assert_int_eq(dvi__tents_energy(tents, &energy), DVI_OK);
  ck_assert_int_eq(dvi__allocation_count(), before);
  dvi__tents_destroy(&tents);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(tents)
{
  tcase_add_test(tests, tents_of_equal_edges_are_leapfrog);
  tcase_add_test(tests, tents_of_equal_cells_are_leapfrog);
  tcase_add_test(tests, a_function_that_grows_evenly_is_exact);
  tcase_add_test(tests, a_constant_field_stays_constant);
  tcase_add_test(tests, a_constant_flux_stays_constant);
  tcase_add_test(tests, ends_are_free_or_held);
  tcase_add_test(tests, a_cavity_of_conductors_has_its_modes);
  tcase_add_test(tests, what_has_no_tents_is_refused);
  tcase_add_test(tests, a_failed_advance_changes_nothing);
  tcase_add_test(tests, tents_that_are_too_high_are_refused);
  tcase_add_test(tests, tents_that_cannot_rise_are_refused);
  tcase_add_test(tests, memory_is_asked_for_at_creation_only);
}
