/* The masses of slots. Where the mass couples no two factors, and a factor's own mass does not
 * change with its place, the kinetic energy is that of the chart's own numbers, and has no moment
 * (group/chart_nodes.h). A potential's moment N = y x L_y on the way turns into the force
 * T^T L_y. */
#include "core/memory.h"
#include "core/status.h"
#include "system/chart/charted_struct.h"

static double entry_of_mass(const dvi_system *s, int row, int column)
{
  const int e = dvi__pattern_find(&s->vv, row, column);
  return e >= 0 ? s->mass_values[e] : 0;
}

/* Give the mass of stored numbers i and j of a slot that does not change with its place. */
static double even_mass(const dvi_system *s, const dvi__factor_slot *slot, int i, int j)
{
  const int vectors = slot->kind == DVI__ROTATION ? 3 : 1;
  if (i / vectors != j / vectors) return 0;
  return entry_of_mass(s, slot->q + i % vectors, slot->q + j % vectors);
}

/* Tell whether a slot's mass is like that, and couples no other slot. */
static int is_apart(const dvi_system *s, const dvi__factor_slot *slot)
{
  const int stored = dvi__chart_stored(slot->kind);
  for (int j = 0; j < stored; j++) {
    for (int e = s->vv.start[slot->q + j]; e < s->vv.start[slot->q + j + 1]; e++)
      if ((s->vv.row[e] < slot->q || s->vv.row[e] >= slot->q + stored) && s->mass_values[e] != 0)
        return 0;
    for (int i = 0; i < stored; i++)
      if (entry_of_mass(s, slot->q + i, slot->q + j) != even_mass(s, slot, i, j)) return 0;
  }
  return 1;
}

/* Read J of a rotation from its mass I x J_d, or m. */
static void read_inertia(const dvi_system *s, const dvi__factor_slot *slot, double *inertia)
{
  if (slot->kind != DVI__ROTATION) {
    *inertia = entry_of_mass(s, slot->q, slot->q);
    return;
  }
  double trace = 0;
  for (int i = 0; i < 3; i++) trace += entry_of_mass(s, slot->q + i, slot->q + i);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      inertia[3 * i + j] = (i == j ? trace : 0) - entry_of_mass(s, slot->q + i, slot->q + j);
}

static dvi_status refuse_memory_of_masses(const dvi_system *s)
{
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %d factors", s->slot_count);
}

static dvi_status read_apart(dvi__charted *x)
{
  const dvi_system *s = x->base;
  for (int c = 0; c < s->slot_count; c++)
    if (!is_apart(s, &s->slots[c])) return DVI_OK;
  x->inertia = DVI_NEW(double, 9 * (size_t)s->slot_count);
  if (x->inertia == NULL) return refuse_memory_of_masses(s);
  for (int c = 0; c < s->slot_count; c++) read_inertia(s, &s->slots[c], x->inertia + 9 * (size_t)c);
  return DVI_OK;
}

dvi_status dvi__charted_read_masses(dvi__charted *x)
{
  const dvi_system *s = x->base;
  x->own_mass = DVI_NEW(double, 3 * (size_t)s->slot_count);
  if (x->own_mass == NULL) return refuse_memory_of_masses(s);
  for (int c = 0; c < s->slot_count; c++)
    for (int j = 0; j < dvi__chart_stored(s->slots[c].kind) && j < 3; j++)
      x->own_mass[3 * c + j] = entry_of_mass(s, s->slots[c].q + j, s->slots[c].q + j);
  return read_apart(x);
}
