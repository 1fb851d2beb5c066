/* Local functions of a cell, on a patch of fine cells, which is the cell or surrounds it.
 *
 * Edges: linear; or solved, with a phi' constant along the edge, where `a` is the mean of both fine
 * cells at an edge, so that neighbours agree; or oversampled: the solutions psi with linear edges
 * of a larger patch are combined so that phi_k is 1 at corner k and 0 at the others. Neighbours do
 * not agree on their edge then, but the layer that linear values make is outside of the cell.
 * Source: Hou and Wu 1997, secs. 2 and 3. */
#include "field/multiscale/cell.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multiscale/patch.h"
#include "num/dense.h"
#include "num/team.h"

enum { LOCALS = DVI__MULTISCALE_LOCALS };

/* Where a thread works. */
typedef struct bench {
  dvi__patch patch;
  double *h[2]; /* sizes of the patch's cells along each axis */
  double *rise; /* shares of an edge, at its nodes */
  double *a;    /* coefficient of the cells of the patch */
  double *u;    /* [4] solutions at the nodes of the patch */
} bench;

typedef struct job {
  const dvi__multiscale_terms *terms;
  const dvi__fine_axis *axis;
  const double *a;
  double *value;
  int size[2];        /* cells of a patch along each axis */
  bench *benches;     /* [threads] */
  dvi_status *status; /* [cells] */
} job;

/* The first fine cell of the patch of a coarse cell. Patches stay inside unless they go round. */
static int patch_start(const job *j, int d, int cell)
{
  const dvi__fine_axis *axis = &j->axis[d];
  const int start = cell * axis->fine - (j->size[d] - axis->fine) / 2;
  if (axis->is_periodic) return start;
  const int last = axis->parts - j->size[d];
  return start < 0 ? 0 : start > last ? last : start;
}

static double coefficient_of(const job *j, int px, int py)
{
  const int x = dvi__fine_axis_wrap(&j->axis[0], px), y = dvi__fine_axis_wrap(&j->axis[1], py);
  return j->a[(size_t)x * (size_t)j->axis[1].parts + (size_t)y];
}

static void gather(const job *j, bench *b, const int *start)
{
  for (int d = 0; d < 2; d++)
    for (int i = 0; i < j->size[d]; i++)
      b->h[d][i] = dvi__fine_axis_length(&j->axis[d],
                                         dvi__fine_axis_wrap(&j->axis[d], start[d] + i));
  for (int i = 0; i < j->size[0]; i++)
    for (int k = 0; k < j->size[1]; k++)
      b->a[i * j->size[1] + k] = coefficient_of(j, start[0] + i, start[1] + k);
}

/* ---- edges ---- */

/* Return the coefficient along part i of an edge in direction d, the mean of both sides. */
static double coefficient_of_edge(const job *j, const int *start, int d, int side, int i)
{
  const dvi__fine_axis *across = &j->axis[1 - d];
  int at[2] = {start[0], start[1]};
  at[d] += i;
  at[1 - d] += side * j->size[1 - d];
  double sum = 0;
  int count = 0;
  for (int k = at[1 - d] - 1; k <= at[1 - d]; k++) {
    if (!across->is_periodic && (k < 0 || k >= across->parts)) continue;
    sum += d == 0 ? coefficient_of(j, at[0], k) : coefficient_of(j, k, at[1]);
    count++;
  }
  return sum / count;
}

/* Set rise [size+1] to the function of an edge in direction d that goes from 0 to 1. */
static void set_rise(const job *j, bench *b, const int *start, int d, int side)
{
  const int n = j->size[d], is_solved = j->terms->edges == DVI__EDGES_SOLVED;
  b->rise[0] = 0;
  for (int i = 0; i < n; i++)
    b->rise[i + 1] = b->rise[i] +
                     b->h[d][i] / (is_solved ? coefficient_of_edge(j, start, d, side, i) : 1);
  for (int i = 0; i < n; i++) b->rise[i] /= b->rise[n];
  b->rise[n] = 1;
}

