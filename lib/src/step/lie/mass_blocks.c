#include "step/lie/mass_blocks.h"

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

/* root [slots]: the first slot of those that the mass couples to c, by any way; NULL if there is no
 * memory. */
static int *components(const dvi_system *s)
{
  int *root = DVI_NEW(int, s->slot_count), *slot = DVI_NEW(int, s->n);
  for (int c = 0; c < s->slot_count && root != NULL && slot != NULL; c++) {
    root[c] = c;
    for (int i = 0; i < dvi__chart_stored(s->slots[c].kind); i++) slot[s->slots[c].q + i] = c;
  }
  for (int j = 0; j < s->n && root != NULL && slot != NULL; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++) {
      const int a = root_of(root, slot[j]), b = root_of(root, slot[s->vv.row[e]]);
      if (s->mass_values[e] != 0) root[a > b ? a : b] = a > b ? b : a;
    }
  for (int c = 0; c < s->slot_count && root != NULL; c++) root[c] = root_of(root, c);
  if (slot == NULL) dvi__release(root);
  dvi__release(slot);
  return slot != NULL ? root : NULL;
}

/* Whether the block of the mass from a slot's first coordinate on is that of a point, m I, or of a
 * body: I x Jd with x' beside it. */
static int is_point(const dvi_system *s, const dvi__factor_slot *slot)
{
  const int stored = dvi__chart_stored(slot->kind);
  const double mass = entry(s, slot->q, slot->q);
  int same = mass > 0;
  for (int i = 0; i < stored; i++)
    for (int j = 0; j < stored; j++)
      same &= entry(s, slot->q + i, slot->q + j) == (i == j ? mass : 0);
  return same;
}

static int is_body(const dvi_system *s, const dvi__factor_slot *slot, int rigid)
{
  const int q = slot->q, x = q + 9;
  const double mass = rigid ? entry(s, x, x) : 0;
  int same = !rigid || mass > 0;
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 9; j++)
      same &= entry(s, q + i, q + j) == (i / 3 == j / 3 ? entry(s, q + i % 3, q + j % 3) : 0);
  for (int i = 0; i < 3 && rigid; i++) {
    for (int j = 0; j < 3; j++) same &= entry(s, x + i, x + j) == (i == j ? mass : 0);
    for (int j = 0; j < 9; j++)
      same &= entry(s, x + i, q + j) == (i == j / 3 ? entry(s, x, q + j % 3) : 0);
  }
  return same;
}

static int make_body(const dvi_system *s, dvi__mass_block *made, dvi__body *body)
{
  const int q = made->slot->q, x = q + 9;
  double Jd[9];
  if (!is_body(s, made->slot, made->rigid)) return 0;
  made->mass = made->rigid ? entry(s, x, x) : 0;
  for (int i = 0; i < 3; i++) made->centre[i] = made->rigid ? entry(s, x, q + i) / made->mass : 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      Jd[3 * i + j] = entry(s, q + i, q + j) - made->mass * made->centre[i] * made->centre[j];
  made->body = body;
  return dvi__body_of(Jd, body);
}

/* The slots of a component that begins with c: 1, or 4 if it is a rigid motion; 0 if they cannot be
 * taken one by one. */
static int make_piece(dvi__mass_blocks *l, const int *root, const int *size, int c)
{
  const dvi_system *s = l->system;
  dvi__mass_block made = {.slot = &s->slots[c]};
  made.rigid = made.slot->kind == DVI__ROTATION && size[c] == 4 && c + 3 < s->slot_count;
  for (int i = 1; i < 4 && made.rigid; i++)
    made.rigid = root[c + i] == c && s->slots[c + i].kind == DVI__LINE;
  if (size[c] != 1 && !made.rigid) return 0;
  if (made.slot->kind != DVI__ROTATION) {
    if (!is_point(s, made.slot)) return 0;
    made.mass = entry(s, made.slot->q, made.slot->q);
  } else if (!make_body(s, &made, &l->body[l->bodies])) {
    return 0;
  }
  l->bodies += made.slot->kind == DVI__ROTATION;
  l->piece[l->alone++] = made;
  return size[c];
}

static void find_pieces(dvi__mass_blocks *l, const int *root, int *size)
{
  const int slots = l->system->slot_count;
  int *together = l->together;
  for (int c = 0; c < slots; c++) size[root[c]]++;
  for (int c = 0; c < slots; c++) {
    if (root[c] == c) together[c] = make_piece(l, root, size, c) == 0;
    together[c] = together[root[c]];
    l->coupled += together[c];
  }
}

dvi_status dvi__mass_blocks_create(const dvi_system *system, dvi__mass_blocks *pieces)
{
  const size_t slots = (size_t)system->slot_count;
  int *root = components(system), *size = DVI_NEW(int, slots);
  *pieces = (dvi__mass_blocks){.system = system,
                               .piece = DVI_NEW(dvi__mass_block, slots),
                               .body = DVI_NEW(dvi__body, slots),
                               .together = DVI_NEW(int, slots)};
  const int possible = root != NULL && size != NULL && pieces->piece != NULL &&
                       pieces->body != NULL && pieces->together != NULL;
  if (possible) find_pieces(pieces, root, size);
  dvi__release(root);
  dvi__release(size);
  return possible ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "slots: no memory");
}

void dvi__mass_blocks_clear(dvi__mass_blocks *pieces)
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

void dvi__mass_block_moment(const dvi__mass_block *piece, const double *q, const double *p,
                            double moment[3])
{
  double turned[3];
  into_body(q + piece->slot->q, p + piece->slot->v + 3, turned);
  dvi__cross(piece->centre, turned, moment);
}

static void body_velocity(const dvi__mass_block *piece, const double *q, const double *p, double *v)
{
  const double *R = q + piece->slot->q;
  double *own = v + piece->slot->v, moment[3] = {0}, moved[3];
  memcpy(own, p + piece->slot->v, (piece->rigid ? 6 : 3) * sizeof *own);
  if (piece->rigid) dvi__mass_block_moment(piece, q, p, moment);
  for (int i = 0; i < 3; i++) own[i] -= moment[i];
  dvi__body_velocity(piece->body, own, own);
  dvi__cross(own, piece->centre, moved);
  for (int i = 0; i < 3 && piece->rigid; i++)
    own[3 + i] = own[3 + i] / piece->mass - dvi__dot(R + 3 * i, moved);
}

void dvi__mass_block_velocity(const dvi__mass_block *piece, const double *q, const double *p,
                              double *v)
{
  const int first = piece->slot->v;
  if (piece->slot->kind == DVI__ROTATION)
    body_velocity(piece, q, p, v);
  else
    for (int i = first; i < first + dvi__chart_velocities(piece->slot->kind); i++)
      v[i] = p[i] / piece->mass;
}
