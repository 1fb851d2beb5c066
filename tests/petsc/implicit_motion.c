/* Motions by implicit steps are those of the system's method, at every step. */
#include <dvi/integrator.h>
#include <dvi/march.h>
#include <dvi/petsc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "expect.h"
#include "implicit.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

#include <petscsys.h>

enum { STEPS = 10 };

/* Several times what leapfrog takes. */
static const double h = 0.125;

/* ---- starts ---- */

/* Heights at the start. */
static double height(const double *x)
{
  return 0.3 * cos(3.14159265 * x[0]) * cos(3.14159265 * x[1]);
}

/* Fill in the start of all unknowns. The others have what is fixed. */
static void fill(const dvi_mesh *mesh, const dvi_field *field, double *q)
{
  int64_t n;
  const double *point = dvi_mesh_points(mesh);
  const int *cell = dvi_field_unknowns(field, &n);
  for (int64_t i = 0; i < n; i++) q[i] = height(point + cell[i] * dvi_mesh_space(mesh));
}

/* Start a march of a share. */
static dvi_status begin(const dvi_mesh *share, const dvi_field *field, const char *method,
                        double step, dvi_march **march)
{
  int64_t n;
  const dvi_march_options options = {.size = sizeof options, .method = method, .step = step};
  double *u = calloc((size_t)dvi_mesh_count(share, 0), sizeof *u);
  const int *cell = dvi_field_unknowns(field, &n);
  double *q = calloc((size_t)n + 1, sizeof *q);
  fill(share, field, q);
  for (int64_t i = 0; i < n; i++) u[cell[i]] = q[i];
  dvi_status status = dvi_march_create(field, &options, march);
  const dvi_march_state state = {.size = sizeof state, .A = u};
  if (status == DVI_OK) status = dvi_march_start(*march, &state);
  free(q);
  free(u);
  return status;
}

/* ---- the whole mesh ---- */

/* The motion of the whole mesh by the integrator's method, whose factors are KLU's. */
typedef struct whole_motion {
  dvi_field *field;
  dvi_system *system;
  dvi_integrator *integrator;
} whole_motion;

static dvi_status begin_whole(const dvi_mesh *mesh, const problem *p, const char *method,
                              whole_motion *w)
{
  int64_t n;
  w->field = make_field(mesh, p);
  (void)dvi_field_unknowns(w->field, &n);
  double *q = calloc((size_t)(2 * n), sizeof *q);
  fill(mesh, w->field, q);
  dvi_status status = dvi_field_system(w->field, &w->system);
  if (status == DVI_OK) status = dvi_integrator_create(w->system, method, &w->integrator);
  if (status == DVI_OK) status = dvi_integrator_start_velocity(w->integrator, 0, q, q + n);
  free(q);
  return status;
}

/* Take a step, and give values of all vertices and the energy. */
static dvi_status step_whole(whole_motion *w, double *u, double *energy)
{
  double invariant[8] = {0}; /* the energy is the first one */
  dvi_status status = dvi_integrator_step(w->integrator, h);
  if (status == DVI_OK)
    status = dvi_system_invariants(w->system, dvi_integrator_time(w->integrator),
                                   dvi_integrator_q(w->integrator), dvi_integrator_p(w->integrator),
                                   invariant);
  *energy = invariant[0];
  return status == DVI_OK ? dvi_field_lift(w->field, dvi_integrator_q(w->integrator), u) : status;
}

static void end_whole(whole_motion *w)
{
  dvi_integrator_destroy(&w->integrator);
  dvi_system_destroy(&w->system);
  dvi_field_destroy(&w->field);
}

/* ---- motions ---- */

/* The largest differences of a march from the whole mesh, and what its energy does. */
typedef struct differences {
  double value, energy, drift;
} differences;

/* Step both STEPS times, and compare them at each step. */
static dvi_status compare(const dvi_mesh *share, dvi_march *march, whole_motion *w, double *u,
                          differences *d)
{
  double *whole = u + dvi_mesh_count(share, 0), first, here, there;
  dvi_status status = dvi_march_observe(march, 0, &first);
  for (int i = 1; i <= STEPS && status == DVI_OK; i++) {
    status = step_whole(w, whole, &there);
    if (status == DVI_OK) status = dvi_march_advance(march, i * h);
    if (status == DVI_OK) status = dvi_march_observe(march, 0, &here);
    if (status == DVI_OK) status = dvi_march_sample(march, DVI_FORM_A, 0, NULL, u);
    if (status != DVI_OK) return status;
    d->value = fmax(d->value, distance(share, u, whole));
    d->energy = fmax(d->energy, fabs(here - there));
    d->drift = fmax(d->drift, fabs(here - first));
  }
  return status;
}

/* A march that loads the state between two steps goes on with the same bits, and so does one of
 * which nothing was asked there. */
