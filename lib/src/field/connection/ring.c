#include "field/connection/ring.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/forms/duals.h"

/* A cell at a hinge, without corners enter and leave. */
typedef struct visit {
  int cell;
  int8_t enter, leave;
} visit;

int dvi__cell_behind(const dvi_mesh *mesh, int64_t cell, int slot)
{
  const int facet = mesh->facet[mesh->n][cell * (mesh->n + 1) + slot],
            *pair = mesh->coface + 2 * (int64_t)facet;
  return pair[0] == cell ? pair[1] : pair[0];
}

/* Call for each cell and each of its hinges. */
static void count_cells(const dvi_mesh *mesh, dvi__rings *r)
{
  const int whole = (2 << mesh->n) - 1;
  int64_t number[DVI__CORNER_SETS];
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) {
    dvi__number_faces(mesh, c, number);
    for (int i = 0; i <= mesh->n; i++)
      for (int j = i + 1; j <= mesh->n; j++) r->start[number[whole & ~(1 << i | 1 << j)] + 1]++;
  }
  for (int64_t h = 0; h < mesh->count[mesh->n - 2]; h++) r->start[h + 1] += r->start[h];
}

/* Put each cell to its hinges, in the order of the cells. The ring turns from the facet without the
 * first of two corners to that without the other, if the vertices of the hinge and then those of
 * the first and the second corner are oriented as the cell is. */
static void place_cells(const dvi_mesh *mesh, dvi__rings *r, int *filled)
{
  const int whole = (2 << mesh->n) - 1;
  int64_t number[DVI__CORNER_SETS];
  for (int64_t c = 0; c < mesh->count[mesh->n]; c++) {
    const int sign = mesh->orientation != NULL ? mesh->orientation[c] : 1;
    dvi__number_faces(mesh, c, number);
    for (int i = 0; i <= mesh->n; i++)
      for (int j = i + 1; j <= mesh->n; j++) {
        const int64_t hinge = number[whole & ~(1 << i | 1 << j)],
                      at = r->start[hinge] + filled[hinge]++;
        const int is_positive = ((i + j) % 2 == 1) == (sign > 0);
        r->cell[at] = (int)c;
        r->enter[at] = (int8_t)(is_positive ? j : i);
        r->leave[at] = (int8_t)(is_positive ? i : j);
      }
  }
}

/* ---- order ---- */

static visit visit_at(const dvi__rings *r, int64_t at)
{
  return (visit){r->cell[at], r->enter[at], r->leave[at]};
}

static void put_visit(dvi__rings *r, int64_t at, visit v)
{
  r->cell[at] = v.cell;
  r->enter[at] = v.enter;
  r->leave[at] = v.leave;
}

/* Put the cell that is entered from another one behind it. Cells of a mesh that is not orientable
 * are turned to the sense of the first. Returns 0 if the cell is not among the rest. */
static int put_next(const dvi_mesh *mesh, dvi__rings *r, int64_t at, int64_t end)
{
  const visit last = visit_at(r, at);
  const int next = dvi__cell_behind(mesh, last.cell, last.leave),
            facet = mesh->facet[mesh->n][(int64_t)last.cell * (mesh->n + 1) + last.leave];
  for (int64_t i = at + 1; i < end; i++) {
    visit v = visit_at(r, i);
    if (v.cell != next) continue;
    if (mesh->facet[mesh->n][(int64_t)next * (mesh->n + 1) + v.enter] != facet) {
      const int8_t other = v.enter;
      v.enter = v.leave;
      v.leave = other;
    }
    put_visit(r, i, visit_at(r, at + 1));
    put_visit(r, at + 1, v);
    return 1;
  }
  return 0;
}

/* Bring to the front a cell that is entered from outside, if there is one. Cells that are left to
 * the outside may be turned. */
