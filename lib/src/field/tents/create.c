#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/volume.h"
#include "field/tents/front.h"

static const double default_fraction = 0.5, fraction_most = 0.999;

/* ---- checks ---- */

/* Boxes of one dimension are simplices. */
static dvi_status check_mesh(const dvi_mesh *mesh, int k)
{
  const int has_boxes = mesh->kind == DVI_BOXES && mesh->n > 1;
  if (has_boxes || mesh->n > 3 || mesh->space >= DVI_MESH_SPACE_MAX)
    return dvi__fail(DVI_UNSUPPORTED,
                     "tents: the mesh has %s of dimension %d in %d coordinates: simplices of "
                     "dimension 1 to 3 in at most 7 are possible",
                     has_boxes ? "boxes" : "simplices", mesh->n, mesh->space);
  for (int l = 0; l < mesh->space; l++)
    if (mesh->metric[l] < 0)
      return dvi__fail(DVI_UNSUPPORTED,
                       "tents: axis %d of the mesh is timelike: take a mesh of space, over which "
                       "tents make spacetime",
                       l);
  if (k < 0 || k >= mesh->n)
    return dvi__fail(DVI_BAD_ARGUMENT, "tents: the degree %d is not from 0 to %d", k, mesh->n - 1);
  return DVI_OK;
}

static dvi_status check_material(const dvi_star *star, int k)
{
  for (int degree = k; degree <= k + 1; degree++)
    for (int64_t c = 0; star->factor[degree] != NULL && c < star->mesh->count[star->mesh->n]; c++)
      if (!(star->factor[degree][c] > 0))
        return dvi__fail(DVI_BAD_ARGUMENT,
                         "tents: the factor of degree %d in cell %lld is %g, which should be "
                         "above 0",
                         degree, (long long)c, star->factor[degree][c]);
  return DVI_OK;
}

/* The negations refuse what is no number, too. */
static dvi_status check_options(const dvi__tents_options *options)
{
  if (!(options->fraction >= 0 && options->fraction <= fraction_most))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "tents: the fraction is %g: above 0 and at most %g is possible",
                     options->fraction, fraction_most);
  if (!(options->least >= 0 && options->least <= 1))
    return dvi__fail(DVI_BAD_ARGUMENT, "tents: the least rise is %g, which is not from 0 to 1",
                     options->least);
  return DVI_OK;
}

static dvi_status check_star(const dvi_star *star, int k)
{
  if (star->kind != DVI_CIRCUMCENTRIC)
    return dvi__fail(DVI_UNSUPPORTED,
                     "tents: the star is not circumcentric: no other one has rows with a single "
                     "unknown");
  DVI_TRY(check_mesh(star->mesh, k));
  return check_material(star, k);
}

static dvi_status check_mass(const dvi__tents *w)
{
  const double *mass = w->star->diagonal[w->k];
  for (int64_t i = 0; i < w->mesh->count[w->k]; i++) {
    if (w->held[i] || mass[i] > 0) continue;
    const dvi__cell_name name = dvi__name_cell(w->mesh, w->k, i);
    return dvi__fail(DVI_SINGULAR,
                     "tents: M_%d has the entry %.3g at %s, which should be above 0: take a mesh "
                     "with acute angles",
                     w->k, mass[i], name.text);
  }
  return DVI_OK;
}

/* ---- tables ---- */

static const int *corners_of_cell(const dvi_mesh *mesh, int k, int64_t cell, const int *vertex)
{
  return k == 0 ? vertex : mesh->corner[k] + cell * (k + 1);
}

static dvi_status find_around(const dvi_mesh *mesh, int k, dvi__around *around)
{
  const int64_t vertices = mesh->count[0], cells = mesh->count[k];
  int64_t *start = around->start = DVI_NEW(int64_t, vertices + 1);
  around->cell = DVI_NEW(int, cells *(k + 1));
  if (start == NULL || around->cell == NULL)
    return dvi__fail(DVI_NO_MEMORY, "tents: no memory for the cells around vertices");
  for (int cell = 0; cell < cells; cell++)
    for (int c = 0; c <= k; c++) start[corners_of_cell(mesh, k, cell, &cell)[c]]++;
  int64_t sum = 0;
  for (int64_t v = 0; v <= vertices; v++) {
    const int64_t count = start[v];
    start[v] = sum;
    sum += count;
  }
  for (int cell = 0; cell < cells; cell++)
    for (int c = 0; c <= k; c++)
      around->cell[start[corners_of_cell(mesh, k, cell, &cell)[c]]++] = cell;
  memmove(start + 1, start, (size_t)vertices * sizeof *start);
  start[0] = 0;
  return DVI_OK;
}

static dvi__sets sets_of(int corners, int members)
{
  dvi__sets sets = {0};
  for (int set = 1; set < 1 << corners; set++)
    if (__builtin_popcount((unsigned)set) == members) sets.set[sets.count++] = set;
  return sets;
}

