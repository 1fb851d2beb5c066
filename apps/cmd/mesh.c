/* dvi mesh, which audits and repairs meshes. */
#include <dvi/audit.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "csv/table.h"
#include "load/open_mesh.h"
#include "module/ranks.h"
#include "module/store.h"

enum { NAME_SIZE = 48 };

/* The options. */
typedef struct mesh_request {
  mesh_sizes sizes;
  const char *repair, *write, *csv;
} mesh_request;

/* ---- the table ---- */

static const char *plural_of(const dvi_mesh *mesh, int k)
{
  static const char *const simplices[] = {"vertices", "edges", "triangles", "tetrahedra",
                                          "simplices_4"},
                           *const boxes[] = {"vertices", "edges", "rectangles", "boxes", "boxes_4"};
  return dvi_mesh_kind(mesh) == DVI_BOXES ? boxes[k] : simplices[k];
}

/* Add one row for each degree, as betti_0, betti_1 and so on. */
static void add_degrees(result_table *rows, const dvi_mesh_report *report, const char *name,
                        double (*value)(const dvi_degree_report *))
{
  for (int k = 0; k <= report->dimension; k++) {
    char text[NAME_SIZE];
    (void)snprintf(text, sizeof text, "%s_%d", name, k);
    table_quantity(rows, text, value(&report->degree[k]));
  }
}

#define VALUE(function, member)                      \
  static double function(const dvi_degree_report *d) \
  {                                                  \
    return (double)d->member;                        \
  }
VALUE(boundary_of, boundary)
VALUE(smallest_of, smallest)
VALUE(largest_of, largest)
VALUE(total_of, total)
VALUE(negative_of, negative)
VALUE(zero_of, zero)
VALUE(star_of, smallest_star)
VALUE(worst_of, worst)
VALUE(fastest_of, fastest)
VALUE(step_of, step)
VALUE(steps_of, steps)
#undef VALUE

static double betti_of(const dvi_degree_report *d)
{
  return d->betti >= 0 ? (double)d->betti : (double)NAN;
}

static const table_column columns[] = {{"quantity", NULL}, {"value", "%.12g"}, {NULL, NULL}};

static result_table *make_table(const dvi_mesh *mesh, const dvi_mesh_report *report)
{
  static const struct {
    const char *name;
    double (*value)(const dvi_degree_report *);
  } each[] = {{"betti", betti_of},
              {"boundary", boundary_of},
              {"smallest_volume", smallest_of},
              {"largest_volume", largest_of},
              {"total_volume", total_of},
              {"negative_duals", negative_of},
              {"zero_duals", zero_of},
              {"smallest_star", star_of},
              {"worst_star", worst_of},
              {"fastest", fastest_of},
              {"step", step_of},
              {"steps", steps_of}};
  result_table *rows = table_create(columns);
  table_quantity(rows, "dimension", report->dimension);
  table_quantity(rows, "space", report->space);
  for (int k = 0; k <= report->dimension; k++)
    table_quantity(rows, plural_of(mesh, k), (double)report->degree[k].count);
  table_quantity(rows, "manifold", report->is_manifold);
  table_quantity(rows, "pinches", (double)report->pinches);
  table_quantity(rows, "orientable", report->is_orientable);
  table_quantity(rows, "quality", report->quality);
  table_quantity(rows, "mean_quality", report->mean_quality);
  table_quantity(rows, "worst_cell", (double)report->worst_cell);
  table_quantity(rows, "dual_ratio", report->dual_ratio);
  table_quantity(rows, "length", report->length);
  for (size_t i = 0; i < sizeof each / sizeof *each; i++)
    add_degrees(rows, report, each[i].name, each[i].value);
  return rows;
}

/* ---- words ---- */

static void print_degrees(const dvi_mesh *mesh, const dvi_mesh_report *report, FILE *stream)
{
  static const table_column titles[] = {
      {"cells", NULL},        {"count", "%.0f"}, {"betti", "%.0f"}, {"smallest", "%.3g"},
      {"largest", "%.3g"},    {"total", "%.6g"}, {"zero", "%.0f"},  {"negative", "%.0f"},
      {"least star", "%.3g"}, {"step", "%.3g"},  {"steps", "%.3g"}, {NULL, NULL}};
  result_table *rows = table_create(titles);
  for (int k = 0; k <= report->dimension; k++) {
    const dvi_degree_report *d = &report->degree[k];
    table_text(rows, plural_of(mesh, k));
    table_number(rows, (double)d->count);
    table_number(rows, betti_of(d));
    table_number(rows, d->smallest);
    table_number(rows, d->largest);
    table_number(rows, d->total);
    table_number(rows, (double)d->zero);
    table_number(rows, (double)d->negative);
    table_number(rows, d->smallest_star);
    table_number(rows, d->step);
    table_number(rows, d->steps);
  }
  if (table_good(rows)) table_print(rows, stream, 0, 0, table_rows(rows));
  table_destroy(&rows);
}

