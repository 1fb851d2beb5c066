/* dvi path: a whole path at once, between ends or closed. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/events.h"
#include "cli/file.h"
#include "load/open.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "csv/points.h"
#include "load/scene.h"
#include "csv/table.h"

enum { VALUES_MOST = 10000, NAME_SIZE = 64, SETTING_SIZE = 128 };

/* What the command line asks for. */
typedef struct path_request {
  const char *method, *ends, *from, *to, *momentum, *symmetry, *guess, *follow, *out;
  long steps; /* 0: not given */
  double t_end, period, energy;
  bool free_period;
  words settings;
} path_request;

/* A family of problems: values of one parameter. */
typedef struct family {
  char name[NAME_SIZE];
  double first, last;
  long parts; /* 0: there is only one problem */
} family;

/* One member of it: the problem, and its path. */
typedef struct member {
  problem *scene;
  dvi_path *path;
  dvi_path_report report;
  bool found; /* a stationary path, and its report; its steps may be too long all the same */
} member;

/* ---- what the path is to be ---- */

static const char *const ends_name[] = {
    [DVI_ENDS_FIXED] = "fixed", [DVI_ENDS_INITIAL] = "initial", [DVI_ENDS_PERIODIC] = "periodic"};

/* The ends by their name; 0: unknown. */
static dvi_ends ends_of(const char *name)
{
  for (int ends = DVI_ENDS_FIXED; ends <= DVI_ENDS_PERIODIC; ends++)
    if (strcmp(name, ends_name[ends]) == 0) return (dvi_ends)ends;
  return (dvi_ends)0;
}

/* Arrays of one path's options. */
typedef struct arrays {
  double *q0, *q1, *p0, *signs, *symmetry;
  int *start, *row;
} arrays;

static bool allocate(arrays *a, size_t n)
{
  *a = (arrays){calloc(n, sizeof(double)), calloc(n, sizeof(double)), calloc(n, sizeof(double)),
                calloc(n, sizeof(double)), calloc(n, sizeof(double)), calloc(n + 1, sizeof(int)),
                calloc(n, sizeof(int))};
  if (a->q0 && a->q1 && a->p0 && a->signs && a->symmetry && a->start && a->row) return true;
  complain("out of memory");
  return false;
}

static void release(arrays *a)
{
  free(a->q0);
  free(a->q1);
  free(a->p0);
  free(a->signs);
  free(a->symmetry);
  free(a->start);
  free(a->row);
}

/* "3,4,-1,-2": coordinate i of the last node is coordinate 3, 4, .. of the first one, or its
 * negative. One entry in each column of the matrix. */
static int read_symmetry(const char *text, const problem *scene, arrays *a)
{
  const int code = list_read("path: --symmetry", text, scene, a->signs);
  if (code != DONE) return code;
  for (int i = 0; i < scene->nq; i++) {
    const double place = fabs(a->signs[i]);
    if (!(place >= 1.0 && place <= scene->nq && place == floor(place)))
      return usage_error("path: --symmetry: %g is no coordinate; there are 1 to %d", a->signs[i],
                         scene->nq);
    const int column = (int)place - 1;
    if (a->symmetry[column] != 0.0)
      return usage_error("path: --symmetry names coordinate %d twice", column + 1);
    a->symmetry[column] = copysign(1.0, a->signs[i]);
    a->row[column] = i;
  }
  for (int i = 0; i <= scene->nq; i++) a->start[i] = i;
  return DONE;
}

/* Given on the command line, else by the guess, else by the problem. */
static int read_end(const char *where, const char *text, const problem *scene,
                    const double *otherwise, double *end)
{
  if (text != NULL) return list_read(where, text, scene, end);
  memcpy(end, otherwise, (size_t)scene->nq * sizeof *end);
  return DONE;
}

