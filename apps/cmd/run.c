/* dvi run, which computes one trajectory with its invariants, as CSV. */
#include <dvi/number.h>
#include <dvi/scene.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "csv/events.h"
#include "cli/file.h"
#include "load/density.h"
#include "load/open.h"
#include "cli/options.h"
#include "shares/share.h"
#include "module/ranks.h"
#include "cli/outputs.h"
#include "watch/field_run.h"
#include "watch/recorder.h"
#include "watch/run_request.h"
#include "load/scene.h"
#include "cli/signals.h"
#include "study/trust.h"
#include "watch/verify.h"
#include "cli/way.h"

/* Before the first step no file is open, and a signal ends the process at once. */
static const char ended_before[] =
    "dvi: run: a signal ended the run before its first step; nothing was written\n";

static bool has_constraint(const problem *scene)
{
  return scene->terms->one_form != NULL || scene->terms->constraint != NULL ||
         scene->terms->holonomic_count > 0 || scene->terms->nonholonomic_count > 0;
}

/* Read the start's momenta, "P1,P2,...". */
static bool parse_momenta(const char *text, int n, double *p)
{
  for (int i = 0; i < n; i++) {
    const char *end = dvi_number_read(text, &p[i]);
    if (end == text || !isfinite(p[i]) || *end != (i < n - 1 ? ',' : '\0')) return false;
    text = end + 1;
  }
  return true;
}

static int place_momenta(const run_request *request, problem *scene)
{
  if (request->project && !has_constraint(scene))
    return usage_error("run: --project is for problems with a constraint, p = alpha(q), phi(q,p) = "
                       "0, phi(t,q) = 0 or A v + a = 0; %s has none",
                       scene->name);
  if (request->momenta == NULL || parse_momenta(request->momenta, scene->nv, scene->p)) return DONE;
  return usage_error("run: --momenta wants %d finite number%s, not '%s'", scene->nv,
                     scene->nv == 1 ? "" : "s with commas between them", request->momenta);
}

static int check_events(const run_request *request, const problem *scene)
{
  if (request->events == NULL || events_count(scene) > 0 || scene->terms->contact_count > 0)
    return DONE;
  return usage_error("run: --events: %s has none; a scene declares them in its sections events and "
                     "contacts",
                     scene->name);
}

/* Hint at --project after a start was refused, if the projected one is not. */
static void hint_at_projection(const problem *scene, dvi_integrator *integrator)
{
  const dvi_start_options options = {.project = 1};
  if (has_constraint(scene) &&
      dvi_integrator_start_with(integrator, 0.0, scene->q, scene->p, &options) == DVI_OK)
    complain("run: --project moves the start onto the constraints");
}

static bool place_start(const run_request *request, const problem *scene,
                        dvi_integrator *integrator)
{
  const dvi_start_options options = {.project = request->project};
  const dvi_status status = request->resume != NULL
                                ? dvi_integrator_restore(integrator, request->resume)
                                : dvi_integrator_start_with(integrator, 0.0, scene->q, scene->p,
                                                            &options);
  if (status == DVI_OK) return true;
  (void)library_error(status);
  if (request->resume == NULL && !request->project) hint_at_projection(scene, integrator);
  return false;
}

/* Return the time to the end, or 0 if it is only a rounding error. */
static double time_to_end(double t, double t_end)
{
  return fabs(t_end - t) <= 16 * DBL_EPSILON * fmax(fabs(t), fabs(t_end)) ? 0.0 : t_end - t;
}

/* Return whether a checkpoint stands past the end. Only a user who gives a step back wants to go
 * back. */
static bool is_past(const run_request *request, double t, double way)
{
  return request->resume != NULL && way * t < 0.0 && !(request->h * way > 0.0);
}

/* Fill in defaults, and refuse a step that cannot lead to the end. */
static int complete_request(run_request *request, const problem *scene, double t)
{
  if (request->every == 0) request->every = scene->every > 0 ? scene->every : 1;
  if (isnan(request->t_end)) request->t_end = scene->t_end;
  if (isnan(request->h) && !(scene->h > 0)) /* only scenes of fields may lack it */
    return usage_error("run: %s by %s needs a step, by --h or in the scene, as in 'step: "
                       "{fraction: 0.5}' of the largest stable one of verlet",
                       scene->name, request->method);
  const double way = time_to_end(t, request->t_end);
  if (is_past(request, t, way))
    return usage_error("run: '%s' stands at t = %.17g, past --t-end %g; --h %g would lead back",
                       request->resume, t, request->t_end, copysign(scene->h, way));
  if (isnan(request->h)) request->h = way < 0.0 ? -scene->h : scene->h;
  return way_check("run", request->h, way, request->t_end,
                   request->how.transform == NULL && request->how.control == NULL);
}

