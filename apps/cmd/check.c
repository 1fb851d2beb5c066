/* dvi check, which compares the derivatives with the values, and tries the method on the
 * problem. */
#include <dvi/scene.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "load/density.h"
#include "load/open.h"
#include "load/open_march.h"
#include "load/scene.h"

/* Number of points beside the start, and their distance from it. */
enum { POINTS = 4 };
static const double APART = 0.01;

/* Above this many coordinates the check's n^2 gradients take too long. */
enum { COORDINATES_MAX = 2000 };

/* Steps for which a field is followed, and the error of a law that roundings may leave. */
enum { STEPS = 100 };
static const double roundoff = 1e-11;

/* Return a number from -1 to 1, the same ones in every run. */
static double check_random(uint64_t *state)
{
  *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(*state >> 11) / 4503599627370496.0 - 1.0;
}

/* Move to a point near the start. Velocities, or momenta of a Hamiltonian, are moved, and
 * coordinates if there is no manifold to leave. */
static void check_move(const problem *scene, uint64_t *state, double *q, double *v)
{
  const double *rates = scene->terms->hamiltonian != NULL ? scene->p : scene->v;
  for (int i = 0; i < scene->nq; i++)
    q[i] = scene->q[i] + (scene->velocity == NULL ? APART * check_random(state) : 0.0);
  for (int i = 0; i < scene->nv; i++)
    v[i] = rates[i] + (scene->velocity == NULL ? APART * check_random(state) : 0.0);
}

static bool has_kink(const problem *scene)
{
  char unread[1];
  return dvi_scene_kink(scene->scene, unread, sizeof unread) >= 0;
}

static void print_derivatives(double worst, int at_kink)
{
  if (worst > 0.0)
    (void)printf("derivatives: within %.1e of differences at %d points near the start", worst,
                 (int)POINTS);
  else
    (void)printf("derivatives: as right as differences at %d points near the start can tell",
                 (int)POINTS);
  if (at_kink > 0) (void)printf("; left out: %d at a kink, which differences go across", at_kink);
  (void)putchar('\n');
}

/* Check the derivatives. Returns DONE, or complains about the first one that is wrong. With a kink
 * another point may replace one that fails, because differences across it are not those of a smooth
 * function. A derivative that is wrong fails at the other points, too. */
static int check_derivatives(const problem *scene, double *q, double *v)
{
  uint64_t state = 1;
  double worst = 0.0;
  int at_kink = 0;
  for (int k = 0; k < POINTS;) {
    dvi_derivative_check found;
    check_move(scene, &state, q, v);
    const dvi_status status = dvi_system_check(scene->system, 0.0, q, v, 0.0, &found);
    if (status == DVI_BAD_ARGUMENT && at_kink < POINTS && has_kink(scene)) {
      at_kink++;
      continue;
    }
    if (status == DVI_BAD_ARGUMENT) {
      complain("check: %s", dvi_last_error());
      if (at_kink > 0)
        complain("check: differences across a kink look like this, too; try a start away from it");
      scene_warn("check", scene);
      return CHECK_FAILED;
    }
    if (status != DVI_OK) return library_error(status);
    worst = fmax(worst, fmax(found.gradient_error, found.hessian_error));
    k++;
  }
  print_derivatives(worst, at_kink);
  return DONE;
}

static int check_all_derivatives(const problem *scene)
{
  if (scene->nq > COORDINATES_MAX) {
    (void)printf("derivatives: not compared; that is for %d coordinates at most, and here are %d\n",
                 (int)COORDINATES_MAX, scene->nq);
    return DONE;
  }
  double *q = calloc((size_t)scene->nq + (size_t)scene->nv, sizeof *q);
  if (q == NULL) {
    complain("out of memory");
    return FAILED;
  }
  const int code = check_derivatives(scene, q, q + scene->nq);
  free(q);
  return code;
}

