/* dvi run: one trajectory with its invariants, as CSV. */
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "alarms.h"
#include "columns.h"
#include "command.h"
#include "events.h"
#include "file.h"
#include "open.h"
#include "options.h"
#include "outputs.h"
#include "progress.h"
#include "scene.h"
#include "signals.h"
#include "trace.h"

/* What the command line asks for. */
typedef struct run_request {
  const char *method, *momenta, *columns, *out, *events, *checkpoint, *resume, *plot;
  double h, t_end, tolerance; /* tolerance: NaN, or refused */
  pacing how;
  long every, checkpoint_every; /* 0: not given */
  bool project, final;
  words settings, alarms;
} run_request;

/* A run under way. */
typedef struct recorder {
  const run_request *request;
  const problem *scene;
  whole_file out, events_out;
  run_columns columns;
  event_list events;
  alarm_list alarms;
  run_trace trace;
  progress_line progress;
  double t_start, t;        /* where the run began; where the last observed step ended */
  double shortest, longest; /* steps, of methods that choose them; 0: none yet */
  double energy;            /* of the start, if a column shows it; else NaN */
  long steps_taken, given_steps;
  long step;    /* counted from t = 0, so that a resumed run writes the rows of an uninterrupted one */
  bool chooses; /* the method chooses its steps */
  bool begun, row_written, stop_silently;
  const volatile sig_atomic_t *caught; /* the signal that ends the run after its step; 0: none yet */
} recorder;

/* Before the first step no file is open: a signal ends the process at once. */
static const char ended_before[] = "dvi: run: a signal ended the run before its first step; nothing was written\n";
static const char ended_again[] = "dvi: run: a second Ctrl-C ended the run at once; FILEs not yet complete stay as they were\n";

static bool has_constraint(const problem *scene)
{
  return scene->terms->one_form != NULL || scene->terms->constraint != NULL;
}

/* main complains about standard output. */
static bool written(const whole_file *file)
{
  if (!ferror(file->stream)) return true;
  if (file->path != NULL) complain("cannot write '%s': %s", file->path, strerror(errno));
  return false;
}

static bool write_row(recorder *r, dvi_integrator *integrator)
{
  columns_row(&r->columns, integrator, r->out.stream);
  r->row_written = true;
  return written(&r->out);
}

/* An event was found. */
static int write_event(int index, double t, const double *q, const double *v, void *user)
{
  recorder *r = user;
  if (r->events_out.stream == NULL) return 0;
  events_row(r->scene, index, t, q, v, r->events_out.stream);
  r->stop_silently = !written(&r->events_out);
  return r->stop_silently ? -1 : 0;
}

static bool row_is_due(const recorder *r)
{
  return !r->request->final && (!r->begun || r->step % r->request->every == 0);
}

/* The lengths that the method chose: not that of the step that ends the run on time. */
static void note_step(recorder *r, const dvi_integrator *integrator)
{
  const double length = fabs(dvi_integrator_last_step(integrator));
  dvi_energy_balance energy = {0};
  (void)dvi_integrator_energy_balance(integrator, &energy);
  if (energy.given_steps > r->given_steps) {
    r->given_steps = energy.given_steps;
    return;
  }
  r->shortest = r->steps_taken == 0 ? length : fmin(r->shortest, length);
  r->longest = fmax(r->longest, length);
  r->steps_taken++;
}

/* The driver calls this at the start, after each step, and once more at the end. */
static int observe(dvi_integrator *integrator, void *user)
{
  recorder *r = user;
  const double t = dvi_integrator_time(integrator);
  if (r->begun && t == r->t) return 0;
  r->t = t;
  r->step += r->begun;
  if (r->chooses && r->begun) note_step(r, integrator);
  r->row_written = false;
  const bool row = row_is_due(r);
  r->begun = true;
  bool good = true;
  if (row || r->trace.t != NULL) good = columns_measure(&r->columns, integrator);
  if (good && row) good = write_row(r, integrator);
  if (good) good = alarms_look(&r->alarms, integrator);
  if (good && r->trace.t != NULL) trace_add(&r->trace, t, dvi_integrator_q(integrator), r->columns.invariant[0]);
  if (r->progress.shown) progress_show(&r->progress, (t - r->t_start) / (r->request->t_end - r->t_start), "dvi run");
  r->stop_silently = !good;
  return good ? 0 : -1;
}

