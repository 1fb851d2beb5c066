/* The implicit-explicit method (docs/methods/imex.md), implicit in K, which is fast, and explicit
 * in the potential. A step is
 *
 *     (M + h^2/4 K) x = h (p0 - h/2 F(q0)),
 *     q1 = q0 + x,      p1 = p0 - h/2 (F(q0) + F(q1)),
 *
 * which is one linear equation, always with the same matrix. F(q1) is what the next step begins
 * with. */
#include "core/status.h"
#include "field/implicit/step.h"

static dvi_status residual(void *of, const double *x, double *r)
{
  const dvi__implicit_step *s = of;
  const dvi_field *f = s->field;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  const double h = s->h;
  dvi_matrix_multiply(&K, 0, x, r);
  for (int64_t i = 0; i < f->unknowns; i++)
    r[i] = f->mass.value[i] * x[i] + h * h / 4 * r[i] -
           h * (s->from->p[f->unknown[i]] - h / 2 * s->force[0][i]);
  return DVI_OK;
}

static void equations(const dvi__implicit_step *s, dvi__field_equations *equations)
{
  equations->stiffness = s->h * s->h / 4;
  equations->residual = residual;
}

static dvi_status begin(dvi__implicit_step *s)
{
  const dvi_field *f = s->field;
  if (!s->knows_force) DVI_TRY(dvi__implicit_force(s, 1, NULL, s->force[0]));
  s->knows_force = 1;
  for (int64_t i = 0; i < f->unknowns; i++)
    s->x[i] = s->h * (s->from->p[f->unknown[i]] / f->mass.value[i]);
  return DVI_OK;
}

static dvi_status end(dvi__implicit_step *s)
{
  return dvi__implicit_force(s, 1, s->x, s->force[1]);
}

static void move(const dvi__implicit_step *s, int64_t i, double *q, double *p)
{
  *q += s->x[i];
  *p -= s->h / 2 * (s->force[0][i] + s->force[1][i]);
  s->force[0][i] = s->force[1][i];
}

const dvi__rule dvi__imex_rule = {.name = "imex",
                                  .numbers = 1,
                                  .forces = 2,
                                  .equations = equations,
                                  .begin = begin,
                                  .end = end,
                                  .move = move};
