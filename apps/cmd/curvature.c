/* dvi curvature, which tells the curvature of meshes, checks it by holonomy, and draws fields of
 * directions with given singularities. */
#include <dvi/curvature.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/numbers.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "csv/table.h"
#include "load/open_mesh.h"

enum { SINGULAR_MAX = 256, NAME_SIZE = 64 };

/* The options. */
typedef struct curvature_request {
  mesh_sizes sizes;
  words singular;
  const char *csv, *hinges, *vtu;
  double angle;
  long symmetry;
} curvature_request;

/* A mesh with the curvature of its hinges. */
typedef struct study {
  const curvature_request *request;
  const char *name;
  dvi_mesh *mesh;
  dvi_connection *plain, *lifted; /* `lifted` is NULL if there is no lift */
  char why[256];                  /* why there is none */
  int n;
  int64_t hinges, inner;
  double *deficit, *turn, *spin; /* [hinges], NaN where there is none */
  int64_t least, most;           /* inner hinges of the smallest and the largest deficit, or -1 */
  double worst, loosest, worst_lift;
  dvi_gauss_bonnet sums; /* of surfaces */
  bool has_field;
  double worst_index, mismatch;
  int64_t loops;
} study;

static const double pi = 3.14159265358979323846;

static const char *const units[] = {"vertex", "edge", "triangle"};

static int status_code(dvi_status status)
{
  return status == DVI_OK ? DONE : library_error(status);
}

/* ---- holonomy ---- */

static void mark_boundary(study *s)
{
  int64_t count;
  const int *rim = dvi_mesh_part_cells(s->mesh, "boundary", s->n - 2, &count);
  for (int64_t h = 0; h < s->hinges; h++) s->turn[h] = s->spin[h] = 0;
  for (int64_t i = 0; i < count; i++) s->turn[rim[i]] = s->spin[rim[i]] = (double)NAN;
  s->inner = s->hinges - count;
}

/* Compare the turns of the holonomy around the inner hinges with their deficits. */
static int compare(const dvi_connection *c, const study *s, double period, double *turn,
                   double *worst, double *loosest)
{
  for (int64_t h = 0; h < s->hinges; h++) {
    double rest;
    if (isnan(turn[h])) continue;
    const dvi_status status = dvi_connection_turn(c, h, &turn[h], &rest);
    if (status != DVI_OK) return library_error(status);
    *worst = fmax(*worst, fabs(remainder(turn[h] - s->deficit[h], period)));
    *loosest = fmax(*loosest, rest);
  }
  return DONE;
}

static void note_extremes(study *s)
{
  s->least = s->most = -1;
  for (int64_t h = 0; h < s->hinges; h++) {
    if (isnan(s->turn[h])) continue;
    if (s->least < 0 || s->deficit[h] < s->deficit[s->least]) s->least = h;
    if (s->most < 0 || s->deficit[h] > s->deficit[s->most]) s->most = h;
  }
}

/* A mesh without a lift is no failure. */
static int lift(study *s)
{
  const dvi_connection_options options = {.size = sizeof options, .spin = 1};
  const dvi_status status = dvi_connection_create(s->mesh, &options, &s->lifted);
  if (status == DVI_OK) return compare(s->lifted, s, 4 * pi, s->spin, &s->worst_lift, &s->loosest);
  if (status != DVI_UNSUPPORTED) return library_error(status);
  (void)snprintf(s->why, sizeof s->why, "%s", dvi_last_error());
  for (int64_t h = 0; h < s->hinges; h++) s->spin[h] = (double)NAN;
  return DONE;
}

