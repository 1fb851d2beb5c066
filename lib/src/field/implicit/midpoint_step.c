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

static void find_middle(dvi__midpoint_step *s, const double *x)
{
  const dvi_field *f = s->field;
  for (int64_t i = 0; i < f->unknowns; i++) s->middle[i] = s->from->q[f->unknown[i]] + x[i];
}

/* Set the force to K q at the middle, less the load. */
static void pull(dvi__midpoint_step *s, const double *x)
{
  const dvi_field *f = s->field;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  find_middle(s, x);
  dvi_matrix_multiply(&K, 0, s->middle, s->force);
  for (int64_t i = 0; i < f->unknowns; i++) s->force[i] -= f->load[i];
}

/* Spread values of unknowns over the cells, of which the others have 0. */
static const double *spread(const dvi__midpoint_step *s, const double *x)
{
  for (int64_t i = 0; i < s->field->unknowns; i++) s->form[s->field->unknown[i]] = x[i];
  return s->form;
}

/* Set the force to d^T M_{k+1} B at the middle. */
static void curl(dvi__midpoint_step *s, const double *x)
{
  const dvi_field *f = s->field;
  const dvi__sweep *w = s->sweep;
  const double *form = spread(s, x);
  for (int64_t b = 0; b < w->faces; b++)
    s->H[b] = w->weight[b] * (s->from->B[b] + dvi__sweep_d(w, b, form));
  for (int64_t i = 0; i < f->unknowns; i++) s->force[i] = dvi__sweep_curl(w, f->unknown[i], s->H);
}

/* Set the force to F, of own unknowns. */
static dvi_status find_force(dvi__midpoint_step *s, const double *x)
{
  const dvi_field *f = s->field;
  if (s->sweep != NULL)
    curl(s, x);
  else
    pull(s, x);
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
    r[i] = f->mass.value[i] * x[i] - half * (s->from->p[f->unknown[i]] - half * s->force[i]);
  return DVI_OK;
}

static dvi_status diagonal(void *of, const double *x, double *d)
{
  dvi__midpoint_step *s = of;
  const dvi_field *f = s->field;
  const dvi__density density = {.second = d};
  find_middle(s, x);
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
static dvi_status move(const dvi__midpoint_step *s, dvi__midpoint_state *to)
{
  const dvi_field *f = s->field;
  const dvi__midpoint_state *from = s->from;
  memcpy(to->q, from->q, (size_t)f->cells * sizeof *to->q);
  memcpy(to->p, from->p, (size_t)f->cells * sizeof *to->p);
  for (int64_t i = 0; i < f->unknowns; i++) {
    to->q[f->unknown[i]] += 2 * s->x[i];
    to->p[f->unknown[i]] -= s->h * s->force[i];
  }
  if (s->sweep != NULL) {
    const double *form = spread(s, s->x);
    for (int64_t b = 0; b < s->sweep->faces; b++)
      to->B[b] = from->B[b] + 2 * dvi__sweep_d(s->sweep, b, form);
  }
  for (int c = 0; c < f->currents; c++) to->delivered[c] = from->delivered[c] + s->h * s->signal[c];
  return dvi__refresh(f->mesh, f->degree, to->p);
}

dvi_status dvi__midpoint_take(dvi__midpoint_step *step, const dvi__midpoint_state *from,
                              dvi__midpoint_state *to, int *is_lost, dvi__elliptic_report *report)
{
  const dvi_field *f = step->field;
  *report = (dvi__elliptic_report){0};
  step->from = from;
  if (f->currents > 0) DVI_TRY(dvi__agree(f->mesh, find_signals(step, from->t + step->h / 2)));
  for (int64_t i = 0; i < f->unknowns; i++)
    step->x[i] = step->h / 2 * (from->p[f->unknown[i]] / f->mass.value[i]);
  DVI_TRY(step->solver.kind->solve(step->solver.solver, step->x, report));
  const dvi_status status = move(step, to);
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
  dvi__release(s->form);
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

static dvi_status allocate(dvi__midpoint_step *s)
{
  const dvi_field *f = s->field;
  const int64_t faces = s->sweep != NULL ? s->sweep->faces : 0;
  s->x = DVI_NEW(double, 4 * f->unknowns);
  if (s->sweep != NULL) s->form = DVI_NEW(double, f->cells + faces);
  if (s->x == NULL || (s->sweep != NULL && s->form == NULL))
    return dvi__fail(DVI_NO_MEMORY, "march: no memory for a step");
  s->middle = s->x + f->unknowns;
  s->force = s->middle + f->unknowns;
  s->work = s->force + f->unknowns;
  if (s->sweep != NULL) s->H = s->form + f->cells;
  return take_losses(s);
}

static dvi_status make(dvi__midpoint_step *s)
{
  const dvi_field *f = s->field;
  DVI_TRY(dvi__agree(f->mesh, allocate(s)));
  const dvi__field_equations equations = {.field = f,
                                          .mass = 1,
                                          .loss = s->loss,
                                          .losses = s->h / 2,
                                          .stiffness = s->h * s->h / 4,
                                          .residual = residual,
                                          .diagonal = f->potential.density != NULL ? diagonal
                                                                                   : NULL,
                                          .of = s};
  return dvi__on_all_create(&equations, &s->solver);
}

dvi_status dvi__midpoint_step_create(const dvi_field *field, const dvi__sweep *sweep, double h,
                                     dvi__midpoint_step **made)
{
  dvi__midpoint_step *s = *made = DVI_NEW(dvi__midpoint_step, 1);
  dvi_status status = dvi__agree(
      field->mesh, s != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "march: no memory for a step"));
  if (status == DVI_OK && s != NULL) {
    s->field = field;
    s->sweep = sweep;
    s->h = h;
    status = make(s);
  }
  if (status != DVI_OK) dvi__midpoint_step_destroy(made);
  return status;
}