static int read_ends(const path_request *request, const problem *scene, const points *guess,
                     dvi_path_options *options, arrays *a)
{
  const bool guessed = request->guess != NULL, fixed = options->ends == DVI_ENDS_FIXED;
  int code = DONE;
  if (options->ends == DVI_ENDS_PERIODIC) {
    if (request->symmetry == NULL) return DONE;
    options->symmetry = a->symmetry;
    options->symmetry_pattern = (dvi_pattern){a->start, a->row};
    return read_symmetry(request->symmetry, scene, a);
  }
  options->q0 = a->q0;
  code = read_end("path: --from", request->from, scene, guessed && fixed ? guess->q : scene->q,
                  a->q0);
  if (fixed) {
    if (request->to == NULL && !guessed)
      return usage_error("path: --ends fixed needs --to, or --guess FILE that leads there");
    options->q1 = a->q1;
    if (code == DONE)
      code = read_end("path: --to", request->to, scene,
                      guessed ? guess->q + (size_t)(guess->count - 1) * (size_t)scene->nq : NULL,
                      a->q1);
  } else {
    options->p0 = a->p0;
    if (code == DONE)
      code = read_end("path: --momentum", request->momentum, scene, scene->p, a->p0);
  }
  return code;
}

static int read_energy(const path_request *request, const problem *scene, dvi_path_options *options)
{
  if (!request->free_period) return DONE;
  options->free_span = 1;
  options->energy = request->energy;
  if (!isnan(request->energy)) return DONE;
  double *invariant = calloc((size_t)dvi_system_invariant_count(scene->system), sizeof *invariant);
  if (invariant == NULL) return complain("out of memory"), FAILED;
  const dvi_status status = dvi_system_invariants(scene->system, 0.0, scene->q, scene->p,
                                                  invariant);
  options->energy = invariant[0];
  free(invariant);
  return status == DVI_OK ? DONE : library_error(status);
}

/* ---- guesses ---- */

/* As many steps forward by the method itself, from the start of the options or the problem. */
static int guess_by_steps(const dvi_path_options *o, const char *method, const problem *scene,
                          points *guess)
{
  dvi_integrator *integrator = NULL;
  int code = open_integrator(scene, method, &integrator);
  if (code != DONE) return code;
  const double *q = o->q0 != NULL ? o->q0 : scene->q, *p = o->p0 != NULL ? o->p0 : scene->p;
  dvi_status status = dvi_integrator_start(integrator, 0.0, q, p);
  bool added = points_add(guess, scene->nq, 0.0, q);
  for (int k = 1; k <= o->steps && status == DVI_OK && added; k++) {
    status = dvi_integrator_step(integrator, o->span / o->steps);
    added = points_add(guess, scene->nq, k, dvi_integrator_q(integrator));
  }
  dvi_integrator_destroy(&integrator);
  if (status != DVI_OK)
    complain("path: the guess by steps forward fails; give another one with --guess, or take more "
             "steps");
  if (status != DVI_OK) return library_error(status);
  return added ? DONE : FAILED;
}

static int make_guess(const path_request *request, const dvi_path_options *o, const problem *scene,
                      const points *given, dvi_path *path)
{
  points steps = {0};
  int code = DONE;
  if (request->guess == NULL && o->ends == DVI_ENDS_FIXED) return DONE; /* the straight line */
  if (request->guess == NULL) code = guess_by_steps(o, request->method, scene, &steps);
  const points *guess = request->guess != NULL ? given : &steps;
  if (code == DONE) {
    const dvi_status status = dvi_path_guess(path, guess->count, scene->nq, guess->t, guess->q);
    code = status == DVI_OK ? DONE : library_error(status);
  }
  points_clear(&steps);
  return code;
}

/* ---- one path ---- */

static int create_with(const path_request *request, const points *guess, member *m, arrays *a)
{
  const problem *scene = m->scene;
  const double span = !isnan(request->period)  ? request->period
                      : !isnan(request->t_end) ? request->t_end
                                               : scene->t_end;
  dvi_path_options options = {.ends = ends_of(request->ends),
                              .steps = (int)request->steps,
                              .span = span,
                              .dimension = scene->nq};
  int code = read_ends(request, scene, guess, &options, a);
  if (code == DONE) code = read_energy(request, scene, &options);
  if (code != DONE) return code;
  const dvi_status status = dvi_path_create(scene->system, request->method, &options, &m->path);
  if (status != DVI_OK)
    return library_error(status) == USAGE || status == DVI_BAD_ARGUMENT || status == DVI_BAD_SIZE
               ? USAGE
               : FAILED;
  return make_guess(request, &options, scene, guess, m->path);
}

