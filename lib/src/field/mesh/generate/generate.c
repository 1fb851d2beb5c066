/* The table of generators, and what they have in common. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/generate/draft.h"
#include "field/mesh/part.h"

enum { LEVELS = 12, MOST_CELLS = 1 << 30 };

/* What the options of a generator may be. A grid has numbers of cells along its axes, and a shape,
 * which has no dimensions, its own numbers. */
typedef struct kind {
  const char *name;
  dvi__generator *generate;
  int least, most; /* dimensions of a grid, or 0 */
  int numbers;     /* of cells of a shape */
  int cells[4];    /* defaults */
  int fewest[4];   /* 0 for 1 */
  int most_cells;  /* 0 for MOST_CELLS */
  int is_periodic; /* along all axes */
  int takes_grading, takes_periods;
  int sizes, space; /* numbers of `extent` and of coordinates of a shape */
  double extent[4]; /* defaults, 0 for 1 */
} kind;

#define GRID .cells = {8, 8, 8, 8}

static const kind kinds[] = {
    {"interval", dvi__generate_box, 1, 1, GRID, .takes_grading = 1, .takes_periods = 1},
    {"box", dvi__generate_box, 1, 4, GRID, .takes_grading = 1, .takes_periods = 1},
    {"kuhn", dvi__generate_kuhn, 1, 4, GRID, .takes_grading = 1, .takes_periods = 1},
    {"kuhn-torus", dvi__generate_kuhn, 1, 4, GRID, .is_periodic = 1, .takes_grading = 1},
    {"staggered", dvi__generate_staggered, 2, 2, GRID},
    {"bcc-torus", dvi__generate_bcc, 3, 3, .cells = {4, 4, 4}, .is_periodic = 1},
    {"disk", dvi__generate_disk, .numbers = 1, .cells = {8}, .sizes = 1, .space = 2},
    {"annulus", dvi__generate_annulus, .numbers = 2, .cells = {4, 24}, .fewest = {1, 3}, .sizes = 2,
     .space = 2, .extent = {1, 0.5}},
    {"icosphere", dvi__generate_icosphere, .numbers = 1, .cells = {3}, .most_cells = LEVELS,
     .sizes = 1, .space = 3},
    {"torus", dvi__generate_torus, .numbers = 2, .cells = {24, 12}, .fewest = {3, 4}, .sizes = 2,
     .space = 3, .extent = {1, 0.5}},
    {"genus-2", dvi__generate_genus, .numbers = 1, .cells = {2}, .sizes = 1, .space = 3},
    {"cylinder", dvi__generate_cylinder, .numbers = 2, .cells = {4, 8}, .sizes = 2, .space = 3,
     .extent = {1, 2}},
    {"ball", dvi__generate_ball, .numbers = 1, .cells = {4}, .sizes = 1, .space = 3},
    {"simplex-4", dvi__generate_simplex_4, .sizes = 1, .space = 4},
    {"simplex-5", dvi__generate_simplex_5, .sizes = 1, .space = 5},
    {"cell-16", dvi__generate_cell_16, .sizes = 1, .space = 4},
    {"cell-600", dvi__generate_cell_600, .sizes = 1, .space = 4},
    {"cross-5", dvi__generate_cross_5, .sizes = 1, .space = 5},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

const char *dvi_mesh_generator_name(int i)
{
  return i >= 0 && i < KINDS ? kinds[i].name : NULL;
}

/* ---- options ---- */

static dvi_status refuse(const kind *k, const char *option, double value)
{
  return dvi__fail(DVI_BAD_OPTION, "mesh %s: %s cannot be %g", k->name, option, value);
}

/* The dimension is that of the option, or the number of cells that are given. That of a shape
 * counts its numbers of cells. Where only one dimension is possible, one number is that of all
 * axes. */
static dvi_status find_dimension(const kind *k, const dvi_generator_options *given,
                                 dvi__sizes *sizes)
{
  const int is_free = k->least < k->most, usual = k->most < 3 ? k->most : 2;
  int count = 0;
  while (count < 4 && given->cells[count] != 0) count++;
  sizes->dimension = k->most == 0            ? k->numbers
                     : given->dimension != 0 ? given->dimension
                     : !is_free              ? k->most
                     : count > 0             ? count
                                             : usual;
  if (given->dimension != 0 && k->most == 0) return refuse(k, "dimension", given->dimension);
  if (k->most > 0 && (sizes->dimension < k->least || sizes->dimension > k->most))
    return dvi__fail(DVI_BAD_OPTION, "mesh %s: %d numbers of cells are given, and %d to %d needed",
                     k->name, sizes->dimension, k->least, k->most);
  for (int i = 0; i < sizes->dimension; i++) {
    const int alike = k->most > 0 && !is_free && count == 1 ? 0 : i;
    sizes->cells[i] = given->cells[alike] != 0 ? given->cells[alike] : k->cells[i];
  }
  for (int i = sizes->dimension; i < 4; i++) {
    if (given->cells[i] != 0) return refuse(k, "a further number of cells", given->cells[i]);
    if (given->periodic[i] != 0) return refuse(k, "a further periodic", given->periodic[i]);
  }
  return DVI_OK;
}

static dvi_status take_cells(const kind *k, const dvi_generator_options *given, dvi__sizes *sizes)
{
  for (int i = 0; i < sizes->dimension; i++) {
    sizes->periodic[i] = k->is_periodic || given->periodic[i];
    const int fewest = sizes->periodic[i] ? 3
                       : k->fewest[i] > 0 ? k->fewest[i]
                                          : 1,
              most = k->most_cells > 0 ? k->most_cells : MOST_CELLS;
    if (given->periodic[i] && !k->takes_periods && !k->is_periodic)
      return refuse(k, "periodic", given->periodic[i]);
    if (sizes->cells[i] < fewest || sizes->cells[i] > most)
      return dvi__fail(DVI_BAD_OPTION, "mesh %s: number %d of cells is %d, and may be %d to %d",
                       k->name, i, sizes->cells[i], fewest, most);
  }
  return DVI_OK;
}

/* Each length and grading is positive, and only those that count are given. */
static dvi_status take_lengths(const kind *k, const dvi_generator_options *given, dvi__sizes *sizes)
{
  const int lengths = k->most > 0 ? sizes->dimension : k->sizes,
            space = k->most > 0 ? sizes->dimension : k->space;
  for (int i = 0; i < 4; i++) {
    const double length = k->extent[i] > 0 ? k->extent[i] : 1;
    sizes->extent[i] = given->extent[i] != 0 ? given->extent[i] : length;
    sizes->grading[i] = given->grading[i] != 0 ? given->grading[i] : 1;
    sizes->origin[i] = given->origin[i];
    const int counts = i < lengths, is_graded = sizes->grading[i] != 1;
    if (!(sizes->extent[i] > 0) || !isfinite(sizes->extent[i]) ||
        (given->extent[i] != 0 && !counts))
      return refuse(k, "a size", given->extent[i]);
    if (!(sizes->grading[i] > 0) || !isfinite(sizes->grading[i]) ||
        (is_graded && (!counts || !k->takes_grading)))
      return refuse(k, "a grading", given->grading[i]);
    if (!isfinite(sizes->origin[i]) || (i >= space && sizes->origin[i] != 0))
      return refuse(k, "an origin", given->origin[i]);
  }
  return DVI_OK;
}

static dvi_status take_options(const kind *k, const dvi_generator_options *given, dvi__sizes *sizes)
{
  if (given->size != sizeof *given)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh %s: set options.size to sizeof(dvi_generator_options)",
                     k->name);
  DVI_TRY(find_dimension(k, given, sizes));
  DVI_TRY(take_cells(k, given, sizes));
  return take_lengths(k, given, sizes);
}

