/* The implicit midpoint rule (docs/methods/midpoint.md). With q_m = q0 + x a step solves
 *
 *     M x - h/2 (p0 - h/2 F) = 0,      F = K q_m - load + w V_u(q_m) - J(t_m) + S (2 x/h),
 *     q1 = q0 + 2 x,      p1 = p0 - h F,
 *
 * and of Maxwell's fields B1 = B0 + 2 d x. The Jacobian is M + h/2 S + h^2/4 (K + w V_uu). The
 * energy of a linear field changes by 2 F.M^-1 r, with what is left of the equation: no factor may
 * be rounded that halves of h do not give exactly. */
#include <math.h>

#include "core/status.h"
#include "field/implicit/step.h"

/* Spread values of unknowns over the cells, of which the others have 0. */
static const double *spread(const dvi__implicit_step *s, const double *x)
{
  for (int64_t i = 0; i < s->field->unknowns; i++) s->form[s->field->unknown[i]] = x[i];
  return s->form;
}

/* Set the force of a Maxwell field to d^T M_{k+1} B at the middle. */
static void curl(const dvi__implicit_step *s, const double *x)
{
  const dvi_field *f = s->field;
  const dvi__sweep *w = s->sweep;
  const double *form = spread(s, x);
  for (int64_t b = 0; b < w->faces; b++)
    s->H[b] = w->weight[b] * (s->from->B[b] + dvi__sweep_d(w, b, form));
  for (int64_t i = 0; i < f->unknowns; i++)
    s->force[0][i] = dvi__sweep_curl(w, f->unknown[i], s->H);
}

/* The force of the last residual is that of the solution. */
static dvi_status residual(void *of, const double *x, double *r)
{
  dvi__implicit_step *s = of;
  const dvi_field *f = s->field;
  const double half = s->h / 2;
  double *force = s->force[0];
  if (s->sweep != NULL)
    curl(s, x);
  else
    DVI_TRY(dvi__implicit_force(s, 1, x, force));
  for (int64_t i = 0; i < f->unknowns && s->loss != NULL; i++)
    force[i] += s->loss[i] * (2 * x[i] / s->h);
  dvi__add_currents(f, -1, s->signal, force);
  for (int64_t i = 0; i < f->unknowns; i++)
    r[i] = f->mass.value[i] * x[i] - half * (s->from->p[f->unknown[i]] - half * force[i]);
  return DVI_OK;
}

static dvi_status diagonal(void *of, const double *x, double *d)
{
  dvi__implicit_step *s = of;
  DVI_TRY(dvi__implicit_diagonal(s, s->h * s->h / 4, 1, x, d));
  return dvi__implicit_check_curvature(s, 1, d);
}

static void equations(const dvi__implicit_step *s, dvi__field_equations *equations)
{
  equations->loss = s->loss;
  equations->losses = s->h / 2;
  equations->stiffness = s->h * s->h / 4;
  equations->residual = residual;
  equations->diagonal = s->field->potential.density != NULL ? diagonal : NULL;
}

/* Evaluate the currents' signals at the middle. */
static dvi_status find_signals(dvi__implicit_step *s, double t)
{
  const dvi_field *f = s->field;
  for (int c = 0; c < f->currents; c++) {
    const int failed = f->current[c].signal(t, s->signal + c, f->current[c].user);
    if (failed != 0)
      return dvi__fail(failed > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                       "march: the signal of current %d returned %d at t = %.9g", c, failed, t);
    if (!isfinite(s->signal[c]))
      return dvi__fail(DVI_NOT_FINITE, "march: the signal of current %d is %g at t = %.9g", c,
                       s->signal[c], t);
  }
  return DVI_OK;
}

static dvi_status begin(dvi__implicit_step *s)
{
  const dvi_field *f = s->field;
  for (int64_t i = 0; i < f->unknowns; i++)
    s->x[i] = s->h / 2 * (s->from->p[f->unknown[i]] / f->mass.value[i]);
  return find_signals(s, s->from->t + s->h / 2);
}

static void move(const dvi__implicit_step *s, int64_t i, double *q, double *p)
{
  *q += 2 * s->x[i];
  *p -= s->h * s->force[0][i];
}

static void move_rest(const dvi__implicit_step *s, dvi__implicit_state *to)
{
  const dvi__implicit_state *from = s->from;
  const double *form = s->sweep != NULL ? spread(s, s->x) : NULL;
  for (int64_t b = 0; form != NULL && b < s->sweep->faces; b++)
    to->B[b] = from->B[b] + 2 * dvi__sweep_d(s->sweep, b, form);
  for (int c = 0; c < s->field->currents; c++)
    to->delivered[c] = from->delivered[c] + s->h * s->signal[c];
}

const dvi__rule dvi__midpoint_rule = {.name = "midpoint",
                                      .numbers = 1,
                                      .forces = 1,
                                      .equations = equations,
                                      .begin = begin,
                                      .move = move,
                                      .move_rest = move_rest};
