/* dvi explain, which shows the choices of a method for a problem before any step is taken. */
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/events.h"
#include "load/density.h"
#include "load/elastic.h"
#include "load/open.h"
#include "load/open_march.h"
#include "cli/options.h"
#include "load/scene.h"
#include "module/ranks.h"
#include "shares/share.h"
#include "shares/stand_in.h"

enum { NAMES_SHOWN = 12, RANKS_MOST = 10000 };

static const double pi = 3.14159265358979323846;

/* Print the value of a parameter, which is its setting or the default. */
static void explain_parameter(const problem_parameter *parameter, const words *settings)
{
  const size_t length = strlen(parameter->name);
  for (int i = 0; i < settings->count; i++)
    if (strncmp(settings->word[i], parameter->name, length) == 0 &&
        settings->word[i][length] == '=') {
      (void)printf("  parameter    %s   %s\n", settings->word[i], parameter->help);
      return;
    }
  char spelling[32];
  problem_spell(parameter, parameter->value, spelling, sizeof spelling);
  (void)printf("  parameter    %s=%s   %s (default)\n", parameter->name, spelling, parameter->help);
}

/* A step that is searched for, and tents, are not asked for by --h. */
static void explain_run(const problem *scene, const char *method)
{
  (void)printf("\n  first run    ");
  if (scene->h > 0 && (!dvi_scene_marches(scene->scene, method) || march_has_step(method)))
    (void)printf("--h %g ", scene->h);
  (void)printf("--t-end %g\n", scene->t_end);
}

static void explain_parameters(const problem *scene, const words *settings)
{
  (void)printf("problem %s: %s\n", scene->name, scene->summary);
  for (const problem_parameter *k = scene->parameter; k->name != NULL; k++)
    explain_parameter(k, settings);
}

static void explain_problem(const problem *scene, const char *method, const words *settings)
{
  explain_parameters(scene, settings);
  if (scene->velocity != NULL)
    (void)printf("  coordinates  %d, velocities %d:", scene->nq, scene->nv);
  else
    (void)printf("  coordinates  %d:", scene->nq);
  for (int i = 0; i < scene->nq && i < NAMES_SHOWN; i++) (void)printf(" %s", scene->coordinate[i]);
  (void)printf("%s", scene->nq > NAMES_SHOWN ? " ..." : "");
  for (int i = 0; i < scene->terms->force_count; i++)
    (void)printf("%s%s", i == 0 ? "\n  forces       " : ", ", scene->terms->forces[i].name);
  if (scene->terms->damping > 0)
    (void)printf("\n  damping      -gamma p with gamma = %g", scene->terms->damping);
  if (scene->terms->vector_potential != NULL)
    (void)printf("\n  terms        a constant mass with a vector potential A(t,q).q'");
  for (int i = 0; i < scene->terms->contact_count; i++)
    (void)printf("%s%s", i == 0 ? "\n  contacts     " : ", ", scene->terms->contacts[i].name);
  if (scene->terms->noise != NULL)
    (void)printf("\n  noise        kT = %g, friction %g", scene->terms->noise->temperature,
                 scene->terms->noise->friction);
  (void)printf("\n  watched      ");
  for (int i = 0; i < dvi_system_invariant_count(scene->system); i++)
    (void)printf("%s%s", i > 0 ? ", " : "", dvi_system_invariant_name(scene->system, i));
  if (events_count(scene) > 0) (void)printf("\n  events       ");
  events_print(scene);
  explain_run(scene, method);
  (void)printf(
      "  judged by    %s\n",
      scene->terms->noise != NULL ? "no other path; averages over long runs can be compared"
      : scene->exact != NULL      ? "its exact solution"
      : scene->digits_q != NULL   ? "its stored quadruple-precision result, or IDA or two runs"
                                  : "IDA or two runs");
}

static int explain_method(const dvi_integrator *integrator)
{
  const size_t size = dvi_integrator_explain(integrator, NULL, 0) + 1;
  char *text = malloc(size);
  if (text == NULL) {
    complain("out of memory");
    return FAILED;
  }
  (void)dvi_integrator_explain(integrator, text, size);
  (void)fputs(text, stdout);
  free(text);
  return DONE;
}

/* Print the effect of a step of length h on a fast frequency. */
static void explain_turn(const char *method, double h, double omega)
{
  double turn, rate;
  (void)printf("fast motion: omega = %g, h omega = %g; ", omega, h * omega);
  if (dvi_exchange(method, h * omega, &turn, &rate) == DVI_OK)
    (void)printf("a step turns it by %.4f (exactly by %.4f), modulo 2 pi; energy goes from mode to "
                 "mode at %.4f of the exact rate\n",
                 turn, fmod(h * omega, 2 * pi), rate);
  else
    (void)printf("%s\n", dvi_last_error());
}

