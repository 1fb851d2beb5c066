/* A lift of a connection to Spin(n), a spin structure.
 *
 * Each rotation has two lifts, s and -s. Around an inner hinge the product of the lifts shall be
 * that of the turn by the deficit, not its negative: the bits of the facets around it, 1 for -s,
 * have a given sum modulo 2. Bits along a tree of cells are chosen as 0, because they only change
 * the lifts of frames. Where all bits but one around a hinge are known, the last one follows. Where
 * none follows, a bit becomes a parameter, and later hinges whose bits are all known give equations
 * for the parameters (inactivation, as in Shokrollahi and Luby 2011). Bits are thus words with one
 * bit for each parameter and the last one for a constant. An equation 0 = 1 says that there is no
 * spin structure, which is so if and only if the second Stiefel-Whitney class does not vanish
 * (Milnor 1963). Of own rotations the holonomies shall be lifted to the shorter turns, which may
 * contradict each other on any mesh. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/connection/connection.h"
#include "field/mesh/volume.h"

enum { PARAMETERS = 63 };

static const uint64_t constant = (uint64_t)1 << PARAMETERS;

/* Own rotations may be wrong by 1e-8 each. */
static const double half_turn_slack = 1e-7;

typedef struct signs {
  const dvi_connection *c;
  int64_t facets, hinges;
  uint64_t *bit;  /* [facets] */
  char *is_known; /* [facets] */
  char *is_free;  /* [hinges] not 0 for those of which nothing is asked */
  uint64_t *sum;  /* [hinges] of the known bits, and of the given one */
  int *unknown;   /* [hinges] */
  int64_t *queue; /* [facets*n] hinges with at most one unknown bit, last in first out */
  int64_t queued;
  int *order;                    /* [cells] from neighbour to neighbour */
  uint64_t used;                 /* parameters */
  uint64_t equation[PARAMETERS]; /* whose lowest bit is the parameter, or 0 */
} signs;

/* ---- parameters ---- */

/* Replace parameters that have an equation, lower ones first. */
static uint64_t reduce(const signs *s, uint64_t word)
{
  for (int p = 0; p < PARAMETERS; p++)
    if (word >> p & 1 && s->equation[p] != 0) word ^= s->equation[p];
  return word;
}

static dvi_status refuse(const signs *s, int64_t hinge)
{
  const dvi__cell_name name = dvi__name_cell(s->c->mesh, s->c->n - 2, hinge);
  if (s->c->is_own)
    return dvi__fail(DVI_UNSUPPORTED,
                     "curvature: the own rotations have no lift that turns by the shorter way "
                     "around all hinges: its signs around %s contradict those around others; take "
                     "the rotations without spin",
                     name.text);
  return dvi__fail(DVI_UNSUPPORTED,
                   "curvature: the mesh has no spin structure, since the signs of lifts around %s "
                   "contradict those around others; take rotations without spin",
                   name.text);
}

static dvi_status add_equation(signs *s, int64_t hinge)
{
  uint64_t word = reduce(s, s->sum[hinge]);
  if (word == constant) return refuse(s, hinge);
  for (int p = 0; p < PARAMETERS && word != 0; p++)
    if (word >> p & 1) {
      s->equation[p] = word;
      break;
    }
  return DVI_OK;
}

/* Free the parameters that have equations. */
static void eliminate(signs *s)
{
  for (int64_t f = 0; f < s->facets; f++) s->bit[f] = reduce(s, s->bit[f]);
  for (int64_t h = 0; h < s->hinges; h++) s->sum[h] = reduce(s, s->sum[h]);
  for (int p = 0; p < PARAMETERS; p++)
    if (s->equation[p] != 0) s->used &= ~((uint64_t)1 << p);
  memset(s->equation, 0, sizeof s->equation);
}

