/* dvi modes, which computes the modes of a field. */
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
#include "load/elastic.h"
#include "load/field.h"
#include "load/open.h"
#include "module/ranks.h"

/* The options. */
typedef struct modes_request {
  long count;
  double near;
  bool at_static_state;
  const char *csv, *vtu, *shapes;
  words settings;
} modes_request;

/* Processes that share the field say how they have found the modes. */
static int print_modes(const modes_request *r, const problem *scene, const double *eigenvalue,
                       const mode_search *search)
{
  static const table_column columns[] = {
      {"index", "%.0f"}, {"eigenvalue", "%.12g"}, {"omega", "%.12g"}, {NULL, NULL}};
  FILE *stream = r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout;
  result_table *rows = table_create(columns);
  for (long i = 0; i < r->count; i++) {
    table_number(rows, (double)(i + 1));
    table_number(rows, eigenvalue[i]);
    table_number(rows, sqrt(fmax(eigenvalue[i], 0.0)));
  }
  bool good = table_good(rows);
  if (good) {
    (void)fprintf(stream, "Modes of %s, of %lld unknowns", scene->name,
                  (long long)search->unknowns);
    if (!isnan(r->near)) (void)fprintf(stream, ", the nearest to %.12g", r->near);
    (void)fprintf(stream, "\nleft out: %lld of frequency zero\n", (long long)search->zeros);
    if (search->solver != NULL)
      (void)fprintf(stream, "by %d processes: %lld solutions by %s, residuals to %.1e\n",
                    ranks_count(), (long long)search->solutions, search->solver, search->residual);
    table_print(rows, stream, 0, 0, table_rows(rows));
    good = r->csv == NULL || table_write(rows, r->csv);
  }
  table_destroy(&rows);
  return good ? DONE : FAILED;
}

/* The modes of a field, or of small vibrations of a solid about rest if there is one. */
static int find_modes(const modes_request *r, const problem *scene, const dvi_field *field,
                      const dvi_elastic *solid)
{
  const dvi_mesh *mesh = solid != NULL ? dvi_elastic_mesh(solid) : field_mesh(field);
  const int64_t numbers = solid != NULL ? dvi_mesh_count(mesh, 0) * dvi_mesh_dimension(mesh)
                                        : dvi_mesh_count(mesh, dvi_field_degree(field));
  const dvi_modes_options options = {
      .size = sizeof options, .count = (int)r->count, .shift = isnan(r->near) ? 0.0 : r->near};
  mode_search search = {.solver = NULL};
  double *eigenvalue = calloc((size_t)r->count * (size_t)(1 + numbers), sizeof *eigenvalue);
  if (eigenvalue == NULL) {
    complain("out of memory");
    return FAILED;
  }
  double *mode = eigenvalue + r->count, *wanted = r->vtu != NULL ? mode : NULL;
  const dvi_status status =
      solid != NULL ? dvi_elastic_modes(solid, &options, eigenvalue, wanted, &search.zeros)
                    : dvi_field_modes(field, &options, eigenvalue, wanted, &search.zeros);
  (void)(solid != NULL ? dvi_elastic_unknowns(solid, &search.unknowns)
                       : dvi_field_unknowns(field, &search.unknowns));
  int code = status == DVI_OK ? print_modes(r, scene, eigenvalue, &search) : library_error(status);
  if (status == DVI_BAD_SIZE) code = USAGE; /* more modes than there are */
  if (code == DONE && r->vtu != NULL)
    code = solid != NULL ? elastic_write_modes(scene, r->vtu, (int)r->count, mode)
                         : field_write(field, r->vtu, "mode", (int)r->count, mode);
  free(eigenvalue);
  return code;
}

/* The modes of a field that several processes share, of which the first one writes. */
static int find_shared(modes_request *r, const problem *scene, const dvi_field *field)
{
  const dvi_modes_options options = {
      .size = sizeof options, .count = (int)r->count, .shift = isnan(r->near) ? 0.0 : r->near};
  mode_search search = {.solver = NULL};
  double *eigenvalue = calloc((size_t)r->count, sizeof *eigenvalue);
  if (eigenvalue == NULL) complain("out of memory");
  int code = ranks_agree(eigenvalue != NULL ? DONE : FAILED);
  if (code == DONE && eigenvalue != NULL) {
    if (!ranks_is_first()) r->csv = NULL;
    const dvi_status status = ranks_modes(field, &options, eigenvalue, &search);
    code = status == DVI_OK ? print_modes(r, scene, eigenvalue, &search) : library_error(status);
    if (status == DVI_BAD_SIZE || status == DVI_UNSUPPORTED) code = USAGE;
  }
  free(eigenvalue);
  return code;
}

static int check_shared(const modes_request *r, const problem *scene)
{
  if (dvi_scene_field(scene->scene) == NULL)
    return usage_error("modes: %d processes share a scene of waves or of Maxwell's field on a "
                       "mesh, and %s is none; leave mpirun out",
                       ranks_count(), scene->name);
  if (r->vtu == NULL) return DONE;
  return usage_error(
      "modes: --vtu needs the whole mesh, which %d processes share; leave it out, or "
      "mpirun",
      ranks_count());
}

