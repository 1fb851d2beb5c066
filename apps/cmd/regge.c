/* dvi regge, which measures and solves complexes with lengths. */
#include <dvi/regge.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "csv/series.h"
#include "csv/table.h"
#include "load/open_mesh.h"

/* The options. */
typedef struct regge_request {
  const char *lengths, *write, *csv;
  double lambda, strut;
  long evolve;
  bool solve, euclidean;
  mesh_sizes sizes;
} regge_request;

/* A complex, and its lengths. */
typedef struct study {
  const regge_request *request;
  dvi_mesh *mesh;
  dvi_regge *regge;
  int64_t edges;
  double *length;
  const int *vertex; /* [2*edges] */
} study;

/* ---- opening ---- */

static int open_study(study *s, const char *name)
{
  const int code = open_mesh("regge", &s->request->sizes, name, &s->mesh);
  if (code != DONE) return code;
  const dvi_regge_terms terms = {
      .size = sizeof terms, .mesh = s->mesh, .lambda = s->request->lambda};
  dvi_status status = dvi_regge_create(&terms, &s->regge);
  if (status != DVI_OK) return library_error(status);
  int width;
  s->edges = dvi_mesh_count(s->mesh, 1);
  s->vertex = dvi_mesh_vertices(s->mesh, 1, &width);
  s->length = calloc((size_t)s->edges, sizeof *s->length);
  if (s->length == NULL) return library_error(DVI_NO_MEMORY);
  status = dvi_regge_lengths(s->regge, s->length);
  return status == DVI_OK ? DONE : library_error(status);
}

static void close_study(study *s)
{
  free(s->length);
  dvi_regge_destroy(&s->regge);
  dvi_mesh_destroy(&s->mesh);
}

/* ---- files of lengths ---- */

/* Find the edge of two vertices among the edges, which are sorted. Returns -1 if there is none. */
static int64_t find_edge(const study *s, double from, double to)
{
  const double low = from < to ? from : to, high = from < to ? to : from;
  int64_t first = 0, last = s->edges;
  while (first < last) {
    const int64_t middle = first + (last - first) / 2;
    const int *v = s->vertex + 2 * middle;
    if (v[0] == low && v[1] == high) return middle;
    if (v[0] < low || (v[0] == low && v[1] < high))
      first = middle + 1;
    else
      last = middle;
  }
  return -1;
}

/* `line` [edges] has the lines of the file that edges have been found in, or 0. */
static int take_lengths(study *s, const series_table *table, const char *path, int *line)
{
  const double *from = table->column[0].value, *to = table->column[1].value,
               *length = table->column[2].value;
  for (int i = 0; i < table->rows; i++) {
    const int64_t edge = find_edge(s, from[i], to[i]);
    if (edge < 0)
      return usage_error("regge: '%s': line %d: no edge joins the vertices %g and %g", path, i + 2,
                         from[i], to[i]);
    if (isnan(length[i]))
      return usage_error("regge: '%s': line %d has no number in column 'length'", path, i + 2);
    if (line[edge] != 0)
      return usage_error("regge: '%s': lines %d and %d are of one edge, of the vertices %g and %g",
                         path, line[edge], i + 2, from[i], to[i]);
    line[edge] = i + 2;
    s->length[edge] = length[i];
  }
  return DONE;
}

/* Read the lengths of some edges. The others keep that of their points. */
static int read_lengths(study *s)
{
  static const char *const name[] = {"from", "to", "length"};
  const char *path = s->request->lengths;
  series_table table = {0};
  int code = DONE;
  if (path == NULL) return DONE;
  for (int i = 0; i < 3 && code == DONE; i++)
    if (series_want(&table, name[i]) < 0) code = FAILED;
  if (code == DONE) code = series_read("regge", path, &table);
  int *line = calloc((size_t)s->edges, sizeof *line);
  if (code == DONE)
    code = line != NULL ? take_lengths(s, &table, path, line) : library_error(DVI_NO_MEMORY);
  free(line);
  series_clear(&table);
  return code;
}

static int write_lengths(const study *s)
{
  static const table_column columns[] = {
      {"from", "%.0f"}, {"to", "%.0f"}, {"length", "%.12g"}, {NULL, NULL}};
  if (s->request->write == NULL) return DONE;
  result_table *rows = table_create(columns);
  for (int64_t e = 0; e < s->edges; e++) {
    table_number(rows, s->vertex[2 * e]);
    table_number(rows, s->vertex[2 * e + 1]);
    table_number(rows, s->length[e]);
  }
  return table_finish(&rows, s->request->write) ? DONE : FAILED;
}