static int measure(study *s)
{
  s->n = dvi_mesh_dimension(s->mesh);
  s->hinges = dvi_mesh_count(s->mesh, s->n - 2);
  s->deficit = calloc(3 * (size_t)s->hinges + 1, sizeof *s->deficit);
  if (s->deficit == NULL) return library_error(DVI_NO_MEMORY);
  s->turn = s->deficit + s->hinges;
  s->spin = s->turn + s->hinges;
  int code = status_code(dvi_hinge_deficits(s->mesh, NULL, s->deficit));
  if (code == DONE && s->n == 2) code = status_code(dvi_gauss_bonnet_of(s->mesh, NULL, &s->sums));
  if (code == DONE) code = status_code(dvi_connection_create(s->mesh, NULL, &s->plain));
  if (code != DONE) return code;
  mark_boundary(s);
  note_extremes(s);
  code = compare(s->plain, s, 2 * pi, s->turn, &s->worst, &s->loosest);
  return code == DONE ? lift(s) : code;
}

/* ---- fields of directions ---- */

/* Read VERTEX=INDEX. */
static int read_pair(const char *text, dvi_singularity *at)
{
  char copy[NAME_SIZE];
  double vertex;
  const char *sign = strchr(text, '=');
  const size_t length = sign != NULL ? (size_t)(sign - text) : sizeof copy;
  if (length < sizeof copy) {
    memcpy(copy, text, length);
    copy[length] = '\0';
    if (parse_number(copy, &vertex) && vertex == floor(vertex) && fabs(vertex) < 1e15 &&
        parse_number(sign + 1, &at->index)) {
      at->vertex = (int64_t)vertex;
      return DONE;
    }
  }
  return usage_error("curvature: --singular %s: a vertex and its index are wanted, as in 12=1",
                     text);
}

/* Read the pairs of all --singular, with commas between them. */
static int read_singular(const words *given, dvi_singularity *at, int *count)
{
  *count = 0;
  for (int i = 0; i < given->count; i++) {
    char copy[1024];
    if (strlen(given->word[i]) >= sizeof copy)
      return usage_error("curvature: --singular has more than %zu letters; give it again",
                         sizeof copy - 1);
    (void)snprintf(copy, sizeof copy, "%s", given->word[i]);
    for (char *item = copy, *next; item != NULL; item = next) {
      next = strchr(item, ',');
      if (next != NULL) *next++ = '\0';
      if (*count == SINGULAR_MAX)
        return usage_error("curvature: --singular: at most %d singularities", SINGULAR_MAX);
      const int code = read_pair(item, &at[(*count)++]);
      if (code != DONE) return code;
    }
  }
  return DONE;
}

/* Find how far the holonomy around vertices is from 2 pi times the indices. */
static void check_indices(study *s, const dvi_connection *adjusted, const dvi_singularity *at,
                          int count)
{
  for (int64_t v = 0; v < s->hinges; v++) {
    double angle, index = 0;
    if (isnan(s->turn[v]) || dvi_connection_turn(adjusted, v, &angle, NULL) != DVI_OK) continue;
    for (int i = 0; i < count; i++)
      if (at[i].vertex == v) index = at[i].index;
    s->worst_index = fmax(s->worst_index, fabs(remainder(angle - 2 * pi * index, 2 * pi)));
  }
}

static int write_field(study *s, const dvi_connection *adjusted)
{
  const int64_t cells = dvi_mesh_count(s->mesh, 2);
  const int space = dvi_mesh_space(s->mesh);
  double *direction = calloc((size_t)(cells * (2 + space)) + 1, sizeof *direction);
  if (direction == NULL) return library_error(DVI_NO_MEMORY);
  double *vector = direction + 2 * cells;
  dvi_status status = dvi_connection_directions(adjusted, 0, s->request->angle * pi / 180,
                                                (int)s->request->symmetry, direction, &s->mismatch);
  if (status == DVI_OK) status = dvi_connection_vectors(adjusted, direction, vector);
  const dvi_view views[] = {
      {.name = "direction", .values = vector, .components = space, .degree = 2},
      {.name = "deficit", .values = s->deficit, .components = 1, .degree = 0}};
  if (status == DVI_OK && s->request->vtu != NULL)
    status = dvi_mesh_write(s->mesh, s->request->vtu, 2, views);
  free(direction);
  return status_code(status);
}

/* Write the deficits of a surface that has no field without singularities. */
static int write_deficits(const study *s)
{
  const dvi_view view = {.name = "deficit", .values = s->deficit, .components = 1, .degree = 0};
  return status_code(dvi_mesh_write(s->mesh, s->request->vtu, 1, &view));
}