/* The last state is always a row, whatever --every says. */
static bool write_last_row(recorder *r, dvi_integrator *integrator)
{
  return r->row_written || (columns_measure(&r->columns, integrator) && write_row(r, integrator));
}

/* The number of the step that ends at t on the grid 0, h, 2h, ...; 0 if t is not on it. In another time there is no such grid, but a count. */
static long step_number(const dvi_integrator *integrator, double t, double h)
{
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  if (dvi_integrator_monitor(integrator) != NULL) return counters.steps;
  const double steps = t / h;
  return steps > 0.0 && steps < 1e15 && fabs(steps - round(steps)) < 1e-6 ? lround(steps) : 0;
}

static void say_interrupted(const recorder *r)
{
  complain("run: signal %d ended the run at t = %.17g of %g; the output is complete up to there", (int)*r->caught, r->t,
           r->request->t_end);
  if (r->request->checkpoint != NULL) complain("run: continue with --resume %s", r->request->checkpoint);
}

/* Of methods that choose their steps: what they chose, and where the energy jumped. */
static void say_steps(const recorder *r, const dvi_integrator *integrator)
{
  dvi_energy_balance energy;
  if (!r->chooses || r->steps_taken == 0) return;
  complain("run: %ld step%s of %.3g to %.3g", r->steps_taken, r->steps_taken == 1 ? "" : "s", r->shortest, r->longest);
  if (dvi_integrator_energy_balance(integrator, &energy) != DVI_OK) return;
  if (energy.fallbacks == 0)
    complain("run: no step was a fallback: the discrete energy is that of the start%s",
             energy.work != 0 ? " and the drive's work" : "");
  else
    complain("run: %ld fallback%s to the least-squares step; the largest energy jump is %.3g, the last %.3g, all together %.3g",
             energy.fallbacks, energy.fallbacks == 1 ? "" : "s", energy.largest_jump, energy.last_jump,
             energy.jumps - energy.given_jumps);
  if (energy.given_steps > 0)
    complain("run: %ld ordinary step%s of given length, to end on time: energy jump %.3g", energy.given_steps,
             energy.given_steps == 1 ? "" : "s", energy.given_jumps);
}

static double energy_now(const recorder *r, dvi_integrator *integrator)
{
  double energy;
  return columns_energy(&r->columns) && dvi_integrator_invariant(integrator, 0, &energy) == DVI_OK ? energy : (double)NAN;
}

/* What no time drives keeps its energy, near enough, unless the step is too large for the method. */
static void say_energy(const recorder *r, dvi_integrator *integrator)
{
  static const double growth = 100;
  const double energy = energy_now(r, integrator), change = fabs(energy - r->energy);
  if (fabs(r->energy) > 0.0 && change > growth * fabs(r->energy) && dvi_system_autonomous(r->scene->system))
    complain("run: the energy went from %.3g to %.3g; is --h %g too large?", r->energy, energy, r->request->h);
}