/* ---- quantities ---- */

static void add_measures(result_table *rows, const study *s, const dvi_regge_measures *m)
{
  const int n = dvi_mesh_dimension(s->mesh);
  table_quantity(rows, "dimension", n);
  table_quantity(rows, "vertices", (double)dvi_mesh_count(s->mesh, 0));
  table_quantity(rows, "edges", (double)s->edges);
  table_quantity(rows, "cells", (double)dvi_mesh_count(s->mesh, n));
  table_quantity(rows, "hinges", (double)m->hinges);
  table_quantity(rows, "boundary_hinges", (double)m->boundary_hinges);
  table_quantity(rows, "action", m->action);
  table_quantity(rows, "volume", m->volume);
  table_quantity(rows, "deficit_min", m->deficit_min);
  table_quantity(rows, "deficit_max", m->deficit_max);
  table_quantity(rows, "gradient_max", m->gradient_max);
  table_quantity(rows, "schlaefli", m->schlaefli);
  table_quantity(rows, "length_min", m->length_min);
  table_quantity(rows, "length_max", m->length_max);
}

static void add_report(result_table *rows, const dvi_regge_report *report)
{
  table_quantity(rows, "iterations", report->iterations);
  table_quantity(rows, "residual", report->residual);
  table_quantity(rows, "unknowns", (double)report->unknowns);
  table_quantity(rows, "null_directions", (double)report->null_directions);
  table_quantity(rows, "softness", report->softness);
}

static int measure(study *s)
{
  static const table_column columns[] = {{"quantity", NULL}, {"value", "%.12g"}, {NULL, NULL}};
  dvi_regge_measures m;
  dvi_regge_report report;
  dvi_status status = DVI_OK;
  if (s->request->solve) status = dvi_regge_solve(s->regge, NULL, s->length, &report);
  if (status == DVI_OK) status = dvi_regge_measure(s->regge, s->length, &m);
  if (status != DVI_OK) return library_error(status);
  result_table *rows = table_create(columns);
  add_measures(rows, s, &m);
  if (s->request->solve) add_report(rows, &report);
  return table_finish(&rows, s->request->csv) ? write_lengths(s) : FAILED;
}

/* ---- universes ---- */

/* The radius of the 3-sphere of the sections' volume, and that of de Sitter's universe. */
static double radius_of(const study *s, double length)
{
  static const double pi = 3.14159265358979323846;
  const double volume = (double)dvi_mesh_count(s->mesh, 3) * sqrt(2) / 12 * pow(length, 3);
  return cbrt(volume / (2 * pi * pi));
}

/* The Euclidean one, a 4-sphere, ends at its pole. */
static double de_sitter(const regge_request *r, double t)
{
  const double rate = sqrt(r->lambda / 3), ratio = r->euclidean ? cos(rate * t) : cosh(rate * t);
  return ratio > 0 ? ratio / rate : (double)NAN;
}

static int write_universe(const study *s, const double *length, const double *constraint)
{
  static const table_column columns[] = {{"t", "%.6g"},          {"length", "%.12g"},
                                         {"radius", "%.12g"},    {"de_sitter", "%.12g"},
                                         {"constraint", "%.3g"}, {NULL, NULL}};
  const regge_request *r = s->request;
  result_table *rows = table_create(columns);
  for (long i = 0; i <= r->evolve && length[i] > 0; i++) {
    const double t = (double)i * r->strut;
    table_number(rows, t);
    table_number(rows, length[i]);
    table_number(rows, radius_of(s, length[i]));
    table_number(rows, de_sitter(r, t));
    table_number(rows, i < r->evolve && length[i + 1] > 0 ? constraint[i] : (double)NAN);
  }
  return table_finish(&rows, r->csv) ? DONE : FAILED;
}

static int evolve(const study *s)
{
  const regge_request *r = s->request;
  const dvi_regge_universe_options options = {.size = sizeof options,
                                              .strut = r->strut,
                                              .steps = (int)r->evolve,
                                              .euclidean = r->euclidean};
  double *length = calloc((size_t)r->evolve + 1, sizeof *length),
         *constraint = calloc((size_t)r->evolve, sizeof *constraint);
  int code = FAILED;
  dvi_status status = DVI_NO_MEMORY;
  if (length != NULL && constraint != NULL)
    status = dvi_regge_universe(s->regge, &options, length, constraint);
  if (status == DVI_OK || status == DVI_STEP_TOO_LARGE)
    code = write_universe(s, length, constraint);
  if (status != DVI_OK) code = library_error(status);
  free(length);
  free(constraint);
  return code;
}

