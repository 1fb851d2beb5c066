/* The first row term, for paths in a chart that is centred at their start
 * (system/chart/centring.h). With p1 = p0 + dp + C the rows are
 *
 *     R_k = sum_j b_j ( h (psi_k - psi_k(1)) L_q + psi_k' L_v )_j - psi_k(1) (p0 + C) */
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "step/element/action_struct.h"

struct dvi__centred_paths {
  dvi__centring centring;
  dvi__action *action;
  double *correction;            /* [n] C, or what carried momenta change */
  double *by_f, *by_xi, *by_end; /* [3 n] derivatives of carried momenta */
};

static void centring_place(void *of, const dvi__row_path *path)
{
  const dvi__centring *centring = &((const dvi__centred_paths *)of)->centring;
  centring->place(centring->of, path->q0, path->q1);
}

static dvi_status centring_rows(void *of, const dvi__row_path *p, const double *own, double *R,
                                double *dp, double *own_R)
{
  const dvi__centred_paths *x = of;
  (void)own, (void)own_R;
  x->centring.correct(x->centring.of, p->r, p->h, p->weight, p->p0, p->dp, x->correction);
  for (int i = 0; i < p->n; i++) {
    for (int k = 0; k < p->s; k++) R[i * p->s + k] -= p->end[k] * x->correction[i];
    dp[i] += x->correction[i];
  }
  return DVI_OK;
}

static void centring_magnitudes(const void *of, const dvi__row_path *p, double *magnitude,
                                double *own_magnitude)
{
  const dvi__centred_paths *x = of;
  (void)own_magnitude;
  for (int i = 0; i < p->n; i++)
    for (int k = 0; k < p->s; k++) magnitude[i * p->s + k] += fabs(p->end[k] * x->correction[i]);
  x->centring.mix(x->centring.of, p->s, magnitude);
}

/* Give dC/dY_l for one entry of the joint pattern. */
static double change_of_correction(const dvi__row_path *p, const dvi__joint_entry *block, int l,
                                   const double *C_q1, const double *C_qq, const double *C_qv)
{
  double sum = block->qq >= 0 ? C_q1[block->qq] * p->end[l] : 0;
  const double *psi = p->psi + l * p->lanes, *dpsi = p->dpsi + l * p->lanes;
  for (int j = 0; j < p->r && block->qq >= 0; j++)
    sum += p->weight[j] * p->h * C_qq[block->qq * p->r + j] * psi[j];
  for (int j = 0; j < p->r && block->qv >= 0; j++)
    sum += p->weight[j] * C_qv[block->qv * p->r + j] * dpsi[j];
  return sum;
}

/* Subtract psi_k(1) dC. */
static dvi_status centring_derivatives(void *of, const dvi__row_path *p, const double *own,
                                       const dvi__row_jacobian *J)
{
  const dvi__centred_paths *x = of;
  const dvi__pattern *joint = dvi__row_joint(J);
  const double *C_q1, *C_qq, *C_qv;
  (void)own;
  x->centring.derive(x->centring.of, p->r, p->h, p->weight, p->p0, &C_q1, &C_qq, &C_qv);
  for (int j = 0; j < p->n; j++)
    for (int l = 0; l < p->s; l++)
      for (int e = joint->start[j]; e < joint->start[j + 1]; e++) {
        const double by = change_of_correction(p, &x->action->block[e], l, C_q1, C_qq, C_qv);
        double *rows = dvi__row_entry(J, e, j, l);
        for (int k = 0; k < p->s; k++) rows[k] -= p->end[k] * by;
      }
  return DVI_OK;
}