/* Check that the invariants have values at the start. */
static int check_invariants(const problem *scene)
{
  double *value = calloc((size_t)dvi_system_invariant_count(scene->system), sizeof *value);
  if (value == NULL) {
    complain("out of memory");
    return FAILED;
  }
  const dvi_status status = dvi_system_invariants(scene->system, 0.0, scene->q, scene->p, value);
  free(value);
  return status == DVI_OK ? DONE : library_error(status);
}

/* Take one step of the method from the start. */
static int check_one_step(const problem *scene, const char *method)
{
  dvi_integrator *integrator = NULL;
  int code = open_integrator(scene, method, &integrator);
  if (code != DONE) return code;
  dvi_status status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  if (status == DVI_OK) status = dvi_integrator_step(integrator, scene->h);
  code = status == DVI_OK ? DONE : library_error(status);
  if (code == DONE) (void)printf("method: %s takes its first step, h = %g\n", method, scene->h);
  dvi_integrator_destroy(&integrator);
  return code;
}

/* Give an observable of a march, or -1 if it has none of that name. */
static double observe(const dvi_march *march, const char *name)
{
  double value = -1;
  for (int i = 0; dvi_march_observable(march, i) != NULL; i++)
    if (strcmp(dvi_march_observable(march, i), name) == 0)
      (void)dvi_march_observe(march, i, &value);
  return value;
}

/* Print laws, and complain of those that are broken. */
static int tell_laws(const char *method, int count, const dvi_law *law)
{
  int code = DONE;
  if (count == 0) return code;
  (void)printf("laws of %s over %d steps from a start at random:", method, (int)STEPS);
  for (int i = 0; i < count; i++)
    (void)printf("%s %s %.1e%s", i > 0 ? "," : "", law[i].name, law[i].error,
                 law[i].is_exact ? "" : " (bounded)");
  (void)printf("\n");
  for (int i = 0; i < count; i++)
    if (law[i].is_exact && !(law[i].error < roundoff)) {
      complain("check: the law of %s is broken by %.3e", law[i].name, law[i].error);
      code = CHECK_FAILED;
    }
  return code;
}

static dvi_status start_at_random(dvi_march *march, double *E)
{
  uint64_t state = 1;
  const int64_t size = dvi_march_size(march, DVI_FORM_E);
  for (int64_t i = 0; i < size; i++) E[i] = check_random(&state);
  const dvi_march_state start = {.size = sizeof start, .E = E};
  return dvi_march_start(march, &start);
}

/* Measure the charges of a grid, whose other laws are those of leapfrog on its boxes. */
static int check_charges(dvi_march *march, double step)
{
  static const char *const name[] = {"gauss", "divergence"};
  dvi_law law[2];
  double *E = calloc((size_t)dvi_march_size(march, DVI_FORM_E), sizeof *E);
  if (E == NULL) {
    complain("out of memory");
    return FAILED;
  }
  dvi_status status = start_at_random(march, E);
  free(E);
  if (status == DVI_OK) status = dvi_march_advance(march, STEPS * step);
  if (status != DVI_OK) return library_error(status);
  int count = 0;
  for (int i = 0; i < 2; i++) {
    const double error = observe(march, name[i]);
    if (error >= 0) law[count++] = (dvi_law){.name = name[i], .error = error, .is_exact = 1};
  }
  return tell_laws("yee", count, law);
}

/* Measure the laws of a field on a march. */
static int check_laws(const problem *scene, const char *method)
{
  const dvi_scene_plan *plan = dvi_scene_plan_of(scene->scene);
  const dvi_march_options options = {.size = sizeof options,
                                     .method = method,
                                     .step = plan->fraction > 0 ? 0 : plan->h,
                                     .fraction = plan->fraction};
  dvi_law law[DVI_LAWS_MAX];
  int count = 0;
  const dvi_status status = dvi_scene_march_laws(scene->scene, &options, STEPS, law, &count);
  if (status != DVI_OK) return library_error(status);
  return tell_laws(method, count, law);
}