/* Refuse the names of states in parts, which mechanical systems do not have. */
static int check_states(const run_request *request, const problem *scene)
{
  const char *const path[] = {request->checkpoint, request->resume};
  for (int i = 0; i < 2; i++)
    if (ranks_part_state(path[i]))
      return usage_error("run: '%s' is a state in parts by its name, which marches of fields on "
                         "meshes have, and %s of one process has not; give another name%s",
                         path[i], request->method,
                         share_is_implicit(request->method) && dvi_scene_field(scene->scene) != NULL
                             ? ", or start 2 processes or more by mpirun"
                             : "");
  return DONE;
}

static int run_integrator(run_request *request, const problem *scene)
{
  dvi_integrator *integrator = NULL;
  int code = check_states(request, scene);
  if (code == DONE) code = open_paced(scene, request->method, &request->how, &integrator);
  if (code == DONE && !place_start(request, scene, integrator)) code = FAILED;
  if (code == DONE) code = complete_request(request, scene, dvi_integrator_time(integrator));
  if (code == DONE && request->resume == NULL && request->how.transform == NULL)
    density_warn_step("run", scene, request->method, request->h);
  if (code == DONE) code = (request->verify ? verify : record)(request, scene, integrator);
  dvi_integrator_destroy(&integrator);
  return code;
}

static bool is_stream(const char *path)
{
  return path != NULL && strcmp(path, "-") == 0;
}

/* Check the files. A run may continue in its own checkpoint, but no two other files may be the
 * same. */
static int check_files(const run_request *request, const char *name)
{
  const named_file files[] = {{.option = "resume", .path = request->resume},
                              {.option = "out", .path = request->out},
                              {.option = "events", .path = request->events},
                              {.option = "plot", .path = request->plot},
                              {.option = "map", .path = request->map},
                              {.option = "pvd", .path = request->pvd},
                              {.option = "checkpoint", .path = request->checkpoint}};
  if (is_stream(request->checkpoint))
    return usage_error("run: --checkpoint -: a checkpoint goes to a file, not to standard output");
  if (is_stream(request->events) && is_stream(request->out))
    return usage_error("run: --events -: standard output has the rows; give --out FILE, too");
  int code = outputs_plot("run", "plot", request->plot);
  if (code == DONE) code = outputs_plot("run", "map", request->map);
  if (code == DONE) code = scene_spared("run", name, 6, files + 1);
  if (code == DONE) code = outputs_distinct("run", 6, files + 1);
  return code == DONE ? outputs_distinct("run", 6, files) : code;
}

/* Check --verify. A verification writes one table, and starts from no other state than the
 * start. */
static int check_verify(const run_request *request)
{
  const named_file others[] = {{.option = "out", .path = request->out},
                               {.option = "events", .path = request->events},
                               {.option = "checkpoint", .path = request->checkpoint},
                               {.option = "resume", .path = request->resume},
                               {.option = "pvd", .path = request->pvd},
                               {.option = "map", .path = request->map},
                               {.option = "plot", .path = request->plot}};
  if (!request->verify) {
    if (request->digits > 0)
      return usage_error("run: --digits %ld is for --verify, which finds digits", request->digits);
    return request->csv != NULL
               ? usage_error("run: --csv is for the table of --verify; rows go to --out FILE")
               : DONE;
  }
  for (size_t k = 0; k < sizeof others / sizeof *others; k++)
    if (others[k].path != NULL && !is_stream(others[k].path))
      return usage_error(
          "run: --verify runs the job several times and writes its own table; leave out --%s",
          others[k].option);
  if (request->every > 0 || request->alarms.count > 0)
    return usage_error("run: --verify has one row, the last one, and no alarms; leave out --%s",
                       request->every > 0 ? "every" : "alarm");
  return request->digits <= TRUST_DIGITS_MOST
             ? DONE
             : usage_error("run: --digits %ld: at most %d can be found in double precision",
                           request->digits, (int)TRUST_DIGITS_MOST);
}

