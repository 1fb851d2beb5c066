/* Reading bodies from a mass. Every entry is compared with that of an invariant mass. */
#include "system/chart/reduced.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

/* The user's masses may have been rounded. */
static const double rounding = 1e-12;

typedef struct reader {
  const dvi_system *system;
  const int *slot; /* slot [n] of every stored coordinate */
  int *body_of;    /* body [slots] whose rotation or place a slot is, or -1 */
  dvi__reduced *made;
} reader;

static double mass_entry(const dvi_system *system, int row, int column)
{
  const int e = dvi__pattern_find(&system->vv, row, column);
  return e >= 0 ? system->mass_values[e] : 0;
}

/* Read a body from the first row of R, which has J_d, m rho and the slot of x. */
static void read_body(const reader *r, int c, dvi__reduced_body *body)
{
  const dvi_system *s = r->system;
  const int q = s->slots[c].q;
  double Jd[9];
  *body = (dvi__reduced_body){.slot = c, .line = -1};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) Jd[3 * i + j] = mass_entry(s, q + i, q + j);
  const double trace = Jd[0] + Jd[4] + Jd[8];
  for (int i = 0; i < 9; i++) body->inertia[i] = (i % 4 == 0 ? trace : 0) - Jd[i];
  for (int j = q; j < q + 3; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++) {
      const int other = r->slot[s->vv.row[e]];
      if (s->slots[other].kind == DVI__LINE && s->mass_values[e] != 0 && body->line < 0)
        body->line = other;
    }
  if (body->line + 3 > s->slot_count) body->line = -1;
  for (int i = 0; i < 3 && body->line >= 0; i++) {
    body->shift[i] = mass_entry(s, q + i, s->slots[body->line].q);
    r->body_of[body->line + i] = r->made->count;
  }
  r->body_of[c] = r->made->count++;
}

/* Return the mass of (i,j) in an invariant system, where i belongs to a body. */
static double expected_mass(const reader *r, int i, int j)
{
  const dvi_system *s = r->system;
  const dvi__reduced_body *body = &r->made->bodies[r->body_of[r->slot[i]]];
  const int q = s->slots[body->slot].q;
  if (r->body_of[r->slot[j]] != r->body_of[r->slot[i]]) return 0;
  if (s->slots[r->slot[i]].kind == DVI__LINE && s->slots[r->slot[j]].kind == DVI__LINE)
    return i == j ? mass_entry(s, s->slots[body->line].q, s->slots[body->line].q) : 0;
  if (s->slots[r->slot[i]].kind == DVI__LINE) return expected_mass(r, j, i);
  const int row = (i - q) / 3;
  if (s->slots[r->slot[j]].kind == DVI__LINE)
    return r->slot[j] == body->line + row ? body->shift[(i - q) % 3] : 0;
  return row == (j - q) / 3 ? mass_entry(s, q + (i - q) % 3, q + (j - q) % 3) : 0;
}

/* Return 1 if an entry of the mass is invariant under the group. */
static int is_invariant(const reader *r, int i, int j, double mass)
{
  const dvi_system *s = r->system;
  const int a = r->slot[i], b = r->slot[j];
  double due = mass;
  if (r->body_of[a] >= 0)
    due = expected_mass(r, i, j);
  else if (r->body_of[b] >= 0)
    due = 0;
  else if (s->slots[a].kind == DVI__CIRCLE || s->slots[b].kind == DVI__CIRCLE)
    due = i == j ? mass_entry(s, s->slots[a].q, s->slots[a].q) : 0;
  return fabs(mass - due) <= rounding * fmax(fabs(mass), fabs(due));
}

/* Return 1 for constant masses of lines and angles. The first of an angle's two numbers has its
 * mass. */
static int is_constant_mass(const reader *r, int i, int j)
{
  const dvi_system *s = r->system;
  const dvi__factor_slot *a = &s->slots[r->slot[i]], *b = &s->slots[r->slot[j]];
  return a->kind != DVI__ROTATION && b->kind != DVI__ROTATION && i == a->q && j == b->q;
}

static dvi_status check_invariance(const reader *r, int i, int j, double mass)
{
  if (is_invariant(r, i, j, mass)) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "the mass of coordinates %d and %d is none that turning and shifting leaves as "
                   "it is; lie-galerkin takes it",
                   i, j);
}

/* Check that no expected entry is missing, for all pairs of two slots. */
static dvi_status check_slots(const reader *r, int a, int b)
{
  const dvi_system *s = r->system;
  for (int i = s->slots[a].q; i < s->slots[a].q + dvi__chart_stored(s->slots[a].kind); i++)
    for (int j = s->slots[b].q; j < s->slots[b].q + dvi__chart_stored(s->slots[b].kind); j++)
      DVI_TRY(check_invariance(r, i, j, mass_entry(s, i, j)));
  return DVI_OK;
}

static dvi_status check_all(const reader *r)
{
  for (int c = 0; c < r->system->slot_count; c++) DVI_TRY(check_slots(r, c, c));
  for (int b = 0; b < r->made->count; b++)
    for (int i = 0; i < 3 && r->made->bodies[b].line >= 0; i++)
      DVI_TRY(check_slots(r, r->made->bodies[b].slot, r->made->bodies[b].line + i));
  return DVI_OK;
}

static dvi_status read_masses(const reader *r)
{
  const dvi_system *s = r->system;
  dvi__reduced *made = r->made;
  for (int j = 0; j < s->n; j++)
    for (int e = s->vv.start[j]; e < s->vv.start[j + 1]; e++) {
      const int i = s->vv.row[e];
      DVI_TRY(check_invariance(r, i, j, s->mass_values[e]));
      if (!is_constant_mass(r, i, j)) continue;
      made->row[made->masses] = s->slots[r->slot[i]].x;
      made->column[made->masses] = s->slots[r->slot[j]].x;
      made->mass[made->masses++] = s->mass_values[e];
    }
  return check_all(r);
}

static dvi_status read_reduced(const reader *r, int *slot)
{
  const dvi_system *s = r->system;
  for (int c = 0; c < s->slot_count; c++) {
    for (int i = 0; i < dvi__chart_stored(s->slots[c].kind); i++) slot[s->slots[c].q + i] = c;
    r->body_of[c] = -1;
  }
  for (int c = 0; c < s->slot_count; c++)
    if (s->slots[c].kind == DVI__ROTATION) read_body(r, c, &r->made->bodies[r->made->count]);
  return read_masses(r);
}

dvi_status dvi__reduced_create(const dvi_system *system, dvi__reduced *made)
{
  const size_t slots = (size_t)system->slot_count,
               entries = (size_t)dvi__pattern_entries(&system->vv);
  int *slot = DVI_NEW(int, system->n), *body_of = DVI_NEW(int, slots);
  *made = (dvi__reduced){0,
                         0,
                         DVI_NEW(dvi__reduced_body, slots),
                         DVI_NEW(int, entries),
                         DVI_NEW(int, entries),
                         DVI_NEW(double, entries)};
  dvi_status status = dvi__fail(DVI_NO_MEMORY, "no memory for bodies");
  if (slot && body_of && made->bodies && made->row && made->column && made->mass)
    status = read_reduced(
        &(reader){.system = system, .slot = slot, .body_of = body_of, .made = made}, slot);
  dvi__release(slot);
  dvi__release(body_of);
  if (status != DVI_OK) dvi__reduced_clear(made);
  return status;
}

void dvi__reduced_clear(dvi__reduced *made)
{
  dvi__release(made->bodies);
  dvi__release(made->row);
  dvi__release(made->column);
  dvi__release(made->mass);
  *made = (dvi__reduced){0};
}