static bool has_constant_field(const study *s)
{
  return s->sums.euler == 0 && dvi_mesh_orientation(s->mesh) != NULL;
}

static int make_field(study *s)
{
  dvi_singularity at[SINGULAR_MAX];
  dvi_adjust_options options = {
      .size = sizeof options, .singularity = at, .symmetry = (int)s->request->symmetry};
  dvi_connection *adjusted = NULL;
  if (s->request->singular.count == 0 && s->request->vtu == NULL) return DONE;
  if (s->request->singular.count == 0 && s->n == 2 && !has_constant_field(s))
    return write_deficits(s);
  int code = read_singular(&s->request->singular, at, &options.singularities);
  if (code != DONE) return code;
  code = status_code(dvi_connection_adjust(s->plain, &options, &adjusted));
  if (code == DONE) {
    s->has_field = true;
    s->loops = dvi_connection_loops(adjusted);
    check_indices(s, adjusted, at, options.singularities);
    code = write_field(s, adjusted);
  }
  dvi_connection_destroy(&adjusted);
  return code;
}

/* ---- tables ---- */

static double deficit_at(const study *s, int64_t hinge)
{
  return hinge >= 0 ? s->deficit[hinge] : (double)NAN;
}

static void add_sums(result_table *rows, const dvi_gauss_bonnet *sums)
{
  table_quantity(rows, "deficits", sums->deficits);
  table_quantity(rows, "turning", sums->turning);
  table_quantity(rows, "euler", (double)sums->euler);
  table_quantity(rows, "two_pi_chi", 2 * pi * (double)sums->euler);
  table_quantity(rows, "difference", sums->difference);
}

static int write_quantities(const study *s)
{
  static const table_column columns[] = {{"quantity", NULL}, {"value", "%.12g"}, {NULL, NULL}};
  if (s->request->csv == NULL) return DONE;
  result_table *rows = table_create(columns);
  table_quantity(rows, "dimension", s->n);
  table_quantity(rows, "hinges", (double)s->hinges);
  table_quantity(rows, "inner_hinges", (double)s->inner);
  if (s->n == 2) add_sums(rows, &s->sums);
  table_quantity(rows, "deficit_min", deficit_at(s, s->least));
  table_quantity(rows, "at_min", s->least >= 0 ? (double)s->least : (double)NAN);
  table_quantity(rows, "deficit_max", deficit_at(s, s->most));
  table_quantity(rows, "at_max", s->most >= 0 ? (double)s->most : (double)NAN);
  table_quantity(rows, "holonomy_error", s->worst);
  table_quantity(rows, "lift_error", s->lifted != NULL ? s->worst_lift : (double)NAN);
  table_quantity(rows, "hinge_error", s->loosest);
  if (s->has_field) {
    table_quantity(rows, "loops", (double)s->loops);
    table_quantity(rows, "index_error", s->worst_index);
    table_quantity(rows, "mismatch", s->mismatch);
  }
  return table_finish(&rows, s->request->csv) ? DONE : FAILED;
}

/* Write the vertices of a hinge with blanks between them. */
static void name_vertices(const study *s, int64_t hinge, char text[NAME_SIZE])
{
  int width = 1;
  const int *vertex = s->n > 2 ? dvi_mesh_vertices(s->mesh, s->n - 2, &width) : NULL;
  size_t at = 0;
  for (int i = 0; i < width && at < NAME_SIZE; i++)
    at += (size_t)snprintf(text + at, NAME_SIZE - at, "%s%lld", i > 0 ? " " : "",
                           vertex != NULL ? (long long)vertex[hinge * width + i]
                                          : (long long)hinge);
}