static void check_saved(const dvi_mesh *share, const dvi_field *field, const char *method)
{
  static unsigned char bytes[1 << 20];
  size_t size = 0;
  double energy[3] = {0, 1, 2};
  dvi_march *march[3] = {NULL, NULL, NULL};
  dvi_status status = DVI_OK;
  for (int k = 0; k < 3 && status == DVI_OK; k++)
    status = begin(share, field, method, h, march + k);
  if (status == DVI_OK) status = dvi_march_advance(march[0], 2.5 * h);
  if (status == DVI_OK) status = dvi_march_save_memory(march[0], bytes, sizeof bytes, &size);
  if (status == DVI_OK) status = dvi_march_load_memory(march[1], bytes, size);
  for (int k = 0; k < 3 && status == DVI_OK; k++) status = dvi_march_advance(march[k], 5 * h);
  for (int k = 0; k < 3 && status == DVI_OK; k++)
    status = dvi_march_observe(march[k], 0, energy + k);
  expect(status == DVI_OK, "a saved state", method);
  expect(energy[0] == energy[1], "a saved state goes on otherwise", method);
  expect(energy[0] == energy[2], "a question changes what follows", method);
  for (int k = 0; k < 3; k++) dvi_march_destroy(march + k);
}

/* A motion, with the bounds of its differences, and of what the method leaves of the energy. */
typedef struct motion {
  const char *method;
  problem problem;
  double value, drift;
  int is_long;
} motion;

static void check_motion(const dvi_mesh *mesh, const motion *m, const char *partitioner)
{
  const dvi_division_options options = {.size = sizeof options, .partitioner = partitioner};
  const size_t vertices = (size_t)dvi_mesh_count(mesh, 0);
  double *u = calloc(2 * vertices, sizeof *u), last = 0;
  uint64_t bits;
  dvi_mesh *share;
  dvi_division *division;
  dvi_march *march = NULL;
  whole_motion whole = {NULL, NULL, NULL};
  differences d = {0, 0, 0};
  expect(dvi_mesh_divide(mesh, &options, &share, &division) == DVI_OK, "no division", m->method);
  dvi_field *field = make_field(share, &m->problem);
  expect(begin_whole(mesh, &m->problem, m->method, &whole) == DVI_OK, "no system", m->method);
  expect(begin(share, field, m->method, h, &march) == DVI_OK, "no march", m->method);
  expect(compare(share, march, &whole, u, &d) == DVI_OK, "no step", m->method);
  expect(dvi_march_observe(march, 0, &last) == DVI_OK, "no energy", m->method);
  expect_below(d.value, m->value, "the difference", m->method);
  expect_below(d.energy, 1e-12, "the energies' difference", m->method);
  expect_below(d.drift, m->drift, "the energy's drift", m->method);
  tell(m->method, hash_values(share, u), 0);
  memcpy(&bits, &last, sizeof bits);
  tell("energy", bits, 0);
  check_saved(share, field, m->method);
  if (getenv("DVI_TELL") != NULL && rank == 0)
    (void)fprintf(stderr, "%s: difference %.2g, energies %.2g, drift %.2g\n", m->method, d.value,
                  d.energy, d.drift);
  dvi_march_destroy(&march);
  end_whole(&whole);
  dvi_field_destroy(&field);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  free(u);
}

void check_motions(const dvi_mesh *mesh, const char *partitioner, int is_long)
{
  static const motion motions[] = {
      {"midpoint", {.is_fixed = 1}, 2e-13, 1e-13, 0},
      {"midpoint", {.has_potential = 1}, 2e-13, 1e-2, 0},
      {"imex", {.is_fixed = 1}, 2e-13, 1e-13, 1},
      {"imex", {.is_fixed = 1, .has_potential = 1}, 2e-13, 0.2, 0},
      {"galerkin:degree=1", {.has_potential = 1}, 2e-13, 1e-2, 1},
      {"galerkin:degree=2", {.is_fixed = 1}, 2e-13, 1e-13, 1},
      {"galerkin:degree=2", {.has_potential = 1}, 2e-13, 1e-3, 0},
  };
  for (size_t i = 0; i < sizeof motions / sizeof *motions; i++)
    if (is_long || !motions[i].is_long) check_motion(mesh, motions + i, partitioner);
}

/* ---- failures ---- */

/* What is shown of a march that fails. */
typedef struct failing {
  const char *method;
  dvi_march *march;
  double before;
} failing;

/* The next step fails with a status and these words, and leaves time and energy. */
static void expect_failure(const failing *f, enum mood how, dvi_status wanted, const char *words)
{
  double after = 0;
  mood = how;
  const dvi_status status = dvi_march_advance(f->march, 9 * h);
  mood = GOOD;
  expect(status == wanted, "another status", f->method);
  expect(strstr(dvi_last_error(), words) != NULL, "another sentence", f->method);
  expect(dvi_march_time(f->march) == 3 * h, "a time that moved", f->method);
  expect(dvi_march_observe(f->march, 0, &after) == DVI_OK && f->before == after, "another state",
         f->method);
}

