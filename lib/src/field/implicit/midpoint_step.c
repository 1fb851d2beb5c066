#include "field/implicit/midpoint_step.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

/* ---- the equations ---- */

static dvi_status refuse(int failed)
{
  return dvi__fail(failed > 0 ? DVI_CALLBACK_RETRY : DVI_CALLBACK_FAILED,
                   "march: the potential returned %d", failed);
}

/* Refuse derivatives of the potential at own unknowns that are not finite. */
static dvi_status check(const dvi_field *f, const double *derivative)
{
  for (int64_t i = 0; i < f->unknowns; i++)
    if (dvi__owns(f->mesh, f->degree, f->unknown[i]))
      DVI_TRY(dvi__field_check_datum(f, "derivative of the potential", 0, derivative[i], f->degree,
                                     f->unknown[i]));
  return DVI_OK;
}

/* Add w V_u at the middle to the force. */
static dvi_status push(dvi__midpoint_step *s)
{
  const dvi_field *f = s->field;
  const dvi__density density = {.first = s->work};
  if (f->potential.density == NULL) return DVI_OK;
  const int failed = dvi__field_density(f, s->middle, 0, f->unknowns, &density);
  if (failed != 0) return refuse(failed);
  for (int64_t i = 0; i < f->unknowns; i++) s->force[i] += s->work[i];
  return check(f, s->work);
}

/* Set the middle to q0 + x, and the force to F there, of own unknowns. */
static dvi_status find_force(dvi__midpoint_step *s, const double *x)
{
  const dvi_field *f = s->field;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  for (int64_t i = 0; i < f->unknowns; i++) s->middle[i] = s->q[f->unknown[i]] + x[i];
  dvi_matrix_multiply(&K, 0, s->middle, s->force);
  for (int64_t i = 0; i < f->unknowns; i++) s->force[i] -= f->load[i];
  for (int64_t i = 0; i < f->unknowns && s->loss != NULL; i++)
    s->force[i] += s->loss[i] * (2 * x[i] / s->h);
  dvi__add_currents(f, -1, s->signal, s->force);
  return push(s);
}

static dvi_status residual(void *of, const double *x, double *r)
{
  dvi__midpoint_step *s = of;
  const dvi_field *f = s->field;
  const double half = s->h / 2;
  DVI_TRY(find_force(s, x));
  for (int64_t i = 0; i < f->unknowns; i++)
    r[i] = f->mass.value[i] * x[i] - half * (s->p[f->unknown[i]] - half * s->force[i]);
  return DVI_OK;
}

static dvi_status diagonal(void *of, const double *x, double *d)
{
  dvi__midpoint_step *s = of;
  const dvi_field *f = s->field;
  const dvi__density density = {.second = d};
  for (int64_t i = 0; i < f->unknowns; i++) s->middle[i] = s->q[f->unknown[i]] + x[i];
  const int failed = dvi__field_density(f, s->middle, 0, f->unknowns, &density);
  if (failed != 0) return refuse(failed);
  DVI_TRY(check(f, d));
  for (int64_t i = 0; i < f->unknowns; i++) d[i] *= s->h * s->h / 4;
  return DVI_OK;
}

/* ---- a step ---- */

/* Evaluate the currents' signals at the middle. */
static dvi_status find_signals(dvi__midpoint_step *s, double t)
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

/* The solver's last residual was that of the solution: the force is there. */
static dvi_status move(const dvi__midpoint_step *s, const dvi__midpoint_state *from,
                       dvi__midpoint_state *to)
{
  const dvi_field *f = s->field;
  if (to->q != from->q) {
    memcpy(to->q, from->q, (size_t)f->cells * sizeof *to->q);
    memcpy(to->p, from->p, (size_t)f->cells * sizeof *to->p);
  }
  for (int64_t i = 0; i < f->unknowns; i++) {
    to->q[f->unknown[i]] += 2 * s->x[i];
    to->p[f->unknown[i]] -= s->h * s->force[i];
  }
  for (int c = 0; c < f->currents; c++) to->delivered[c] = from->delivered[c] + s->h * s->signal[c];
  return dvi__refresh(f->mesh, f->degree, to->p);
}

dvi_status dvi__midpoint_take(dvi__midpoint_step *step, const dvi__midpoint_state *from,
                              dvi__midpoint_state *to, int *is_lost, dvi__elliptic_report *report)
{
  const dvi_field *f = step->field;
  *report = (dvi__elliptic_report){0};
  step->q = from->q;
  step->p = from->p;
  if (f->currents > 0) DVI_TRY(dvi__agree(f->mesh, find_signals(step, from->t + step->h / 2)));
  for (int64_t i = 0; i < f->unknowns; i++)
    step->x[i] = step->h / 2 * (from->p[f->unknown[i]] / f->mass.value[i]);
  DVI_TRY(step->solver.kind->solve(step->solver.solver, step->x, report));
  const dvi_status status = move(step, from, to);
  *is_lost = status != DVI_OK;
  return status;
}

/* ---- create ---- */

void dvi__midpoint_step_destroy(dvi__midpoint_step **made)
{
  dvi__midpoint_step *s = *made;
  if (s == NULL) return;
  dvi__on_all_clear(&s->solver);
  dvi__release(s->x);
  dvi__release(s->loss);
  dvi__release(s);
  *made = NULL;
}

/* S is diagonal where M is. A share without losses may have no rows of it. */
static dvi_status take_losses(dvi__midpoint_step *s)
{
  const dvi_field *f = s->field;
  if (f->damping.rows == 0) return DVI_OK;
  s->loss = DVI_NEW(double, f->unknowns);
  if (s->loss == NULL) return dvi__fail(DVI_NO_MEMORY, "march: no memory for losses");
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int64_t at = dvi__csr_find(&f->damping, i, (int)i);
    if (at >= 0) s->loss[i] = f->damping.value[at];
  }
  return DVI_OK;
}

static dvi_status allocate(const dvi_field *f, double h, dvi__midpoint_step **made)
{
  dvi__midpoint_step *s = *made = DVI_NEW(dvi__midpoint_step, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "march: no memory for a step");
  s->field = f;
  s->h = h;
  s->x = DVI_NEW(double, 4 * f->unknowns);
  if (s->x == NULL) return dvi__fail(DVI_NO_MEMORY, "march: no memory for a step");
  s->middle = s->x + f->unknowns;
  s->force = s->middle + f->unknowns;
  s->work = s->force + f->unknowns;
  return take_losses(s);
}

dvi_status dvi__midpoint_step_create(const dvi_field *field, double h, dvi__midpoint_step **made)
{
  *made = NULL;
  dvi_status status = dvi__agree(field->mesh, allocate(field, h, made));
  if (status == DVI_OK && *made != NULL) {
    const dvi__field_equations equations = {.field = field,
                                            .mass = 1,
                                            .loss = (*made)->loss,
                                            .losses = h / 2,
                                            .stiffness = h * h / 4,
                                            .residual = residual,
                                            .diagonal = field->potential.density != NULL ? diagonal
                                                                                         : NULL,
                                            .of = *made};
    status = dvi__on_all_create(&equations, &(*made)->solver);
  }
  if (status != DVI_OK) dvi__midpoint_step_destroy(made);
  return status;
}