static int run_check_request(const run_request *request, const char *name)
{
  if (check_verify(request) != DONE) return USAGE;
  if (request->checkpoint_every > 0 && request->checkpoint == NULL)
    return usage_error("run: --checkpoint-every needs --checkpoint FILE");
  if (request->map_of != NULL && request->map == NULL)
    return usage_error("run: --map-of %s names what --map FILE.svg draws", request->map_of);
  if (request->resume != NULL && request->pvd != NULL && access(request->pvd, F_OK) == 0)
    return usage_error("run: --pvd %s is there, and a resumed run would replace its frames; give "
                       "another name",
                       request->pvd);
  if (request->resume != NULL && (request->momenta != NULL || request->project))
    return usage_error("run: --momenta and --project are for the start, which --resume replaces");
  if (request->every > 0 && request->final)
    return usage_error("run: --every %ld places rows that --final leaves out; give one of them",
                       request->every);
  if (!isnan(request->tolerance))
    return usage_error("run: --tolerance: steps chosen by estimates of their errors make any of "
                       "these methods neither symplectic nor "
                       "symmetric, and its energy drifts; --time-transform or --step-control adapt "
                       "steps without that");
  if (pacing_check("run", &request->how) != DONE) return USAGE;
  const int code = check_files(request, name);
  if (code != DONE) return code;
  if (!ranks_is_first()) return DONE; /* the first process alone writes */
  if (request->checkpoint != NULL && !file_writable(request->checkpoint)) return FAILED;
  if (request->events != NULL && !file_writable(request->events)) return FAILED;
  if (request->map != NULL && !file_writable(request->map)) return FAILED;
  return request->plot == NULL || file_writable(request->plot) ? DONE : FAILED;
}

/* Refuse a setting that a resumed run would ignore. */
static int run_check_settings(const run_request *request, const problem *scene)
{
  const char *setting = start_setting(scene, &request->settings);
  if (setting == NULL || request->resume == NULL) return DONE;
  return usage_error(
      "run: --set %s places the start, which --resume replaces; leave out one of them", setting);
}

/* Only scenes of fields may lack an end. */
static int run_check_end(const run_request *request, const problem *scene)
{
  if (!isnan(request->t_end) || scene->t_end > 0) return DONE;
  return usage_error("run: %s has no section until, so that --t-end is needed", scene->name);
}

static int run_march(run_request *request, const problem *scene)
{
  int code = run_check_settings(request, scene);
  if (code == DONE) code = run_check_end(request, scene);
  if (request->method == NULL) request->method = scene->method;
  if (code == DONE) density_warn_growth("run", scene);
  return code == DONE ? field_run(request, scene) : code;
}

/* Run the problem of a command line that has been checked. */
static int run_problem(run_request *request, const char *name)
{
  problem *scene;
  signals_end(true, ended_before);
  int code = open_any(name, &request->settings, &scene);
  if (code != DONE) return code;
  code = ranks_count() > 1 ? share_check("run", scene, request->method, ranks_count()) : DONE;
  if (code != DONE) {
    problem_destroy(&scene);
    return code;
  }
  if (dvi_scene_marches(scene->scene, request->method)) {
    code = run_march(request, scene);
    problem_destroy(&scene);
    return code;
  }
  if (dvi_scene_grid_only(scene->scene) != NULL) return refuse_grid(&scene, true);
  code = scene_complete(scene);
  if (code != DONE) {
    problem_destroy(&scene);
    return code;
  }
  if (request->threads > 0) {
    problem_destroy(&scene);
    return usage_error("run: --threads is for marches of fields, such as yee and leapfrog");
  }
  scene_warn("run", scene);
  if (request->verify) code = refuse_noise("run: --verify", scene);
  if (code == DONE) code = open_wish("run", scene, &request->method);
  if (code == DONE) code = density_judge("run", scene, request->method);
  if (code == DONE) code = place_momenta(request, scene);
  if (code == DONE) code = check_events(request, scene);
  if (code == DONE) code = run_check_settings(request, scene);
  if (code == DONE) code = run_check_end(request, scene);
  if (code == DONE) code = run_integrator(request, scene);
  problem_destroy(&scene);
  return code;
}

static const char summary[] = "Compute a trajectory with fixed steps, with those that sem chooses, "
                              "or with steps that follow the motion; write it and its\n"
                              "invariants as CSV. A scene may say which method it wants, after how "
                              "many steps a row, which columns, and which\n"
                              "events end the run.\n";