static dvi_status new_parameter(signs *s, uint64_t *word)
{
  if (s->used == constant - 1) eliminate(s);
  for (int p = 0; p < PARAMETERS; p++) {
    *word = (uint64_t)1 << p;
    if (s->used & *word) continue;
    s->used |= *word;
    return DVI_OK;
  }
  return dvi__fail(DVI_UNSUPPORTED,
                   "curvature: more than %d signs of lifts are independent, as on surfaces of "
                   "genus 32; take rotations without spin",
                   PARAMETERS);
}

/* ---- known bits ---- */

static void know(signs *s, int64_t facet, uint64_t word)
{
  const int n = s->c->n;
  s->bit[facet] = word;
  s->is_known[facet] = 1;
  for (int j = 0; j < n; j++) {
    const int hinge = s->c->mesh->facet[n - 1][facet * n + j];
    s->sum[hinge] ^= word;
    if (--s->unknown[hinge] <= 1 && !s->is_free[hinge]) s->queue[s->queued++] = hinge;
  }
}

static int64_t facet_at(const signs *s, int64_t at)
{
  const dvi__rings *r = &s->c->rings;
  return s->c->mesh->facet[s->c->n][(int64_t)r->cell[at] * (s->c->n + 1) + r->leave[at]];
}

static dvi_status follow_hinges(signs *s)
{
  while (s->queued > 0) {
    const int64_t hinge = s->queue[--s->queued];
    if (s->unknown[hinge] == 0) {
      DVI_TRY(add_equation(s, hinge));
      continue;
    }
    int64_t at = s->c->rings.start[hinge];
    while (s->is_known[facet_at(s, at)]) at++;
    know(s, facet_at(s, at), s->sum[hinge]);
  }
  return DVI_OK;
}

/* ---- hinges ---- */

/* Tell if the product of the lifts around an inner hinge is the negative of what it shall be.
 * Nothing is asked of half turns by own rotations, which are as long in either sense. */
static dvi_status ask_hinge(signs *s, int64_t hinge, double deficit)
{
  const int n = s->c->n, size = dvi__spin_size(n);
  double lift[DVI__SPIN_MAX], wanted[DVI__SPIN_MAX], along = 0;
  dvi__plane plane;
  DVI_TRY(dvi_connection_holonomy(s->c, hinge, NULL, lift));
  dvi__spin_one(n, wanted);
  if (!s->c->is_own) {
    DVI_TRY(dvi__hinge_plane(s->c, hinge, &plane));
    dvi__spin_turn(n, &plane, deficit, wanted);
  }
  for (int i = 0; i < size; i++) along += lift[i] * wanted[i];
  s->is_free[hinge] = s->c->is_own && fabs(along) <= half_turn_slack;
  s->sum[hinge] = along < 0 ? constant : 0;
  return DVI_OK;
}

static dvi_status start_hinges(signs *s)
{
  double *deficit = DVI_NEW(double, s->hinges);
  dvi_status status = deficit != NULL ? dvi_hinge_deficits(s->c->mesh, s->c->length, deficit)
                                      : dvi__fail(DVI_NO_MEMORY, "curvature: no memory for a lift");
  for (int64_t h = 0; h < s->hinges && status == DVI_OK; h++) {
    s->unknown[h] = (int)(s->c->rings.start[h + 1] - s->c->rings.start[h]);
    s->is_free[h] = s->c->rings.is_open[h];
    if (!s->is_free[h]) status = ask_hinge(s, h, deficit[h]);
  }
  dvi__release(deficit);
  return status;
}

/* Bits of the facets that lead from cell to cell of a tree are 0. */
static void know_tree(signs *s, char *is_reached)
{
  const int n = s->c->n;
  int64_t length = 0, done = 0;
  for (int64_t c = 0; c < s->c->mesh->count[n]; c++) {
    if (is_reached[c]) continue;
    is_reached[c] = 1;
    s->order[length++] = (int)c;
    for (; done < length; done++)
      for (int slot = 0; slot <= n; slot++) {
        const int next = dvi__cell_behind(s->c->mesh, s->order[done], slot);
        if (next < 0 || is_reached[next]) continue;
        is_reached[next] = 1;
        s->order[length++] = next;
        know(s, s->c->mesh->facet[n][(int64_t)s->order[done] * (n + 1) + slot], 0);
      }
  }
}

