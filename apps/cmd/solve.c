/* dvi solve, which finds the static state of a field. */
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "csv/table.h"
#include "load/density.h"
#include "load/field.h"
#include "load/moving.h"
#include "load/open.h"
#include "load/scene.h"

/* The options. */
typedef struct solve_request {
  const char *csv, *vtu;
  words settings;
} solve_request;

/* Print the energy and the probes of the state, a system's invariants without a momentum. */
static dvi_status print_invariants(FILE *stream, const problem *scene, const dvi_field *field,
                                   const double *u)
{
  const dvi_system *system = scene->system;
  const int count = dvi_system_invariant_count(system);
  const size_t n = (size_t)dvi_system_nq(system);
  double *q = calloc(2 * n + (size_t)count + 1, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  double *value = q + 2 * n;
  dvi_status status = dvi_field_project(field, u, NULL, q, NULL);
  if (status == DVI_OK) status = dvi_system_invariants(system, 0, q, q + n, value);
  for (int i = 0; i < count && status == DVI_OK; i++) {
    const char *name = dvi_system_invariant_name(system, i);
    if (strncmp(name, "momentum_", strlen("momentum_")) != 0)
      (void)fprintf(stream, "%-10s %.12g\n", name, value[i]);
  }
  free(q);
  return status;
}

static int print_report(const solve_request *r, const problem *scene, const dvi_field *field,
                        const double *u, const dvi_field_solve_report *report)
{
  const int64_t vertices = dvi_mesh_count(field_mesh(field), 0);
  FILE *stream = r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout;
  double least = INFINITY, most = -INFINITY;
  for (int64_t v = 0; v < vertices; v++) {
    least = fmin(least, u[v]);
    most = fmax(most, u[v]);
  }
  (void)fprintf(stream, "Static state of %s\n", scene->name);
  (void)fprintf(stream, "unknowns   %lld of %lld vertices\n", (long long)report->unknowns,
                (long long)vertices);
  if (report->iterations > 0) (void)fprintf(stream, "iterations %d\n", report->iterations);
  (void)fprintf(stream, "residual   %.2e\n", report->residual);
  if (report->imbalance > 0.0)
    (void)fprintf(stream, "imbalance  %.2e, taken away\n", report->imbalance);
  (void)fprintf(stream, "u          from %.12g to %.12g\n", least, most);
  const dvi_status status = print_invariants(stream, scene, field, u);
  return status == DVI_OK ? DONE : library_error(status);
}

static bool write_values(const char *path, const dvi_mesh *mesh, const double *u)
{
  static const char *const axis[] = {"x", "y", "z", "w"};
  const int space = dvi_mesh_space(mesh);
  table_column columns[7] = {{"vertex", ""}};
  for (int l = 0; l < space; l++) columns[1 + l] = (table_column){axis[l], ""};
  columns[1 + space] = (table_column){"u", ""};
  result_table *rows = table_create(columns);
  for (int64_t v = 0; v < dvi_mesh_count(mesh, 0); v++) {
    table_number(rows, (double)v);
    for (int l = 0; l < space; l++) table_number(rows, dvi_mesh_points(mesh)[v * space + l]);
    table_number(rows, u[v]);
  }
  return table_finish(&rows, path);
}

/* Newton's method of a field with a potential starts from the scene's start. */
static int solve_field(const solve_request *r, const problem *scene, const dvi_field *field)
{
  const dvi_mesh *mesh = field_mesh(field);
  const int64_t vertices = dvi_mesh_count(mesh, dvi_field_degree(field));
  dvi_field_solve_options options;
  dvi_field_solve_report report = {0};
  double *u = calloc((size_t)vertices, sizeof *u);
  if (u == NULL) {
    complain("out of memory");
    return FAILED;
  }
  (void)dvi_scene_solve_options(scene->scene, &options);
  dvi_status status = dvi_field_lift(field, scene->q, u);
  if (status == DVI_OK) status = dvi_field_solve(field, &options, u, &report);
  int code = status == DVI_OK ? DONE : library_error(status);
  if (code == DONE) code = print_report(r, scene, field, u, &report);
  if (code == DONE && r->csv != NULL && !write_values(r->csv, mesh, u)) code = FAILED;
  if (code == DONE && r->vtu != NULL) code = field_write(field, r->vtu, "u", 1, u);
  free(u);
  return code;
}

/* ---- fields with a density ---- */

/* Print what is watched of a state: energy and probes, or of a field without rates the probes. */
static dvi_status print_watched(FILE *stream, const problem *scene, const dvi_density *density,
                                const double *U)
{
  const dvi_system *system = dvi_scene_system(scene->scene);
  const dvi_system_terms *terms = dvi_scene_terms(scene->scene);
  const int momenta = terms->symmetry_count, probes = terms->invariant_count,
            count = 1 + momenta + probes;
  int64_t n;
  (void)dvi_density_unknowns(density, &n);
  double *q = calloc(2 * (size_t)n + (size_t)count, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  double *const p = q + n, *const value = p + n;
  dvi_status status = dvi_density_project(density, U, NULL, q, NULL, system != NULL ? p : NULL);
  if (status == DVI_OK && system != NULL) status = dvi_system_invariants(system, 0, q, p, value);
  if (status == DVI_OK && system != NULL)
    (void)fprintf(stream, "%-10s %.12g\n", "energy", value[0]);
  for (int i = 0; i < probes && status == DVI_OK; i++) {
    const dvi_invariant *probe = terms->invariants + i;
    double *to = value + 1 + momenta + i;
    if (system == NULL && probe->value(0, q, p, to, probe->user) != 0) status = DVI_CALLBACK_FAILED;
    if (status == DVI_OK) (void)fprintf(stream, "%-10s %.12g\n", probe->name, *to);
  }
  free(q);
  return status;
}

/* Print the least and the greatest value of each component at the quadrature points. */
static dvi_status print_ranges(FILE *stream, const problem *scene, const dvi_density *density,
                               const double *U)
{
  static const int none[DVI_AXES_MAX] = {0};
  const dvi_space *space = dvi_density_space(density);
  const int64_t points = dvi_space_points(space, NULL, NULL);
  double *value = calloc((size_t)points + 1, sizeof *value);
  dvi_status status = value != NULL ? DVI_OK : DVI_NO_MEMORY;
  for (int c = 0; c < dvi_density_components(density) && status == DVI_OK; c++) {
    double least = INFINITY, most = -INFINITY;
    status = dvi_space_apply(space, none, U + c * dvi_space_functions(space), value);
    for (int64_t i = 0; i < points; i++) {
      least = fmin(least, value[i]);
      most = fmax(most, value[i]);
    }
    (void)fprintf(stream, "%-10s from %.12g to %.12g\n", dvi_scene_component(scene->scene, c),
                  least, most);
  }
  free(value);
  return status;
}

static int tell_state(const solve_request *r, const problem *scene, const dvi_density *density,
                      const double *U, const dvi_field_solve_report *report)
{
  FILE *stream = r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout;
  (void)fprintf(stream, "Static state of %s\n", scene->name);
  (void)fprintf(stream, "unknowns   %lld of %lld coefficients\n", (long long)report->unknowns,
                (long long)density_coefficients(density));
  (void)fprintf(stream, "iterations %d\n", report->iterations);
  (void)fprintf(stream, "residual   %.2e\n", report->residual);
  dvi_status status = print_ranges(stream, scene, density, U);
  if (status == DVI_OK) status = print_watched(stream, scene, density, U);
  return status == DVI_OK ? DONE : library_error(status);
}

/* ---- ground states ---- */

/* Print the norm and mu, and what is watched of the state, the energy first. */
static dvi_status tell_ground(const solve_request *r, const problem *scene,
                              const dvi_schroedinger_ground_report *state, const double *U)
{
  FILE *stream = r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout;
  (void)fprintf(stream, "Ground state of %s\n", scene->name);
  (void)fprintf(stream, "%-10s %.12g\n", "norm", dvi_scene_ground_norm(scene->scene));
  (void)fprintf(stream, "%-10s %.12g\n", "mu", state->mu);
  if (state->followed < 1)
    (void)fprintf(stream,
                  "%-10s of less energy than the state followed from no interaction, which is a "
                  "saddle beyond %.3g of it\n",
                  "branch", state->followed);
  const dvi_status status = print_watched(stream, scene, density_of(scene), U);
  return status == DVI_OK ? print_ranges(stream, scene, density_of(scene), U) : status;
}

/* The state is real. Its imaginary part stays as it is, 0. */
static int solve_ground(const solve_request *r, const problem *scene, double *U)
{
  const dvi_schroedinger *equation = dvi_scene_schroedinger(scene->scene);
  dvi_schroedinger_ground_report state;
  if (equation == NULL) return library_error(DVI_UNSUPPORTED);
  dvi_status status = dvi_schroedinger_ground(equation, dvi_scene_ground_norm(scene->scene), &state,
                                              U);
  if (status == DVI_OK) status = tell_ground(r, scene, &state, U);
  return status == DVI_OK ? DONE : library_error(status);
}

/* A wave function of zero is a state, and seldom the one that is meant. */
static void hint_at_ground(const problem *scene, const dvi_density *density, const double *U)
{
  const double nothing = 1e-12;
  double most = 0.0;
  for (int64_t i = 0; i < density_coefficients(density); i++) most = fmax(most, fabs(U[i]));
  if (most < nothing && dvi_scene_schroedinger(scene->scene) != NULL)
    complain(
        "solve: this state is psi = 0; 'solve: ground' in the scene asks for the ground state");
}

static int solve_static(const solve_request *r, const problem *scene, double *U)
{
  const double *q, *v, *p;
  const dvi_density *density = density_of(scene);
  dvi_field_solve_report report = {0};
  dvi_scene_start(scene->scene, &q, &v, &p);
  dvi_status status = dvi_density_lift(density, 0, q, U);
  if (status == DVI_OK) status = dvi_density_solve(density, U, &report);
  if (status == DVI_OK) hint_at_ground(scene, density, U);
  return status == DVI_OK ? tell_state(r, scene, density, U, &report) : library_error(status);
}

static int solve_density(const solve_request *r, const problem *scene, const dvi_density *density)
{
  double *U = calloc((size_t)density_coefficients(density), sizeof *U);
  if (U == NULL) {
    complain("out of memory");
    return FAILED;
  }
  int code = dvi_scene_ground_norm(scene->scene) > 0 ? solve_ground(r, scene, U)
                                                     : solve_static(r, scene, U);
  if (code == DONE && r->csv != NULL) code = density_write(scene, r->csv, 1, U);
  if (code == DONE && r->vtu != NULL) code = density_view(scene, r->vtu, 1, U);
  free(U);
  return code;
}

/* ---- meshes that move ---- */

/* Print the probes of a state. */
static dvi_status print_probes(FILE *stream, const problem *scene, const double *q)
{
  const dvi_system_terms *terms = dvi_scene_terms(scene->scene);
  for (int i = 0; i < terms->invariant_count; i++) {
    const dvi_invariant *probe = terms->invariants + i;
    double value = 0;
    if (probe->value(0, q, NULL, &value, probe->user) != 0) return DVI_CALLBACK_FAILED;
    (void)fprintf(stream, "%-10s %.12g\n", probe->name, value);
  }
  return DVI_OK;
}

/* Write the nodes with their values to the files that are asked for. */
static int write_nodes(const solve_request *r, const problem *scene, const double *q)
{
  moving_views views;
  int code = moving_views_make(scene, 0, q, &views);
  if (code == DONE && r->csv != NULL) code = moving_write(scene, r->csv, &views);
  if (code == DONE && r->vtu != NULL) {
    const dvi_status status = dvi_mesh_write(views.mesh, r->vtu, views.count, views.view);
    if (status != DVI_OK) code = library_error(status);
  }
  moving_views_clear(&views);
  return code;
}

static int solve_moving(const solve_request *r, const problem *scene, const dvi_moving *moving)
{
  const double *start, *v, *p;
  const size_t n = (size_t)dvi_scene_terms(scene->scene)->dimension;
  dvi_moving_report report = {0};
  FILE *stream = r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout;
  double *q = calloc(n + 1, sizeof *q);
  if (q == NULL) {
    complain("out of memory");
    return FAILED;
  }
  dvi_scene_start(scene->scene, &start, &v, &p);
  memcpy(q, start, n * sizeof *q);
  dvi_status status = dvi_moving_solve(moving, q, &report);
  if (status == DVI_OK) {
    (void)fprintf(stream, "Static state of %s\n", scene->name);
    (void)fprintf(stream, "unknowns   %zu\niterations %d\nresidual   %.2e\n", n, report.iterations,
                  report.residual);
    (void)fprintf(stream, "%-10s %.12g\n%-10s %.12g\n", "energy", report.energy, "barrier",
                  report.barrier);
    status = print_probes(stream, scene, q);
  }
  int code = status == DVI_OK ? DONE : library_error(status);
  if (code == DONE && (r->csv != NULL || r->vtu != NULL)) code = write_nodes(r, scene, q);
  free(q);
  return code;
}

static const char *const details[] = {
    "The static state balances the stiffness, the potential, the source and the flux through the "
    "boundary: -div(a grad u) + V_u = f. Without a potential the problem is linear. With one it is "
    "solved by Newton's method from the scene's start. Where no value is fixed, source and flux "
    "must sum to zero, and the section solve sets the mean. The energy and the probes of the scene "
    "are printed.\n",
    "This is of waves ('field: wave'). A static electric field is minus the gradient of such a u, "
    "with a = eps, and the charges as the source. What is static of 'field: maxwell' is what a run "
    "with losses tends to.\n",
    "The static state of fields with a density (section 'density') is that where the derivatives "
    "of all parts without rates vanish, found by Newton's method from the scene's start. With "
    "'solve: ground' it is the ground state of the section schroedinger, of norm 1 or that of "
    "'solve: {ground: NORM}': mu is its chemical potential. On a mesh that "
    "moves ('moving') nodes and values are found together, energy and barrier are those of the "
    "action, and the files have the nodes.\n",
    "Columns of --csv: vertex, its coordinates, u. Of a density: the position of the vertices, and "
    "the value of each component and of |psi|^2 of a complex field.\n",
    "Examples:\n"
    "  dvi solve membrane.yaml\n"
    "  dvi solve membrane.yaml --csv values.csv --vtu values.vtu\n",
    NULL,
};

static const option command_options[] = {
    {.name = "csv",
     OPTION_AT(solve_request, csv),
     .value = "FILE",
     .help = "write the values at the vertices as CSV; - for standard output",
     .is_csv = true},
    {.name = "vtu",
     OPTION_AT(solve_request, vtu),
     .value = "FILE.vtu",
     .help = "write the mesh and the values for ParaView"},
    {.name = "set",
     OPTION_AT(solve_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the scene; may be repeated"},
    {.name = NULL},
};

static const command_line command = {
    .name = "solve",
    .synopsis = "SCENE.yaml [OPTIONS]",
    .operand = "SCENE.yaml",
    .summary = "Find the static state of a scene's field.\n",
    .options = command_options,
    .details = details,
};

int solve_command(int argc, char **argv)
{
  solve_request r = {.csv = NULL};
  const char *name;
  const dvi_field *field;
  const dvi_density *density = NULL;
  problem *scene;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  const named_file files[] = {{"csv", r.csv}, {"vtu", r.vtu}};
  code = outputs_distinct("solve", 2, files);
  if (code != DONE) return code;
  code = open_any(name, &r.settings, &scene);
  if (code != DONE) return code;
  if (dvi_scene_moving(scene->scene) != NULL) {
    code = solve_moving(&r, scene, dvi_scene_moving(scene->scene));
    problem_destroy(&scene);
    return code;
  }
  code = field_choose("solve", name, &scene, &field, &density, NULL);
  if (code != DONE) return code;
  if (density != NULL) {
    code = solve_density(&r, scene, density);
  } else {
    code = scene_complete(scene);
    if (code == DONE) code = solve_field(&r, scene, field);
  }
  problem_destroy(&scene);
  return code;
}