static const char *const details[] = {
    "Columns: t, the coordinates, their momenta (p_ and the coordinate's name), energy, the other "
    "invariants. Problems with\n"
    "rotations and directions have velocities, too, before the momenta, and after all the distance "
    "of the coordinates from\n"
    "their manifold. A rotation is R11,R12,R13,R21..R33, its velocity Omega1..Omega3 and its "
    "momentum Pi1..Pi3, both in the\n"
    "body's frame; a direction is a unit vector, its velocity (v_) and its momentum (p_) vectors "
    "orthogonal to it;\n"
    "methods that choose their steps add h, the length of the step that led to the row, with a "
    "one-form there is the\n"
    "constraint |p - alpha(q)|, and dg and dg-phase add jump, the largest one; 17 digits, so that "
    "every number is read\n"
    "back as it was. The first row is the start (with --resume: the checkpoint), the last one is "
    "the end, wherever\n"
    "--every puts the rows between.\n",
    "Of scenes a rotation R has columns R_11 .. R_33, omega_R_x and p_R_x. Forces add "
    "energy_balance, constraints the largest of\n"
    "them, constraint, contacts the smallest gap, gap, and a heat bath its temperature. The force "
    "of a constraint, lambda_NAME,\n"
    "is shown if --columns or the scene names it; that of a joint has a number for each row, "
    "lambda_NAME_1.\n",
    "Fields, of waves and Maxwell's ('field: maxwell'), are advanced by the marches leapfrog, yee, "
    "avi and tents, too, whose columns are\n"
    "energy and the probes. gauss, charge, divergence and growth are shown if --columns names "
    "them. --pvd writes E and B in the cells, or u.\n"
    "Solids ('field: elastic') have the marches avi and verlet, and --pvd writes their nodes where "
    "they are, with velocities and stresses.\n",
    "What no column shows is not evaluated for the rows. The energy of a system that does not "
    "depend on time is looked at all the\n"
    "same, in the first 32 steps, in every 61st later on, and at the end; an error above 1 % of "
    "the mean kinetic energy (or of "
    "that\n"
    "at its time, if it is larger) is told at the end, with what helps. With a one-form or a "
    "Hamiltonian the scale is by how much\n"
    "the energy would change if coordinates and momenta went back to the start, one at a time. Of "
    "methods that step over fast\n"
    "potentials 10 % are told. The exit code is 0 all the same.\n",
    "mpirun -np N dvi run SCENE.yaml: N processes share the mesh of a wave, of Maxwell's field or "
    "of a solid, or a grid of yee.\n"
    "The rows are those of one process, by midpoint, imex and galerkin up to roundoff. A mesh that "
    "is too large for one\n"
    "process is read in parts from the file of dvi mesh FILE --write mesh.h5 "
    "(docs/fields/processes.md).\n",
    "--verify runs the whole job with h, h/2 and h/4, and, for up to 500 coordinates, by IDA, "
    "where that takes no longer than\n"
    "these runs, or 2 s, and prints for each column its value at the end with h, an estimate of "
    "its error, and how many digits\n"
    "of its largest magnitude on the way, or of the terms that cancel in an invariant, are right. "
    "--digits N judges all\n"
    "coordinates and all momenta, each in the maximum norm, and the columns that --columns names: "
    "fewer end with exit code 3,\n"
    "and with a step or a method that would do. It costs seven times the run; with IDA fourteen, "
    "or seven and about 2 s.\n"
    "It takes every mechanical method, --time-transform, --step-control and events; no marches of "
    "fields, --out, --events,\n"
    "--plot, --alarm, --every or checkpoints.\n",
    "--plot draws the columns of --columns, or of the scene; default: six coordinates, places and "
    "angles before directions, of a\n"
    "body that only turns its angular velocity; and how energy and other invariants change. "
    "Standard error says what is drawn.\n",
    "--map draws a field on a line over space and time, from all steps of a mechanical method and "
    "from the rows of a march. Of\n"
    "a long run every second, fourth and so on is drawn. A field with a density (section "
    "'density') "
    "shows its components, their\n"
    "rates (u'), derivatives of both in space (d(u,x)), and of a complex field psi |psi|^2 and "
    "phase(psi). --pvd writes the components "
    "and "
    "|psi|^2 of a density at the\n"
    "vertices of the mesh, or of a domain at about as many points as it has functions.\n",
    "Events of a scene are looked for in every step. One with 'stop: yes' ends the run at its "
    "time: the last row is the state\n"
    "there, and the exit code 0. The columns of --events are event, its name, t, the coordinates "
    "and their velocities (v_), on\n"
    "the step's path; how often each was found is told at the end. Hits of contacts are listed "
    "there, too, by the contact's name,\n"
    "with the velocities before them; moreau-jean finds no hits, and lists none.\n",
    "An alarm changes nothing in the run: standard error says at the end when the invariant's size "
    "first passed the bound,\n"
    "and how large it was at most; the exit code is 0.\n",
    "FILE.h5 has the dataset rows, with the names of its columns in the attribute columns. It "
    "grows in its place, and can be\n"
    "read on the way, and up to the last second of a run that was killed; with --resume rows are "
    "appended to it, and those\n"
    "behind the checkpoint are cut off first, so that it has the rows of an uninterrupted run.\n",
    "Other FILEs are written whole or not at all: a run that fails leaves what was there. Rows on "
    "standard output come\n"
    "as they are computed. Ctrl-C, SIGTERM and SIGHUP end a run after the current step, with the "
    "output complete, the\n"
    "checkpoint written, and exit code 130, 143 or 129; before the first step they end it at once, "
    "and nothing is\n"
    "written. A second Ctrl-C ends it at once.\n",
    "A checkpoint holds the state of the method, not the command line: resume with the same "
    "problem, method and\n"
    "step, and the run continues bit for bit. Parameters that only place the start cannot be set "
    "then.\n",
    "--time-transform: steps H of a fictitious time tau, dt/dtau = g(q), with g the monitor; the "
    "run stays symplectic, takes\n"
    "implicit methods and autonomous problems, and ends at T all the same. Monitors: "
    "distance:power=P, 1/g = sum of r^-P over\n"
    "all pairs of bodies (P default: 1.5); arclength, equal lengths in phase space; "
    "acceleration:power=P, g = |a|^-P (0.75).\n"
    "--step-control: a symmetric method takes steps of about H g. Rows are in t. Too large an H "
    "shows in the energy.\n",
    "Examples:\n"
    "  dvi run kepler --method galerkin:degree=4 --h 0.1 --t-end 100 --out orbit.csv --plot "
    "orbit.svg\n"
    "  dvi run kepler --method verlet --h 0.001 --t-end 10 --set e=0.9 --every 100\n"
    "  dvi run free-body --method lie-verlet --h 0.1 --t-end 100 --momenta 1.5,-1,0.6 --out "
    "body.csv\n"
    "  dvi run outer-solar --method galerkin:degree=8 --h 200 --t-end 500000 --final\n"
    "  dvi run kepler --set e=0.99 --method galerkin:degree=4 --time-transform distance --h 0.3 "
    "--t-end 63\n"
    "  dvi run kepler --method sem:degree=2 --h 0.05 --t-end 100 --set e=0.5 --out orbit.csv\n"
    "  dvi run fpu --method midpoint --h 0.01 --t-end 100 --checkpoint fpu.state --out part1.csv\n"
    "  dvi run fpu --method midpoint --h 0.01 --t-end 200 --resume fpu.state --out part2.csv\n"
    "  dvi run cart.yaml --final --plot cart.svg\n"
    "  dvi run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 --verify --digits 6\n"
    "  dvi run cart.yaml | dvi plot - --axes x:theta --out path.svg\n"
    "  dvi run cavity.yaml --method leapfrog --columns energy,gauss --pvd cavity.pvd --every 50\n",
    NULL,
};

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(run_request, method),
     .value = "SPEC",
     .help = "the method: name[:key=value,...], see dvi list methods"},
    {.name = "h",
     OPTION_AT(run_request, h),
     .value = "H",
     .help = "the step, for sem the first one; default: the problem's"},
    {.name = "t-end",
     OPTION_AT(run_request, t_end),
     .value = "T",
     .help = "the end, from t = 0 (T < 0: backward); default: the problem's"},
    {.name = "time-transform",
     OPTION_AT(run_request, how.transform),
     .value = "MONITOR",
     .help = "steps of equal length in another time: distance[:power=P], arclength or "
             "acceleration[:power=P]"},
    {.name = "step-control",
     OPTION_AT(run_request, how.control),
     .value = "MONITOR",
     .help = "steps that follow a monitor reversibly: cheaper, symmetric, not symplectic"},
    {.name = "tolerance",
     OPTION_AT(run_request, tolerance),
     .value = "TOL",
     .help = "refused: see --time-transform and --step-control"},
    {.name = "every",
     OPTION_AT(run_request, every),
     .value = "K",
     .help = "a row after every K steps; default: 1; not with --final"},
    {.name = "final", OPTION_AT(run_request, final), .help = "the header and the last row only"},
    {.name = "set",
     OPTION_AT(run_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the problem; may be repeated"},
    {.name = "momenta",
     OPTION_AT(run_request, momenta),
     .value = "P1,P2,...",
     .help = "the momenta of the start, in the order of their columns; default: the problem's"},
    {.name = "project",
     OPTION_AT(run_request, project),
     .help = "if the start is off a problem's constraint: project it; default: refuse"},
    {.name = "columns",
     OPTION_AT(run_request, columns),
     .value = "A,B,...",
     .help = "columns behind t; default: the scene's, or all"},
    {.name = "alarm",
     OPTION_AT(run_request, alarms),
     .value = "NAME=BOUND",
     .help = "say when an invariant passes this; once for each"},
    {.name = "out",
     OPTION_AT(run_request, out),
     .value = "FILE",
     .help = "where the rows go, as HDF5 if its name ends in .h5; left out, or -: standard output"},
    {.name = "events",
     OPTION_AT(run_request, events),
     .value = "FILE.csv",
     .help = "list the scene's events there; default: count them",
     .is_csv = true},
    {.name = "checkpoint",
     OPTION_AT(run_request, checkpoint),
     .value = "FILE",
     .help =
         "save the state there when the run ends, however it ends; of fields on meshes in parts "
         "if the name ends in .h5"},
    {.name = "checkpoint-every",
     OPTION_AT(run_request, checkpoint_every),
     .value = "K",
     .help = "and after every K steps"},
    {.name = "threads",
     OPTION_AT(run_request, threads),
     .value = "N",
     .help = "of a march of a field (yee, leapfrog, avi); the bits are the same; default: 1"},
    {.name = "resume",
     OPTION_AT(run_request, resume),
     .value = "FILE",
     .help = "start from a checkpoint of the same problem and method; may be the file of "
             "--checkpoint"},
    {.name = "verify",
     OPTION_AT(run_request, verify),
     .help = "run with half the step, and a quarter, too: how many digits are right?"},
    {.name = "digits",
     OPTION_AT(run_request, digits),
     .value = "N",
     .help = "with --verify: exit code 3 if fewer than N are"},
    {.name = "csv",
     OPTION_AT(run_request, csv),
     .value = "-|FILE",
     .help = "with --verify: its table as CSV",
     .is_csv = true},
    {.name = "pvd",
     OPTION_AT(run_request, pvd),
     .value = "FILE.pvd|FILE.vtkhdf",
     .help = "of a field: write it at each row beside, as FILE_000000.vtu and so on, and their "
             "list for ParaView, or as one file of HDF5"},
    {.name = "map",
     OPTION_AT(run_request, map),
     .value = "FILE.svg",
     .help = "of a field on a line: draw it in colours over space and time"},
    {.name = "map-of",
     OPTION_AT(run_request, map_of),
     .value = "NAME",
     .help = "what --map draws, as u', 'd(u,x)', psi_re or 'phase(psi)'; default: the first field, "
             "of a "
             "complex one |psi|^2"},
    {.name = "plot",
     OPTION_AT(run_request, plot),
     .value = "FILE.svg",
     .help = "draw columns over time, and the invariants' errors; it says which"},
    {.name = NULL},
};

static const command_line command = {
    .name = "run",
    .synopsis = "PROBLEM|SCENE.yaml --method SPEC [--h H] [--t-end T] [OPTIONS]",
    .operand = "PROBLEM",
    .summary = summary,
    .options = command_options,
    .details = details,
};

static int run_alone(int argc, char **argv)
{
  run_request r = {.out = "-", .h = (double)NAN, .t_end = (double)NAN, .tolerance = (double)NAN};
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  code = ranks_agree(run_check_request(&r, name));
  if (code != DONE) return code;
  if (!ranks_is_first()) r.out = "-";
  r.command = command_spelled("run", argc, argv);
  code = run_problem(&r, name);
  free(r.command);
  return code;
}

int run_command(int argc, char **argv)
{
  const int code = ranks_begin();
  return ranks_end(code == DONE ? run_alone(argc, argv) : code);
}
