/* The nodes of a field of rotations: which are held, where the others are, and their volumes. */
#include <dvi/group.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/rotations/rotations.h"

/* Distance from a rotation that a held R may have. */
static const double roundoff = 1e-12;

/* Split the number of a node into its places along the axes. */
static void split(const dvi_rotations *f, int64_t node, int *place)
{
  for (int d = f->axes - 1; d >= 0; d--) {
    place[d] = (int)(node % f->count[d]);
    node /= f->count[d];
  }
}

static int is_end(const dvi_rotations *f, const int *place, int d, int upper)
{
  return !f->periodic[d] && place[d] == (upper ? f->count[d] - 1 : 0);
}

static int is_held(const dvi_rotations *f, const int *place)
{
  for (int d = 0; d < f->axes; d++)
    for (int upper = 0; upper < 2; upper++)
      if (f->is_clamped[d][upper] && is_end(f, place, d, upper)) return 1;
  return 0;
}

/* Return the width of a node along an axis, which is half a cell at an end. */
static double width_of(const dvi_rotations *f, const int *place, int d)
{
  return f->length[d] * (is_end(f, place, d, 0) || is_end(f, place, d, 1) ? 0.5 : 1);
}

static double volume_of(const dvi_rotations *f, const int *place)
{
  double volume = 1;
  for (int d = 0; d < f->axes; d++) volume *= width_of(f, place, d);
  return volume;
}

static void position_of(const dvi_rotations *f, const int *place, double *x)
{
  for (int d = 0; d < f->axes; d++) x[d] = f->lower[d] + place[d] * f->length[d];
}

static dvi_status hold(dvi_rotations *f, const dvi_rotations_terms *terms, int64_t node,
                       const int *place)
{
  double x[DVI_AXES_MAX] = {0}, *R = f->held + DVI__ENTRIES * node;
  position_of(f, place, x);
  if (terms->held(x, R, terms->user) != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "rotations: the held rotation at %g failed", x[0]);
  if (dvi_so3_distance(R) <= roundoff) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "rotations: what is held at %g is no rotation (distance %.2g)",
                   x[0], dvi_so3_distance(R));
}

static dvi_status number_nodes(dvi_rotations *f, const dvi_rotations_terms *terms)
{
  int place[DVI_AXES_MAX] = {0};
  for (int64_t node = 0; node < f->nodes; node++) {
    split(f, node, place);
    const int held = is_held(f, place);
    f->number[node] = held ? -1 : (int)f->unknowns++;
    if (held) DVI_TRY(hold(f, terms, node, place));
  }
  if (f->unknowns == 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "rotations: every node is held; more cells are needed");
  return DVI_OK;
}

static dvi_status place_nodes(dvi_rotations *f)
{
  int place[DVI_AXES_MAX] = {0};
  f->x = DVI_NEW(double, f->unknowns * f->axes);
  f->volume = DVI_NEW(double, f->unknowns);
  if (f->x == NULL || f->volume == NULL)
    return dvi__fail(DVI_NO_MEMORY, "rotations: no memory for %lld nodes", (long long)f->nodes);
  for (int64_t node = 0; node < f->nodes; node++) {
    if (f->number[node] < 0) continue;
    split(f, node, place);
    position_of(f, place, f->x + (int64_t)f->number[node] * f->axes);
    f->volume[f->number[node]] = volume_of(f, place);
  }
  return DVI_OK;
}

dvi_status dvi__rotations_place(dvi_rotations *f, const dvi_rotations_terms *terms)
{
  f->nodes = 1;
  for (int d = 0; d < f->axes; d++) {
    f->nodes *= f->count[d];
    if (f->nodes > INT_MAX / DVI__ENTRIES)
      return dvi__fail(DVI_BAD_SIZE, "rotations: an int cannot count the entries of %lld rotations",
                       (long long)f->nodes);
  }
  f->number = DVI_NEW(int, f->nodes);
  f->held = DVI_NEW(double, f->nodes *DVI__ENTRIES);
  if (f->number == NULL || f->held == NULL)
    return dvi__fail(DVI_NO_MEMORY, "rotations: no memory for %lld nodes", (long long)f->nodes);
  DVI_TRY(number_nodes(f, terms));
  return place_nodes(f);
}

/* ---- the bending ---- */

/* An edge from a node to the next one along an axis, and its area over its length. */
typedef struct edge {
  int64_t from, to;
  int axis;
  double weight;
} edge;

/* Find the edge that begins at a node. Returns 0 if there is none. */
static int find_edge(const dvi_rotations *f, int64_t node, int d, edge *found)
{
  int place[DVI_AXES_MAX] = {0};
  int64_t stride = 1;
  split(f, node, place);
  for (int k = f->axes - 1; k > d; k--) stride *= f->count[k];
  if (is_end(f, place, d, 1)) return 0;
  double area = 1;
  for (int k = 0; k < f->axes; k++)
    if (k != d) area *= width_of(f, place, k);
  const int last = place[d] == f->count[d] - 1;
  *found = (edge){.from = node,
                  .to = last ? node - stride * (f->count[d] - 1) : node + stride,
                  .axis = d,
                  .weight = area / f->length[d]};
  return 1;
}

