/* Prolongation-collocation.
 *
 * The space is the polynomial of degree 2m-1 through both ends. Its derivatives up to the m-th at
 * both ends are those that the equations of motion and their prolongation give. The quadrature is
 * that of Euler and Maclaurin with [m/2] terms,
 *     Ld(q0,q1) = h/2 (L(0) + L(h))
 *                 - sum_{l=1}^{[m/2]} B_{2l}/(2l)! h^{2l} (L^{(2l-1)}(h) - L^{(2l-1)}(0)),
 * where L^{(k)} is the k-th time derivative along the polynomial. The momenta p0 = -D1 Ld and
 * p1 = D2 Ld are exact, by multipliers for the collocation (step/onestep/prolongation.h). m = 1
 * gives the straight line and the trapezoid. The order is 2 [m/2] + 2, that of the quadrature. The
 * method is symmetric and symplectic. Source: Leok and Shingel 2012, IMA J. Numer. Anal.
 * 32:1194. */
#include "step/onestep/prolongation.h"
#include "method/one_step.h"
#include "num/compensated.h"

enum { DERIVATIVES };

enum { COORDINATES_MOST = 500 };

static const dvi__key keys[] = {
    {"derivatives", NULL, 1, DVI__PROLONGATION_MOST, 2,
     "m: the highest derivative of q that is matched at both ends, 1 to 10; default: 2"},
    {0},
};

static void prolongation_collocation_explain(const dvi__stepper *self, dvi__text *text)
{
  const int m = self->settings.value[DERIVATIVES];
  dvi__text_add(text, "path: polynomial of degree %d, by derivatives up to the %d%s at both ends\n",
                2 * m - 1, m,
                m == 1   ? "st"
                : m == 2 ? "nd"
                : m == 3 ? "rd"
                         : "th");
  dvi__text_add(text, "quadrature: Euler-Maclaurin, the trapezoid and %d term%s\n", m / 2,
                m / 2 == 1 ? "" : "s");
}

static dvi_status prolongation_collocation_place(dvi__stepper *self, const dvi__state *state,
                                                 double h, double part)
{
  const dvi__one_step *one = self->own;
  (void)part;
  dvi__prolongation_place(one->of, state->t, h, state->q, state->p);
  return DVI_OK;
}

DVI__STEP_KIND(prolongation, prolongation_collocation_place, prolongation_collocation_explain,
               .inexact = 1);

static dvi_status prolongation_collocation_create(dvi__stepper *self)
{
  const int m = self->settings.value[DERIVATIVES];
  dvi__prolongation *of;
  if (self->system->n > COORDINATES_MOST)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "%s: %d coordinates, and its matrices are full: at most %d are possible; take galerkin",
        self->method->name, self->system->n, COORDINATES_MOST);
  self->symmetric = 1;
  self->order = 2 * (m / 2) + 2;
  const dvi_status status = dvi__prolongation_create(self->system, m, self->counters, &of);
  if (status != DVI_OK) return dvi__fail_in(status, "%s", self->method->name);
  return dvi__one_step_create(self, sizeof(dvi__one_step), &kind, of,
                              (size_t)(2 * m - 1) * (size_t)self->system->n);
}

static dvi_status prolongation_collocation_step(dvi__stepper *self, dvi__state *state, double h)
{
  const dvi__one_step *one = self->own;
  DVI_TRY(dvi__one_step_solve(self, state, h));
  DVI_TRY(dvi__prolongation_end(one->of, one->x, one->dq, one->dp, self->memory + DVI__CARRIED));
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, one->dp);
  DVI_TRY(dvi__one_step_move(self, state, h, one->x));
  return DVI_OK;
}

static void prolongation_collocation_path(const dvi__stepper *self, const double *q0, double h,
                                          double tau, double *q, double *v)
{
  const dvi__one_step *one = self->own;
  dvi__prolongation_path(one->of, self->memory + DVI__CARRIED, h, tau, q, v);
  for (int i = 0; q != NULL && i < self->system->n; i++) q[i] += q0[i];
}

const dvi__method dvi__prolongation_collocation = {
    .name = "prolongation-collocation",
    .summary = "equations of motion and their derivatives at both ends, Euler-Maclaurin; order 2 "
               "[m/2] + 2; any Lagrangian with Taylor coefficients",
    .cite = "LeokShingel2012b",
    .keys = keys,
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL,
    DVI__ONE_STEP_OPERATIONS,
    .create = prolongation_collocation_create,
    .step = prolongation_collocation_step,
    .path = prolongation_collocation_path,
};