/* The problem with its settings, and its path with a guess. */
static int create(const char *name, const path_request *request, const words *settings, member *m)
{
  points guess = {0};
  arrays a = {0};
  path_request own = *request;
  int code = open_problem(name, settings, &m->scene);
  if (code == DONE) code = open_wish("path", m->scene, &own.method);
  if (code == DONE && m->scene->terms->factors != NULL)
    code = usage_error("path: %s has factors, and paths are found between ends in R^n; dvi run "
                       "goes forward from its start",
                       name);
  if (code == DONE && request->guess != NULL) code = points_read(request->guess, m->scene, &guess);
  if (code == DONE)
    code = allocate(&a, (size_t)m->scene->nq) ? create_with(&own, &guess, m, &a) : FAILED;
  release(&a);
  points_clear(&guess);
  return code;
}

static void destroy(member *m)
{
  dvi_path_destroy(&m->path);
  problem_destroy(&m->scene);
}

/* ---- families ---- */

/* "e=0.1:0.9:8" */
static int read_family(const path_request *request, family *f)
{
  const char *text = request->follow;
  char first[NAME_SIZE], last[NAME_SIZE], count[NAME_SIZE], rest[2];
  char *end = NULL;
  if (text == NULL) return DONE;
  if (request->settings.count == WORDS_MAX)
    return usage_error("path: --set is given too often for --continue");
  const int fields = sscanf(text, "%63[^=]=%63[^:]:%63[^:]:%63[0-9]%1s", f->name, first, last,
                            count, rest);
  if (fields == 4) f->parts = strtol(count, &end, 10);
  if (fields != 4 || !parse_number(first, &f->first) || !parse_number(last, &f->last) ||
      f->parts < 1 || f->parts > VALUES_MOST)
    return usage_error("path: --continue wants NAME=FROM:TO:PARTS with 1 to %d parts, not '%s'",
                       (int)VALUES_MOST, text);
  return DONE;
}

static int solve(member *m)
{
  const dvi_status status = dvi_path_solve(m->path, &m->report);
  m->found = status == DVI_OK || status == DVI_STEP_TOO_LARGE;
  return status == DVI_OK ? DONE : library_error(status);
}

/* Member k of the family, guessed along the two before it. */
static int follow(const char *name, const path_request *request, const family *f, long k,
                  const member *last, const member *before, member *next)
{
  char setting[SETTING_SIZE];
  words settings = request->settings;
  if (f->parts > 0) {
    (void)snprintf(setting, sizeof setting, "%s=%.17g", f->name,
                   f->first + (f->last - f->first) * ((double)k / (double)f->parts));
    settings.word[settings.count++] = setting;
  }
  int code = create(name, request, &settings, next);
  if (code == DONE && last->path != NULL) {
    const dvi_status status = dvi_path_guess_along(next->path, last->path, before->path, 1.0);
    code = status == DVI_OK ? DONE : library_error(status);
  }
  if (code == DONE) code = solve(next);
  if (code != DONE && f->parts > 0) complain("path: this was at %s", setting);
  return code;
}

/* The last member of the family. */
static int solve_family(const char *name, const path_request *request, const family *f,
                        member *last)
{
  member before = {0};
  int code = DONE;
  long k = 0;
  do {
    member next = {0};
    code = follow(name, request, f, k, last, &before, &next);
    destroy(&before);
    before = *last;
    *last = next;
  } while (code == DONE && ++k <= f->parts);
  destroy(&before);
  return code;
}

/* ---- output ---- */

