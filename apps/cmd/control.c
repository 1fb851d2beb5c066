/* dvi control, which finds the controls that lead a scene from its start to its end at the least
 * cost. */
#include <dvi/scene.h>
#include <math.h>
#include <string.h>

#include "boundary/control_report.h"
#include "cli/command.h"
#include "cli/file.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "csv/points.h"
#include "load/open.h"

typedef struct control_request {
  const char *method, *guess, *out;
  long steps; /**< 0 if not given */
  bool free_time;
  words settings;
} control_request;

static int create_problem(const control_request *request, controlled *c)
{
  const problem *scene = c->scene;
  const char *method = request->method;
  const dvi_controls *controls = dvi_scene_controls(scene->scene);
  dvi_scene_end end;
  if (dvi_scene_control(scene->scene, 0) == NULL)
    return usage_error("control: %s has no section controls, as in 'controls: {u: {cost: u^2/2}}'",
                       scene->name);
  if (controls == NULL)
    return usage_error("control: no control of %s stands in its forces", scene->name);
  if (!dvi_scene_end_of(scene->scene, &end))
    return usage_error("control: %s has no section final, which says where the motion ends",
                       scene->name);
  const int code = open_wish("control", scene, &method);
  if (code != DONE) return code;
  const double steps = request->steps > 0 ? (double)request->steps
                                          : fmax(2, round(scene->t_end / scene->h));
  if (!(steps <= 0x7fffffff)) return usage_error("control: %g steps are too many", steps);
  const dvi_control_options options = {.steps = (int)steps,
                                       .span = scene->t_end,
                                       .dimension = scene->nq,
                                       .q0 = scene->q,
                                       .p0 = scene->p,
                                       .q1 = end.q,
                                       .p1 = end.p,
                                       .free_q1 = end.free_q,
                                       .free_p1 = end.free_p,
                                       .free_span = request->free_time};
  c->count = controls->count;
  const dvi_status status = dvi_control_create(scene->system, method, controls, &options,
                                               &c->control);
  return status == DVI_OK ? DONE : library_error(status);
}

static int take_guess(const control_request *request, const controlled *c)
{
  points guess = {0};
  if (request->guess == NULL) return DONE;
  int code = points_read(request->guess, c->scene, &guess);
  if (code == DONE) {
    const dvi_status status = dvi_control_guess(c->control, guess.count, c->scene->nq, guess.t,
                                                guess.q);
    if (status != DVI_OK) code = library_error(status);
  }
  points_clear(&guess);
  return code;
}

static int solve(controlled *c)
{
  const dvi_status status = dvi_control_solve(c->control, &c->report);
  return status == DVI_OK ? DONE : library_error(status);
}

static int control_scene(const char *path, const control_request *request)
{
  controlled c = {.scene = NULL};
  const bool rows_on_output = request->out != NULL && strcmp(request->out, "-") == 0;
  const named_file out = {.option = "out", .path = request->out};
  int code = scene_spared("control", path, 1, &out);
  if (code == DONE) code = open_problem(path, &request->settings, &c.scene);
  if (code == DONE && request->out != NULL && !rows_on_output && !file_writable(request->out))
    code = FAILED;
  if (code == DONE) code = create_problem(request, &c);
  if (code == DONE) code = take_guess(request, &c);
  if (code == DONE) code = solve(&c);
  if (code == DONE) control_print(&c, rows_on_output ? stderr : stdout);
  if (code == DONE && request->out != NULL) code = control_write(&c, request->out);
  dvi_control_destroy(&c.control);
  problem_destroy(&c.scene);
  return code;
}

static const char *const details[] = {
    "The scene's sections: `controls` has the controls with their costs and bounds, `forces` says "
    "how they act, `initial`\n"
    "is the start and `final` the end, `until` the time from one to the other, `step` the length "
    "of a step. Numbers that\n"
    "`final` leaves out are free.\n",
    "The sum of the costs is made stationary over all motions of the method, all steps at once; "
    "dvi says whether the\n"
    "solution is a local minimum. Which of several is found depends on the guess: the straight "
    "line between start and end,\n"
    "or the points of a FILE.\n",
    "Columns of FILE: t, the coordinates, their momenta, the controls, and the costates "
    "costate_x, costate_p_x, which are\n"
    "the derivatives of the remaining cost by x and p_x, at the N+1 nodes; a FILE may be the "
    "guess of another problem.\n",
    "Examples:\n"
    "  dvi control swing-up.yaml\n"
    "  dvi control swing-up.yaml --method galerkin:degree=4 --steps 40 --out u.csv\n",
    NULL,
};

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(control_request, method),
     .value = "SPEC",
     .help = "galerkin, midpoint, trapezoidal, or hp or hamiltonian of types 1 to 3; default: "
             "the scene's"},
    {.name = "steps",
     OPTION_AT(control_request, steps),
     .value = "N",
     .help = "how many steps the motion has; default: by the scene's step"},
    {.name = "free-time",
     OPTION_AT(control_request, free_time),
     .help = "find the time to the end with the least cost, too; `until` is its guess"},
    {.name = "guess",
     OPTION_AT(control_request, guess),
     .value = "FILE",
     .help = "points of a guess: CSV with t and the coordinates"},
    {.name = "set",
     OPTION_AT(control_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the scene; may be repeated"},
    {.name = "out",
     OPTION_AT(control_request, out),
     .value = "FILE",
     .help = "write the nodes there; -: standard output; default: nowhere",
     .is_csv = true},
    {.name = NULL},
};

static const command_line command = {
    .name = "control",
    .synopsis = "SCENE.yaml [OPTIONS]",
    .operand = "SCENE",
    .summary = "Find the controls that lead from a state to another one at the least cost.\n",
    .options = command_options,
    .details = details,
};

int control_command(int argc, char **argv)
{
  control_request r = {.method = NULL};
  const char *path;
  int code;
  if (!options_parse(&command, argc, argv, &r, &path, &code)) return code;
  if (!scene_is_path(path))
    return usage_error("control: '%s' is no scene; controls are declared in scenes", path);
  return control_scene(path, &r);
}