static void find_front(const dvi_mesh *mesh, dvi__rings *r, int64_t hinge)
{
  const int64_t first = r->start[hinge], end = r->start[hinge + 1];
  int64_t found = -1;
  for (int64_t at = first; at < end && found < 0; at++)
    if (dvi__cell_behind(mesh, r->cell[at], r->enter[at]) < 0) found = at;
  for (int64_t at = first; at < end && found < 0 && mesh->orientation == NULL; at++)
    if (dvi__cell_behind(mesh, r->cell[at], r->leave[at]) < 0) {
      const int8_t other = r->enter[at];
      r->enter[at] = r->leave[at];
      r->leave[at] = other;
      found = at;
    }
  r->is_open[hinge] = found >= 0;
  if (found < 0) return;
  const visit front = visit_at(r, found);
  put_visit(r, found, visit_at(r, first));
  put_visit(r, first, front);
}

static dvi_status order_cells(const dvi_mesh *mesh, dvi__rings *r, int64_t hinge)
{
  const int64_t first = r->start[hinge], end = r->start[hinge + 1];
  find_front(mesh, r, hinge);
  for (int64_t at = first; at + 1 < end; at++)
    if (!put_next(mesh, r, at, end))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "curvature: the cells around %s do not hang together; give each of their "
                       "rings a %s of its own",
                       dvi__name_cell(mesh, mesh->n - 2, hinge).text,
                       dvi__degree_name(DVI_SIMPLICES, mesh->n - 2));
  return DVI_OK;
}

/* ---- all ---- */

static int64_t visits_of(const dvi_mesh *mesh)
{
  return mesh->count[mesh->n] * mesh->n * (mesh->n + 1) / 2;
}

static dvi_status make(const dvi_mesh *mesh, dvi__rings *r)
{
  const int64_t hinges = mesh->count[mesh->n - 2], visits = visits_of(mesh);
  int *filled = DVI_NEW(int, hinges);
  r->start = DVI_NEW(int64_t, hinges + 1);
  r->cell = DVI_NEW(int, visits);
  r->enter = DVI_NEW(int8_t, 2 * visits);
  r->leave = r->enter + visits;
  r->is_open = DVI_NEW(char, hinges);
  dvi_status status = DVI_OK;
  if (filled == NULL || r->start == NULL || r->cell == NULL || r->enter == NULL ||
      r->is_open == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "curvature: no memory for rings of cells");
  if (status == DVI_OK) {
    count_cells(mesh, r);
    place_cells(mesh, r, filled);
  }
  for (int64_t h = 0; h < hinges && status == DVI_OK; h++) status = order_cells(mesh, r, h);
  dvi__release(filled);
  return status;
}

dvi_status dvi__rings_create(const dvi_mesh *mesh, dvi__rings *rings)
{
  memset(rings, 0, sizeof *rings);
  const dvi_status status = make(mesh, rings);
  if (status != DVI_OK) dvi__rings_clear(rings);
  return status;
}

void dvi__rings_clear(dvi__rings *r)
{
  dvi__release(r->start);
  dvi__release(r->cell);
  dvi__release(r->enter);
  dvi__release(r->is_open);
  memset(r, 0, sizeof *r);
}

dvi_status dvi__rings_copy(const dvi_mesh *mesh, const dvi__rings *r, dvi__rings *copy)
{
  const size_t hinges = (size_t)mesh->count[mesh->n - 2], visits = (size_t)visits_of(mesh);
  *copy = (dvi__rings){.start = dvi__duplicate(r->start, hinges + 1, sizeof *r->start),
                       .cell = dvi__duplicate(r->cell, visits, sizeof *r->cell),
                       .enter = dvi__duplicate(r->enter, 2 * visits, sizeof *r->enter),
                       .is_open = dvi__duplicate(r->is_open, hinges, sizeof *r->is_open)};
  if (copy->start == NULL || copy->cell == NULL || copy->enter == NULL || copy->is_open == NULL) {
    dvi__rings_clear(copy);
    return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for rings of cells");
  }
  copy->leave = copy->enter + visits;
  return DVI_OK;
}