/* ---- fields with a density ---- */

/* A state of a system of first order turns with the eigenvalue itself. */
static int print_spectrum(const modes_request *r, const problem *scene, const double *eigenvalue)
{
  static const table_column columns[] = {
      {"index", "%.0f"}, {"eigenvalue", "%.12g"}, {"omega", "%.12g"}, {NULL, NULL}};
  FILE *stream = r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout;
  const bool is_first_order = scene->terms->one_form != NULL;
  int64_t unknowns;
  (void)dvi_density_unknowns(density_of(scene), &unknowns);
  result_table *rows = table_create(columns);
  for (long i = 0; i < r->count; i++) {
    table_number(rows, (double)(i + 1));
    table_number(rows, eigenvalue[i]);
    table_number(rows, is_first_order        ? (double)NAN
                       : eigenvalue[i] < 0.0 ? (double)NAN
                                             : sqrt(eigenvalue[i]));
  }
  bool good = table_good(rows);
  if (good) {
    (void)fprintf(stream, "Modes of %s, of %lld unknowns", scene->name, (long long)unknowns);
    if (!isnan(r->near)) (void)fprintf(stream, ", the nearest to %.12g", r->near);
    (void)fprintf(stream, "\n");
    table_print(rows, stream, 0, 0, table_rows(rows));
    good = r->csv == NULL || table_write(rows, r->csv);
  }
  table_destroy(&rows);
  return good ? DONE : FAILED;
}

/* Find the static state near the start. */
static dvi_status find_state(const problem *scene, double *U)
{
  const double *q, *v, *p;
  dvi_scene_start(scene->scene, &q, &v, &p);
  const dvi_status status = dvi_density_lift(density_of(scene), 0, q, U);
  return status == DVI_OK ? dvi_density_solve(density_of(scene), U, NULL) : status;
}

/* ---- stationary states ---- */

/* Write the states [count][functions], which are real, with an imaginary part of zeros. */
static int write_states(const modes_request *r, const problem *scene, const double *psi)
{
  const size_t all = (size_t)density_coefficients(density_of(scene)), functions = all / 2;
  double *U = calloc((size_t)r->count * all, sizeof *U);
  if (U == NULL) {
    complain("out of memory");
    return FAILED;
  }
  for (size_t i = 0; i < (size_t)r->count; i++)
    memcpy(U + i * all, psi + i * functions, functions * sizeof *U);
  int code = r->shapes != NULL ? density_write(scene, r->shapes, (int)r->count, U) : DONE;
  if (code == DONE && r->vtu != NULL) code = density_view(scene, r->vtu, (int)r->count, U);
  free(U);
  return code;
}

static int find_states(const modes_request *r, const problem *scene,
                       const dvi_schroedinger *equation)
{
  const int64_t functions = dvi_space_functions(dvi_schroedinger_space(equation));
  double *energy = calloc((size_t)r->count * (size_t)(1 + functions), sizeof *energy);
  if (energy == NULL) {
    complain("out of memory");
    return FAILED;
  }
  double *const psi = energy + r->count;
  const dvi_status status = dvi_schroedinger_modes(equation, (int)r->count, energy, psi);
  int code = status == DVI_OK ? print_spectrum(r, scene, energy) : library_error(status);
  if (status == DVI_BAD_SIZE) code = USAGE; /* more states than the space has */
  if (code == DONE) code = write_states(r, scene, psi);
  free(energy);
  return code;
}

static int find_spectrum(const modes_request *r, const problem *scene, const dvi_density *density)
{
  const dvi_schroedinger *equation = dvi_scene_schroedinger(scene->scene);
  if (equation != NULL && r->at_static_state)
    return usage_error("modes: --static is not for schroedinger, whose modes are its stationary "
                       "states; dvi solve finds the ground state with 'solve: ground'");
  if (equation != NULL && !isnan(r->near))
    return usage_error("modes: --near is not for schroedinger, whose states are found from the "
                       "lowest one on; --count K finds more");
  if (equation != NULL) return find_states(r, scene, equation);
  const size_t all = (size_t)density_coefficients(density), count = (size_t)r->count;
  const dvi_modes_options options = {
      .size = sizeof options, .count = (int)r->count, .shift = isnan(r->near) ? 0.0 : r->near};
  double *eigenvalue = calloc(count + all + count * all, sizeof *eigenvalue);
  if (eigenvalue == NULL) {
    complain("out of memory");
    return FAILED;
  }
  double *const U = eigenvalue + count, *const mode = U + all;
  dvi_status status = r->at_static_state ? find_state(scene, U) : DVI_OK;
  if (status == DVI_OK) status = dvi_density_modes(density, &options, U, eigenvalue, mode);
  int code = status == DVI_OK ? print_spectrum(r, scene, eigenvalue) : library_error(status);
  if (status == DVI_BAD_SIZE) code = USAGE; /* more modes than the field has */
  if (code == DONE && r->shapes != NULL)
    code = density_write(scene, r->shapes, (int)r->count, mode);
  if (code == DONE && r->vtu != NULL) code = density_view(scene, r->vtu, (int)r->count, mode);
  free(eigenvalue);
  return code;
}