static void explain_fast_motion(const problem *scene, const char *method, double h)
{
  double least, most;
  if (dvi_fast_frequencies(scene->system, &least, &most) != DVI_OK) {
    (void)printf("fast motion: %s\n", dvi_last_error());
    return;
  }
  explain_turn(method, h, most);
  if (least < (1 - 1e-6) * most) explain_turn(method, h, least);
}

/* Say which steps a march of a field takes. */
static void tell_steps_of(const dvi_march *march, const char *method)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  (void)printf("march: %s with ", method);
  if (facts.longest > facts.step)
    (void)printf("steps from %g to %g, each below its own bound\n", facts.step, facts.longest);
  else if (isinf(facts.bound))
    (void)printf("steps of %g, which have no bound\n", facts.step);
  else if (facts.step <= facts.bound)
    (void)printf("steps of %g, below the bound %g\n", facts.step, facts.bound);
  else
    (void)printf("steps of %g, beyond the bound %.3g of the start's density: noise may grow\n",
                 facts.step, facts.bound);
}

static int open_steps(const problem *scene, const char *method, double h, dvi_march **march)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .step = isnan(h) ? 0 : h};
  const int code = open_march(scene, &options, march);
  if (code == DONE) tell_steps_of(*march, method);
  return code;
}

static int tell_steps(const problem *scene, const char *method, double h)
{
  dvi_march *march = NULL;
  const int code = open_steps(scene, method, h, &march);
  dvi_march_destroy(&march);
  return code;
}

static int explain_march(const problem *scene, const char *method, double h)
{
  const int code = tell_steps(scene, method, h);
  if (code != DONE) return code;
  scene_tell(scene);
  if (elastic_of(scene) != NULL && strncmp(method, "avi", 3) == 0 && isnan(h))
    elastic_tell_cost(scene, method, dvi_scene_plan_of(scene->scene)->fraction);
  return DONE;
}

static int explain_all(const problem *scene, const char *method, const pacing *how, double h)
{
  dvi_integrator *integrator = NULL;
  if (dvi_scene_marches(scene->scene, method))
    return how->transform == NULL && how->control == NULL
               ? explain_march(scene, method, h)
               : usage_error("explain: %s is a march of a field, whose steps follow no monitor",
                             method);
  int code = open_paced(scene, method, how, &integrator);
  if (code != DONE) return code;
  const dvi_status status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  code = status == DVI_OK ? explain_method(integrator) : library_error(status);
  if (code == DONE && !isnan(h)) explain_fast_motion(scene, method, fabs(h));
  /* A scene derives expressions on demand, and one step demands all that the method needs. It does
   * not matter whether the step succeeds. */
  if (code == DONE && scene->scene != NULL) (void)dvi_integrator_step(integrator, scene->h);
  if (code == DONE) scene_tell(scene);
  dvi_integrator_destroy(&integrator);
  return code;
}

/* Without a method there is the field alone. */
static int explain_density(problem *scene)
{
  scene_tell(scene);
  complain(
      "explain: with --method, or a section method in the scene, its steps are explained, too");
  problem_destroy(&scene);
  return DONE;
}

/* The options. */
typedef struct explain_request {
  const char *method; /* NULL for the scene's */
  words settings;
  pacing how;
  double h;        /* NaN if not given */
  long ranks;      /* processes to be foreseen, 0 if not given */
  const char *csv; /* NULL if not given */
} explain_request;

static int check_shares(const explain_request *r, const problem *scene)
{
  if (r->how.transform != NULL || r->how.control != NULL)
    return usage_error("explain: processes share marches of fields, whose steps follow no monitor");
  return share_check("explain", scene, r->method, r->ranks > 0 ? (int)r->ranks : ranks_count());
}

/* One process has no implicit march, but a system. */
static int open_shares(const explain_request *r, const problem *scene, const char *method,
                       dvi_march **march)
{
  if (r->ranks == 0 || !share_is_implicit(method)) return open_steps(scene, method, r->h, march);
  (void)printf("march: %s, whose steps have no bound\n", method);
  return DONE;
}

/* Processes that are foreseen have what shares have, and no more. */
static int open_for_shares(const explain_request *r, const char *name, problem **scene)
{
  const dvi_scene_division division = {
      .size = sizeof division, .divide = stand_in_keep, .read = ranks_read, .grid = ranks_grid()};
  if (r->ranks == 0 || !scene_is_path(name)) return open_any(name, &r->settings, scene);
  return scene_open_share(name, &r->settings, &division, scene);
}