static void print_variation(const dvi_path_report *r, FILE *stream)
{
  if (r->zero < 0)
    (void)fprintf(stream, "second variation  not defined for these ends, or not found\n");
  else if (r->negative < 0)
    (void)fprintf(stream,
                  "second variation  not resolved by these steps: %ld zero, but %d of symmetry; "
                  "take more steps\n",
                  r->zero, r->symmetries);
  else
    (void)fprintf(stream, "second variation  %s: %ld negative, %ld zero (%d of symmetry)\n",
                  r->negative > 0 ? "saddle" : "minimum", r->negative, r->zero, r->symmetries);
}

static void print_spread(const dvi_path_report *r, FILE *stream)
{
  const double relative = r->kinetic > 0.0 ? r->energy_spread / r->kinetic : 0.0;
  if (isnan(r->energy_spread))
    (void)fprintf(stream, "energy spread     not defined: the system depends on time\n");
  else
    (void)fprintf(
        stream,
        "energy spread     %.1e, %.1e of the kinetic energy; at most %.1e of it in a step\n",
        r->energy_spread, relative, r->energy_jump);
}

static void print_report(const member *m, const path_request *request, FILE *stream)
{
  const dvi_path_report *r = &m->report;
  dvi_counters counters;
  dvi_path_counters(m->path, &counters);
  (void)fprintf(stream, "%s, ends %s, %d steps of %s\n", m->scene->name, request->ends,
                dvi_path_steps(m->path), dvi_path_method(m->path));
  (void)fprintf(stream, "action            %.15g\n", r->action);
  if (!isnan(r->energy)) (void)fprintf(stream, "energy            %.15g\n", r->energy);
  print_spread(r, stream);
  (void)fprintf(stream, "span              %.15g\n", r->span);
  (void)fprintf(stream, "gradient          %.1e of the largest momentum\n", r->gradient);
  print_variation(r, stream);
  (void)fprintf(stream, "solver            %d iterations, %ld factorizations, %ld symbolic\n",
                r->iterations, counters.factorizations, counters.symbolic);
}

static void write_header(const problem *scene, FILE *stream)
{
  (void)fputs("t", stream);
  for (int i = 0; i < 2 * scene->nq; i++) {
    (void)fputc(',', stream);
    csv_text(stream, i < scene->nq ? scene->coordinate[i] : scene->momentum[i - scene->nq]);
  }
  for (int i = 0; i < dvi_system_invariant_count(scene->system); i++) {
    (void)fputc(',', stream);
    csv_text(stream, dvi_system_invariant_name(scene->system, i));
  }
  (void)fputc('\n', stream);
}

static dvi_status write_rows(const member *m, double *invariant, FILE *stream)
{
  for (int k = 0; k <= dvi_path_steps(m->path); k++) {
    const double t = dvi_path_time(m->path, k), *q = dvi_path_q(m->path, k),
                 *p = dvi_path_p(m->path, k);
    const dvi_status status = dvi_system_invariants(m->scene->system, t, q, p, invariant);
    if (status != DVI_OK) return status;
    (void)fprintf(stream, "%.17g", t);
    for (int i = 0; i < m->scene->nq; i++) (void)fprintf(stream, ",%.17g", q[i]);
    for (int i = 0; i < m->scene->nq; i++) (void)fprintf(stream, ",%.17g", p[i]);
    for (int i = 0; i < dvi_system_invariant_count(m->scene->system); i++)
      (void)fprintf(stream, ",%.17g", invariant[i]);
    (void)fputc('\n', stream);
  }
  return DVI_OK;
}

static int write_path(const member *m, const char *out)
{
  whole_file file = {0};
  double *invariant = calloc((size_t)dvi_system_invariant_count(m->scene->system),
                             sizeof *invariant);
  int code = invariant != NULL && file_open(&file, out) ? DONE : FAILED;
  if (invariant == NULL) complain("out of memory");
  if (code == DONE) {
    write_header(m->scene, file.stream);
    const dvi_status status = write_rows(m, invariant, file.stream);
    if (status != DVI_OK) code = library_error(status);
  }
  if (code == DONE && !file_keep(&file)) code = FAILED;
  file_discard(&file);
  free(invariant);
  return code;
}