static const char *const details[] = {
    "A mode is a motion in which all points swing with one frequency omega, the square root of an "
    "eigenvalue of K x = lambda M x with the field's stiffness and mass. A part of the mesh "
    "without "
    "a fixed value has a mode of frequency zero, which is counted and left out. A potential takes "
    "no part.\n",
    "The modes of an electromagnetic field ('field: maxwell') are those without charge, and their "
    "shapes are E. The static fields are counted and left out, absorbing walls count as pmc, and "
    "sigma as 0. Damped modes, and those of a grid that only yee advances, are found by dvi "
    "spectrum in the columns of a run.\n",
    "The modes of a solid ('field: elastic') are small vibrations about rest. Motions of the whole "
    "solid are counted and left out, and damping, loads and obstacles take no part.\n",
    "The modes of fields with a density (section 'density') are those of small motions about 0, or "
    "with --static about the static state near the scene's start. All parts of the density count. "
    "With one-forms the eigenvalues are the lambda of H x = lambda N x with the Hessians of the "
    "energy and of the norm, in which real and imaginary parts are two. Of the section "
    "schroedinger "
    "they are the energies of stationary states without interaction, each once.\n",
    "mpirun -np N dvi modes SCENE.yaml lets N processes share the mesh of a wave or of Maxwell's "
    "field. --vtu takes one process.\n",
    "Columns of --csv: index, eigenvalue, omega, ascending. Columns of --shapes: the position of "
    "the vertices, and the value of each component of each mode.\n",
    "Examples:\n"
    "  dvi modes drum.yaml --count 6\n"
    "  dvi modes drum.yaml --count 3 --near 100 --csv - --vtu modes.vtu\n"
    "  dvi modes cavity.yaml --vtu modes.vtu\n",
    NULL,
};

static const option command_options[] = {
    {.name = "count",
     OPTION_AT(modes_request, count),
     .value = "K",
     .help = "how many modes; default: 6"},
    {.name = "near",
     OPTION_AT(modes_request, near),
     .value = "X",
     .help = "those whose eigenvalues are nearest to X; default: the lowest"},
    {.name = "csv",
     OPTION_AT(modes_request, csv),
     .value = "FILE",
     .help = "write the modes' eigenvalues as CSV; - for standard output",
     .is_csv = true},
    {.name = "vtu",
     OPTION_AT(modes_request, vtu),
     .value = "FILE.vtu",
     .help = "write the mesh and the modes' shapes for ParaView"},
    {.name = "static",
     OPTION_AT(modes_request, at_static_state),
     .help = "of a density: about the static state near the start; default: about 0"},
    {.name = "shapes",
     OPTION_AT(modes_request, shapes),
     .value = "FILE",
     .help = "of a density: write the modes' values as CSV"},
    {.name = "set",
     OPTION_AT(modes_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the scene; may be repeated"},
    {.name = NULL},
};

static const command_line command = {
    .name = "modes",
    .synopsis = "SCENE.yaml [OPTIONS]",
    .operand = "SCENE.yaml",
    .summary = "Compute the modes of a scene's field: eigenvalues, frequencies, shapes.\n",
    .options = command_options,
    .details = details,
};

static int modes_alone(int argc, char **argv)
{
  modes_request r = {.count = 6, .near = (double)NAN};
  const char *name;
  const dvi_field *field;
  const dvi_density *density;
  const dvi_elastic *solid;
  problem *scene;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  const named_file files[] = {{"csv", r.csv}, {"vtu", r.vtu}, {"shapes", r.shapes}};
  if (r.count > 100000) return usage_error("modes: --count %ld: 100000 at most", r.count);
  code = outputs_distinct("modes", 3, files);
  if (code != DONE) return code;
  code = open_any(name, &r.settings, &scene);
  if (code == DONE && ranks_count() > 1 && (code = check_shared(&r, scene)) != DONE)
    problem_destroy(&scene);
  if (code == DONE) code = field_choose("modes", name, &scene, &field, &density, &solid);
  if (code != DONE) return code;
  if (density == NULL && (r.at_static_state || r.shapes != NULL))
    code = usage_error("modes: --static and --shapes are for fields with a density");
  else if (ranks_count() > 1)
    code = find_shared(&r, scene, field);
  else
    code = density != NULL ? find_spectrum(&r, scene, density)
                           : find_modes(&r, scene, field, solid);
  problem_destroy(&scene);
  return code;
}

int modes_command(int argc, char **argv)
{
  const int code = ranks_begin();
  return ranks_end(code == DONE ? modes_alone(argc, argv) : code);
}