/* Drive the integrator to the end and write all rows. */
static int advance(recorder *r, dvi_integrator *integrator)
{
  const run_request *request = r->request;
  const dvi_run_options options = {.h = request->h,
                                   .t_end = request->t_end,
                                   .observe = observe,
                                   .user = r,
                                   .events = r->events.event,
                                   .event_count = r->events.count,
                                   .checkpoint = request->checkpoint,
                                   .checkpoint_every = request->checkpoint_every,
                                   .cancel = r->caught};
  r->t_start = dvi_integrator_time(integrator);
  r->step = step_number(integrator, r->t_start, request->h);
  r->energy = energy_now(r, integrator);
  columns_header(&r->columns, r->out.stream);
  if (r->events_out.stream != NULL) events_header(r->scene, r->events_out.stream);
  progress_start(&r->progress, request->final || r->out.path != NULL);
  dvi_run_report report;
  const dvi_status status = dvi_run(integrator, &options, &report);
  progress_end(&r->progress);
  /* Said at once: what is asked below may leave a sentence of its own. */
  const int code = status == DVI_OK ? DONE : r->stop_silently ? FAILED : library_error(status);
  say_steps(r, integrator);
  events_tell(&r->events, "run", &report);
  alarms_tell(&r->alarms);
  if (r->stop_silently) return FAILED;
  const bool complete = (status != DVI_OK && request->final) || write_last_row(r, integrator);
  if (status != DVI_OK) return code;
  say_energy(r, integrator);
  if (*r->caught != 0) say_interrupted(r);
  return !complete ? FAILED : *r->caught != 0 ? 128 + (int)*r->caught : DONE;
}

/* The start's momenta, "P1,P2,...". */
static bool parse_momenta(const char *text, int n, double *p)
{
  for (int i = 0; i < n; i++) {
    char *end;
    p[i] = strtod(text, &end);
    if (end == text || !isfinite(p[i]) || *end != (i < n - 1 ? ',' : '\0')) return false;
    text = end + 1;
  }
  return true;
}

static int place_momenta(const run_request *request, problem *scene)
{
  if (request->project && !has_constraint(scene))
    return usage_error("run: --project is for problems with a constraint, p = alpha(q) or phi(q,p) = 0; %s has none", scene->name);
  if (request->momenta == NULL || parse_momenta(request->momenta, scene->nv, scene->p)) return DONE;
  return usage_error("run: --momenta wants %d finite numbers with commas between them, not '%s'", scene->nv, request->momenta);
}

static int check_events(const run_request *request, const problem *scene)
{
  if (request->events == NULL || events_count(scene) > 0) return DONE;
  return usage_error("run: --events: %s has none; a scene declares them in its section events", scene->name);
}

static bool place(const run_request *request, const problem *scene, dvi_integrator *integrator)
{
  const dvi_start_options options = {.project = request->project};
  const dvi_status status = request->resume != NULL ? dvi_integrator_restore(integrator, request->resume)
                                                    : dvi_integrator_start_with(integrator, 0.0, scene->q, scene->p, &options);
  if (status == DVI_OK) return true;
  (void)library_error(status);
  return false;
}

/* The way to the end; 0 if only roundings of the time lie between. */
static double way_to_end(double t, double t_end)
{
  return fabs(t_end - t) <= 16 * DBL_EPSILON * fmax(fabs(t), fabs(t_end)) ? 0.0 : t_end - t;
}

/* Fill in what was left out, and refuse a step that cannot lead to the end. */
static int complete(run_request *request, const problem *scene, double t)
{
  if (request->every == 0) request->every = scene->every > 0 ? scene->every : 1;
  if (isnan(request->t_end)) request->t_end = scene->t_end;
  const double way = way_to_end(t, request->t_end);
  if (isnan(request->h)) request->h = way < 0.0 ? -scene->h : scene->h;
  if (request->h == 0.0) return usage_error("run: --h 0 leads nowhere");
  if (request->resume != NULL && way * scene->h < 0.0 && request->h > 0.0)
    return usage_error("run: '%s' stands at t = %.17g, past --t-end %g", request->resume, t, request->t_end);
  if (way * request->h < 0.0)
    return usage_error("run: --h %g leads away from --t-end %g; change the sign of one", request->h, request->t_end);
  return DONE;
}

/* Whether what was written is to stay: all but what a failure has cut short. */
static bool to_be_kept(int code)
{
  return code == DONE || code > CHECK_FAILED;
}