/* Set the edges of the four functions to their values and all other nodes to 0. */
static void set_edges(const job *j, bench *b, const int *start)
{
  const int nx = j->size[0], ny = j->size[1], nodes = (nx + 1) * (ny + 1);
  memset(b->u, 0, (size_t)LOCALS * (size_t)nodes * sizeof *b->u);
  for (int d = 0; d < 2; d++)
    for (int side = 0; side < 2; side++) {
      const int stride = d == 0 ? ny + 1 : 1;
      const int first = d == 0 ? side * ny : side * nx * (ny + 1);
      const int low = d == 0 ? side : 2 * side, high = d == 0 ? 2 + side : 2 * side + 1;
      set_rise(j, b, start, d, side);
      for (int i = 0; i <= j->size[d]; i++) {
        b->u[(ptrdiff_t)low * nodes + first + (ptrdiff_t)i * stride] = 1 - b->rise[i];
        b->u[(ptrdiff_t)high * nodes + first + (ptrdiff_t)i * stride] = b->rise[i];
      }
    }
}

/* ---- functions of a cell ---- */

/* Copy the part of the patch's solutions that is the cell, from node `first` of the patch. */
static void cut_out(const job *j, const bench *b, int first, double *value)
{
  const int n = j->axis[0].fine + 1, row = j->size[1] + 1, nodes = (j->size[0] + 1) * row;
  for (int k = 0; k < LOCALS; k++)
    for (int i = 0; i < n; i++)
      memcpy(value + ((ptrdiff_t)k * n + i) * n,
             b->u + (ptrdiff_t)k * nodes + first + (ptrdiff_t)i * row, (size_t)n * sizeof *value);
}

/* Give the place of corner k in the values of a function. */
static int corner_place(int fine, int k)
{
  return k / 2 * fine * (fine + 1) + k % 2 * fine;
}

/* Replace the solutions psi in `value` by their combinations that are 1 at one corner each. */
static dvi_status recombine(int fine, double *value)
{
  const int nodes = (fine + 1) * (fine + 1);
  double part[LOCALS][LOCALS] = {{0}}; /* of psi_l in phi_k: [k][l] */
  for (int k = 0; k < LOCALS; k++) {
    double at_corners[LOCALS * LOCALS]; /* psi_l at corner c, column by column */
    int pivot[LOCALS];
    for (int i = 0; i < LOCALS * LOCALS; i++)
      at_corners[i] = value[i / LOCALS * nodes + corner_place(fine, i % LOCALS)];
    part[k][k] = 1;
    if (!dvi__dense_solve(LOCALS, at_corners, pivot, part[k])) return DVI_SINGULAR;
  }
  for (int i = 0; i < nodes; i++) {
    double psi[LOCALS];
    for (int l = 0; l < LOCALS; l++) psi[l] = value[l * nodes + i];
    for (int k = 0; k < LOCALS; k++) {
      value[k * nodes + i] = 0;
      for (int l = 0; l < LOCALS; l++) value[k * nodes + i] += part[k][l] * psi[l];
    }
  }
  for (int i = 0; i < LOCALS * LOCALS; i++)
    value[i / LOCALS * nodes + corner_place(fine, i % LOCALS)] = i / LOCALS == i % LOCALS;
  return DVI_OK;
}

static dvi_status solve_cell(const job *j, bench *b, int cell)
{
  const int fine = j->axis[0].fine, nodes = (j->size[0] + 1) * (j->size[1] + 1);
  const int at[2] = {cell / j->axis[1].cells, cell % j->axis[1].cells};
  const int start[2] = {patch_start(j, 0, at[0]), patch_start(j, 1, at[1])};
  double *value = j->value + (size_t)cell * LOCALS * (size_t)((fine + 1) * (fine + 1));
  gather(j, b, start);
  DVI_TRY(dvi__patch_factor(&b->patch, b->h[0], b->h[1], b->a));
  set_edges(j, b, start);
  for (int k = 0; k < LOCALS; k++)
    DVI_TRY(dvi__patch_solve(&b->patch, b->u + (ptrdiff_t)k * nodes));
  cut_out(j, b, (at[0] * fine - start[0]) * (j->size[1] + 1) + at[1] * fine - start[1], value);
  return j->terms->edges == DVI__EDGES_OVERSAMPLED ? recombine(fine, value) : DVI_OK;
}

