#include "step/lie/mass_blocks.h"

#include <string.h>

#include "step/lie/slot.h"
#include "core/memory.h"
#include "core/status.h"

static double mass_block_entry(const dvi_system *s, int row, int column)
{
  const int e = dvi__pattern_find(&s->vv, row, column);
  return e >= 0 ? s->mass_values[e] : 0;
}

static int mass_block_root_of(int *root, int c)
{
  while (root[c] != c) c = root[c] = root[root[c]];
  return c;
}

/* Return root [slots], the first slot of all that the mass couples to slot c, directly or not. NULL
 * if there is no memory. */
static int *mass_block_components(const dvi_system *s)
{
  int *root = DVI_NEW(int, s->slot_count), *slot = DVI_NEW(int, s->n);
  for (int c = 0; c < s->slot_count && root != NULL && slot != NULL; c++) {
    root[c] = c;
    for (int i = 0; i < dvi__chart_stored(s->slots[c].kind); i++) slot[s->slots[c].q + i] = c;
  }
  for (int j = 0; j < s->n && root != NULL && slot != NULL; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++) {
      const int a = mass_block_root_of(root, slot[j]),
                b = mass_block_root_of(root, slot[s->vv.row[e]]);
      if (s->mass_values[e] != 0) root[a > b ? a : b] = a > b ? b : a;
    }
  for (int c = 0; c < s->slot_count && root != NULL; c++) root[c] = mass_block_root_of(root, c);
  if (slot == NULL) dvi__release(root);
  dvi__release(slot);
  return slot != NULL ? root : NULL;
}

/* Return 1 if the block of the mass from a slot's first coordinate on is that of a point, m I.
 * is_body checks for a body, I x Jd with x' beside it. */
static int is_point(const dvi_system *s, const dvi__factor_slot *slot)
{
  const int stored = dvi__chart_stored(slot->kind);
  const double mass = mass_block_entry(s, slot->q, slot->q);
  int same = mass > 0;
  for (int i = 0; i < stored; i++)
    for (int j = 0; j < stored; j++)
      same &= mass_block_entry(s, slot->q + i, slot->q + j) == (i == j ? mass : 0);
  return same;
}

static int is_body(const dvi_system *s, const dvi__factor_slot *slot, int rigid)
{
  const int q = slot->q, x = q + 9;
  const double mass = rigid ? mass_block_entry(s, x, x) : 0;
  int same = !rigid || mass > 0;
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 9; j++)
      same &= mass_block_entry(s, q + i, q + j) ==
              (i / 3 == j / 3 ? mass_block_entry(s, q + i % 3, q + j % 3) : 0);
  for (int i = 0; i < 3 && rigid; i++) {
    for (int j = 0; j < 3; j++) same &= mass_block_entry(s, x + i, x + j) == (i == j ? mass : 0);
    for (int j = 0; j < 9; j++)
      same &= mass_block_entry(s, x + i, q + j) ==
              (i == j / 3 ? mass_block_entry(s, x, q + j % 3) : 0);
  }
  return same;
}

static int make_body(const dvi_system *s, dvi__mass_block *made, dvi__body *body)
{
  const int q = made->slot->q, x = q + 9;
  double Jd[9];
  if (!is_body(s, made->slot, made->rigid)) return 0;
  made->mass = made->rigid ? mass_block_entry(s, x, x) : 0;
  for (int i = 0; i < 3; i++)
    made->centre[i] = made->rigid ? mass_block_entry(s, x, q + i) / made->mass : 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      Jd[3 * i + j] = mass_block_entry(s, q + i, q + j) -
                      made->mass * made->centre[i] * made->centre[j];
  made->body = body;
  return dvi__body_of(Jd, body);
}

/* Make the mass block of the component of slots that begins with c. Returns the number of slots, 1,
 * or 4 for a rigid motion, or 0 if these slots cannot be treated alone. */
static int mass_block_make(dvi__mass_blocks *l, const int *root, const int *size, int c)
{
  const dvi_system *s = l->system;
  dvi__mass_block made = {.slot = &s->slots[c]};
  made.rigid = made.slot->kind == DVI__ROTATION && size[c] == 4 && c + 3 < s->slot_count;
  for (int i = 1; i < 4 && made.rigid; i++)
    made.rigid = root[c + i] == c && s->slots[c + i].kind == DVI__LINE;
  if (size[c] != 1 && !made.rigid) return 0;
  if (made.slot->kind != DVI__ROTATION) {
    if (!is_point(s, made.slot)) return 0;
    made.mass = mass_block_entry(s, made.slot->q, made.slot->q);
  } else if (!make_body(s, &made, &l->body[l->bodies])) {
    return 0;
  }
  l->bodies += made.slot->kind == DVI__ROTATION;
  l->block[l->alone++] = made;
  return size[c];
}

static void mass_block_find_all(dvi__mass_blocks *l, const int *root, int *size)
{
  const int slots = l->system->slot_count;
  int *together = l->together;
  for (int c = 0; c < slots; c++) size[root[c]]++;
  for (int c = 0; c < slots; c++) {
    if (root[c] == c) together[c] = mass_block_make(l, root, size, c) == 0;
    together[c] = together[root[c]];
    l->coupled += together[c];
  }
}

dvi_status dvi__mass_blocks_create(const dvi_system *system, dvi__mass_blocks *blocks)
{
  const size_t slots = (size_t)system->slot_count;
  int *root = mass_block_components(system), *size = DVI_NEW(int, slots);
  *blocks = (dvi__mass_blocks){.system = system,
                               .block = DVI_NEW(dvi__mass_block, slots),
                               .body = DVI_NEW(dvi__body, slots),
                               .together = DVI_NEW(int, slots)};
  const int possible = root != NULL && size != NULL && blocks->block != NULL &&
                       blocks->body != NULL && blocks->together != NULL;
  if (possible) mass_block_find_all(blocks, root, size);
  dvi__release(root);
  dvi__release(size);
  return possible ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "slots: no memory");
}

void dvi__mass_blocks_clear(dvi__mass_blocks *blocks)
{
  dvi__release(blocks->block);
  dvi__release(blocks->body);
  dvi__release(blocks->together);
}

/* ---- velocities ---- */

static void body_velocity(const dvi__mass_block *block, const double *q, const double *p, double *v)
{
  const double *R = q + block->slot->q;
  double *own = v + block->slot->v, moment[3] = {0}, moved[3];
  memcpy(own, p + block->slot->v, (block->rigid ? 6 : 3) * sizeof *own);
  if (block->rigid) dvi__slot_moment(block->centre, R, p + block->slot->v + 3, moment);
  for (int i = 0; i < 3; i++) own[i] -= moment[i];
  dvi__body_velocity(block->body, own, own);
  dvi__cross(own, block->centre, moved);
  for (int i = 0; i < 3 && block->rigid; i++)
    own[3 + i] = own[3 + i] / block->mass - dvi__dot(R + 3 * i, moved);
}

void dvi__mass_block_velocity(const dvi__mass_block *block, const double *q, const double *p,
                              double *v)
{
  const int first = block->slot->v;
  if (block->slot->kind == DVI__ROTATION)
    body_velocity(block, q, p, v);
  else
    for (int i = first; i < first + dvi__chart_velocities(block->slot->kind); i++)
      v[i] = p[i] / block->mass;
}
