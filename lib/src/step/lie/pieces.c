#include "step/lie/pieces.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "group/vector.h"

static double entry(const dvi_system *s, int row, int column)
{
  const int e = dvi__pattern_find(&s->vv, row, column);
  return e >= 0 ? s->mass_values[e] : 0;
}

static int root_of(int *root, int c)
{
  while (root[c] != c) c = root[c] = root[root[c]];
  return c;
}

/* root [cells]: the first cell of those that the mass couples to c, by any way; NULL if there is no memory. */
static int *components(const dvi_system *s)
{
  int *root = DVI_NEW(int, s->cell_count), *cell = DVI_NEW(int, s->n);
  for (int c = 0; c < s->cell_count && root != NULL && cell != NULL; c++) {
    root[c] = c;
    for (int i = 0; i < dvi__chart_stored(s->cells[c].kind); i++) cell[s->cells[c].q + i] = c;
  }
  for (int j = 0; j < s->n && root != NULL && cell != NULL; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++) {
      const int a = root_of(root, cell[j]), b = root_of(root, cell[s->vv.row[e]]);
      if (s->mass_values[e] != 0) root[a > b ? a : b] = a > b ? b : a;
    }
  for (int c = 0; c < s->cell_count && root != NULL; c++) root[c] = root_of(root, c);
  if (cell == NULL) dvi__release(root);
  dvi__release(cell);
  return cell != NULL ? root : NULL;
}

/* Whether the block of the mass from a cell's first coordinate on is that of a point, m I, or of a body: I x Jd with x' beside it. */
static int is_point(const dvi_system *s, const dvi__cell *cell)
{
  const int stored = dvi__chart_stored(cell->kind);
  const double mass = entry(s, cell->q, cell->q);
  int same = mass > 0;
  for (int i = 0; i < stored; i++)
    for (int j = 0; j < stored; j++) same &= entry(s, cell->q + i, cell->q + j) == (i == j ? mass : 0);
  return same;
}

static int is_body(const dvi_system *s, const dvi__cell *cell, int rigid)
{
  const int q = cell->q, x = q + 9;
  const double mass = rigid ? entry(s, x, x) : 0;
  int same = !rigid || mass > 0;
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 9; j++) same &= entry(s, q + i, q + j) == (i / 3 == j / 3 ? entry(s, q + i % 3, q + j % 3) : 0);
  for (int i = 0; i < 3 && rigid; i++) {
    for (int j = 0; j < 3; j++) same &= entry(s, x + i, x + j) == (i == j ? mass : 0);
    for (int j = 0; j < 9; j++) same &= entry(s, x + i, q + j) == (i == j / 3 ? entry(s, x, q + j % 3) : 0);
  }
  return same;
}

static int make_body(const dvi_system *s, dvi__piece *made, dvi__body *body)
{
  const int q = made->cell->q, x = q + 9;
  double Jd[9];
  if (!is_body(s, made->cell, made->rigid)) return 0;
  made->mass = made->rigid ? entry(s, x, x) : 0;
  for (int i = 0; i < 3; i++) made->centre[i] = made->rigid ? entry(s, x, q + i) / made->mass : 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) Jd[3 * i + j] = entry(s, q + i, q + j) - made->mass * made->centre[i] * made->centre[j];
  made->body = body;
  return dvi__body_of(Jd, body);
}

/* The cells of a component that begins with c: 1, or 4 if it is a rigid motion; 0 if they cannot be taken one by one. */
static int make_piece(dvi__pieces *l, const int *root, const int *size, int c)
{
  const dvi_system *s = l->system;
  dvi__piece made = {.cell = &s->cells[c]};
  made.rigid = made.cell->kind == DVI__ROTATION && size[c] == 4 && c + 3 < s->cell_count;
  for (int i = 1; i < 4 && made.rigid; i++) made.rigid = root[c + i] == c && s->cells[c + i].kind == DVI__LINE;
  if (size[c] != 1 && !made.rigid) return 0;
  if (made.cell->kind != DVI__ROTATION) {
    if (!is_point(s, made.cell)) return 0;
    made.mass = entry(s, made.cell->q, made.cell->q);
  } else if (!make_body(s, &made, &l->body[l->bodies])) {
    return 0;
  }
  l->bodies += made.cell->kind == DVI__ROTATION;
  l->piece[l->alone++] = made;
  return size[c];
}

static void find_pieces(dvi__pieces *l, const int *root, int *size)
{
  const int cells = l->system->cell_count;
  int *together = l->together;
  for (int c = 0; c < cells; c++) size[root[c]]++;
  for (int c = 0; c < cells; c++) {
    if (root[c] == c) together[c] = make_piece(l, root, size, c) == 0;
    together[c] = together[root[c]];
    l->coupled += together[c];
  }
}

dvi_status dvi__pieces_create(const dvi_system *system, dvi__pieces *pieces)
{
  const size_t cells = (size_t)system->cell_count;
  int *root = components(system), *size = DVI_NEW(int, cells);
  *pieces = (dvi__pieces){
      .system = system, .piece = DVI_NEW(dvi__piece, cells), .body = DVI_NEW(dvi__body, cells), .together = DVI_NEW(int, cells)};
  const int possible = root != NULL && size != NULL && pieces->piece != NULL && pieces->body != NULL && pieces->together != NULL;
  if (possible) find_pieces(pieces, root, size);
  dvi__release(root);
  dvi__release(size);
  return possible ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "cells: no memory");
}

void dvi__pieces_clear(dvi__pieces *pieces)
{
  dvi__release(pieces->piece);
  dvi__release(pieces->body);
  dvi__release(pieces->together);
}

/* ---- velocities ---- */

/* R^T x */
static void into_body(const double *R, const double *x, double *inside)
{
  for (int i = 0; i < 3; i++) inside[i] = R[i] * x[0] + R[3 + i] * x[1] + R[6 + i] * x[2];
}

void dvi__piece_moment(const dvi__piece *piece, const double *q, const double *p, double moment[3])
{
  double turned[3];
  into_body(q + piece->cell->q, p + piece->cell->v + 3, turned);
  dvi__cross(piece->centre, turned, moment);
}

static void body_velocity(const dvi__piece *piece, const double *q, const double *p, double *v)
{
  const double *R = q + piece->cell->q;
  double *own = v + piece->cell->v, moment[3] = {0}, moved[3];
  memcpy(own, p + piece->cell->v, (piece->rigid ? 6 : 3) * sizeof *own);
  if (piece->rigid) dvi__piece_moment(piece, q, p, moment);
  for (int i = 0; i < 3; i++) own[i] -= moment[i];
  dvi__body_velocity(piece->body, own, own);
  dvi__cross(own, piece->centre, moved);
  for (int i = 0; i < 3 && piece->rigid; i++) own[3 + i] = own[3 + i] / piece->mass - dvi__dot(R + 3 * i, moved);
}

void dvi__piece_velocity(const dvi__piece *piece, const double *q, const double *p, double *v)
{
  const int first = piece->cell->v;
  if (piece->cell->kind == DVI__ROTATION)
    body_velocity(piece, q, p, v);
  else
    for (int i = first; i < first + dvi__chart_velocities(piece->cell->kind); i++) v[i] = p[i] / piece->mass;
}
