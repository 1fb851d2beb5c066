#include "field/implicit/step.h"

#include <math.h>
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
    s->place[i] = x != NULL ? s->from->q[f->unknown[i]] + by * x[i] : s->from->q[f->unknown[i]];
}

dvi_status dvi__implicit_force(dvi__implicit_step *s, double by, const double *x, double *force)
{
  const dvi_field *f = s->field;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  const dvi__density density = {.first = s->work};
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

dvi_status dvi__implicit_check_curvature(const dvi__implicit_step *s, double times, const double *d)
{
  const dvi_field *f = s->field;
  double least = 1;
  for (int64_t i = 0; i < f->unknowns; i++)
    if (dvi__owns(f->mesh, f->degree, f->unknown[i]))
      least = fmin(least, 1 + times * d[i] / f->mass.value[i]);
  if (least > 0) return DVI_OK;
  return dvi__fail(DVI_STEP_TOO_LARGE,
                   "the potential is so concave that the step may have several solutions; h is "
                   "to be below %.3g",
                   s->h / sqrt(1 - least));
}

/* ---- a step ---- */

static dvi_status solve(dvi__implicit_step *s, dvi__elliptic_report *report)
{
  const dvi_mesh *mesh = s->field->mesh;
  DVI_TRY(dvi__agree(mesh, s->rule->begin(s)));
  DVI_TRY(s->solver.kind->solve(s->solver.solver, s->x, report));
  return s->rule->end != NULL ? dvi__agree(mesh, s->rule->end(s)) : DVI_OK;
}

static dvi_status move(const dvi__implicit_step *s, dvi__implicit_state *to)
{
  const dvi_field *f = s->field;
  memcpy(to->q, s->from->q, (size_t)f->cells * sizeof *to->q);
  memcpy(to->p, s->from->p, (size_t)f->cells * sizeof *to->p);
  for (int64_t i = 0; i < f->unknowns; i++)
    s->rule->move(s, i, to->q + f->unknown[i], to->p + f->unknown[i]);
  if (s->rule->move_rest != NULL) s->rule->move_rest(s, to);
  return dvi__refresh(f->mesh, f->degree, to->p);
}

dvi_status dvi__implicit_take(dvi__implicit_step *step, const dvi__implicit_state *from,
                              dvi__implicit_state *to, int *is_lost, dvi__elliptic_report *report)
{
  *report = (dvi__elliptic_report){0};
  step->from = from;
  DVI_TRY(solve(step, report));
  const dvi_status status = move(step, to);
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

static dvi_status allocate(dvi__implicit_step *s)
{
  const dvi_field *f = s->field;
  const dvi__rule *rule = s->rule;
  s->x = DVI_NEW(double, (rule->numbers + 2 + rule->forces) * f->unknowns);
  if (s->sweep != NULL) s->form = DVI_NEW(double, f->cells + s->sweep->faces);
  if (s->x == NULL || (s->sweep != NULL && s->form == NULL))
    return dvi__fail(DVI_NO_MEMORY, "march: no memory for a step");
  s->place = s->x + rule->numbers * f->unknowns;
  s->work = s->place + f->unknowns;
  for (int k = 0; k < rule->forces; k++) s->force[k] = s->work + (k + 1) * f->unknowns;
  if (s->sweep != NULL) s->H = s->form + f->cells;
  return take_losses(s);
}

static dvi_status make(dvi__implicit_step *s)
{
  dvi__field_equations equations = {.field = s->field, .mass = 1, .of = s};
  DVI_TRY(dvi__agree(s->field->mesh, allocate(s)));
  s->rule->equations(s, &equations);
  return dvi__on_all_create(&equations, &s->solver);
}

dvi_status dvi__implicit_step_create(const dvi__implicit_step *wanted, dvi__implicit_step **made)
{
  dvi__implicit_step *s = *made = DVI_NEW(dvi__implicit_step, 1);
  dvi_status status = dvi__agree(
      wanted->field->mesh,
      s != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "march: no memory for a step"));
  if (status == DVI_OK && s != NULL) {
    *s = *wanted;
    status = make(s);
  }
  if (status != DVI_OK) dvi__implicit_step_destroy(made);
  return status;
}