static void work(void *user, int member, int cell)
{
  const job *j = user;
  j->status[cell] = solve_cell(j, &j->benches[member], cell);
}

/* ---- all cells ---- */

static void clear_bench(bench *b)
{
  dvi__patch_clear(&b->patch);
  for (int d = 0; d < 2; d++) dvi__release(b->h[d]);
  dvi__release(b->rise);
  dvi__release(b->a);
  dvi__release(b->u);
}

static dvi_status create_bench(const int *size, bench *b)
{
  const size_t nx = (size_t)size[0], ny = (size_t)size[1];
  b->h[0] = DVI_NEW(double, nx);
  b->h[1] = DVI_NEW(double, ny);
  b->rise = DVI_NEW(double, (nx > ny ? nx : ny) + 1);
  b->a = DVI_NEW(double, nx *ny);
  b->u = DVI_NEW(double, LOCALS *(nx + 1) * (ny + 1));
  if (!b->h[0] || !b->h[1] || !b->rise || !b->a || !b->u)
    return dvi__fail(DVI_NO_MEMORY, "msfem: no memory for a cell of %d x %d fine ones", size[0],
                     size[1]);
  return dvi__patch_create(size[0], size[1], DVI__PATCH_EDGES_FIXED, &b->patch);
}

/* The sentence of another thread is lost. */
static dvi_status report(const job *j, int cells)
{
  for (int cell = 0; cell < cells; cell++) {
    const int x = cell / j->axis[1].cells, y = cell % j->axis[1].cells;
    if (j->status[cell] != DVI_OK)
      return dvi__fail(j->status[cell],
                       "%s: the local problem of cell (%d, %d) could not be solved (%s); the "
                       "coefficient may vary by too many powers of ten there",
                       j->terms->coefficient.name, x, y, dvi_status_meaning(j->status[cell]));
  }
  return DVI_OK;
}

static dvi_status run(job *j, int threads, int cells)
{
  if (j->benches == NULL || j->status == NULL)
    return dvi__fail(DVI_NO_MEMORY, "msfem: no memory for %d threads", threads);
  for (int i = 0; i < threads; i++) DVI_TRY(create_bench(j->size, &j->benches[i]));
  if (threads == 1) {
    for (int cell = 0; cell < cells; cell++) work(j, 0, cell);
    return report(j, cells);
  }
  dvi__team *team;
  DVI_TRY(dvi__team_create(threads, &team));
  dvi__team_share(team, cells, work, j);
  dvi__team_destroy(&team);
  return report(j, cells);
}

static int patch_size(const dvi__multiscale_terms *terms, const dvi__fine_axis *axis)
{
  const int size = axis->fine + (terms->edges == DVI__EDGES_OVERSAMPLED ? 2 * terms->overlap : 0);
  return size < axis->parts ? size : axis->parts;
}

dvi_status dvi__cells_solve(const dvi__multiscale_terms *terms, const dvi__fine_axis axis[2],
                            const double *a, double *value)
{
  const int cells = axis[0].cells * axis[1].cells, threads = terms->threads;
  job j = {.terms = terms,
           .axis = axis,
           .a = a,
           .value = value,
           .size = {patch_size(terms, &axis[0]), patch_size(terms, &axis[1])},
           .benches = DVI_NEW(bench, threads),
           .status = DVI_NEW(dvi_status, cells)};
  const dvi_status status = run(&j, threads, cells);
  for (int i = 0; j.benches != NULL && i < threads; i++) clear_bench(&j.benches[i]);
  dvi__release(j.benches);
  dvi__release(j.status);
  return status;
}
