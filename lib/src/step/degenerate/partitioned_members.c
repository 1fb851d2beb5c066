#include "step/degenerate/partitioned_members.h"

#include "core/memory.h"
#include "core/status.h"
#include "num/pfaffian.h"
#include "step/degenerate/partitioned_struct.h"
#include "step/degenerate/stage_inverse_members.h"
#include "system/evaluate/form_batches.h"

typedef dvi__abreast abreast;

struct dvi__partitioned_members {
  dvi__partitioned *step;
  dvi__evaluator *evaluator;
  dvi__stage_inverse_members *inverse;
  double h;
  int has_gradients; /* H_qv and qv1 have the gradients of alpha at the next residual's points */
  const abreast *q0, *p0, *carried; /* [n] */
  /* The numbers of dvi__partitioned with these names. */
  abreast *t, *Q, *V, *L_q, *L_v, *H_qq, *H_qv, *k0, *k1, *K0, *K1, *dq, *q1, *alpha1, *qv0, *qq1,
      *qv1;
  abreast *numbers; /* all of them */
};

int dvi__partitioned_has_members(const dvi__partitioned *p)
{
  return p->inverse != NULL && p->kick.has_multiplier && !p->kick.at_mean &&
         p->n <= DVI__SIDES_MOST && (p->system->terms & DVI__ONE_FORM) != 0 &&
         dvi__hessian_noise(p->system) == 0;
}

/* ---- create ---- */

/* Lay out the arrays in the numbers, or count these. */
static size_t members_lay_out(dvi__partitioned_members *m)
{
  const dvi_system *system = m->step->system;
  const size_t n = (size_t)m->step->n, s = (size_t)m->step->s,
               qq = (size_t)dvi__pattern_entries(&system->qq),
               qv = (size_t)dvi__pattern_entries(&system->qv);
  abreast **const array[] = {&m->t,    &m->Q,      &m->V,   &m->L_q, &m->L_v, &m->H_qq,
                             &m->H_qv, &m->k0,     &m->k1,  &m->K0,  &m->K1,  &m->dq,
                             &m->q1,   &m->alpha1, &m->qv0, &m->qq1, &m->qv1};
  const size_t size[] = {s, n * s, n * s, n * s, n * s, qq * s, qv * s, n, n,
                         n, n,     n,     n,     n,     qv,     qq,     qv};
  size_t count = 0;
  for (size_t i = 0; i < sizeof size / sizeof *size; count += size[i++])
    *array[i] = m->numbers != NULL ? m->numbers + count : NULL;
  return count;
}

static dvi_status members_complete(dvi__partitioned_members *m)
{
  const dvi__partitioned *p = m->step;
  DVI_TRY(
      dvi__evaluator_create(p->system, DVI__ABREAST * p->s, DVI__HESSIANS, NULL, &m->evaluator));
  DVI_TRY(dvi__stage_inverse_members_create(p->inverse, &m->inverse));
  m->numbers = DVI_NEW(abreast, members_lay_out(m));
  if (m->numbers == NULL)
    return dvi__fail(DVI_NO_MEMORY, "no memory for %d members in %d dimensions", DVI__ABREAST,
                     p->n);
  (void)members_lay_out(m);
  return DVI_OK;
}