static int write_hinges(const study *s)
{
  static const table_column columns[] = {
      {"hinge", "%.0f"},    {"vertices", NULL}, {"cells", "%.0f"},   {"boundary", "%.0f"},
      {"deficit", "%.12g"}, {"turn", "%.12g"},  {"lifted", "%.12g"}, {NULL, NULL}};
  if (s->request->hinges == NULL) return DONE;
  result_table *rows = table_create(columns);
  for (int64_t h = 0; h < s->hinges; h++) {
    char vertices[NAME_SIZE];
    int64_t cells;
    (void)dvi_connection_ring(s->plain, h, &cells);
    name_vertices(s, h, vertices);
    table_number(rows, (double)h);
    table_text(rows, vertices);
    table_number(rows, (double)cells);
    table_number(rows, isnan(s->turn[h]) ? 1 : 0);
    table_number(rows, s->deficit[h]);
    table_number(rows, s->turn[h]);
    table_number(rows, s->spin[h]);
  }
  return table_finish(&rows, s->request->hinges) ? DONE : FAILED;
}

/* ---- words ---- */

static void print_place(const study *s, int64_t hinge, FILE *stream)
{
  char vertices[NAME_SIZE];
  name_vertices(s, hinge, vertices);
  (void)fprintf(stream, "%s %lld", units[s->n - 2], (long long)hinge);
  if (s->n > 2) (void)fprintf(stream, " (vertices %s)", vertices);
}

static void print_deficits(const study *s, FILE *stream)
{
  if (s->least < 0) {
    (void)fprintf(stream, "all hinges are on the boundary\n");
    return;
  }
  (void)fprintf(stream, "deficits from %.12g at ", s->deficit[s->least]);
  print_place(s, s->least, stream);
  (void)fprintf(stream, " to %.12g at ", s->deficit[s->most]);
  print_place(s, s->most, stream);
  (void)fputc('\n', stream);
}

static void print_holonomy(const study *s, FILE *stream)
{
  const bool has_sides = dvi_mesh_orientation(s->mesh) != NULL;
  if (s->least < 0) return;
  (void)fprintf(stream,
                "holonomy in %s(%d): turns by the deficits modulo 2 pi up to %.1e, and fixes "
                "hinges up to %.1e\n",
                has_sides ? "SO" : "O", s->n, s->worst, s->loosest);
  if (s->lifted != NULL)
    (void)fprintf(stream, "holonomy in Spin(%d): turns by the deficits modulo 4 pi up to %.1e\n",
                  s->n, s->worst_lift);
  else
    (void)fprintf(stream, "no lift: %s\n", s->why);
}

static void print_report(const study *s, FILE *stream)
{
  const dvi_gauss_bonnet *sums = &s->sums;
  (void)fprintf(stream, "%s: dimension %d in %d coordinates, %lld hinges, %lld of them inside\n",
                s->name, s->n, dvi_mesh_space(s->mesh), (long long)s->hinges, (long long)s->inner);
  if (s->n == 2)
    (void)fprintf(stream,
                  "Gauss-Bonnet: deficits %.12g + turning %.12g = 2 pi chi %.12g, chi = %lld, up "
                  "to %.1e\n",
                  sums->deficits, sums->turning, 2 * pi * (double)sums->euler,
                  (long long)sums->euler, sums->difference);
  print_deficits(s, stream);
  print_holonomy(s, stream);
  if (s->has_field)
    (void)fprintf(stream,
                  "directions: holonomy 2 pi times the indices up to %.1e, mismatch at edges %.1e, "
                  "%lld loops\n",
                  s->worst_index, s->mismatch, (long long)s->loops);
  else if (s->request->vtu != NULL)
    (void)fprintf(stream, "directions: none, %s\n",
                  dvi_mesh_orientation(s->mesh) == NULL
                      ? "because the surface is not orientable"
                      : "because they need indices that sum to chi: name vertices by --singular");
}

/* ---- the command ---- */

static bool is_standard(const char *path)
{
  return path != NULL && strcmp(path, "-") == 0;
}