/* ---- the command ---- */

static const char *const details[] = {
    "The complex is that of a generator, all of whose edges have length 1: simplex-4, cell-16, "
    "cell-600 of tetrahedra, simplex-5, cross-5 of 4-simplices. Or it is a mesh of tetrahedra from "
    "a file (MSH 2.2 or 4.1), or of another generator, with the lengths between its points.\n",
    "Rows: quantity,value. action is the sum of the hinges' volumes times deficits less Lambda "
    "times volume, which is half of the integral of R - 2 Lambda. deficit_min and deficit_max are "
    "of inner hinges; gradient_max is the largest derivative of the action by a length off the "
    "boundary, schlaefli the largest defect of Schlaefli's identity beside its terms. With --solve "
    "the lengths off the boundary make the action stationary, and null_directions counts those "
    "that are free (gauge).\n",
    "With --evolve the rows are t,length,radius,de_sitter,constraint: a closed universe whose "
    "sections are the complex, from its moment of rest, with Lambda > 0.\n",
    "Examples:\n"
    "  dvi regge cell-600\n"
    "  dvi regge ball --cells 2 --lengths curved.csv --solve --write flat.csv\n"
    "  dvi regge cell-600 --lambda 3 --evolve 20 --strut 0.05\n",
    NULL,
};

static const option command_options[] = {
    {.name = "lambda",
     OPTION_AT(regge_request, lambda),
     .value = "L",
     .help = "the cosmological constant (default: 0)"},
    {.name = "lengths",
     OPTION_AT(regge_request, lengths),
     .value = "FILE",
     .help = "read lengths from a CSV file with columns from, to (vertices), length"},
    {.name = "solve",
     OPTION_AT(regge_request, solve),
     .help = "make the action stationary in the lengths off the boundary"},
    {.name = "write",
     OPTION_AT(regge_request, write),
     .value = "FILE",
     .help = "write the lengths as CSV, as --lengths reads them"},
    {.name = "evolve",
     OPTION_AT(regge_request, evolve),
     .value = "STEPS",
     .help = "let a universe of such sections expand by so many layers"},
    {.name = "strut",
     OPTION_AT(regge_request, strut),
     .value = "M",
     .help = "length of the struts between sections (default: 0.05)"},
    {.name = "euclidean",
     OPTION_AT(regge_request, euclidean),
     .help = "struts are lengths, not proper times: a 4-sphere for de Sitter's universe"},
    {.name = "csv",
     OPTION_AT(regge_request, csv),
     .value = "FILE",
     .help = "write the rows to a file (default: standard output)",
     .is_csv = true},
    MESH_SIZE_OPTIONS(regge_request, sizes),
    {.name = NULL},
};

static const command_line command = {
    .name = "regge",
    .synopsis = "FILE|GENERATOR [OPTIONS]",
    .operand = "FILE|GENERATOR",
    .summary =
        "Curvature and action of a complex from the lengths of its edges (Regge calculus).\n",
    .options = command_options,
    .details = details,
};

static int check(const regge_request *r)
{
  if (r->evolve > 0 && (r->solve || r->lengths != NULL || r->write != NULL))
    return usage_error("regge: --evolve chooses its lengths: leave out --solve, --lengths and "
                       "--write");
  if (r->evolve > 1000000)
    return usage_error("regge: --evolve %ld: at most 1000000 layers are possible", r->evolve);
  if (r->evolve == 0 && r->euclidean)
    return usage_error("regge: --euclidean is for --evolve; all else is Euclidean anyway");
  if (r->evolve == 0 && r->strut != 0)
    return usage_error("regge: --strut is for --evolve, and is the length of struts between "
                       "sections");
  const named_file files[] = {{"csv", r->csv}, {"write", r->write}};
  return outputs_distinct("regge", 2, files);
}

int regge_command(int argc, char **argv)
{
  regge_request r = {.csv = "-"};
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  code = check(&r);
  if (code != DONE) return code;
  if (r.strut == 0) r.strut = 0.05;
  study s = {.request = &r};
  code = open_study(&s, name);
  if (code == DONE) code = read_lengths(&s);
  if (code == DONE) code = r.evolve > 0 ? evolve(&s) : measure(&s);
  close_study(&s);
  return code;
}
