#include "field/implicit/step.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"

/* ---- forces ---- */

dvi_status dvi__implicit_refuse(int failed)
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

static void stand_at(dvi__implicit_step *s, double by, const double *x)
{
  const dvi_field *f = s->field;
  for (int64_t i = 0; i < f->unknowns; i++)
    s->place[i] = x != NULL ? s->q[f->unknown[i]] + by * x[i] : s->q[f->unknown[i]];
}

/* Spread values of unknowns over the cells, of which the others have 0. */
static const double *spread(const dvi__implicit_step *s, const double *x)
{
  for (int64_t i = 0; i < s->field->unknowns; i++) s->form[s->field->unknown[i]] = x[i];
  return s->form;
}

/* Set the force to d^T M_{k+1} B, with B + by d x. */
static void curl(dvi__implicit_step *s, double by, const double *x, double *force)
{
  const dvi_field *f = s->field;
  const dvi__sweep *w = s->sweep;
  const double *form = x != NULL ? spread(s, x) : NULL;
  for (int64_t b = 0; b < w->faces; b++) {
    const double change = form != NULL ? by * dvi__sweep_d(w, b, form) : 0;
    s->H[b] = w->weight[b] * (s->B[b] + change);
  }
  for (int64_t i = 0; i < f->unknowns; i++) force[i] = dvi__sweep_curl(w, f->unknown[i], s->H);
}

dvi_status dvi__implicit_force(dvi__implicit_step *s, double by, const double *x, double *force)
{
  const dvi_field *f = s->field;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  const dvi__density density = {.first = s->work};
  if (s->sweep != NULL) {
    curl(s, by, x, force);
    return DVI_OK;
  }
  stand_at(s, by, x);
  dvi_matrix_multiply(&K, 0, s->place, force);
  for (int64_t i = 0; i < f->unknowns; i++) force[i] -= f->load[i];
  if (f->potential.density == NULL) return DVI_OK;
  const int failed = dvi__field_density(f, s->place, 0, f->unknowns, &density);
  if (failed != 0) return dvi__implicit_refuse(failed);
  for (int64_t i = 0; i < f->unknowns; i++) force[i] += s->work[i];
  return check(f, s->work);
}

dvi_status dvi__implicit_diagonal(dvi__implicit_step *s, double factor, double by, const double *x,
                                  double *d)
{
  const dvi_field *f = s->field;
  const dvi__density density = {.second = d};
  stand_at(s, by, x);
  const int failed = dvi__field_density(f, s->place, 0, f->unknowns, &density);
  if (failed != 0) return dvi__implicit_refuse(failed);
  DVI_TRY(check(f, d));
  for (int64_t i = 0; i < f->unknowns; i++) d[i] *= factor;
  return DVI_OK;
}

/* ---- a step ---- */

static dvi_status solve(dvi__implicit_step *s, dvi__elliptic_report *report)
{
  const dvi_mesh *mesh = s->field->mesh;
  DVI_TRY(dvi__agree(mesh, s->rule->begin(s)));
  DVI_TRY(s->solver.kind->solve(s->solver.solver, s->x, report));
  return s->rule->end != NULL ? dvi__agree(mesh, s->rule->end(s)) : DVI_OK;
}

static dvi_status move(const dvi__implicit_step *s, const dvi__implicit_state *from,
                       dvi__implicit_state *to)
{
  const dvi_field *f = s->field;
  memcpy(to->q, from->q, (size_t)f->cells * sizeof *to->q);
  memcpy(to->p, from->p, (size_t)f->cells * sizeof *to->p);
  for (int64_t i = 0; i < f->unknowns; i++)
    s->rule->move(s, i, to->q + f->unknown[i], to->p + f->unknown[i]);
  if (s->sweep != NULL) {
    const double *form = spread(s, s->x);
    for (int64_t b = 0; b < s->sweep->faces; b++)
      to->B[b] = from->B[b] + s->rule->way * dvi__sweep_d(s->sweep, b, form);
  }
  for (int c = 0; c < f->currents; c++) to->delivered[c] = from->delivered[c] + s->h * s->signal[c];
  return dvi__refresh(f->mesh, f->degree, to->p);
}

dvi_status dvi__implicit_take(dvi__implicit_step *step, const dvi__implicit_state *from,
                              dvi__implicit_state *to, int *is_lost, dvi__elliptic_report *report)
{
  *report = (dvi__elliptic_report){0};
  step->t = from->t;
  step->q = from->q;
  step->p = from->p;
  step->B = from->B;
  DVI_TRY(solve(step, report));
  const dvi_status status = move(step, from, to);
  *is_lost = status != DVI_OK;
  return status;
}

/* ---- create ---- */

void dvi__implicit_step_destroy(dvi__implicit_step **made)
{
  dvi__implicit_step *s = *made;
  if (s == NULL) return;
  dvi__on_all_clear(&s->solver);
  dvi__release(s->x);
  dvi__release(s->form);
  dvi__release(s->loss);
  dvi__release(s);
  *made = NULL;
}

/* S is diagonal where M is. A share without losses may have no rows of it. */
static dvi_status take_losses(dvi__implicit_step *s)
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

static dvi_status allocate(const dvi__implicit_terms *terms, double h, dvi__implicit_step **made)
{
  const dvi_field *f = terms->field;
  const dvi__rule *rule = terms->rule;
  dvi__implicit_step *s = *made = DVI_NEW(dvi__implicit_step, 1);
  if (s != NULL) s->x = DVI_NEW(double, (rule->numbers + 2 + rule->forces) * f->unknowns);
  if (s != NULL && terms->sweep != NULL) s->form = DVI_NEW(double, f->cells + terms->sweep->faces);
  if (s == NULL || s->x == NULL || (terms->sweep != NULL && s->form == NULL))
    return dvi__fail(DVI_NO_MEMORY, "march: no memory for a step");
  s->field = f;
  s->rule = rule;
  s->sweep = terms->sweep;
  s->h = h;
  s->place = s->x + rule->numbers * f->unknowns;
  s->work = s->place + f->unknowns;
  for (int k = 0; k < rule->forces; k++) s->force[k] = s->work + (k + 1) * f->unknowns;
  if (s->sweep != NULL) s->H = s->form + f->cells;
  return take_losses(s);
}

dvi_status dvi__implicit_step_create(const dvi__implicit_terms *terms, double h,
                                     dvi__implicit_step **made)
{
  const dvi_field *field = terms->field;
  *made = NULL;
  dvi_status status = dvi__agree(field->mesh, allocate(terms, h, made));
  if (status == DVI_OK && *made != NULL) {
    dvi__field_equations equations = {.field = field, .mass = 1, .of = *made};
    terms->rule->equations(*made, &equations);
    status = dvi__on_all_create(&equations, &(*made)->solver);
  }
  if (status != DVI_OK) dvi__implicit_step_destroy(made);
  return status;
}