static void number_faces(dvi__tents *w)
{
  const int n = w->mesh->n, sets = 1 << (n + 1);
  for (int64_t cell = 0; cell < w->mesh->count[n]; cell++) {
    int64_t number[DVI__CORNER_SETS];
    dvi__number_faces(w->mesh, cell, number);
    for (int set = 1; set < sets; set++) w->face[cell * sets + set] = (int)number[set];
  }
  w->faces = sets_of(n + 1, w->k + 1);
  w->raised = sets_of(n + 2, w->k + 2);
}

/* The action of a cell is -(eps/mu)^(1/2) |dA|^2/2 in the metric of its light. */
static void find_light(dvi__tents *w)
{
  const double *eps = w->star->factor[w->k], *stiffness = w->star->factor[w->k + 1];
  for (int64_t c = 0; c < w->mesh->count[w->mesh->n]; c++) {
    const double mass = eps != NULL ? eps[c] : 1, stiff = stiffness != NULL ? stiffness[c] : 1;
    w->speed[c] = sqrt(stiff / mass);
    w->weight[c] = sqrt(stiff) * sqrt(mass);
  }
}

/* The largest frequency of a (k+1)-cell with its k-cells alone, whose masses are shared equally by
 * all (k+1)-cells at them, has the square M_{k+1} sum n_s/M_s. No frequency of the mesh is above
 * all of these. */
static double local_square(const dvi__tents *w, int64_t cell, const int *sharers)
{
  const int k = w->k;
  double sum = 0;
  for (int j = 0; j < k + 2; j++) {
    const int s = w->mesh->facet[k + 1][cell * (k + 2) + j];
    if (!w->held[s]) sum += sharers[s] / w->star->diagonal[k][s];
  }
  return w->star->diagonal[k + 1][cell] * sum;
}

/* Give the shortest of the stable steps of (k+1)-cells at each vertex. */
static void find_steps(const dvi__tents *w, int *sharers, double *step)
{
  const dvi_mesh *mesh = w->mesh;
  const int k = w->k;
  for (int64_t v = 0; v < mesh->count[0]; v++) step[v] = INFINITY;
  for (int64_t i = 0; i < mesh->count[k + 1] * (k + 2); i++) sharers[mesh->facet[k + 1][i]]++;
  for (int64_t cell = 0; cell < mesh->count[k + 1]; cell++) {
    const double square = local_square(w, cell, sharers),
                 stable = square > 0 ? 2 / sqrt(square) : (double)INFINITY;
    for (int c = 0; c < k + 2; c++) {
      const int v = mesh->corner[k + 1][cell * (k + 2) + c];
      step[v] = fmin(step[v], stable);
    }
  }
}

static void limit_by_light(dvi__tents *w)
{
  const dvi_mesh *mesh = w->mesh;
  const dvi__sets edges = sets_of(mesh->n + 1, 2);
  for (int64_t e = 0; e < mesh->count[1]; e++) w->reach[e] = INFINITY;
  for (int64_t cell = 0; cell < mesh->count[mesh->n]; cell++) {
    const double slope = w->fraction / (dvi__steepest(mesh, cell) * w->speed[cell]);
    for (int i = 0; i < edges.count; i++) {
      const int64_t edge = dvi__face_of(w, cell, edges.set[i]);
      w->reach[edge] = fmin(w->reach[edge], slope * dvi__cell_volume(mesh, 1, edge));
    }
  }
}

static dvi_status find_reach(dvi__tents *w)
{
  const dvi_mesh *mesh = w->mesh;
  int *sharers = DVI_NEW(int, mesh->count[w->k]);
  double *step = DVI_NEW(double, mesh->count[0]);
  const dvi_status status = sharers && step
                                ? DVI_OK
                                : dvi__fail(DVI_NO_MEMORY, "tents: no memory for local steps");
  if (status == DVI_OK) {
    limit_by_light(w);
    find_steps(w, sharers, step);
    for (int64_t e = 0; e < mesh->count[1]; e++) {
      const int *end = mesh->corner[1] + 2 * e;
      w->reach[e] = fmin(w->reach[e], w->fraction * fmin(step[end[0]], step[end[1]]));
    }
  }
  dvi__release(sharers);
  dvi__release(step);
  return status;
}

/* ---- memory ---- */

static int allocate_front(const dvi_mesh *mesh, int k, dvi__front *front)
{
  front->time = DVI_NEW(double, mesh->count[0]);
  front->rises = DVI_NEW(int64_t, mesh->count[0]);
  front->heap = DVI_NEW(int, mesh->count[0]);
  front->A = DVI_NEW(double, mesh->count[k]);
  front->row = DVI_NEW(double, mesh->count[k]);
  return front->time && front->rises && front->heap && front->A && front->row;
}