static int write_files(recorder *r, dvi_integrator *integrator)
{
  const run_request *request = r->request;
  int code = FAILED;
  if (request->plot != NULL && !trace_init(&r->trace, r->scene->nq)) return FAILED;
  if (file_open(&r->out, request->out) && (request->events == NULL || file_open(&r->events_out, request->events)))
    code = advance(r, integrator);
  if (to_be_kept(code) && !file_keep(&r->out)) code = FAILED;
  if (to_be_kept(code) && request->events != NULL && !file_keep(&r->events_out)) code = FAILED;
  if (to_be_kept(code) && request->plot != NULL && !trace_plot(&r->trace, r->scene->name, r->scene->coordinate, request->plot))
    code = FAILED;
  file_discard(&r->out);
  file_discard(&r->events_out);
  trace_clear(&r->trace);
  return code;
}

static int record(run_request *request, const problem *scene, dvi_integrator *integrator)
{
  recorder r = {.request = request, .scene = scene, .chooses = dvi_integrator_chooses_steps(integrator)};
  int code = columns_choose(&r.columns, scene, integrator, request->columns);
  r.columns.energy = request->plot != NULL;
  if (code == DONE) code = alarms_read(&r.alarms, scene, &request->alarms);
  r.caught = signals_note(ended_again);
  if (code == DONE) code = events_list(&r.events, scene, write_event, &r) ? write_files(&r, integrator) : FAILED;
  events_clear(&r.events);
  columns_clear(&r.columns);
  return code;
}

static int run(run_request *request, const problem *scene)
{
  dvi_integrator *integrator = NULL;
  int code = open_paced(scene, request->method, &request->how, &integrator);
  if (code == DONE && !place(request, scene, integrator)) code = FAILED;
  if (code == DONE) code = complete(request, scene, dvi_integrator_time(integrator));
  if (code == DONE) code = record(request, scene, integrator);
  dvi_integrator_destroy(&integrator);
  return code;
}

static bool is_stream(const char *path)
{
  return path != NULL && strcmp(path, "-") == 0;
}

/* A run may go on in its own checkpoint; no two other files may be the same. */
static int check_files(const run_request *request, const char *name)
{
  const named_file files[] = {{"resume", request->resume},
                              {"out", request->out},
                              {"events", request->events},
                              {"plot", request->plot},
                              {"checkpoint", request->checkpoint}};
  if (is_stream(request->checkpoint))
    return usage_error("run: --checkpoint -: a checkpoint goes to a file, not to standard output");
  if (is_stream(request->events) && is_stream(request->out))
    return usage_error("run: --events -: standard output has the rows; give --out FILE, too");
  int code = outputs_plot("run", request->plot);
  if (code == DONE) code = scene_spared("run", name, 4, files + 1);
  if (code == DONE) code = outputs_distinct("run", 4, files + 1);
  return code == DONE ? outputs_distinct("run", 4, files) : code;
}

static int check_request(const run_request *request, const char *name)
{
  if (request->checkpoint_every > 0 && request->checkpoint == NULL)
    return usage_error("run: --checkpoint-every needs --checkpoint FILE");
  if (request->resume != NULL && (request->momenta != NULL || request->project))
    return usage_error("run: --momenta and --project are for the start, which --resume replaces");
  if (request->every > 0 && request->final)
    return usage_error("run: --every %ld places rows that --final leaves out; give one of them", request->every);
  if (!isnan(request->tolerance))
    return usage_error(
        "run: --tolerance: steps chosen by estimates of their errors make any of these methods neither symplectic nor "
        "symmetric, and its energy drifts; --time-transform or --step-control adapt steps without that");
  if (pacing_check("run", &request->how) != DONE) return USAGE;
  const int code = check_files(request, name);
  if (code != DONE) return code;
  if (request->checkpoint != NULL && !file_writable(request->checkpoint)) return FAILED;
  if (request->events != NULL && !file_writable(request->events)) return FAILED;
  return request->plot == NULL || file_writable(request->plot) ? DONE : FAILED;
}

/* A setting that a resumed run would not heed. */
static int check_settings(const run_request *request, const problem *scene)
{
  const char *setting = start_setting(scene, &request->settings);
  if (setting == NULL || request->resume == NULL) return DONE;
  return usage_error("run: --set %s places the start, which --resume replaces; leave out one of them", setting);
}

