#include "system/term/constraint.h"

#include "core/memory.h"
#include "core/status.h"

static dvi_status refuse_memory_of_weights(void)
{
  return dvi__fail(DVI_NO_MEMORY, "no memory for the constraints");
}

/* ---- the term ---- */

static dvi_status copy_weighted(const dvi_constraint *given, int n, dvi__lagrangian_term *term)
{
  term->name = "constraint";
  DVI_TRY(dvi__pattern_copy_symmetric(&given->qq, n, "constraint: d2(phi.w)/dq2", &term->qq));
  DVI_TRY(dvi__pattern_copy(&given->qp, n, "constraint: d2(phi.w)/dqdp", &term->qv));
  DVI_TRY(dvi__pattern_copy_symmetric(&given->pp, n, "constraint: d2(phi.w)/dp2", &term->vv));
  return given->hessian != NULL ? DVI_OK : dvi__general_group(term);
}

dvi_status dvi__constraint_copy(const dvi_constraint *given, int n, dvi__constraint_term **term)
{
  if (given->value == NULL || given->gradient == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "system: the constraint has no %s callback",
                     given->value == NULL ? "value" : "gradient");
  if (given->count < 2 || given->count > 2 * n || given->count % 2 != 0)
    return dvi__fail(DVI_BAD_SIZE,
                     "system: %d constraints; an even number from 2 to %d is needed, for others "
                     "have a singular bracket matrix",
                     given->count, 2 * n);
  dvi__constraint_term *made = *term = DVI_NEW(dvi__constraint_term, 1);
  if (made == NULL) return refuse_memory_of_weights();
  made->callbacks = *given;
  DVI_TRY(dvi__pattern_copy_rectangular(&given->gradients, 2 * n, given->count,
                                        "constraint: gradients", &made->gradients));
  DVI_TRY(dvi__pattern_copy(&(dvi_pattern){0}, given->count, "constraint: bracket matrix",
                            &made->bracket));
  return copy_weighted(given, n, &made->weighted);
}

void dvi__constraint_clear(dvi__constraint_term **term)
{
  if (*term == NULL) return;
  dvi__pattern_clear(&(*term)->gradients);
  dvi__pattern_clear(&(*term)->bracket);
  dvi__general_clear(&(*term)->weighted);
  dvi__release(*term);
  *term = NULL;
}

/* ---- phi.w ---- */

static int weighted_value(double t, const double *q, const double *p, double *sum, void *user)
{
  const dvi__weighted *own = user;
  const dvi_constraint *c = &own->constraint->callbacks;
  (void)t;
  *sum = 0;
  const int returned = c->value(q, p, own->phi, c->user);
  for (int a = 0; a < c->count && returned == 0; a++) *sum += own->w[a] * own->phi[a];
  return returned;
}

static int weighted_gradient(double t, const double *q, const double *p, double *sum_q,
                             double *sum_p, void *user)
{
  const dvi__weighted *own = user;
  const dvi_constraint *c = &own->constraint->callbacks;
  const dvi__pattern *gradients = &own->constraint->gradients;
  const int n = gradients->rows / 2, returned = c->gradient(q, p, own->phi_z, c->user);
  (void)t;
  for (int i = 0; i < n; i++) sum_q[i] = sum_p[i] = 0;
  for (int a = 0; a < c->count && returned == 0; a++)
    for (int k = gradients->start[a]; k < gradients->start[a + 1]; k++) {
      const int row = gradients->row[k];
      *(row < n ? sum_q + row : sum_p + row - n) += own->w[a] * own->phi_z[k];
    }
  return returned;
}

static int weighted_hessian(double t, const double *q, const double *p, double *qq, double *qp,
                            double *pp, void *user)
{
  const dvi__weighted *own = user;
  const dvi_constraint *c = &own->constraint->callbacks;
  (void)t;
  return c->hessian(q, p, own->w, qq, qp, pp, c->user);
}

dvi_status dvi__weighted_open(const dvi_system *system, dvi__weighted *weighted)
{
  const dvi__constraint_term *c = system->constraint;
  *weighted = (dvi__weighted){.term = c->weighted,
                              .constraint = c,
                              .phi = DVI_NEW(double, c->callbacks.count),
                              .phi_z = DVI_NEW(double, dvi__pattern_entries(&c->gradients))};
  weighted->term.callbacks = (dvi_lagrangian){
      .value = weighted_value,
      .gradient = weighted_gradient,
      .hessian = c->callbacks.hessian != NULL ? weighted_hessian : NULL,
      .user = weighted};
  return weighted->phi != NULL && weighted->phi_z != NULL ? DVI_OK : refuse_memory_of_weights();
}

void dvi__weighted_close(dvi__weighted *weighted)
{
  dvi__release(weighted->phi);
  dvi__release(weighted->phi_z);
  *weighted = (dvi__weighted){0};
}