/* ---- drafts ---- */

dvi_status dvi__draft_allocate(dvi__draft *draft, const char *generator, double points,
                               double cells)
{
  dvi_mesh_terms *terms = &draft->terms;
  const int corners = dvi__corners(terms->kind, terms->dimension),
            space = terms->space > 0 ? terms->space : terms->dimension;
  if (points >= INT_MAX || cells * corners >= INT_MAX)
    return dvi__fail(DVI_BAD_OPTION, "mesh %s: %.3g points and %.3g cells are too many", generator,
                     points, cells);
  terms->points = (int64_t)points;
  terms->cells = (int64_t)cells;
  terms->point = draft->point = DVI_NEW(double, terms->points *space);
  terms->vertex = draft->vertex = DVI_NEW(int, terms->cells *corners);
  draft->side = DVI_NEW(unsigned char, terms->points);
  if (draft->point == NULL || draft->vertex == NULL || draft->side == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh %s: no memory for %.3g cells", generator, cells);
  return DVI_OK;
}

int dvi__nodes_along(const dvi__sizes *sizes, int axis)
{
  return sizes->cells[axis] + !sizes->periodic[axis];
}

double dvi__node_at(const dvi__sizes *sizes, int axis, int node)
{
  const double part = (double)node / sizes->cells[axis];
  return sizes->origin[axis] + sizes->extent[axis] * pow(part, sizes->grading[axis]);
}

/* ---- the mesh ---- */

/* A facet of the boundary belongs to each side on which all of its vertices lie. */
static dvi_status add_side(dvi_mesh *mesh, const dvi__draft *draft, int side, char *marked)
{
  int64_t count = 0, rim;
  const int *facet = dvi_mesh_part_cells(mesh, "boundary", mesh->n - 1, &rim),
            corners = dvi__corners(mesh->kind, mesh->n - 1);
  memset(marked, 0, (size_t)mesh->count[mesh->n - 1]);
  for (int64_t i = 0; i < rim; i++) {
    int on_side = 1;
    const int *corner = mesh->n > 1 ? mesh->corner[mesh->n - 1] + (int64_t)facet[i] * corners
                                    : facet + i;
    for (int c = 0; c < corners; c++) on_side &= draft->side[corner[c]] >> side;
    marked[facet[i]] = (char)on_side;
    count += on_side;
  }
  if (count == 0) return DVI_OK;
  return dvi__part_add(mesh, draft->name[side], mesh->n - 1, marked);
}

static dvi_status add_sides(dvi_mesh *mesh, const dvi__draft *draft)
{
  dvi_status status = DVI_OK;
  int64_t most = 0;
  for (int k = 0; k < mesh->n; k++) most = mesh->count[k] > most ? mesh->count[k] : most;
  char *marked = DVI_NEW(char, most);
  if (marked == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh: no memory for parts");
  for (int i = 0; i < DVI__SIDES && status == DVI_OK; i++)
    if (draft->name[i] != NULL) status = add_side(mesh, draft, i, marked);
  dvi__release(marked);
  return status;
}

static dvi_status generate(const kind *k, const dvi__sizes *sizes, dvi_mesh **mesh)
{
  dvi__draft draft = {.terms = {.size = sizeof draft.terms}};
  dvi_status status = k->generate(sizes, &draft);
  draft.terms.period = draft.period;
  if (status == DVI_OK) status = dvi_mesh_create(&draft.terms, mesh);
  if (status == DVI_OK) status = add_sides(*mesh, &draft);
  if (status != DVI_OK) dvi_mesh_destroy(mesh);
  dvi__release(draft.point);
  dvi__release(draft.vertex);
  dvi__release(draft.side);
  return status;
}

static dvi_status refuse_name(const char *name)
{
  char list[256] = "";
  for (int i = 0; i < KINDS; i++) {
    const size_t at = strlen(list);
    (void)snprintf(list + at, sizeof list - at, "%s%s", i > 0 ? ", " : "", kinds[i].name);
  }
  return dvi__fail(DVI_BAD_OPTION, "mesh: there is no generator \"%s\"; there are %s", name, list);
}

dvi_status dvi_mesh_generate(const char *name, const dvi_generator_options *options,
                             dvi_mesh **mesh)
{
  const dvi_generator_options defaults = {.size = sizeof defaults};
  dvi__sizes sizes = {.size = sizeof sizes};
  int i = 0;
  if (name == NULL || mesh == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh: a generator's name and a mesh are needed");
  *mesh = NULL;
  while (i < KINDS && strcmp(kinds[i].name, name) != 0) i++;
  if (i == KINDS) return refuse_name(name);
  DVI_TRY(take_options(kinds + i, options != NULL ? options : &defaults, &sizes));
  return generate(kinds + i, &sizes, mesh);
}