/* The line makes sense: everything else. */
static int run_problem(run_request *request, const char *name)
{
  problem *scene;
  signals_end(true, ended_before);
  int code = open_problem(name, &request->settings, &scene);
  if (code != DONE) return code;
  scene_warn("run", scene);
  code = open_wish("run", scene, &request->method);
  if (code == DONE) code = place_momenta(request, scene);
  if (code == DONE) code = check_events(request, scene);
  if (code == DONE) code = check_settings(request, scene);
  if (code == DONE) code = run(request, scene);
  problem_destroy(&scene);
  return code;
}

static const char *const details[] = {
    "Columns: t, the coordinates, their momenta (p_ and the coordinate's name), energy, the other invariants. Problems with\n"
    "rotations and directions have velocities, too, before the momenta, and after all the distance of the coordinates from\n"
    "their manifold. A rotation is R11,R12,R13,R21..R33, its velocity Omega1..Omega3 and its momentum Pi1..Pi3, both in the\n"
    "body's frame; a direction is a unit vector, its velocity (v_) and its momentum (p_) vectors orthogonal to it;\n"
    "methods that choose their steps add h, the length of the step that led to the row, with a one-form there is the\n"
    "constraint |p - alpha(q)|, and dg and dg-phase add jump, the largest one; 17 digits, so that every number is read\n"
    "back as it was. The first row is the start (with --resume: the checkpoint), the last one is the end, wherever\n"
    "--every puts the rows between.\n",
    "What no column shows is not evaluated: --columns x,y wants no energy. Where it is shown, and changes by more than a hundred\n"
    "times what it was at the start without a drive, that is told at the end: the step is too large.\n",
    "Events of a scene are looked for in every step. One with 'stop: yes' ends the run at its time: the last row is the state\n"
    "there, and the exit code 0. The columns of --events are event, its name, t, the coordinates and their velocities (v_), on\n"
    "the step's path; how often each was found is told at the end.\n",
    "An alarm changes nothing in the run: standard error says at the end when the invariant's size first passed the bound,\n"
    "and how large it was at most; the exit code is 0.\n",
    "FILEs are written whole or not at all: a run that fails leaves what was there. Rows on standard output come\n"
    "as they are computed. Ctrl-C, SIGTERM and SIGHUP end a run after the current step, with the output complete, the\n"
    "checkpoint written, and exit code 130, 143 or 129; before the first step they end it at once, and nothing is\n"
    "written. A second Ctrl-C ends it at once.\n",
    "A checkpoint holds the state of the method, not the command line: resume with the same problem, method and\n"
    "step, and the run continues bit for bit. Parameters that only place the start cannot be set then.\n",
    "--time-transform: steps H of a fictitious time tau, dt/dtau = g(q), with g the monitor; the run stays symplectic, takes\n"
    "implicit methods and autonomous problems, and ends at T all the same. Monitors: distance:power=P, 1/g = sum of r^-P over\n"
    "all pairs of bodies (P left out: 1.5); arclength, equal lengths in phase space; acceleration:power=P, g = |a|^-P (0.75).\n"
    "--step-control: a symmetric method takes steps of about H g. Rows are in t. Too large an H shows in the energy.\n",
    "Examples:\n"
    "  dvi run kepler --method galerkin:degree=4 --h 0.1 --t-end 100 --out orbit.csv --plot orbit.svg\n"
    "  dvi run kepler --method verlet --h 0.001 --t-end 10 --set e=0.9 --every 100\n"
    "  dvi run free-body --method lie-verlet --h 0.1 --t-end 100 --momenta 1.5,-1,0.6 --out body.csv\n"
    "  dvi run outer-solar --method galerkin:degree=8 --h 200 --t-end 500000 --final\n"
    "  dvi run kepler --set e=0.99 --method galerkin:degree=4 --time-transform distance --h 0.3 --t-end 63\n"
    "  dvi run kepler --method sem:degree=2 --h 0.05 --t-end 100 --set e=0.5 --out orbit.csv\n"
    "  dvi run fpu --method midpoint --h 0.01 --t-end 100 --checkpoint fpu.state --out part1.csv\n"
    "  dvi run fpu --method midpoint --h 0.01 --t-end 200 --resume fpu.state --out part2.csv\n"
    "  dvi run cart.yaml --final --plot cart.svg\n"
    "  dvi run cart.yaml | dvi plot - --axes x:theta --out path.svg\n",
    NULL,
};