/* Print the number of a k-cell, and where its centre is. */
static void print_place(const dvi_mesh *mesh, int k, int64_t cell, FILE *stream)
{
  const int space = dvi_mesh_space(mesh);
  double *centre = calloc((size_t)(dvi_mesh_count(mesh, k) * space), sizeof *centre);
  (void)fprintf(stream, "%lld", (long long)cell);
  if (centre != NULL && dvi_mesh_centres(mesh, k, centre) == DVI_OK)
    for (int l = 0; l < space; l++)
      (void)fprintf(stream, "%s%.4g%s", l > 0 ? ", " : ", at (", centre[cell * space + l],
                    l + 1 == space ? ")" : "");
  free(centre);
}

/* Print where the worst star of a degree is. */
static void print_worst(const dvi_mesh *mesh, const dvi_mesh_report *report, FILE *stream)
{
  for (int k = 0; k <= report->dimension; k++) {
    const dvi_degree_report *d = &report->degree[k];
    if (d->negative == 0) continue;
    (void)fprintf(stream, "the worst dual of the %s is that of ", plural_of(mesh, k));
    print_place(mesh, k, d->worst, stream);
    (void)fputc('\n', stream);
  }
}

/* Print why and where the mesh is no manifold. */
static void print_fault(const dvi_mesh *mesh, const dvi_mesh_report *report, FILE *stream)
{
  if (report->is_manifold) return;
  (void)fprintf(stream, "no manifold: ");
  if (report->branching >= 0) {
    (void)fprintf(stream, "more than two cells, and so no star, at number ");
    print_place(mesh, report->dimension - 1, report->branching, stream);
    (void)fprintf(stream, ", of the %s\n", plural_of(mesh, report->dimension - 1));
  } else if (report->pinched >= 0) {
    (void)fprintf(stream, "%lld pinched, where cells do not hang together, among them vertex ",
                  (long long)report->pinches);
    print_place(mesh, 0, report->pinched, stream);
    (void)fputc('\n', stream);
  } else {
    (void)fprintf(stream, "%lld edges are pinched, where cells do not hang together\n",
                  (long long)report->pinches);
  }
}

static void print_advice(const dvi_mesh_report *report, FILE *stream)
{
  if (report->advice & DVI_ADVICE_FLIP)
    (void)fprintf(stream, "what helps: --repair flip gives edges duals that are not negative\n");
  if (report->advice & DVI_ADVICE_GLUE)
    (void)fprintf(stream, "what helps: --repair glue makes boxes of simplices with one "
                          "circumcentre\n");
  if (report->advice & DVI_ADVICE_STAR)
    (void)fprintf(stream, "what helps: the barycentric star or Whitney's, which are positive\n");
}

static void print_report(const char *name, const dvi_mesh *mesh, const dvi_mesh_report *report,
                         FILE *stream)
{
  (void)fprintf(stream, "%s: dimension %d in %d coordinates, %s, %s\n", name, report->dimension,
                report->space, report->is_manifold ? "a manifold" : "no manifold",
                report->is_orientable ? "orientable" : "not orientable");
  for (int i = 2; dvi_mesh_part_name(mesh, i) != NULL; i++)
    (void)fprintf(stream, "%s%s", i == 2 ? "parts: " : ", ", dvi_mesh_part_name(mesh, i));
  if (dvi_mesh_part_name(mesh, 2) != NULL) (void)fputc('\n', stream);
  print_degrees(mesh, report, stream);
  (void)fprintf(stream, "quality %.3g at least (cell %lld), %.3g in the mean\n", report->quality,
                (long long)report->worst_cell, report->mean_quality);
  if (isfinite(report->dual_ratio))
    (void)fprintf(stream, "positive dual edges at least %.3g of their edges\n", report->dual_ratio);
  print_worst(mesh, report, stream);
  print_fault(mesh, report, stream);
  print_advice(report, stream);
}

/* ---- the command ---- */