/* A step that fails tells why on all processes alike, leaves the state, and can be repeated. */
static void check_failure(const dvi_mesh *share, const char *method)
{
  failing f = {.method = method};
  double last[2] = {0, 1};
  char words[160];
  dvi_field *field = make_field(share, &(problem){.has_potential = 1});
  for (int k = 0; k < 2; k++) {
    expect(begin(share, field, method, h, &f.march) == DVI_OK, "no march", method);
    expect(dvi_march_advance(f.march, 3 * h) == DVI_OK, "no step", method);
    expect(dvi_march_observe(f.march, 0, &f.before) == DVI_OK, "no energy", method);
    (void)snprintf(words, sizeof words,
                   "march: %.*s: step 4 from t = 0.375 with h = 0.125 failed; the state is "
                   "unchanged, try a smaller step",
                   (int)strcspn(method, ":"), method);
    if (k == 0) expect_failure(&f, FAILING, DVI_CALLBACK_FAILED, words);
    if (k == 0 && strcmp(method, "imex") != 0) {
      expect_failure(&f, PUSHING, DVI_STEP_TOO_LARGE,
                     "may have several solutions; h is to be below");
      expect_failure(&f, JUMPING, DVI_NOT_CONVERGED, "left a residual of");
    }
    expect(dvi_march_advance(f.march, 9 * h) == DVI_OK, "it does not go on", method);
    expect(dvi_march_observe(f.march, 0, last + k) == DVI_OK, "no energy", method);
    dvi_march_destroy(&f.march);
  }
  expect(last[0] == last[1], "a failure changes what follows", method);
  dvi_field_destroy(&field);
}

void check_failures(void)
{
  dvi_mesh *mesh = staggered_mesh(8, 8), *share;
  dvi_division *division;
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", "failures");
  check_failure(share, "midpoint");
  check_failure(share, "imex");
  check_failure(share, "galerkin:degree=2");
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&mesh);
  dvi_division_destroy(&division);
}

/* ---- costs ---- */

/* Steps allocate nothing in the library, and evaluate the potential's slope that often. */
static void check_cost(const dvi_mesh *share, const char *method, int evaluations)
{
  dvi_march *march = NULL;
  dvi_field *field = make_field(share, &(problem){.has_potential = 1});
  expect(begin(share, field, method, h, &march) == DVI_OK, "no march", method);
  expect(dvi_march_advance(march, h) == DVI_OK, "no step", method);
  const long allocations = dvi__allocation_count();
  slopes = 0;
  expect(dvi_march_advance(march, 5 * h) == DVI_OK, "no step", method);
  expect(dvi__allocation_count() == allocations, "a step allocates", method);
  expect(slopes == 4 * evaluations, "other evaluations", method);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}

/* Newton's method takes three corrections here, and evaluates two stages before and after each. */
void check_costs(void)
{
  dvi_mesh *mesh = staggered_mesh(8, 8), *share;
  dvi_division *division;
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", "costs");
  check_cost(share, "imex", 1);
  check_cost(share, "galerkin:degree=2", 2 * 4);
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&mesh);
  dvi_division_destroy(&division);
}

/* ---- orders ---- */

/* Move to t = 0.25, and give the value of each vertex. */
static void move_by(const dvi_mesh *share, const dvi_field *field, const char *method, double step,
                    double *u)
{
  dvi_march *march = NULL;
  expect(begin(share, field, method, step, &march) == DVI_OK, "no march", method);
  expect(dvi_march_advance(march, 0.25) == DVI_OK, "no step", method);
  expect(dvi_march_sample(march, DVI_FORM_A, 0, NULL, u) == DVI_OK, "no values", method);
  dvi_march_destroy(&march);
}

/* Errors shrink by a factor where the step is halved. */
static void check_order(const dvi_mesh *share, const char *method, double factor)
{
  const int64_t vertices = dvi_mesh_count(share, 0);
  double *u = calloc((size_t)(3 * vertices), sizeof *u), change[2] = {0, 0};
  dvi_field *field = make_field(share, &(problem){.has_potential = 1});
  for (int k = 0; k < 3; k++) move_by(share, field, method, 1.0 / (128 << k), u + k * vertices);
  for (int64_t v = 0; v < vertices; v++)
    for (int k = 0; k < 2; k++)
      change[k] = fmax(change[k], fabs(u[(k + 1) * vertices + v] - u[k * vertices + v]));
  (void)MPI_Allreduce(MPI_IN_PLACE, change, 2, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  expect_below(change[0] / change[1] / factor - 1, 0.08, "the order", method);
  dvi_field_destroy(&field);
  free(u);
}

void check_orders(void)
{
  dvi_mesh *mesh = staggered_mesh(8, 8), *share;
  dvi_division *division;
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", "orders");
  check_order(share, "midpoint", 4);
  check_order(share, "imex", 4);
  check_order(share, "galerkin:degree=2", 16);
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&mesh);
  dvi_division_destroy(&division);
}