/* Let a march of a field happen for its longest step. */
static int check_march(const problem *scene, const char *method)
{
  const dvi_march_options options = {.size = sizeof options, .method = method};
  dvi_march_facts facts;
  dvi_march *march = NULL;
  int code = open_march(scene, &options, &march);
  if (code != DONE) return code;
  dvi_march_facts_of(march, &facts);
  const dvi_status status = dvi_march_advance(march, facts.longest);
  code = status == DVI_OK ? DONE : library_error(status);
  if (code == DONE)
    (void)printf("method: %s takes its first step, h = %g\n", method, facts.longest);
  const bool is_grid = strcmp(facts.method, "yee") == 0;
  if (code == DONE) code = is_grid ? check_charges(march, facts.step) : check_laws(scene, method);
  dvi_march_destroy(&march);
  return code;
}

/* Check the mechanical system, and take a step of the method. */
static int check_system(problem *scene, const char *method)
{
  int code = scene_complete(scene);
  if (code == DONE) code = check_all_derivatives(scene);
  if (code == DONE) code = check_invariants(scene);
  return code == DONE && method != NULL ? check_one_step(scene, method) : code;
}

/* Warn of declarations without use, which may be names that were changed elsewhere. */
static void warn_unused(const problem *scene)
{
  const char *name;
  for (int i = 0; scene->scene != NULL && (name = dvi_scene_unused(scene->scene, i)) != NULL; i++)
    (void)printf("%s: nothing in the scene mentions it\n", name);
}

static const char *const details[] = {
    "Of a field's march, such as leapfrog or avi, the laws are measured: energy, charge, "
    "divergence, reciprocity, gauge\n"
    "invariance and the multisymplectic form formula. Of multisymplectic steps they are that "
    "formula, Noether's theorem, and of the box scheme energy and momentum in each place, and of "
    "Schroedinger's equation the norm. Of yee "
    "these are charge and divergence: its "
    "other laws are those of\n"
    "leapfrog on the mesh of the boxes. The last three digits of a double are left to "
    "roundings.\n",
    "Exit codes: 0 all is well; 1 a file cannot be read, or the step fails; 2 the scene makes no "
    "sense, and where; 3 a derivative "
    "or a law is wrong, and which.\n",
    "Examples:\n"
    "  dvi check cart.yaml\n"
    "  dvi check cart.yaml --set l=2 --method verlet\n",
    NULL,
};

/* The options. */
typedef struct check_request {
  const char *method; /* NULL for the scene's, or none */
  words settings;
} check_request;

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(check_request, method),
     .value = "SPEC",
     .help = "take a step with this method; default: the scene's, or none"},
    {.name = "set",
     OPTION_AT(check_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the problem; may be repeated"},
    {.name = NULL},
};

static const command_line command = {
    .name = "check",
    .synopsis = "PROBLEM|SCENE.yaml [OPTIONS]",
    .operand = "PROBLEM",
    .summary = "Read a problem, compare all its derivatives with differences of its values, "
               "evaluate what is watched, and take "
               "one step.\n",
    .options = command_options,
    .details = details,
};

int check_command(int argc, char **argv)
{
  check_request r = {.method = NULL};
  const char *name;
  problem *scene;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  code = open_any(name, &r.settings, &scene);
  if (code != DONE) return code;
  if (r.method == NULL) r.method = scene->method;
  const bool is_grid = dvi_scene_grid_only(scene->scene) != NULL;
  if (r.method == NULL && is_grid) r.method = "yee";
  (void)printf("%s: %s\n", scene->name, scene->summary);
  const bool marches = is_grid || dvi_scene_marches(scene->scene, r.method);
  code = marches ? check_march(scene, r.method) : check_system(scene, r.method);
  if (code == DONE && !marches && r.method != NULL) code = density_judge("check", scene, r.method);
  if (code == DONE && !is_grid) scene_tell(scene);
  if (code == DONE && !marches && r.method != NULL)
    density_warn_step("check", scene, r.method, scene->h);
  if (code == DONE) density_warn_growth("check", scene);
  warn_unused(scene);
  problem_destroy(&scene);
  return code;
}