/* Parameters are chosen near to what is known, so that few are needed. */
static dvi_status find_bits(signs *s)
{
  const int n = s->c->n;
  DVI_TRY(follow_hinges(s));
  for (int64_t i = 0; i < s->c->mesh->count[n]; i++)
    for (int slot = 0; slot <= n; slot++) {
      const int64_t facet = s->c->mesh->facet[n][(int64_t)s->order[i] * (n + 1) + slot];
      uint64_t word;
      if (s->is_known[facet] || s->c->mesh->coface[2 * facet + 1] < 0) continue;
      DVI_TRY(new_parameter(s, &word));
      know(s, facet, word);
      DVI_TRY(follow_hinges(s));
    }
  return DVI_OK;
}

/* ---- all ---- */

static dvi_status choose_signs(signs *s, dvi_connection *c)
{
  char *is_reached = DVI_NEW(char, c->mesh->count[c->n]);
  s->bit = DVI_NEW(uint64_t, s->facets);
  s->is_known = DVI_NEW(char, s->facets);
  s->is_free = DVI_NEW(char, s->hinges);
  s->sum = DVI_NEW(uint64_t, s->hinges);
  s->unknown = DVI_NEW(int, s->hinges);
  s->queue = DVI_NEW(int64_t, s->facets * c->n);
  s->order = DVI_NEW(int, c->mesh->count[c->n]);
  dvi_status status = DVI_OK;
  if (is_reached == NULL || s->bit == NULL || s->is_known == NULL || s->is_free == NULL ||
      s->sum == NULL || s->unknown == NULL || s->queue == NULL || s->order == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "curvature: no memory for a lift");
  if (status == DVI_OK) status = start_hinges(s);
  if (status == DVI_OK) {
    know_tree(s, is_reached);
    status = find_bits(s);
  }
  const int size = dvi__spin_size(c->n);
  for (int64_t f = 0; f < s->facets && status == DVI_OK; f++)
    if (reduce(s, s->bit[f]) & constant)
      for (int i = 0; i < size; i++) c->lifted[f * size + i] *= -1;
  dvi__release(is_reached);
  dvi__release(s->bit);
  dvi__release(s->is_known);
  dvi__release(s->is_free);
  dvi__release(s->sum);
  dvi__release(s->unknown);
  dvi__release(s->queue);
  dvi__release(s->order);
  return status;
}

static dvi_status lift_rotations(dvi_connection *c)
{
  const int n = c->n, size = dvi__spin_size(n);
  for (int64_t f = 0; f < c->mesh->count[n - 1]; f++) {
    double copy[DVI__ROTATION_MAX];
    if (c->mesh->coface[2 * f + 1] < 0) continue;
    memcpy(copy, c->rotation + f * n * n, (size_t)(n * n) * sizeof *copy);
    if (dvi__determinant(n, copy) < 0)
      return dvi__fail(DVI_UNSUPPORTED,
                       "curvature: the rotation through %s turns right into left, and has no lift",
                       dvi__name_cell(c->mesh, n - 1, f).text);
    dvi__spin_of(n, c->rotation + f * n * n, c->lifted + f * size);
  }
  return DVI_OK;
}

dvi_status dvi__connection_lift(dvi_connection *c)
{
  signs s = {.c = c, .facets = c->mesh->count[c->n - 1], .hinges = c->mesh->count[c->n - 2]};
  if (c->mesh->orientation == NULL && !c->is_own)
    return dvi__fail(DVI_UNSUPPORTED,
                     "curvature: the mesh is not orientable, and its rotations have no lift; take "
                     "them without spin");
  c->lifted = DVI_NEW(double, s.facets *dvi__spin_size(c->n));
  if (c->lifted == NULL) return dvi__fail(DVI_NO_MEMORY, "curvature: no memory for a lift");
  DVI_TRY(lift_rotations(c));
  return choose_signs(&s, c);
}