/* Call a function for each edge of the grid. */
static void for_edges(dvi_rotations *f, void (*visit)(dvi_rotations *f, const edge *e))
{
  edge e;
  for (int64_t node = 0; node < f->nodes; node++)
    for (int d = 0; d < f->axes; d++)
      if (find_edge(f, node, d, &e)) visit(f, &e);
}

/* Entry (i,j) of one rotation meets (i,k) of the other one, with the weight of (j,k). */
static void count_edge(dvi_rotations *f, const edge *e)
{
  const int a = f->number[e->from], b = f->number[e->to];
  if (a < 0 || b < 0) return;
  for (int i = 0; i < DVI__ENTRIES; i++) {
    f->hessian.start[(int64_t)DVI__ENTRIES * a + i + 1] += 3;
    f->hessian.start[(int64_t)DVI__ENTRIES * b + i + 1] += 3;
  }
}

/* Put the three entries of a row behind those that it has. `load` counts these meanwhile. */
static void put_row(dvi_rotations *f, int64_t row, int64_t column, const double *weight)
{
  const int64_t at = f->hessian.start[row] + (int64_t)f->load[row];
  for (int k = 0; k < 3; k++) {
    f->hessian.column[at + k] = (int)(column + k);
    f->hessian.value[at + k] = weight[k];
  }
  f->load[row] += 3;
}

static void put_edge(dvi_rotations *f, const edge *e)
{
  const int a = f->number[e->from], b = f->number[e->to];
  if (a < 0 || b < 0) return;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double weight[3];
      for (int k = 0; k < 3; k++) weight[k] = -e->weight * f->bending[e->axis][3 * j + k];
      put_row(f, (int64_t)DVI__ENTRIES * a + 3 * i + j, (int64_t)DVI__ENTRIES * b + 3 * i, weight);
      put_row(f, (int64_t)DVI__ENTRIES * b + 3 * i + j, (int64_t)DVI__ENTRIES * a + 3 * i, weight);
    }
}

/* Add the constant of an edge, tr(tr(K)/2 I - K), and what a held end pulls at a free one. */
static void load_edge(dvi_rotations *f, const edge *e)
{
  const int number[2] = {f->number[e->from], f->number[e->to]};
  const double *held[2] = {f->held + DVI__ENTRIES * e->from, f->held + DVI__ENTRIES * e->to},
               *B = f->bending[e->axis];
  f->constant += e->weight * (B[0] + B[4] + B[8]);
  for (int end = 0; end < 2; end++)
    for (int i = 0; i < 3 && number[end] >= 0 && number[!end] < 0; i++)
      for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
          f->load[(int64_t)DVI__ENTRIES * number[end] + 3 * i + j] += e->weight * B[3 * j + k] *
                                                                      held[!end][3 * i + k];
  for (int k = 0; k < DVI__ENTRIES && number[0] < 0 && number[1] < 0; k++)
    f->constant -= e->weight * B[k] *
                   (held[0][k / 3] * held[1][k % 3] + held[0][3 + k / 3] * held[1][3 + k % 3] +
                    held[0][6 + k / 3] * held[1][6 + k % 3]);
}

/* Sort the groups of three columns of a row, of which there are two for each axis. */
static void sort_row(dvi__csr *H, int64_t row)
{
  for (int64_t e = H->start[row] + 3; e < H->start[row + 1]; e += 3)
    for (int64_t at = e; at > H->start[row] && H->column[at - 3] > H->column[at]; at -= 3)
      for (int k = 0; k < 3; k++) {
        const int column = H->column[at + k];
        const double value = H->value[at + k];
        H->column[at + k] = H->column[at - 3 + k];
        H->value[at + k] = H->value[at - 3 + k];
        H->column[at - 3 + k] = column;
        H->value[at - 3 + k] = value;
      }
}

dvi_status dvi__rotations_bend(dvi_rotations *f)
{
  const int64_t rows = DVI__ENTRIES * f->unknowns;
  f->load = DVI_NEW(double, rows);
  if (f->load == NULL) return dvi__fail(DVI_NO_MEMORY, "rotations: no memory for the bending");
  const int64_t most = rows * 6 * f->axes;
  DVI_TRY(dvi__csr_allocate(rows, rows, most, &f->hessian));
  for_edges(f, count_edge);
  for (int64_t i = 0; i < rows; i++) f->hessian.start[i + 1] += f->hessian.start[i];
  for_edges(f, put_edge);
  for (int64_t i = 0; i < rows; i++) sort_row(&f->hessian, i);
  memset(f->load, 0, (size_t)rows * sizeof *f->load);
  for_edges(f, load_edge);
  return DVI_OK;
}
