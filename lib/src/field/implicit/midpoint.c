/* The implicit midpoint rule. With q_m = q0 + x the equations of a step (docs/methods/midpoint.md)
 * are
 *
 *     M x - h/2 p0 + h^2/4 F(q_m) = 0,      q1 = q0 + 2 x,      p1 = p0 - h F(q_m).
 *
 * The Jacobian is M + h^2/4 (K + w V_uu). */
#include "core/status.h"
#include "field/implicit/step.h"

static dvi_status residual(void *of, const double *x, double *r)
{
  dvi__implicit_step *s = of;
  const dvi_field *f = s->field;
  const double h = s->h, *force = s->force[0];
  DVI_TRY(dvi__implicit_force(s, 1, x, s->force[0]));
  for (int64_t i = 0; i < f->unknowns; i++)
    r[i] = f->mass.value[i] * x[i] - h / 2 * s->p[f->unknown[i]] + h * h / 4 * force[i];
  return DVI_OK;
}

static dvi_status diagonal(void *of, const double *x, double *d)
{
  dvi__implicit_step *s = of;
  return dvi__implicit_diagonal(s, s->h * s->h / 4, 1, x, d);
}

static void equations(const dvi__implicit_step *s, dvi__field_equations *equations)
{
  equations->stiffness = s->h * s->h / 4;
  equations->residual = residual;
  equations->diagonal = s->field->potential.density != NULL ? diagonal : NULL;
}

static dvi_status begin(dvi__implicit_step *s)
{
  const dvi_field *f = s->field;
  for (int64_t i = 0; i < f->unknowns; i++)
    s->x[i] = s->h / 2 * (s->p[f->unknown[i]] / f->mass.value[i]);
  return DVI_OK;
}

static dvi_status end(dvi__implicit_step *s)
{
  return dvi__implicit_force(s, 1, s->x, s->force[0]);
}

static void move(const dvi__implicit_step *s, int64_t i, double *q, double *p)
{
  *q += 2 * s->x[i];
  *p -= s->h * s->force[0][i];
}

const dvi__rule dvi__midpoint_rule = {.name = "midpoint",
                                      .is_straight = 1,
                                      .numbers = 1,
                                      .forces = 1,
                                      .equations = equations,
                                      .begin = begin,
                                      .end = end,
                                      .move = move};
