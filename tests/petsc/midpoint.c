/* Steps of the implicit midpoint rule on the shares of MPI's processes: what roundings do in many
 * of them, times between them, and their allocations. It prints hashes, which implicit.sh compares.
 * Usage: mpirun -np N midpoint [all] */
#include <dvi/integrator.h>
#include <dvi/march.h>
#include <dvi/petsc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "expect.h"
#include "support/heap.h"
#include "support/meshes.h"

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

static const char waves[] = "a wave";

/* ---- a wave with fixed values, and perhaps a potential ---- */

static int evaluations; /* of the potential's derivative, of a whole share */

static int quartic(int64_t count, const double *x, const double *u, double *V, double *V_u,
                   double *V_uu, void *user)
{
  (void)x, (void)user;
  evaluations += V_u != NULL;
  for (int64_t i = 0; i < count; i++) {
    const double s = u[i] * u[i];
    if (V != NULL) V[i] = s / 2 + s * s / 4;
    if (V_u != NULL) V_u[i] = u[i] + s * u[i];
    if (V_uu != NULL) V_uu[i] = 1 + 3 * s;
  }
  return 0;
}

static dvi_field *make_field(const dvi_mesh *mesh, int has_potential)
{
  const dvi_condition edge = {.part = "boundary", .kind = DVI_FIXED};
  const dvi_field_potential potential = {.density = quartic};
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  (void)dvi_star_create(mesh, NULL, &star);
  const dvi_wave_terms terms = {.size = sizeof terms,
                                .star = star,
                                .condition = &edge,
                                .conditions = 1,
                                .potential = has_potential ? &potential : NULL};
  (void)dvi_wave_create(&terms, &field);
  dvi_star_destroy(&star);
  return field;
}

static double height(const double *x)
{
  return exp(-20 * ((x[0] - 0.4) * (x[0] - 0.4) + (x[1] - 0.5) * (x[1] - 0.5)));
}

static void fill(const dvi_mesh *mesh, const dvi_field *field, double *q)
{
  int64_t n;
  const double *point = dvi_mesh_points(mesh);
  const int *cell = dvi_field_unknowns(field, &n);
  for (int64_t i = 0; i < n; i++) q[i] = height(point + cell[i] * dvi_mesh_space(mesh));
}

/* A wave on the shares, which has started. */
typedef struct wave {
  dvi_mesh *mesh, *share;
  dvi_division *division;
  dvi_field *field;
  dvi_march *march;
} wave;

static dvi_march *begin(const wave *w, double h)
{
  int64_t n;
  const dvi_march_options options = {.size = sizeof options, .method = "midpoint", .step = h};
  const int *cell = dvi_field_unknowns(w->field, &n);
  double *u = DVI_NEW(double, dvi_mesh_count(w->share, 0)), *q = DVI_NEW(double, n);
  dvi_march *march = NULL;
  fill(w->share, w->field, q);
  for (int64_t i = 0; i < n; i++) u[cell[i]] = q[i];
  const dvi_march_state state = {.size = sizeof state, .A = u};
  expect(dvi_march_create(w->field, &options, &march) == DVI_OK, "no march", waves);
  expect(dvi_march_start(march, &state) == DVI_OK, "no start", waves);
  dvi__release(u);
  dvi__release(q);
  return march;
}

static wave start(int across, int has_potential, double h)
{
  wave w = {.mesh = staggered_mesh(across, across)};
  expect(dvi_mesh_divide(w.mesh, NULL, &w.share, &w.division) == DVI_OK, "no division", waves);
  w.field = make_field(w.share, has_potential);
  w.march = begin(&w, h);
  return w;
}

static void end(wave *w)
{
  dvi_march_destroy(&w->march);
  dvi_field_destroy(&w->field);
  dvi_mesh_destroy(&w->share);
  dvi_division_destroy(&w->division);
  dvi_mesh_destroy(&w->mesh);
}

static double energy_of(const dvi_march *march)
{
  double energy = (double)NAN;
  expect(dvi_march_observe(march, 0, &energy) == DVI_OK, "no energy", waves);
  return energy;
}

static void move(dvi_march *march, double t)
{
  expect(dvi_march_advance(march, t) == DVI_OK, "no step", waves);
}

/* Print what must be the same on any number of processes. */
static void tell(const char *what, double value)
{
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  if (rank == 0) (void)printf("%s %016llx\n", what, (unsigned long long)bits);
}

/* ---- roundings ---- */

/* The energy of a linear wave stays. The square of this h is rounded by almost half a digit, by
 * which each step would change the energy if it were a factor. */
static void check_drift(int steps, double most)
{
  const double h = 0.257;
  wave w = start(9, 0, h);
  const double first = energy_of(w.march);
  move(w.march, steps * h);
  const double drift = (energy_of(w.march) - first) / first;
  expect(fabs(drift) <= most, "energy drifts", waves);
  if (getenv("DVI_TELL") != NULL && rank == 0)
    (void)fprintf(stderr, "drift in %d steps: %.2g\n", steps, drift);
  tell("energy", energy_of(w.march));
  end(&w);
}

/* ---- times between the ends of steps ---- */