dvi_status dvi__action_centre(dvi__action *a, const dvi__centring *centring)
{
  dvi__centred_paths *x = a->centred = DVI_NEW(dvi__centred_paths, 1);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for charts");
  *x = (dvi__centred_paths){.centring = *centring, .action = a};
  x->correction = DVI_NEW(double, 10 * (size_t)a->n);
  if (x->correction == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for charts");
  x->by_f = x->correction + a->n;
  x->by_xi = x->by_f + 3 * (size_t)a->n;
  x->by_end = x->by_xi + 3 * (size_t)a->n;
  return dvi__action_add_term(a, &(dvi__row_term){.name = "charts",
                                                  .of = x,
                                                  .place = centring_place,
                                                  .rows = centring_rows,
                                                  .magnitudes = centring_magnitudes,
                                                  .derivatives = centring_derivatives});
}

void dvi__action_clear_charts(dvi__action *a)
{
  if (a->centred != NULL) dvi__release(a->centred->correction);
  dvi__release(a->centred);
}

/* ---- momenta that other terms add on the way ---- */

static void add_carried(const dvi__action *a, const double *more, double *R, double *dp)
{
  for (int i = 0; i < a->n; i++) {
    for (int k = 0; k < a->s; k++) R[i * a->s + k] -= a->end[k] * more[i];
    dp[i] += more[i];
  }
}

void dvi__action_carry(dvi__action *a, const double *xi, const double *f, double *R, double *dp)
{
  const dvi__centred_paths *x = a->centred;
  if (x == NULL) return;
  x->centring.carry(x->centring.of, xi, f, x->correction);
  add_carried(a, x->correction, R, dp);
}

void dvi__action_carry_force(dvi__action *a, const double *xi, const double *f, double *R,
                             double *dp)
{
  const dvi__centred_paths *x = a->centred;
  x->centring.carry(x->centring.of, xi, f, x->correction);
  for (int i = 0; i < a->n; i++)
    if (x->centring.width[i] > 0) x->correction[i] += f[i];
  add_carried(a, x->correction, R, dp);
}

void dvi__action_arrive(const dvi__action *a, const double *added)
{
  const dvi__centred_paths *x = a->centred;
  if (x != NULL) x->centring.carry(x->centring.of, a->terms.q1, added, x->correction);
}

dvi__carried dvi__action_carried(dvi__action *a, const double *xi, const double *f)
{
  const dvi__centred_paths *x = a->centred;
  if (x == NULL) return (dvi__carried){0};
  x->centring.carry_derivatives(x->centring.of, xi, f, x->by_f, x->by_xi, x->by_end);
  return (dvi__carried){x->by_f, x->by_xi, x->by_end, x->centring.first, x->centring.width};
}

double dvi__carried_entry(const dvi__carried *c, int row, const double *column, int e)
{
  double sum = 0;
  if (c->by_f == NULL) return 0;
  for (int b = 0; b < c->width[row]; b++)
    sum += c->by_f[3 * row + b] * column[e - (row - c->first[row]) + b];
  return sum;
}

void dvi__action_carry_movements(const dvi__action *a, const dvi__carried *c, const double *psi,
                                 const dvi__row_jacobian *J)
{
  for (int i = 0; c->by_f != NULL && i < a->n; i++)
    for (int b = 0; b < c->width[i]; b++)
      for (int l = 0; l < a->s; l++) {
        double *rows = dvi__row_block(J, i, c->first[i] + b, l);
        const double by = c->by_xi[3 * i + b] * psi[l] + c->by_end[3 * i + b] * a->end[l];
        for (int k = 0; k < a->s; k++) rows[k] -= a->end[k] * by;
      }
}

double dvi__action_turn(const dvi__action *a, const double *from, const double *Y)
{
  const dvi__centring *centring = &a->centred->centring;
  return centring->turn(centring->of, a->s, Y, from);
}

int dvi__action_signs(const dvi__action *a)
{
  return a->centred->centring.signs;
}

double dvi__action_turned(const dvi__action *a, const double *xi)
{
  const dvi__centring *centring = &a->centred->centring;
  return centring->turn(centring->of, 1, xi, NULL);
}
