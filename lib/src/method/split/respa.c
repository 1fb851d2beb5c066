/* The impulse method (Verlet-I, r-RESPA). The slow potentials kick. Between the kicks stands the
 * fast motion, by short steps of Verlet's method or exactly.
 *
 *     Ld(q0,q1) = action of the fast motion from q0 to q1 - h/2 (U(t0,q0) + U(t1,q1))
 * This action is the sum of Verlet's for the substeps, or the integral of T - W along the exact
 * path for W = q.Kq/2 + b.q. U kicks (method/split/impulse.h). The order is 2, and the method is
 * symmetric and symplectic. Kicks in phase with a fast mode resonate, where h omega is near a
 * multiple of pi. Source: Tuckerman, Berne and Martyna 1992; Stern 2009, sec. 2.2.4. */
#include "core/status.h"
#include "method/split/oscillation.h"

enum { SUBSTEPS };

enum { EXACT };

static const char *substeps_name(int index)
{
  return index == EXACT ? "exact" : NULL;
}

static const dvi__key keys[] = {
    {"substeps", substeps_name, 1, 1000000, 10,
     "how many steps of verlet the fast motion takes in a step; or exact, for quadratic fast "
     "potentials; default: 10"},
    {0},
};

static dvi_status respa_substeps(dvi__stepper *self, dvi__state *state, double h)
{
  return dvi__impulse_inner_steps(self, state, h, self->settings.value[SUBSTEPS]);
}

static int is_exact(const dvi__stepper *self)
{
  return self->settings.value[SUBSTEPS] == EXACT;
}

static dvi_status respa_create(dvi__stepper *self)
{
  if (is_exact(self))
    return dvi__oscillation_create(self, NULL, DVI__MOTION_AUTO, "substeps=k takes any");
  DVI_TRY(dvi__impulse_create(self, sizeof(dvi__impulse), 0));
  ((dvi__impulse *)self->own)->move = respa_substeps;
  DVI_TRY(dvi__impulse_take_inner(self, "verlet:blocking=none"));
  self->stable = self->settings.value[SUBSTEPS] * ((dvi__impulse *)self->own)->inner->stable;
  return DVI_OK;
}

static void respa_destroy(dvi__stepper *self)
{
  if (is_exact(self))
    dvi__oscillation_destroy(self);
  else if (self->own != NULL)
    dvi__impulse_destroy(self);
}

static void respa_explain(const dvi__stepper *self, dvi__text *text)
{
  if (is_exact(self))
    dvi__oscillation_explain(self, text);
  else
    dvi__text_add(text,
                  "kernel: explicit; a step has one gradient of the slow potentials and %d of the "
                  "fast ones\nsolver: none\n",
                  self->settings.value[SUBSTEPS]);
}

const dvi__method dvi__respa = {
    .name = "respa",
    .summary = "impulse method, to compare with: kicks by slow potentials, substeps or exact "
               "motion of the fast ones; order 2; resonates",
    .cite = "TuckermanBerneMartyna1992",
    .keys = keys,
    DVI__IMPULSE_OPERATIONS,
    .create = respa_create,
    .destroy = respa_destroy,
    .explain = respa_explain,
};