/* ---- the command ---- */

/* An option that these ends would not heed. */
static int check_uses(const path_request *r)
{
  const dvi_ends ends = ends_of(r->ends);
  const struct {
    const char *option;
    bool given;
    unsigned used_by; /* bits of dvi_ends */
  } uses[] = {{"to", r->to != NULL, 1U << DVI_ENDS_FIXED},
              {"from", r->from != NULL, 1U << DVI_ENDS_FIXED | 1U << DVI_ENDS_INITIAL},
              {"momentum", r->momentum != NULL, 1U << DVI_ENDS_INITIAL},
              {"t-end", !isnan(r->t_end), 1U << DVI_ENDS_FIXED | 1U << DVI_ENDS_INITIAL},
              {"period", !isnan(r->period), 1U << DVI_ENDS_PERIODIC},
              {"free-period", r->free_period, 1U << DVI_ENDS_PERIODIC},
              {"symmetry", r->symmetry != NULL, 1U << DVI_ENDS_PERIODIC}};
  for (size_t k = 0; k < sizeof uses / sizeof *uses; k++)
    if (uses[k].given && !(uses[k].used_by & 1U << ends))
      return usage_error("path: --%s has no use with --ends %s", uses[k].option, r->ends);
  if (!isnan(r->energy) && !r->free_period)
    return usage_error("path: --energy is for --free-period: a given period has its energy");
  return DONE;
}

static int check_request(const path_request *r, const char *name)
{
  if (r->ends == NULL) return usage_error("path: --ends is missing: fixed, periodic or initial");
  if (ends_of(r->ends) == 0)
    return usage_error("path: --ends %s: there are fixed, periodic and initial", r->ends);
  if (r->steps == 0) return usage_error("path: --steps is missing");
  if (r->steps > 0x7fffffff) return usage_error("path: --steps %ld are too many", r->steps);
  const double span = !isnan(r->period) ? r->period : r->t_end;
  if (span <= 0.0)
    return usage_error("path: --%s %g is not a positive time",
                       !isnan(r->period) ? "period" : "t-end", span);
  const named_file out = {"out", r->out};
  const int code = scene_spared("path", name, 1, &out);
  return code == DONE ? check_uses(r) : code;
}

static const char *const details[] = {
    "Ends: fixed asks Hamilton's principle itself: --from and --to are given, everything between "
    "is unknown. periodic closes\n"
    "the path, so that it comes back to its start in position and momentum. initial joins steps "
    "forward, from --from with\n"
    "--momentum, into one system; it gives what dvi run gives.\n",
    "The guess may be rough: some points, joined by straight lines. Left out: the straight line "
    "between fixed ends; else as\n"
    "many steps forward by the method from the problem's start. Newton's method with line search "
    "(KINSOL) leads from there\n"
    "to a stationary path, which need not be the nearest; dvi says whether the action has a "
    "minimum there or a saddle.\n",
    "Steps that follow a motion keep its energy. A path over which, or in a step of which, it\n"
    "changes by more than a tenth of the kinetic energy is printed, but not called solved: dvi "
    "says\n"
    "where it changes most and how many steps to try, writes no FILE, and the exit code is 1. A\n"
    "system that depends on time keeps no energy, and is not tested.\n",
    "--symmetry 3,4,5,6,1,2 says that coordinate 1 of the last node is coordinate 3 of the first "
    "one, and so on (-3: its\n"
    "negative): three bodies in a plane that take each other's places, after one third of the "
    "period of the whole.\n"
    "--free-period finds the period that belongs to an energy. --continue e=0.1:0.9:8 solves at e "
    "= 0.1, 0.2, .. 0.9, each\n"
    "guessed from the two before; the last one is reported.\n",
    "Columns of FILE: t, the coordinates, their momenta, energy, the other invariants, at the N+1 "
    "nodes; a FILE of dvi run or\n"
    "dvi path may be the guess of another one.\n",
    "Examples:\n"
    "  dvi path pendulum --method midpoint --ends fixed --to 2 --t-end 2 --steps 100 --out "
    "path.csv\n"
    "  dvi path kepler --method galerkin:degree=4 --ends fixed --from 1,0 --to=-0.5,1 --t-end 3 "
    "--steps 30\n"
    "  dvi path figure-eight --method galerkin:degree=8 --ends periodic --steps 24\n"
    "  dvi path figure-eight --method galerkin:degree=8 --ends periodic --symmetry 3,4,5,6,1,2 "
    "--period 2.2 --steps 8 \\\n"
    "    --guess sketch.csv\n",
    NULL,
};