static int run(study *s)
{
  const curvature_request *r = s->request;
  int code = open_mesh("curvature", &r->sizes, s->name, &s->mesh);
  if (code == DONE && (dvi_mesh_dimension(s->mesh) < 2 || dvi_mesh_kind(s->mesh) == DVI_BOXES))
    code = status_code(dvi_hinge_deficits(s->mesh, NULL, NULL));
  if (code == DONE) code = measure(s);
  if (code == DONE) code = make_field(s);
  if (code == DONE) {
    print_report(s, is_standard(r->csv) || is_standard(r->hinges) ? stderr : stdout);
    code = write_quantities(s);
  }
  if (code == DONE) code = write_hinges(s);
  dvi_connection_destroy(&s->plain);
  dvi_connection_destroy(&s->lifted);
  dvi_mesh_destroy(&s->mesh);
  free(s->deficit);
  return code;
}

static const char *const details[] = {
    "The mesh is that of a generator, such as icosphere, torus, genus-2, disk, annulus, ball, "
    "cell-600 or simplex-5, or of a file (MSH 2.2 or 4.1, OFF, PLY), as for dvi mesh. Its cells "
    "are triangles, tetrahedra or 4-simplices. Hinges are their faces of dimension n - 2.\n",
    "Rows of --csv: quantity,value, such as deficits, turning, two_pi_chi, difference, "
    "deficit_min, deficit_max, holonomy_error, lift_error. Rows of --hinges: hinge, vertices, "
    "cells, boundary, deficit, and the turns of the holonomy in SO(n) and lifted to Spin(n), which "
    "are empty at the boundary.\n",
    "--singular makes a field of directions on a surface. The indices sum to Euler's "
    "characteristic, and a vertex of a boundary stands for the whole boundary. Without --singular, "
    "--vtu has directions if Euler's characteristic is 0.\n",
    "Examples:\n"
    "  dvi curvature torus --csv -\n"
    "  dvi curvature cell-600 --hinges edges.csv\n"
    "  dvi curvature icosphere --singular 0=1,5=1 --vtu field.vtu\n",
    NULL,
};

static const option command_options[] = {
    MESH_SIZE_OPTIONS(curvature_request, sizes),
    {.name = "csv",
     OPTION_AT(curvature_request, csv),
     .value = "FILE",
     .help = "write all quantities as CSV; - for standard output",
     .is_csv = true},
    {.name = "hinges",
     OPTION_AT(curvature_request, hinges),
     .value = "FILE",
     .help = "write a row for each hinge as CSV; - for standard output"},
    {.name = "singular",
     OPTION_AT(curvature_request, singular),
     .value = "V=INDEX,...",
     .help = "vertices around which the field of directions turns; may be repeated"},
    {.name = "symmetry",
     OPTION_AT(curvature_request, symmetry),
     .value = "N",
     .help = "fields of N directions, whose indices are multiples of 1/N (default: 1)"},
    {.name = "angle",
     OPTION_AT(curvature_request, angle),
     .value = "A",
     .help = "turn all directions by so many degrees (default: 0)"},
    {.name = "vtu",
     OPTION_AT(curvature_request, vtu),
     .value = "FILE",
     .help = "write deficits and directions; without --singular all indices are 0"},
    {.name = NULL},
};

static const command_line command = {
    .name = "curvature",
    .synopsis = "FILE|GENERATOR [OPTIONS]",
    .operand = "FILE|GENERATOR",
    .summary = "Tell the curvature of a mesh of simplices: deficits, Gauss and Bonnet's theorem, "
               "holonomy.\nMake a field of directions with given singularities.\n",
    .options = command_options,
    .details = details,
};

int curvature_command(int argc, char **argv)
{
  curvature_request r = {.symmetry = 1};
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  if (r.symmetry > 1000000)
    return usage_error("curvature: --symmetry %ld: at most 1000000 directions", r.symmetry);
  const named_file files[] = {{"csv", r.csv}, {"hinges", r.hinges}, {"vtu", r.vtu}};
  code = outputs_distinct("curvature", 3, files);
  if (code == DONE && is_standard(r.csv) && is_standard(r.hinges))
    code = usage_error("curvature: --csv - and --hinges - would be mixed; name a file");
  study s = {.request = &r, .name = name};
  return code == DONE ? run(&s) : code;
}
