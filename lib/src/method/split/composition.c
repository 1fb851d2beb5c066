/* Symmetric compositions of a symmetric method Phi.
 *
 *     Psi_h = Phi_{g_m h} o ... o Phi_{g_2 h} o Phi_{g_1 h},    g_i = g_{m+1-i},   sum g_i = 1
 * The discrete Lagrangian is the sum of those of the substeps, stationary in the points between
 * them (Marsden and West 2001, sec. 2.5.1). The g_i are those of method/scheme.h. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/damping.h"
#include "method/scheme.h"
#include "num/compensated.h"
#include "system/rescale/transformed.h"

enum { ORDER, BASE };

enum {
  VERLET,
  BORIS,
  MIDPOINT,
  TRAPEZOIDAL,
  GALERKIN,
  IMEX,
  LIE_VERLET,
  SHAPED_GALERKIN,
  NONHOLONOMIC,
  FLOW_GALERKIN,
  BASES
};

static const char *base_name(int index)
{
  static const char *const name[] = {
      "verlet", "boris",      "midpoint",        "trapezoidal",  "galerkin",
      "imex",   "lie-verlet", "shaped-galerkin", "nonholonomic", "flow-galerkin"};
  return index >= 0 && index < BASES ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"order", dvi__scheme_name, 0, 0, 0, "4, 6 or 8; default: 4"},
    {"base", base_name, 0, 0, DVI__LEFT_OUT,
     "the symmetric method that is composed: verlet, boris, midpoint, trapezoidal, galerkin, imex, "
     "lie-verlet, nonholonomic, flow-galerkin, or a program's shaped-galerkin; all other keys are "
     "its own; default: verlet, on groups lie-verlet, with holonomic constraints trapezoidal, with "
     "nonholonomic ones nonholonomic, with a vector potential boris"},
    {0},
};

static const dvi__scheme *scheme_of(const dvi__stepper *self)
{
  return dvi__scheme_at(self->settings.value[ORDER]);
}

static dvi_status composition_create(dvi__stepper *self)
{
  int *chosen = &self->settings.value[BASE];
  if (*chosen == DVI__LEFT_OUT)
    *chosen = self->system->terms & DVI__FACTORS            ? LIE_VERLET
              : self->system->terms & DVI__NONHOLONOMIC     ? NONHOLONOMIC
              : self->system->terms & DVI__HOLONOMIC        ? TRAPEZOIDAL
              : self->system->terms & DVI__VECTOR_POTENTIAL ? BORIS
                                                            : VERLET;
  dvi__stepper *base = self->own = DVI_NEW(dvi__stepper, 1);
  if (base == NULL) return dvi__fail(DVI_NO_MEMORY, "composition: no memory");
  dvi_status status = dvi__stepper_create_inner(self, base_name(*chosen), self->system,
                                                self->shapes, base);
  if (status == DVI_UNSUPPORTED)
    return dvi__fail_in(status, "composition: choose another base=, this one does not serve");
  if (status == DVI_OK && base->method->keep_lengths != NULL)
    status = base->method->keep_lengths(base, scheme_of(self)->lengths);
  if (status != DVI_OK) return dvi__fail_in(status, "composition");
  if (!base->symmetric)
    return dvi__fail(DVI_BAD_OPTION,
                     "composition: %s is not symmetric; choose a symmetric quadrature",
                     base->specification);
  self->order = scheme_of(self)->order;
  self->order = base->order > self->order ? base->order : self->order;
  self->symmetric = 1;
  self->stable = 0.5 * base->stable * scheme_of(self)->stable;
  self->bound = base->bound;
  self->follows = base->follows;
  self->fingerprint = base->fingerprint;
  self->fingerprinted = base->fingerprinted;
  self->memory_count = base->memory_count;
  return DVI_OK;
}

static void composition_destroy(dvi__stepper *self)
{
  if (self->own == NULL) return;
  dvi__stepper_destroy(self->own);
  dvi__release(self->own);
}

/* Return the base, which works on the memory of this method. */
static dvi__stepper *base_of(const dvi__stepper *self)
{
  dvi__stepper *base = self->own;
  base->memory = self->memory;
  return base;
}

static void composition_start(dvi__stepper *self, const double *v)
{
  dvi__stepper_start(base_of(self), v);
}

/* Move the clock by h. The rounded weights sum to 1 but for a rounding, which would add up over
 * many steps. */