static int run(const char *name, const path_request *request)
{
  family values = {.parts = 0};
  member found = {0};
  int code = check_request(request, name);
  if (code == DONE) code = read_family(request, &values);
  if (code == DONE && request->out != NULL && strcmp(request->out, "-") != 0 &&
      !file_writable(request->out))
    return FAILED;
  if (code == DONE) code = solve_family(name, request, &values, &found);
  const bool rows_on_output = request->out != NULL && strcmp(request->out, "-") == 0;
  if (code == DONE) events_passed("path", found.scene);
  if (found.found) print_report(&found, request, rows_on_output ? stderr : stdout);
  if (code == DONE && request->out != NULL) code = write_path(&found, request->out);
  destroy(&found);
  return code;
}

int path_command(int argc, char **argv)
{
  path_request r = {.t_end = (double)NAN, .period = (double)NAN, .energy = (double)NAN};
  const option options[] = {
      {.name = "method",
       .word = &r.method,
       .value = "SPEC",
       .help = "galerkin, midpoint, trapezoidal, or hp or hamiltonian of types 1 to 3; default: "
               "the scene's"},
      {.name = "ends", .word = &r.ends, .value = "KIND", .help = "fixed, periodic or initial"},
      {.name = "steps", .count = &r.steps, .value = "N", .help = "how many steps the path has"},
      {.name = "t-end",
       .number = &r.t_end,
       .value = "T",
       .help = "the end, from t = 0; default: the problem's"},
      {.name = "period",
       .number = &r.period,
       .value = "T",
       .help = "of periodic ends, or its guess; default: the problem's end"},
      {.name = "from",
       .word = &r.from,
       .value = "Q",
       .help = "the first node, \"1,0.5\"; default: the problem's or the guess's start"},
      {.name = "to",
       .word = &r.to,
       .value = "Q",
       .help = "the last node; default: the guess's end"},
      {.name = "momentum",
       .word = &r.momentum,
       .value = "P",
       .help = "the first momentum; default: the problem's"},
      {.name = "symmetry",
       .word = &r.symmetry,
       .value = "LIST",
       .help = "which coordinate each one ends as; see below"},
      {.name = "free-period",
       .flag = &r.free_period,
       .help = "the period is unknown, the energy is given"},
      {.name = "energy",
       .number = &r.energy,
       .value = "E",
       .help = "that energy; default: that of the problem's start"},
      {.name = "guess",
       .word = &r.guess,
       .value = "FILE",
       .help = "points of a guess: CSV with t and the coordinates"},
      {.name = "continue",
       .word = &r.follow,
       .value = "NAME=FROM:TO:PARTS",
       .help = "follow the path as a parameter changes"},
      {.name = "set",
       .words = &r.settings,
       .value = "NAME=VALUE",
       .help = "set a parameter of the problem; may be repeated"},
      {.name = "out",
       .word = &r.out,
       .value = "FILE",
       .help = "write the nodes there; -: standard output; default: nowhere"},
      {.name = NULL},
  };
  const command_line command = {
      .name = "path",
      .synopsis = "PROBLEM|SCENE.yaml [--method SPEC] --ends KIND --steps N [OPTIONS]",
      .operand = "PROBLEM",
      .summary = "Make the action of a whole path stationary: boundary value problems and periodic "
                 "orbits.\n",
      .options = options,
      .details = details,
  };
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &name, &code)) return code;
  return run(name, &r);
}