static void release_front(dvi__front *front)
{
  dvi__release(front->time);
  dvi__release(front->rises);
  dvi__release(front->heap);
  dvi__release(front->A);
  dvi__release(front->row);
}

static int64_t most_around(const dvi_mesh *mesh, const dvi__around *around)
{
  int64_t most = 0;
  for (int64_t v = 0; v < mesh->count[0]; v++)
    if (around->start[v + 1] - around->start[v] > most)
      most = around->start[v + 1] - around->start[v];
  return most;
}

static int allocate_tables(dvi__tents *w)
{
  const dvi_mesh *mesh = w->mesh;
  const int64_t cells = mesh->count[mesh->n];
  w->held = DVI_NEW(int8_t, mesh->count[w->k]);
  w->speed = DVI_NEW(double, cells);
  w->weight = DVI_NEW(double, cells);
  w->reach = DVI_NEW(double, mesh->count[1]);
  w->face = DVI_NEW(int, cells << (mesh->n + 1));
  w->base = DVI_NEW(double, mesh->count[w->k + 1]);
  if (w->k > 0) w->charge = DVI_NEW(double, 3 * mesh->count[w->k - 1]);
  return w->held && w->speed && w->weight && w->reach && w->face && w->base &&
         (w->charge || w->k == 0);
}

static int allocate_work(dvi__tents *w)
{
  const int64_t values = w->mesh->count[w->k];
  w->level = DVI_NEW(dvi__front, 1);
  w->level_time = DVI_NEW(double, 1);
  w->rise = DVI_NEW(double, values);
  w->row = DVI_NEW(double, values);
  w->dual = DVI_NEW(double, values);
  w->size = DVI_NEW(double, values);
  w->star_of = DVI_NEW(double, most_around(w->mesh, &w->cells) * DVI__CORNER_SETS);
  return w->level && w->level_time && w->rise && w->row && w->dual && w->size && w->star_of &&
         allocate_front(w->mesh, w->k, &w->front) && allocate_front(w->mesh, w->k, w->level);
}

void dvi__tents_destroy(dvi__tents **tents)
{
  if (tents == NULL || *tents == NULL) return;
  dvi__tents *w = *tents;
  *tents = NULL;
  void *const owned[] = {w->held,       w->force,        w->speed,       w->weight,
                         w->reach,      w->face,         w->base,        w->rise,
                         w->row,        w->dual,         w->size,        w->charge,
                         w->star_of,    w->cells.start,  w->cells.cell,  w->edges.start,
                         w->edges.cell, w->values.start, w->values.cell, w->level_time};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  release_front(&w->front);
  if (w->level != NULL) release_front(w->level);
  dvi__release(w->level);
  dvi_star_destroy(&w->star);
  dvi__release(w);
}

/* ---- create ---- */

static dvi_status make(dvi__tents *w, const dvi__tents_terms *terms)
{
  const dvi_mesh *mesh = w->mesh;
  DVI_TRY(find_around(mesh, mesh->n, &w->cells));
  DVI_TRY(find_around(mesh, 1, &w->edges));
  DVI_TRY(find_around(mesh, w->k, &w->values));
  if (terms->force != NULL)
    w->force = dvi__duplicate(terms->force, (size_t)mesh->count[w->k], sizeof *w->force);
  if (!allocate_tables(w) || !allocate_work(w) || (terms->force != NULL && w->force == NULL))
    return dvi__fail(DVI_NO_MEMORY, "tents: no memory for %lld cells",
                     (long long)mesh->count[mesh->n]);
  if (terms->held != NULL) memcpy(w->held, terms->held, (size_t)mesh->count[w->k]);
  DVI_TRY(check_mass(w));
  for (int l = 0; l < mesh->space; l++) w->metric[l] = 1;
  w->metric[mesh->space] = -1;
  number_faces(w);
  find_light(w);
  DVI_TRY(find_reach(w));
  dvi__tents_start(w, &(dvi_march_state){.size = sizeof(dvi_march_state)});
  return DVI_OK;
}

dvi_status dvi__tents_create(const dvi__tents_terms *terms, const dvi__tents_options *options,
                             dvi__tents **tents)
{
  const dvi__tents_options defaults = {0};
  *tents = NULL;
  if (options == NULL) options = &defaults;
  DVI_TRY(check_options(options));
  DVI_TRY(check_star(terms->star, terms->k));
  dvi__tents *w = DVI_NEW(dvi__tents, 1);
  if (w == NULL) return dvi__fail(DVI_NO_MEMORY, "tents: no memory");
  w->star = dvi_star_share(terms->star);
  w->mesh = w->star->mesh;
  w->k = terms->k;
  w->fraction = options->fraction > 0 ? options->fraction : default_fraction;
  w->least = options->least > 0 ? options->least : 1;
  w->seed = options->seed;
  const dvi_status status = make(w, terms);
  *tents = w;
  if (status != DVI_OK) dvi__tents_destroy(tents);
  return status;
}