static void move_clock(double t, double t_compensation, double h, double *moved,
                       double *moved_compensation)
{
  *moved = t;
  *moved_compensation = t_compensation;
  dvi__add_compensated(moved, moved_compensation, h);
}

static dvi_status composition_step(dvi__stepper *self, dvi__state *state, double h)
{
  dvi__stepper *base = base_of(self);
  const dvi__scheme *s = scheme_of(self);
  const double t = state->t, t_compensation = state->t_compensation;
  for (int i = 0; i < s->substeps; i++)
    DVI_TRY(dvi__inner_step(self, base, state, h * dvi__scheme_part(s, i)));
  if (dvi__transformed_of(self->system) == NULL)
    move_clock(t, t_compensation, h, &state->t, &state->t_compensation);
  return DVI_OK;
}

static int composition_pass(dvi__stepper *self, const dvi__state *now, const double *before,
                            dvi__state *next, const double *h, int count)
{
  dvi__stepper *base = base_of(self);
  const dvi__scheme *s = scheme_of(self);
  double substeps[DVI__SUBSTEPS_MOST];
  if (base->method->pass == NULL || count != 1) return 0;
  dvi__scheme_lengths(s, h[0], substeps);
  if (!base->method->pass(base, now, before, next, substeps, s->substeps)) return 0;
  move_clock(now->t, now->t_compensation, h[0], &next->t, &next->t_compensation);
  return 1;
}

static double composition_traffic(const dvi__stepper *self, int count)
{
  const dvi__stepper *base = self->own;
  return base->method->traffic != NULL && count == 1
             ? base->method->traffic(base, scheme_of(self)->substeps)
             : 0;
}

/* ---- members side by side ---- */

/* Allocate the clocks at the start of a step [2*capacity]. */
static dvi_status composition_prepare_lanes(dvi__stepper *self, int capacity)
{
  dvi__stepper *base = self->own;
  DVI_TRY(dvi__stepper_prepare_lanes(base, capacity));
  if (base->lanes == NULL) return DVI_OK;
  self->lanes = DVI_NEW(double, 2 * (size_t)capacity);
  return self->lanes != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "composition: no memory");
}

static void clear_lanes(dvi__stepper *self)
{
  dvi__release(self->lanes);
}

static void composition_step_lanes(dvi__stepper *self, dvi__members *m, double h)
{
  dvi__stepper *base = self->own;
  const dvi__scheme *s = scheme_of(self);
  const size_t bytes = (size_t)m->count * sizeof(double);
  double *t = self->lanes, *t_compensation = t + m->count;
  memcpy(t, m->t, bytes);
  memcpy(t_compensation, m->t_compensation, bytes);
  for (int i = 0; i < s->substeps; i++) dvi__take_step_lanes(base, m, h * dvi__scheme_part(s, i));
  for (int k = 0; k < m->count; k++)
    move_clock(t[k], t_compensation[k], h, m->t + k, m->t_compensation + k);
}

static int composition_recognizes(const dvi__stepper *self, const double *memory)
{
  const dvi__stepper *base = self->own;
  return base->method->recognizes == NULL || base->method->recognizes(base, memory);
}

static void composition_explain(const dvi__stepper *self, dvi__text *text)
{
  const dvi__stepper *base = self->own;
  dvi__text_add(text, "composition: %d substeps a step, each by %s\n", scheme_of(self)->substeps,
                base->specification);
  base->method->explain(base, text);
}

const dvi__method dvi__composition = {
    .name = "composition",
    .summary = "symmetric composition of a symmetric method to order 4, 6 or 8",
    .cite = "KahanLi1997",
    .keys = keys,
    .takes_rest = 1,
    .takes_shapes = 1,
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL | DVI__FACTORS | DVI__FORCES |
            DVI__HOLONOMIC | DVI__NONHOLONOMIC | DVI__VECTOR_POTENTIAL | DVI__CONTACT |
            DVI__DAMPING,
    .composes = 1,
    .create = composition_create,
    .destroy = composition_destroy,
    .start = composition_start,
    .step = composition_step,
    .pass = composition_pass,
    .traffic = composition_traffic,
    .recognizes = composition_recognizes,
    .explain = composition_explain,
    .prepare_lanes = composition_prepare_lanes,
    .clear_lanes = clear_lanes,
    .step_lanes = composition_step_lanes,
};