/* Without counters, because the caller knows the cost of a member. */
dvi_status dvi__partitioned_members_create(dvi__partitioned *p, dvi__partitioned_members **members)
{
  dvi__partitioned_members *m = *members = DVI_NEW(dvi__partitioned_members, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  m->step = p;
  const dvi_status status = members_complete(m);
  if (status != DVI_OK) dvi__partitioned_members_destroy(members);
  return status;
}

void dvi__partitioned_members_destroy(dvi__partitioned_members **members)
{
  dvi__partitioned_members *m = *members;
  if (m == NULL) return;
  dvi__evaluator_destroy(&m->evaluator);
  dvi__stage_inverse_members_destroy(&m->inverse);
  dvi__release(m->numbers);
  dvi__release(m);
  *members = NULL;
}

void dvi__partitioned_members_place(dvi__partitioned_members *m, double h, const dvi__abreast *t,
                                    const dvi__abreast *q, const dvi__abreast *p,
                                    const dvi__abreast *carried)
{
  m->h = h;
  m->q0 = q;
  m->p0 = p;
  m->carried = carried;
  for (int i = 0; i < m->step->s; i++) m->t[i] = *t + m->step->c[i] * h;
}

/* ---- points ---- */

/* Compute the sum of weights times x [s]. */
INLINE void dot_abreast(int s, const double *weight, const abreast *x, abreast *dot)
{
  abreast sum = {0};
  for (int l = 0; l < s; l++) sum += weight[l] * x[l];
  *dot = sum;
}

WIDE static void points_abreast(const dvi__partitioned_members *m, const abreast *x)
{
  const dvi__partitioned *p = m->step;
  const int s = p->s;
  abreast sum;
  for (int i = 0; i < p->n; i++, x += p->m) {
    const abreast lambda = x[s];
    m->k0[i] = p->kick.before * lambda + p->kick.carried * m->carried[i];
    m->k1[i] = p->kick.after * lambda;
    for (int k = 0; k < s; k++) {
      dot_abreast(s, p->a[k], x, &sum);
      m->V[i * s + k] = x[k] / m->h;
      m->Q[i * s + k] = m->q0[i] + (m->k0[i] + sum);
    }
    dot_abreast(s, p->b, x, &sum);
    m->dq[i] = m->k0[i] + sum + m->k1[i];
    m->q1[i] = m->q0[i] + m->dq[i];
  }
}

WIDE static void continue_abreast(const dvi__partitioned *p, double ratio, const abreast *last,
                                  abreast *x)
{
  for (int i = 0; i < p->n; i++, last += p->m, x += p->m) {
    for (int k = 0; k < p->s; k++) {
      dot_abreast(p->s, p->shift[k], last, &x[k]);
      x[k] *= ratio;
    }
    x[p->s] = (abreast){0};
  }
}

void dvi__partitioned_members_continue(dvi__partitioned_members *m, double ratio,
                                       const dvi__abreast *last, dvi__abreast *x)
{
  dvi__partitioned_shift(m->step, ratio);
  continue_abreast(m->step, ratio, last, x);
}

void dvi__partitioned_members_ends(dvi__partitioned_members *m, const dvi__abreast *x,
                                   dvi__abreast *dq)
{
  points_abreast(m, x);
  for (int i = 0; i < m->step->n; i++) dq[i] = m->dq[i];
}

/* ---- the inverse ---- */

INLINE void gather_members(const abreast *values, int at, int count, abreast *out)
{
  for (int k = 0; k < count; k++) out[k] = at >= 0 ? values[at * count + k] : (abreast){0};
}

/* Fill an entry as the step does. */
INLINE void fill_members_entry(const dvi__partitioned_members *m, const dvi__joint_entry *where,
                               dvi__stage_entry_members *out)
{
  const dvi__partitioned *p = m->step;
  const int s = p->s;
  gather_members(m->H_qv, where->vq, s, out->A);
  gather_members(m->H_qv, where->qv, s, out->B);
  gather_members(m->H_qq, where->qq, s, out->K);
  gather_members(m->qv1, where->vq, 1, out->A + s);
  gather_members(m->qv1, where->qv, 1, out->B + s);
  gather_members(m->qq1, where->qq, 1, out->K + s);
  gather_members(m->qv0, where->qv, 1, &out->a);
  for (int k = 0; k < s; k++) out->K[k] *= m->h;
  out->B[s] *= p->kick.after;
  out->a *= p->kick.before;
}

WIDE static void fill_members_entries(const dvi__partitioned_members *m)
{
  const dvi__partitioned *p = m->step;
  for (int j = 0; j < p->n; j++)
    for (int e = p->joint.start[j]; e < p->joint.start[j + 1]; e++)
      fill_members_entry(m, &p->block[e],
                         dvi__stage_inverse_members_entry(m->inverse, p->joint.row[e], j));
}

static dvi_status evaluate_members_hessians(dvi__partitioned_members *m,
                                            const int going[DVI__ABREAST])
{
  const int points = DVI__ABREAST * m->step->s;
  DVI_TRY(dvi__form_hessian_batch(m->evaluator, points, (double *)m->Q, (double *)m->V,
                                  (double *)m->H_qq, (double *)m->H_qv));
  DVI_TRY(dvi__subtract_potential_hessians(m->evaluator, points, (double *)m->t, (double *)m->Q,
                                           (double *)m->H_qq));
  DVI_TRY(dvi__form_batch(m->evaluator, DVI__ABREAST, going, (const double *)m->q0, NULL,
                          (double *)m->qv0));
  return dvi__form_hessian_batch(m->evaluator, DVI__ABREAST, (double *)m->q1, (double *)m->k1,
                                 (double *)m->qq1, (double *)m->qv1);
}

dvi_status dvi__partitioned_members_invert(dvi__partitioned_members *m, const dvi__abreast *x,
                                           int regular[DVI__ABREAST])
{
  const dvi__partitioned *p = m->step;
  points_abreast(m, x);
  DVI_TRY(evaluate_members_hessians(m, regular));
  fill_members_entries(m);
  dvi__stage_inverse_members_begin(m->inverse, p->s, p->b, regular);
  m->has_gradients = 1;
  return DVI_OK;
}

/* ---- the residual ---- */

/* Compute the effect on p of the kicks k0, by the gradients that the Jacobian left. */
INLINE void kick_members_at_start(const dvi__partitioned_members *m)
{
  const dvi__pattern *qv = &m->step->system->qv;
  for (int i = 0; i < m->step->n; i++) m->K0[i] = (abreast){0};
  for (int j = 0; j < m->step->n; j++)
    for (int e = qv->start[j]; e < qv->start[j + 1]; e++) m->K0[qv->row[e]] += m->k0[j] * m->qv0[e];
}

WIDE static void residual_abreast(const dvi__partitioned_members *m, abreast *R)
{
  const dvi__partitioned *p = m->step;
  const int s = p->s;
  abreast sum;
  kick_members_at_start(m);
  for (int i = 0; i < p->n; i++, R += p->m) {
    const abreast *F = m->L_q + i * s, *alpha = m->L_v + i * s;
    for (int k = 0; k < s; k++) {
      dot_abreast(s, p->abar[k], F, &sum);
      R[k] = (alpha[k] - m->p0[i]) - m->K0[i] - m->h * sum;
    }
    dot_abreast(s, p->b, F, &sum);
    R[s] = (m->p0[i] - m->alpha1[i]) + (m->K0[i] + m->h * sum + m->K1[i]);
  }
}

/* Compute the gradients of alpha.w at `count` points of a member, from those of alpha. */
WIDE static void gradients_along(const dvi__partitioned *p, int count, const abreast *w,
                                 const abreast *alpha_q, abreast *alpha_w_q)
{
  const dvi__pattern *qv = &p->system->qv;
  for (int i = 0; i < p->n * count; i++) alpha_w_q[i] = (abreast){0};
  for (int j = 0; j < p->n; j++)
    for (int e = qv->start[j]; e < qv->start[j + 1]; e++)
      for (int k = 0; k < count; k++)
        alpha_w_q[qv->row[e] * count + k] += w[j * count + k] * alpha_q[e * count + k];
}

/* The first residual is at the point of the Jacobian, which has left the gradients of alpha. */
static dvi_status evaluate_members_gradients(dvi__partitioned_members *m,
                                             const int going[DVI__ABREAST])
{
  const dvi__partitioned *p = m->step;
  const int points = DVI__ABREAST * p->s;
  double *qv = m->has_gradients ? NULL : (double *)m->H_qv,
         *qv1 = m->has_gradients ? NULL : (double *)m->qv1;
  DVI_TRY(dvi__form_batch(m->evaluator, points, going, (double *)m->Q, (double *)m->L_v, qv));
  DVI_TRY(dvi__form_batch(m->evaluator, DVI__ABREAST, going, (double *)m->q1, (double *)m->alpha1,
                          qv1));
  gradients_along(p, p->s, m->V, m->H_qv, m->L_q);
  gradients_along(p, 1, m->k1, m->qv1, m->K1);
  m->has_gradients = 0;
  return dvi__subtract_potentials(m->evaluator, points, (double *)m->t, (double *)m->Q,
                                  (double *)m->L_q);
}

dvi_status dvi__partitioned_members_correct(dvi__partitioned_members *m, const dvi__abreast *x,
                                            const int going[DVI__ABREAST], dvi__abreast *r)
{
  points_abreast(m, x);
  DVI_TRY(evaluate_members_gradients(m, going));
  residual_abreast(m, r);
  dvi__stage_inverse_members_solve(m->inverse, r);
  return DVI_OK;
}

/* ---- the end ---- */

/* Compute the two-forms [n*n] by columns from gradients of alpha. */
WIDE static void two_forms_of(const dvi__partitioned *p, const abreast *alpha_q, abreast *Omega)
{
  const abreast zero = {0};
  for (int i = 0; i < p->n * p->n; i++) Omega[i] = zero;
  for (int j = 0; j < p->n; j++)
    for (int e = p->joint.start[j]; e < p->joint.start[j + 1]; e++) {
      const dvi__joint_entry *where = &p->block[e];
      const abreast *ij = where->qv >= 0 ? &alpha_q[where->qv] : &zero,
                    *ji = where->vq >= 0 ? &alpha_q[where->vq] : &zero;
      Omega[j * p->n + p->joint.row[e]] = *ij - *ji;
    }
}

/* Find the sides of singular points on which members are, from gradients of alpha. */
static void find_members_sides(const dvi__partitioned *p, const abreast *alpha_q,
                               int side[DVI__ABREAST])
{
  abreast Omega[DVI__SIDES_MOST * DVI__SIDES_MOST];
  double of_member[DVI__SIDES_MOST * DVI__SIDES_MOST];
  two_forms_of(p, alpha_q, Omega);
  for (int lane = 0; lane < DVI__ABREAST; lane++) {
    for (int i = 0; i < p->n * p->n; i++) of_member[i] = Omega[i][lane];
    side[lane] = dvi__pfaffian_sign((size_t)p->n, of_member);
  }
}

dvi_status dvi__partitioned_members_constrain(dvi__partitioned_members *m, const dvi__abreast *q,
                                              dvi__abreast *p, int regular[DVI__ABREAST])
{
  int before[DVI__ABREAST], after[DVI__ABREAST];
  DVI_TRY(dvi__form_batch(m->evaluator, DVI__ABREAST, regular, (const double *)q, (double *)p,
                          (double *)m->qv1));
  find_members_sides(m->step, m->qv0, before);
  find_members_sides(m->step, m->qv1, after);
  for (int lane = 0; lane < DVI__ABREAST; lane++) regular[lane] &= before[lane] == after[lane];
  return DVI_OK;
}
