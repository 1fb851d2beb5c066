/* dvi gradient, which differentiates a run of a scene by its start and its parameters. */
#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"
#include "csv/table.h"
#include "varied/varied.h"

typedef struct gradient_request {
  const char *method, *out;
  double h, t_end; /**< NaN if not given */
  bool tangent;
  words settings;
} gradient_request;

/* The run as it is asked for, in equal steps that end at the end. */
static int plan_run(const gradient_request *r, const problem *scene, dvi_run_plan *plan)
{
  const double h = isnan(r->h) ? scene->h : r->h, t_end = isnan(r->t_end) ? scene->t_end : r->t_end;
  const double steps = round(t_end / h);
  if (!(h > 0) || !(steps >= 1 && steps < 1e9))
    return usage_error("gradient: steps of %g to t = %g are no run", h, t_end);
  *plan = (dvi_run_plan){.h = t_end / steps, .steps = (long)steps, .q = scene->q, .p = scene->p};
  return DONE;
}

/* ---- the gradient of the objective ---- */

static int write_objective(const varied *v, const dvi_run_plan *plan, double *room, FILE *stream)
{
  const dvi_objective *objective = dvi_scene_objective(v->scene->scene);
  const int n = v->n;
  dvi_gradient g = {.by_q = room, .by_p = room + n, .by_theta = v->by_parameter};
  if (objective == NULL)
    return usage_error("gradient: %s has no section objective, as in 'objective: {end: %s^2}'; "
                       "--tangent needs none",
                       v->scene->name, v->scene->coordinate[0]);
  const dvi_status status = dvi_sensitivity_gradient(v->run, plan, objective, &g);
  if (status != DVI_OK) return library_error(status);
  (void)fprintf(stream, "name,value,derivative\nobjective,%.17g,\n", g.value);
  for (int k = 0; k < varied_count(v); k++) {
    double derivative = k < 2 * n ? room[k] : g.by_theta[k - 2 * n];
    for (int i = 0; i < n && k >= 2 * n; i++)
      derivative += g.by_q[i] * v->by_q[(k - 2 * n) * n + i] +
                    g.by_p[i] * v->by_p[(k - 2 * n) * n + i];
    if (varied_name(v, k) == NULL) continue;
    csv_text(stream, varied_name(v, k));
    (void)fprintf(stream, ",%.17g,%.17g\n", varied_value(v, k), derivative);
  }
  return DONE;
}

/* ---- the tangents of the end ---- */

static void write_state(const varied *v, const double *change, FILE *stream)
{
  for (int i = 0; i < 2 * v->n; i++) {
    const double *q = dvi_sensitivity_q(v->run), *p = dvi_sensitivity_p(v->run);
    const double state = i < v->n ? q[i] : p[i - v->n];
    (void)fprintf(stream, ",%.17g", change != NULL ? change[i] : state);
  }
  (void)fputc('\n', stream);
}

static int write_tangents(const varied *v, const dvi_run_plan *plan, double *room, FILE *stream)
{
  dvi_status status = dvi_sensitivity_start(v->run, plan->t, plan->q, plan->p);
  for (long k = 0; k < plan->steps && status == DVI_OK; k++)
    status = dvi_sensitivity_step(v->run, plan->h);
  if (status != DVI_OK) return library_error(status);
  (void)fputs("name,value", stream);
  for (int i = 0; i < 2 * v->n; i++) {
    (void)fputc(',', stream);
    csv_text(stream, varied_name(v, i));
  }
  (void)fprintf(stream, "\nend,%.17g", dvi_sensitivity_time(v->run));
  write_state(v, NULL, stream);
  for (int k = 0; k < varied_count(v); k++) {
    if (varied_name(v, k) == NULL) continue;
    varied_tangent(v, k, room);
    csv_text(stream, varied_name(v, k));
    (void)fprintf(stream, ",%.17g", varied_value(v, k));
    write_state(v, room, stream);
  }
  return DONE;
}

static int write_table(const gradient_request *request, const varied *v)
{
  whole_file file = {0};
  dvi_run_plan plan = {0};
  double *room = calloc(2 * (size_t)v->n, sizeof *room);
  int code = plan_run(request, v->scene, &plan);
  if (code == DONE && (room == NULL || !file_open(&file, request->out))) code = FAILED;
  if (code == DONE)
    code = (request->tangent ? write_tangents : write_objective)(v, &plan, room, file.stream);
  if (code == DONE && !file_keep(&file)) code = FAILED;
  file_discard(&file);
  free(room);
  return code;
}

static int gradient_scene(const char *path, const gradient_request *request)
{
  scene_text text = {0};
  varied v = {.scene = NULL};
  const named_file out = {.option = "out", .path = request->out};
  int code = scene_spared("gradient", path, 1, &out);
  if (code == DONE) code = scene_load(path, &text);
  if (code == DONE)
    code = varied_open("gradient", path, &text, &request->settings, request->method, &v);
  if (code == DONE) code = write_table(request, &v);
  varied_close(&v);
  free(text.text);
  return code;
}

static const char *const details[] = {
    "The section `objective` has an `end`, an expression of t, the coordinates and their momenta "
    "at the end of the run, and\n"
    "an `integral` over the run, of t, coordinates and velocities. Their sum is differentiated by "
    "the adjoint of the run,\n"
    "exactly for the steps that the method takes. --tangent differentiates the end itself.\n",
    "Columns: name, value, derivative. Rows: objective, the coordinates and momenta of the start, "
    "the parameters, whose\n"
    "part in the start is included. Parameters that are lists, or made of others, have no row. "
    "With --tangent: name, value,\n"
    "and the derivatives of the coordinates and momenta at the end; the row `end` has these "
    "themselves.\n",
    "Examples:\n"
    "  dvi gradient throw.yaml\n"
    "  dvi gradient throw.yaml --tangent --method verlet --h 0.01\n",
    NULL,
};

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(gradient_request, method),
     .value = "SPEC",
     .help = "galerkin, midpoint, trapezoidal, verlet, or hp or hamiltonian of types 1 to 3; "
             "default: the scene's"},
    {.name = "h",
     OPTION_AT(gradient_request, h),
     .value = "H",
     .help = "the step; default: the scene's"},
    {.name = "t-end",
     OPTION_AT(gradient_request, t_end),
     .value = "T",
     .help = "the end, from t = 0; default: the scene's"},
    {.name = "tangent",
     OPTION_AT(gradient_request, tangent),
     .help = "the derivatives of the end, not of the objective"},
    {.name = "set",
     OPTION_AT(gradient_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the scene; may be repeated"},
    {.name = "out",
     OPTION_AT(gradient_request, out),
     .value = "FILE",
     .help = "where the rows go; left out, or -: standard output",
     .is_csv = true},
    {.name = NULL},
};

static const command_line command = {
    .name = "gradient",
    .synopsis = "SCENE.yaml [--tangent] [OPTIONS]",
    .operand = "SCENE",
    .summary = "Differentiate a run by its start and its parameters.\n",
    .options = command_options,
    .details = details,
};

int gradient_command(int argc, char **argv)
{
  gradient_request r = {.out = "-", .h = (double)NAN, .t_end = (double)NAN};
  const char *path;
  int code;
  if (!options_parse(&command, argc, argv, &r, &path, &code)) return code;
  if (!scene_is_path(path))
    return usage_error("gradient: '%s' is no scene; `dvi_sensitivity` differentiates runs of C "
                       "programs",
                       path);
  return gradient_scene(path, &r);
}