/* Move the whole mesh by the integrator's method, with a last step to t that is shorter. */
static void move_whole(const wave *w, int has_potential, double h, double t, double *u)
{
  int64_t n;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_field *field = make_field(w->mesh, has_potential);
  (void)dvi_field_unknowns(field, &n);
  double *q = DVI_NEW(double, 2 * n);
  fill(w->mesh, field, q);
  dvi_status status = dvi_field_system(field, &system);
  if (status == DVI_OK) status = dvi_integrator_create(system, "midpoint", &integrator);
  if (status == DVI_OK) status = dvi_integrator_start_velocity(integrator, 0, q, q + n);
  const int steps = (int)floor(t / h);
  for (int i = 0; i < steps && status == DVI_OK; i++) status = dvi_integrator_step(integrator, h);
  if (status == DVI_OK) status = dvi_integrator_step(integrator, t - steps * h);
  if (status == DVI_OK) status = dvi_field_lift(field, dvi_integrator_q(integrator), u);
  expect(status == DVI_OK, "no motion of the whole mesh", waves);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_field_destroy(&field);
  dvi__release(q);
}

/* What is seen between steps is the end of a shorter one, as the integrator makes it, and the steps
 * go on as if nobody had looked. */
static void check_between(int has_potential)
{
  const double h = 0.125, t = 0.8;
  wave w = start(10, has_potential, h);
  const int64_t whole = dvi_mesh_count(w.mesh, 0), here = dvi_mesh_count(w.share, 0);
  double *u = DVI_NEW(double, here), *there = DVI_NEW(double, whole), apart = 0;
  move_whole(&w, has_potential, h, t, there);
  move(w.march, t);
  expect(dvi_march_time(w.march) == t, "another time", waves);
  expect(dvi_march_sample(w.march, DVI_FORM_A, 0, NULL, u) == DVI_OK, "no values", waves);
  for (int64_t v = 0; v < here; v++)
    apart = fmax(apart, fabs(u[v] - there[dvi_mesh_share_numbers(w.share, 0)[v]]));
  expect(apart < 1e-13, "not the integrator's shorter step", waves);
  tell("between", energy_of(w.march));
  dvi_march *straight = begin(&w, h);
  move(straight, 1.5);
  move(w.march, 1.5);
  expect(energy_of(straight) == energy_of(w.march), "a look that changes the motion", waves);
  tell("after", energy_of(w.march));
  dvi_march_destroy(&straight);
  dvi__release(u);
  dvi__release(there);
  end(&w);
}

/* A state that is saved between steps goes on from there with the same bits, and shows the same. */
static void check_saved(void)
{
  static unsigned char bytes[1 << 18];
  size_t size = 0;
  wave w = start(10, 1, 0.125);
  dvi_march *other = begin(&w, 0.125);
  move(w.march, 0.8);
  expect(dvi_march_save_memory(w.march, bytes, sizeof bytes, &size) == DVI_OK, "no state", waves);
  expect(dvi_march_load_memory(other, bytes, size) == DVI_OK, "a state that is refused", waves);
  expect(energy_of(w.march) == energy_of(other), "another state is shown", waves);
  move(w.march, 1.5);
  move(other, 1.5);
  expect(energy_of(w.march) == energy_of(other), "a saved state goes on otherwise", waves);
  dvi_march_destroy(&other);
  end(&w);
}

/* ---- what a step costs ---- */

/* The library allocates nothing in a step. PETSc has a block for each solution, and one for each
 * correction, which are taken and given back. MPI has more in its sums, where there are others. */
static void check_allocations(int has_potential)
{
  enum { STEPS = 8 };
  const double h = 0.125;
  const int corrections = 2 + has_potential;
  wave w = start(16, has_potential, h);
  move(w.march, 3 * h);
  const long own = dvi__allocation_count(), all = heap_calls();
  evaluations = 0;
  for (int i = 1; i <= STEPS; i++) move(w.march, (3 + i) * h);
  const long calls = heap_calls() - all;
  expect(dvi__allocation_count() == own, "a step allocates", waves);
  expect(ranks > 1 || !heap_is_counted() || calls <= 2L * STEPS * (1 + corrections),
         "PETSc allocates more", waves);
  expect(evaluations == (has_potential ? STEPS * (1 + corrections) : 0),
         "forces are evaluated again", waves);
  if (getenv("DVI_TELL") != NULL)
    (void)fprintf(stderr, "process %d: %.1f calls of the heap and %.1f evaluations a step\n", rank,
                  (double)calls / STEPS, (double)evaluations / STEPS);
  end(&w);
}

int main(int argc, char **argv)
{
  if (PetscInitialize(&argc, &argv, NULL, NULL) != 0) return 1;
  (void)MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  (void)MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  check_drift(300, 4e-15);
  for (int has_potential = 0; has_potential < 2; has_potential++) {
    check_between(has_potential);
    check_allocations(has_potential);
  }
  check_saved();
  if (argc > 1 && strcmp(argv[1], "all") == 0) {
    check_drift(10000, 1.2e-13);
    check_drift(100000, 1.2e-12);
  }
  (void)PetscFinalize();
  return failures > 0;
}