static int audit(const mesh_request *r, const char *name, const dvi_mesh *mesh, bool is_last)
{
  dvi_mesh_report report;
  const dvi_status status = dvi_mesh_audit(mesh, NULL, &report);
  if (status != DVI_OK) return library_error(status);
  print_report(name, mesh, &report, r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout);
  if (r->csv == NULL || !is_last) return DONE;
  result_table *rows = make_table(mesh, &report);
  return table_finish(&rows, r->csv) ? DONE : FAILED;
}

static int repair(const mesh_request *r, dvi_mesh **mesh)
{
  dvi_mesh *repaired = NULL;
  int64_t flips = 0;
  const bool flip = strcmp(r->repair, "flip") == 0;
  const dvi_status status = flip ? dvi_mesh_flip(*mesh, &repaired, &flips)
                                 : dvi_mesh_glue(*mesh, &repaired);
  if (status != DVI_OK) return library_error(status);
  dvi_mesh_destroy(mesh);
  *mesh = repaired;
  FILE *stream = r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout;
  if (flip)
    (void)fprintf(stream, "\n%lld edges flipped\n\n", (long long)flips);
  else
    (void)fprintf(stream, "\nglued to boxes\n\n");
  return DONE;
}

static const char *const details[] = {
    "The mesh is that of a generator: "
    "interval, box, kuhn, kuhn-torus, staggered, bcc-torus, disk, annulus, icosphere, torus, "
    "genus-2, cylinder, ball, simplex-4, simplex-5, cell-16, cell-600, cross-5. Or it is read from "
    "a file: MSH 2.2 or 4.1, OFF, PLY, or FILE.h5 of --write.\n",
    "A row for the cells of each degree k: how many; Betti numbers, which count holes; volumes; "
    "circumcentric dual cells of no and of negative volume; the least entry of the star M_k; the "
    "longest stable step of leapfrog on k-forms; steps for the mesh's length at speed 1.\n",
    "Rows of --csv: quantity,value, such as vertices, betti_0, orientable, smallest_star_1. With "
    "--repair they are those of the repaired mesh.\n",
    "Examples:\n"
    "  dvi mesh kuhn --cells 4,4,4 --repair glue\n"
    "  dvi mesh part.msh --csv - --repair flip --write better.msh\n",
    NULL,
};

static const option command_options[] = {
    MESH_SIZE_OPTIONS(mesh_request, sizes),
    {.name = "repair",
     OPTION_AT(mesh_request, repair),
     .value = "flip|glue",
     .help = "flip edges of triangles, or glue simplices to boxes; both meshes are shown"},
    {.name = "write",
     OPTION_AT(mesh_request, write),
     .value = "FILE",
     .help = "write the mesh as .msh, .off, .ply or .vtu, or as .h5 for several processes"},
    {.name = "csv",
     OPTION_AT(mesh_request, csv),
     .value = "FILE",
     .help = "write all quantities as CSV; - for standard output",
     .is_csv = true},
    {.name = NULL},
};

static const command_line command = {
    .name = "mesh",
    .synopsis = "FILE|GENERATOR [OPTIONS]",
    .operand = "FILE|GENERATOR",
    .summary = "Audit a mesh: counts, holes, quality, dual cells, stable steps, and what helps.\n",
    .options = command_options,
    .details = details,
};

static int write_mesh(const dvi_mesh *mesh, const char *path)
{
  if (store_is_wanted(path)) return ranks_write_mesh(mesh, path);
  const dvi_status status = dvi_mesh_write(mesh, path, 0, NULL);
  return status == DVI_OK ? DONE : library_error(status);
}

static int run(const mesh_request *r, const char *name)
{
  dvi_mesh *mesh = NULL;
  int code = open_mesh("mesh", &r->sizes, name, &mesh);
  if (code == DONE) code = audit(r, name, mesh, r->repair == NULL);
  if (code == DONE && r->repair != NULL) code = repair(r, &mesh);
  if (code == DONE && r->repair != NULL) code = audit(r, name, mesh, true);
  if (code == DONE && r->write != NULL) {
    code = write_mesh(mesh, r->write);
  }
  dvi_mesh_destroy(&mesh);
  return code;
}

int mesh_command(int argc, char **argv)
{
  mesh_request r = {.repair = NULL};
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  if (r.repair != NULL && strcmp(r.repair, "flip") != 0 && strcmp(r.repair, "glue") != 0)
    return usage_error("mesh: --repair is flip or glue, not '%s'", r.repair);
  const named_file files[] = {{"csv", r.csv}, {"write", r.write}};
  code = outputs_distinct("mesh", 2, files);
  return code == DONE ? run(&r, name) : code;
}