/* Say how several processes share the mesh of a field, or would share it. */
static int explain_shares(const explain_request *r, const char *name)
{
  problem *scene;
  dvi_march *march = NULL;
  int code = open_for_shares(r, name, &scene);
  if (code != DONE) return code;
  const char *method = r->method != NULL ? r->method : scene->method;
  const share_request request = {.path = name,
                                 .settings = &r->settings,
                                 .method = method,
                                 .h = r->h,
                                 .csv = ranks_is_first() ? r->csv : NULL};
  code = check_shares(r, scene);
  if (code == DONE) {
    explain_parameters(scene, &r->settings);
    code = open_shares(r, scene, method, &march);
  }
  if (code == DONE)
    code = r->ranks > 0 ? share_foresee(&request, scene, march, (int)r->ranks)
                        : share_tell(&request, scene, march);
  dvi_march_destroy(&march);
  problem_destroy(&scene);
  return code;
}

static const char *const details[] = {
    "Examples:\n"
    "  dvi explain kepler --method galerkin:degree=4\n"
    "  dvi explain fpu --method midpoint --set ell=1000\n"
    "  dvi explain fpu --method imex --h 0.1\n"
    "  dvi explain kepler --method galerkin:degree=4 --time-transform distance:power=1.5\n"
    "  dvi explain cart.yaml\n",
    "With --h: by which angle a step turns the largest frequency of the potentials that are "
    "declared fast and quadratic\n"
    "(and the least one, if there are several), and how fast slow forces carry energy from one "
    "mode to another of the same\n"
    "frequency. An angle over the step is the frequency that the method gives to the mode.\n",
    "Processes that mpirun or srun started share the mesh of a wave, of Maxwell's field or of a "
    "solid, or a grid for yee. Said is which\n"
    "cells each of them owns, what an exchange makes it receive, and what was counted in the first "
    "steps: mpirun -np 4 dvi explain\n"
    "drum.yaml --method leapfrog. Without mpirun, --ranks 4 foresees it: one process cuts the mesh "
    "for all, a little differently.\n"
    "Columns of --csv: rank,partitioner,cells,ghosts,neighbours,messages,bytes; cells are those of "
    "the highest degree, and ghosts\n"
    "those of other processes beside them. Of a grid both are values of E and B.\n",
    NULL,
};

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(explain_request, method),
     .value = "SPEC",
     .help = "the method: name[:key=value,...], see dvi list methods; default: the scene's"},
    {.name = "time-transform",
     OPTION_AT(explain_request, how.transform),
     .value = "MONITOR",
     .help = "steps of equal length in another time: distance[:power=P], arclength or "
             "acceleration[:power=P]"},
    {.name = "step-control",
     OPTION_AT(explain_request, how.control),
     .value = "MONITOR",
     .help = "steps that follow a monitor reversibly: cheaper, symmetric, not symplectic"},
    {.name = "h",
     OPTION_AT(explain_request, h),
     .value = "H",
     .help = "say what steps of this length do to fast frequencies, too"},
    {.name = "set",
     OPTION_AT(explain_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the problem; may be repeated"},
    {.name = "ranks",
     OPTION_AT(explain_request, ranks),
     .value = "N",
     .help = "of a march of a field: foresee how N processes would share its mesh or grid"},
    {.name = "csv",
     OPTION_AT(explain_request, csv),
     .value = "-|FILE",
     .help = "of processes that share a mesh: a row for each as CSV; -: behind the words",
     .is_csv = true},
    {.name = NULL},
};

static const command_line command = {
    .name = "explain",
    .synopsis = "PROBLEM|SCENE.yaml --method SPEC [OPTIONS]",
    .operand = "PROBLEM",
    .summary = "Say which terms a problem has, and which kernel, solver and sparsity a method "
               "chooses for it, and why.\n",
    .options = command_options,
    .details = details,
};

static int explain_alone(int argc, char **argv)
{
  explain_request r = {.h = (double)NAN};
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  code = pacing_check("explain", &r.how);
  if (code != DONE) return code;
  if (ranks_count() > 1 && r.ranks > 0)
    return usage_error("explain: --ranks foresees processes, and %d are there; leave mpirun out",
                       ranks_count());
  if (r.ranks > RANKS_MOST)
    return usage_error("explain: --ranks %ld is too many, %d are possible", r.ranks,
                       (int)RANKS_MOST);
  if (r.ranks > 0) code = ranks_begin_alone();
  if (code != DONE) return code;
  if (ranks_count() > 1 || r.ranks > 0) return explain_shares(&r, name);
  if (r.csv != NULL)
    return usage_error("explain: --csv is for the shares of several processes: give --ranks, or "
                       "start them by mpirun");
  problem *scene;
  code = open_problem(name, &r.settings, &scene);
  if (code != DONE) return code;
  if (r.method == NULL && scene->method == NULL && density_of(scene) != NULL)
    return explain_density(scene);
  code = open_wish("explain", scene, &r.method);
  if (code == DONE) explain_problem(scene, r.method, &r.settings);
  if (code == DONE) code = explain_all(scene, r.method, &r.how, r.h);
  problem_destroy(&scene);
  return code;
}

int explain_command(int argc, char **argv)
{
  const int code = ranks_begin();
  return ranks_end(code == DONE ? explain_alone(argc, argv) : code);
}
