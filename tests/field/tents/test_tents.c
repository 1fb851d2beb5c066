/* Forms that advance by tents, with the exact solutions of their equations as judges. */
#include <dvi/forms.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/tents/front.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- tents and their forms ---- */

typedef struct pitched {
  dvi_star *star;
  dvi__tents *tents;
  int k;
  int64_t size, above; /* k-cells and (k+1)-cells */
  double *A, *E, *B;   /* of a start, or of a sample */
} pitched;

/* The mesh belongs to the star then. */
static pitched pitch_over(dvi_mesh *mesh, int k, const double *const *factor, const int8_t *held,
                          dvi__tents_options options)
{
  pitched p = {.k = k, .size = dvi_mesh_count(mesh, k), .above = dvi_mesh_count(mesh, k + 1)};
  const dvi_star_options star = {.size = sizeof star, .factor = factor};
  ck_assert_msg(dvi_star_create(mesh, &star, &p.star) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  ck_assert_msg(dvi__tents_create(p.star, k, held, &options, &p.tents) == DVI_OK, "%s",
                dvi_last_error());
  p.A = calloc((size_t)p.size, sizeof *p.A);
  p.E = calloc((size_t)p.size, sizeof *p.E);
  p.B = calloc((size_t)p.above, sizeof *p.B);
  return p;
}

static void strike(pitched *p)
{
  dvi__tents_destroy(&p->tents);
  dvi_star_destroy(&p->star);
  free(p->A);
  free(p->E);
  free(p->B);
}

/* Start from A and E, with B = dA. */
static void start(const pitched *p)
{
  dvi__tents_start(p->tents, &(dvi_march_state){.A = p->A, .E = p->E});
}

static void advance(const pitched *p, double t)
{
  ck_assert_msg(dvi__tents_advance(p->tents, t) == DVI_OK, "%s", dvi_last_error());
}

static void sample(const pitched *p)
{
  ck_assert_int_eq(dvi__tents_sample(p->tents, DVI_FORM_A, p->size, NULL, p->A), DVI_OK);
  ck_assert_int_eq(dvi__tents_sample(p->tents, DVI_FORM_E, p->size, NULL, p->E), DVI_OK);
  ck_assert_int_eq(dvi__tents_sample(p->tents, DVI_FORM_B, p->above, NULL, p->B), DVI_OK);
}

static double energy_of(const pitched *p)
{
  double energy;
  ck_assert_msg(dvi__tents_energy(p->tents, &energy) == DVI_OK, "%s", dvi_last_error());
  return energy;
}

/* A plane wave of a form along x: cos or sin of 2 pi (x - c t), times each component's factor. */
typedef struct wave {
  double phase, factor[4];
  int is_sine, components;
} wave;

static int plane_wave(const double *x, double *value, void *user)
{
  const wave *w = user;
  const double angle = 2 * pi * (x[0] - w->phase), f = w->is_sine ? sin(angle) : cos(angle);
  for (int c = 0; c < w->components; c++) value[c] = w->factor[c] * f;
  return 0;
}

static void integrate(const pitched *p, int k, wave w, double *form)
{
  const dvi_mesh *mesh = dvi_star_mesh(p->star);
  w.components = dvi_form_components(dvi_mesh_space(mesh), k);
  ck_assert_int_eq(dvi_form_integrate(mesh, k, plane_wave, &w, form), DVI_OK);
}

/* u = sin(2 pi (x - c t)), E = -u'. */
static void set_sine(const pitched *p, double c)
{
  integrate(p, 0, (wave){.factor = {1}, .is_sine = 1}, p->A);
  integrate(p, 0, (wave){.factor = {2 * pi * c}}, p->E);
}

static double largest_error(int64_t count, const double *a, const double *b)
{
  double most = 0;
  for (int64_t i = 0; i < count; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

static void fill_at_random(int64_t count, double size, unsigned long long seed, double *form)
{
  for (int64_t i = 0; i < count; i++) form[i] = size * (2 * random_number(&seed) - 1);
}

/* ---- leapfrog ---- */

/* Default tents on a circle of equal edges rise by half an edge from left to right. Their right
 * triangles have the weights of leapfrog, and both schemes add the same terms. */
START_TEST(tents_of_equal_edges_are_leapfrog)
{
  enum { N = 16, STEPS = 40 };
  const double h = 1.0 / N, dt = h / 2;
  pitched p = pitch_over(ring_mesh(N, 0, 1), 0, NULL, NULL, (dvi__tents_options){0});
  double u[N], v[N];
  fill_at_random(N, 1, 3, p.A);
  fill_at_random(N, 1, 4, p.E);
  memcpy(u, p.A, sizeof u);
  for (int i = 0; i < N; i++) v[i] = -p.E[i];
  start(&p);
  for (int step = 0; step < STEPS; step++) {
    double pull[N];
    for (int kick = 0; kick < 2; kick++) {
      for (int i = 0; i < N; i++)
        pull[i] = ((u[(i + 1) % N] - u[i]) - (u[i] - u[(i + N - 1) % N])) / (h * h);
      for (int i = 0; i < N; i++) v[i] += dt / 2 * pull[i];
      for (int i = 0; i < N && kick == 0; i++) u[i] += dt * v[i];
    }
    advance(&p, (step + 1) * dt);
    sample(&p);
    for (int i = 0; i < N; i++) {
      ck_assert_double_eq_tol(p.A[i], u[i], 1e-15 * (step + 4));
      ck_assert_double_eq_tol(-p.E[i], v[i], 1e-15 * (step + 4) / dt);
    }
  }
  ck_assert_int_eq(p.tents->front.tents, N * STEPS);
  strike(&p);
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
      pitched p = pitch_over(mesh, k, NULL, NULL, (dvi__tents_options){0});
      double *E = calloc((size_t)p.size, sizeof *E), *B = calloc((size_t)p.above, sizeof *B),
             *work = calloc((size_t)(p.size + p.above), sizeof *work), dt;
      int vertex;
      ck_assert_int_eq(dvi__tents_pitch(p.tents, &vertex, &dt), DVI_OK);
      fill_at_random(p.size, 1, 5, p.E);
      memcpy(E, p.E, (size_t)p.size * sizeof *E);
      start(&p);
      for (int step = 0; step < 20; step++) leap(&p, dt, E, B, work);
      advance(&p, 20 * dt);
      sample(&p);
      ck_assert_double_le(largest_error(p.size, p.E, E), 1e-12);
      ck_assert_double_le(largest_error(p.above, p.B, B), 1e-12);
      free(E);
      free(B);
      free(work);
      strike(&p);
    }
}
END_TEST

/* ---- exact solutions ---- */

typedef struct place {
  const char *generator; /* NULL for those of tests */
  int n, across, up;
} place;

static const place places[] = {{NULL, 1, 24, 0},       {NULL, 2, 6, 6},   {"interval", 1, 9, 0},
                               {"staggered", 2, 5, 4}, {"disk", 2, 3, 0}, {"icosphere", 2, 1, 0},
                               {"bcc-torus", 3, 3, 3}};
enum { PLACES = sizeof places / sizeof *places };

static dvi_mesh *mesh_at(const place *at)
{
  if (at->generator == NULL)
    return at->n == 1 ? ring_mesh(at->across, 0.3, 5) : equilateral_torus(at->across, at->up);
  dvi_generator_options options = {.size = sizeof options, .cells = {at->across, at->up}};
  if (at->n == 3) options.cells[2] = at->up;
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_generate(at->generator, &options, &mesh) == DVI_OK, "%s",
                dvi_last_error());
  return mesh;
}

/* On free boundaries, whose duals are cut off, too. The rows of an affine function are exact, and
 * roundings add up over the some hundred tents of a vertex. Those of E are divided by the mass of the
 * smallest cell. */
START_TEST(a_function_that_grows_evenly_is_exact)
{
  for (int i = 0; i < PLACES; i++)
    for (int random = 0; random < 2; random++) {
      pitched p = pitch_over(mesh_at(places + i), 0, NULL, NULL,
                             (dvi__tents_options){.least = random ? 0.1 : 1, .seed = 9});
      for (int64_t v = 0; v < p.size; v++) {
        p.A[v] = 1;
        p.E[v] = -2;
      }
      start(&p);
      advance(&p, 1);
      sample(&p);
      for (int64_t v = 0; v < p.size; v++) {
        ck_assert_double_eq_tol(p.A[v], 3, places[i].n == 1 ? 7e-15 : 1.5e-14);
        ck_assert_double_eq_tol(p.E[v], -2, 3e-13);
      }
      strike(&p);
    }
}
END_TEST

/* E = dx + 0.3 dy - 0.7 dz on meshes that repeat themselves. No charge moves. */
START_TEST(a_constant_field_stays_constant)
{
  static const int torus[] = {1, 6};
  for (int i = 0; i < 2; i++) {
    pitched p = pitch_over(mesh_at(places + torus[i]), 1, NULL, NULL,
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
    start(&p);
    advance(&p, 1);
    sample(&p);
    ck_assert_double_le(largest_error(p.size, p.E, E), 5e-15);
    ck_assert_double_le(dvi__tents_charge_error(p.tents), 1e-14);
    ck_assert_int_gt(p.tents->front.tents, 10 * dvi_mesh_count(mesh, 0));
    free(E);
    strike(&p);
  }
}
END_TEST

/* A magnetic flux through a torus has no potential A. It is taken as B at the start. */
START_TEST(a_constant_flux_stays_constant)
{
  for (int k = 0; k < 2; k++) {
    pitched p = pitch_over(equilateral_torus(6, 6), k, NULL, NULL, (dvi__tents_options){0});
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
    advance(&p, 1);
    sample(&p);
    ck_assert_double_le(largest_error(p.above, p.B, B), 1e-14);
    for (int64_t i = 0; i < p.size; i++) ck_assert_double_eq_tol(p.E[i], 0, 1e-13);
    free(B);
    strike(&p);
  }
}
END_TEST

/* ---- waves ---- */

/* Returns the largest error of a sine that has gone once around a circle of random edges. */
static double error_of_sine(int points, double least)
{
  pitched p = pitch_over(ring_mesh(points, 0.2, 5), 0, NULL, NULL,
                         (dvi__tents_options){.least = least, .seed = 7});
  set_sine(&p, 1);
  double *u = calloc((size_t)points, sizeof *u);
  memcpy(u, p.A, (size_t)points * sizeof *u);
  start(&p);
  advance(&p, 1);
  sample(&p);
  const double error = largest_error(points, p.A, u);
  free(u);
  strike(&p);
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
  pitched p = pitch_over(mesh, 1, NULL, NULL, (dvi__tents_options){.least = least, .seed = 7});
  double *E = calloc((size_t)p.size, sizeof *E), *B = calloc((size_t)p.above, sizeof *B), error = 0,
         square = 0;
  integrate(&p, 1, (wave){.factor = {0, 1}}, E);
  integrate(&p, 2, (wave){.factor = {1}}, B);
  dvi__tents_start(p.tents, &(dvi_march_state){.E = E, .B = B});
  advance(&p, 1);
  sample(&p);
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
  strike(&p);
  return sqrt(error / square);
}

/* The measured errors of random tents are 0.15, 0.040, 0.019. */
START_TEST(light_converges_on_triangles)
{
  static const int cells[] = {4, 8, 12}, rows[] = {4, 10, 14};
  static const double most[] = {0.18, 0.05, 0.025};
  for (int random = 0; random < 2; random++)
    for (int i = 0; i < 3; i++)
      ck_assert_double_le(error_of_light(equilateral_torus(cells[i], rows[i]), random ? 0.5 : 1),
                          most[i]);
}
END_TEST

START_TEST(light_converges_on_tetrahedra)
{
  double error[2];
  for (int i = 0; i < 2; i++) {
    const int n = 3 + 2 * i;
    dvi_mesh *mesh = mesh_at(&(place){"bcc-torus", 3, n, n});
    error[i] = error_of_light(mesh, 1);
  }
  ck_assert_double_le(error[0], 0.4);
  ck_assert_double_ge(log(error[0] / error[1]) / log(5.0 / 3), 1.5);
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
    pitched p = pitch_over(mesh_at(&(place){"interval", 1, N, 0}), 0, NULL, held,
                           (dvi__tents_options){0});
    double shape[N + 1];
    for (int i = 0; i <= N; i++)
      shape[i] = p.A[i] = is_held ? (i % N ? sin(pi * i * h) : 0) : cos(pi * i * h);
    start(&p);
    advance(&p, t);
    sample(&p);
    for (int i = 0; i <= N; i++) ck_assert_double_eq_tol(p.A[i], shape[i] * cos(w * t), 1e-13);
    strike(&p);
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
  pitched p = pitch_over(mesh, 1, NULL, held, (dvi__tents_options){0});
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
  start(&p);
  advance(&p, 1);
  sample(&p);
  for (int64_t e = 0; e < p.size; e++) {
    error += p.star->diagonal[1][e] * pow(p.E[e] + E[e], 2);
    square += p.star->diagonal[1][e] * E[e] * E[e];
    if (held[e]) ck_assert_double_eq(p.E[e], 0);
  }
  ck_assert_double_le(sqrt(error / square), 0.03);
  ck_assert_double_le(dvi__tents_charge_error(p.tents), 1e-13);
  free(E);
  free(held);
  strike(&p);
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
    pitched p = pitch_over(ring_mesh(N, 0.1, 3), 0, factor, NULL, (dvi__tents_options){0});
    set_sine(&p, c);
    memcpy(u, p.A, sizeof u);
    start(&p);
    advance(&p, 1 / c);
    sample(&p);
    ck_assert_double_le(largest_error(N, p.A, u), 0.01);
    strike(&p);
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
  pitched p = pitch_over(mesh_at(&(place){"interval", 1, N, 0}), 0, factor, NULL,
                         (dvi__tents_options){0});
  const double width = 0.04;
  for (int i = 0; i <= N; i++) {
    const double s = ((double)i / N - 0.25) / width;
    p.A[i] = exp(-s * s);
    p.E[i] = -2 * s / width * exp(-s * s);
  }
  start(&p);
  advance(&p, 0.4);
  sample(&p);
  double least = 0, most = 0;
  for (int i = 0; i < N / 2; i++) least = fmin(least, p.A[i]);
  for (int i = N / 2; i <= N; i++) most = fmax(most, p.A[i]);
  ck_assert_double_eq_tol(least, -1.0 / 3, 0.01);
  ck_assert_double_eq_tol(most, 2.0 / 3, 0.01);
  strike(&p);
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
  pitched p = pitch_over(mesh, 1, factor, NULL, (dvi__tents_options){.least = 0.5, .seed = 4});
  fill_at_random(p.size, 1, 6, p.E);
  start(&p);
  const double before = energy_of(&p);
  advance(&p, 2);
  ck_assert_double_le(dvi__tents_charge_error(p.tents), 1e-13);
  ck_assert_double_eq_tol(energy_of(&p) / before, 1, 0.1);
  free(eps);
  free(nu);
  strike(&p);
}
END_TEST

/* ---- stability ---- */

static pitched random_ring(double fraction)
{
  return pitch_over(ring_mesh(32, 0.2, 5), 0, NULL, NULL,
                    (dvi__tents_options){.fraction = fraction, .least = 0.5, .seed = 7});
}

/* Random tents drift like random steps: they are stable for a while only. */
START_TEST(half_of_the_local_step_is_bounded_and_nine_tenths_grow)
{
  pitched half = random_ring(0.5), most = random_ring(0.9);
  double largest = 0;
  set_sine(&half, 1);
  start(&half);
  advance(&half, 20);
  sample(&half);
  for (int64_t i = 0; i < half.size; i++) largest = fmax(largest, fabs(half.A[i]));
  ck_assert_double_le(largest, 1.06);
  fill_at_random(most.size, 1, 8, most.E);
  start(&most);
  const double before = energy_of(&most);
  advance(&most, 60);
  ck_assert_double_ge(energy_of(&most), 100 * before);
  strike(&half);
  strike(&most);
}
END_TEST

/* All frequencies are in a random start. Regular tents of half the local step keep the energy. */
START_TEST(the_energy_of_random_fields_is_bounded)
{
  for (int i = 0; i < PLACES; i++)
    for (int k = 0; k < places[i].n && k < 2; k++) {
      pitched p = pitch_over(mesh_at(places + i), k, NULL, NULL, (dvi__tents_options){0});
      fill_at_random(p.size, 1, 8, p.E);
      start(&p);
      const double before = energy_of(&p);
      for (int t = 1; t <= repeats(10); t++) {
        advance(&p, t);
        ck_assert_double_eq_tol(energy_of(&p) / before, 1, 0.2);
      }
      strike(&p);
    }
}
END_TEST

/* The front is never steeper than the fraction of light's slope, on its edges and in its cells. */
START_TEST(fronts_are_not_steeper_than_light)
{
  for (int i = 0; i < PLACES; i++) {
    pitched p = pitch_over(mesh_at(places + i), 0, NULL, NULL,
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
    strike(&p);
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

/* ---- refusals ---- */

static void check_refusal(dvi_mesh *mesh, dvi_star_kind kind, int k, dvi__tents_options options,
                          dvi_status status, const char *words)
{
  dvi_star *star = NULL;
  dvi__tents *tents = NULL;
  const dvi_star_options of_star = {.size = sizeof of_star, .kind = kind};
  ck_assert_msg(dvi_star_create(mesh, &of_star, &star) == DVI_OK, "%s", dvi_last_error());
  ck_assert_int_eq(dvi__tents_create(star, k, NULL, &options, &tents), status);
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
  check_refusal(mesh_at(&(place){"box", 2, 3, 3}), DVI_CIRCUMCENTRIC, 1, plain, DVI_UNSUPPORTED,
                "boxes");
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
  pitched p = pitch_over(ring_mesh(16, 0.2, 2), 0, NULL, NULL,
                         (dvi__tents_options){.fraction = 0.95, .least = 0.2, .seed = 3});
  fill_at_random(p.size, 1e300, 1, p.A);
  start(&p);
  double t = 0;
  dvi_status status = DVI_OK;
  for (; status == DVI_OK && t < 1000; t += status == DVI_OK) {
    sample(&p);
    status = dvi__tents_advance(p.tents, t + 1);
  }
  ck_assert_int_eq(status, DVI_NOT_FINITE);
  check_words("is not finite at t =");
  ck_assert_double_eq(p.tents->t, t);
  double *A = calloc((size_t)p.size, sizeof *A);
  memcpy(A, p.A, (size_t)p.size * sizeof *A);
  sample(&p);
  ck_assert_mem_eq(A, p.A, (size_t)p.size * sizeof *A);
  free(A);
  strike(&p);
}
END_TEST

/* Pitched by hand, tents can be too high. With neighbours at t = 0 at the distance h, a vertex at t
 * may rise to t' only if its row has a negative weight, -(h^2 - t t')/(h (t' - t)). At t' = h an
 * edge is null. */
START_TEST(tents_that_are_too_high_are_refused)
{
  const double h = 0.125;
  pitched p = pitch_over(ring_mesh(8, 0, 1), 0, NULL, NULL, (dvi__tents_options){0});
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
  strike(&p);
}
END_TEST

/* At t = 1e16 the next number is 2 later. */
START_TEST(tents_that_cannot_rise_are_refused)
{
  pitched p = pitch_over(ring_mesh(8, 0, 1), 0, NULL, NULL, (dvi__tents_options){0});
  dvi__tents_start(p.tents, &(dvi_march_state){.t = 1e16});
  ck_assert_int_eq(dvi__tents_advance(p.tents, 1e16 + 4), DVI_SINGULAR);
  check_words("vertex 0");
  check_words("cannot rise at t = 10000000000000000");
  strike(&p);
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
    status = dvi__tents_create(star, 1, NULL, NULL, &tents);
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
  tcase_add_test(tests, a_travelling_sine_converges);
  tcase_add_test(tests, light_converges_on_triangles);
  tcase_add_test(tests, light_converges_on_tetrahedra);
  tcase_add_test(tests, ends_are_free_or_held);
  tcase_add_test(tests, a_cavity_of_conductors_has_its_modes);
  tcase_add_test(tests, a_medium_has_its_speed_of_light);
  tcase_add_test(tests, a_pulse_is_reflected_at_an_interface);
  tcase_add_test(tests, charges_stay_in_random_media);
  tcase_add_test(tests, half_of_the_local_step_is_bounded_and_nine_tenths_grow);
  tcase_add_test(tests, the_energy_of_random_fields_is_bounded);
  tcase_add_test(tests, fronts_are_not_steeper_than_light);
  tcase_add_test(tests, the_steepest_front_of_a_triangle_is_known);
  tcase_add_test(tests, what_has_no_tents_is_refused);
  tcase_add_test(tests, a_failed_advance_changes_nothing);
  tcase_add_test(tests, tents_that_are_too_high_are_refused);
  tcase_add_test(tests, tents_that_cannot_rise_are_refused);
  tcase_add_test(tests, memory_is_asked_for_at_creation_only);
}