int run_command(int argc, char **argv)
{
  run_request r = {.out = "-", .h = (double)NAN, .t_end = (double)NAN, .tolerance = (double)NAN};
  const option options[] = {
      {.name = "method", .word = &r.method, .value = "SPEC", .help = "the method: name[:key=value,...], see dvi list methods"},
      {.name = "h", .number = &r.h, .value = "H", .help = "the step, for sem the first one; left out: the problem's"},
      {.name = "t-end", .number = &r.t_end, .value = "T", .help = "the end, from t = 0 (T < 0: backward); left out: the problem's"},
      {.name = "time-transform",
       .word = &r.how.transform,
       .value = "MONITOR",
       .help = "steps of equal length in another time: distance[:power=P], arclength or acceleration[:power=P]"},
      {.name = "step-control",
       .word = &r.how.control,
       .value = "MONITOR",
       .help = "steps that follow a monitor reversibly: cheaper, symmetric, not symplectic"},
      {.name = "tolerance", .number = &r.tolerance, .value = "TOL", .help = "refused: see --time-transform and --step-control"},
      {.name = "every", .count = &r.every, .value = "K", .help = "a row after every K steps; left out: 1; not with --final"},
      {.name = "final", .flag = &r.final, .help = "the header and the last row only"},
      {.name = "set", .words = &r.settings, .value = "NAME=VALUE", .help = "set a parameter of the problem; may be repeated"},
      {.name = "momenta",
       .word = &r.momenta,
       .value = "P1,P2,...",
       .help = "the momenta of the start, in the order of their columns; left out: the problem's"},
      {.name = "project", .flag = &r.project, .help = "if the start is off a problem's constraint: project it; left out: refuse"},
      {.name = "columns", .word = &r.columns, .value = "A,B,...", .help = "columns behind t; left out: the scene's, or all"},
      {.name = "alarm", .words = &r.alarms, .value = "NAME=BOUND", .help = "say when an invariant passes this; once for each"},
      {.name = "out", .word = &r.out, .value = "FILE", .help = "where the rows go; left out, or -: standard output"},
      {.name = "events", .word = &r.events, .value = "FILE.csv", .help = "list the scene's events there; left out: count them"},
      {.name = "checkpoint",
       .word = &r.checkpoint,
       .value = "FILE",
       .help = "save the state there when the run ends, however it ends"},
      {.name = "checkpoint-every", .count = &r.checkpoint_every, .value = "K", .help = "and after every K steps"},
      {.name = "resume",
       .word = &r.resume,
       .value = "FILE",
       .help = "start from a checkpoint of the same problem and method; may be the file of --checkpoint"},
      {.name = "plot", .word = &r.plot, .value = "FILE.svg", .help = "draw coordinates and energy error over time"},
      {.name = NULL},
  };
  const command_line command = {
      .name = "run",
      .synopsis = "PROBLEM|SCENE.yaml --method SPEC [--h H] [--t-end T] [OPTIONS]",
      .operand = "PROBLEM",
      .summary = "Compute a trajectory with fixed steps, with those that sem chooses, or with steps that follow the motion; write "
                 "it and its\n"
                 "invariants as CSV. A scene may say which method it wants, after how many steps a row, which columns, and which\n"
                 "events end the run.\n",
      .options = options,
      .details = details,
  };
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &name, &code)) return code;
  code = check_request(&r, name);
  return code == DONE ? run_problem(&r, name) : code;
}
