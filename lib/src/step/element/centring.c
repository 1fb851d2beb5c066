/* Rows and Jacobian of paths in a chart that is centred at their start: with p1 = p0 + dp + C the rows are
 *
 *     R_k = sum_j b_j ( h (psi_k - psi_k(1)) L_q + psi_k' L_v )_j - psi_k(1) (p0 + C) */
#include <math.h>

#include "step/element/action_struct.h"
#include "core/memory.h"
#include "core/status.h"

dvi_status dvi__action_centre(dvi__action *a, const dvi__centring *centring)
{
  a->centring = *centring;
  a->correction = DVI_NEW(double, a->n);
  a->end_q = DVI_NEW(double, a->n);
  a->end_dp = DVI_NEW(double, a->n);
  return a->correction && a->end_q && a->end_dp ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "action: no memory for charts");
}

void dvi__action_centre_path(dvi__action *a, const double *Y)
{
  if (a->correction == NULL) return;
  for (int i = 0; i < a->n; i++) {
    a->end_q[i] = a->q0[i];
    for (int k = 0; k < a->s; k++) a->end_q[i] += a->end[k] * Y[i * a->s + k];
  }
  a->centring.place(a->centring.of, a->q0, a->end_q);
}

/* L_q holds the weights here. */
void dvi__action_centre_rows(dvi__action *a, double *R)
{
  if (a->correction == NULL) return;
  for (int i = 0; i < a->n; i++) {
    a->end_dp[i] = 0;
    for (int j = 0; j < a->r; j++) a->end_dp[i] += a->h * a->L_q[i * a->r + j];
  }
  a->centring.correct(a->centring.of, a->r, a->h, a->weight, a->p0, a->end_dp, a->correction);
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < a->s; k++) R[i * a->s + k] -= a->end[k] * a->correction[i];
}

void dvi__action_centre_magnitudes(const dvi__action *a, double *magnitude)
{
  if (a->correction == NULL) return;
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < a->s; k++) magnitude[i * a->s + k] += fabs(a->end[k] * a->correction[i]);
  a->centring.mix(a->centring.of, a->s, magnitude);
}

double dvi__action_turn(const dvi__action *a, const double *from, const double *Y)
{
  return a->centring.turn(a->centring.of, a->s, Y, from);
}

int dvi__action_signs(const dvi__action *a)
{
  return a->centring.signs;
}

double dvi__action_turned(const dvi__action *a, const double *xi)
{
  return a->centring.turn(a->centring.of, 1, xi, NULL);
}

/* dC/dY_l for one entry of the joint pattern. */
static double change(const dvi__action *a, const dvi__block *block, int l, const double *C_q1, const double *C_qq,
                     const double *C_qv)
{
  double sum = block->qq >= 0 ? C_q1[block->qq] * a->end[l] : 0;
  const double *psi = a->psi + l * a->lanes, *dpsi = a->dpsi + l * a->lanes;
  for (int j = 0; j < a->r && block->qq >= 0; j++) sum += a->weight[j] * a->h * C_qq[block->qq * a->r + j] * psi[j];
  for (int j = 0; j < a->r && block->qv >= 0; j++) sum += a->weight[j] * C_qv[block->qv * a->r + j] * dpsi[j];
  return sum;
}

void dvi__action_centre_jacobian(dvi__action *a, double *values)
{
  const double *C_q1, *C_qq, *C_qv;
  const size_t s = (size_t)a->s;
  if (a->correction == NULL) return;
  a->centring.derive(a->centring.of, a->r, a->h, a->weight, a->p0, &C_q1, &C_qq, &C_qv);
  for (int j = 0; j < a->n; j++) {
    double *column = values + s * s * (size_t)a->joint.start[j];
    for (int l = 0; l < a->s; l++)
      for (int e = a->joint.start[j]; e < a->joint.start[j + 1]; e++, column += s) {
        const double by = change(a, &a->block[e], l, C_q1, C_qq, C_qv);
        for (size_t k = 0; k < s; k++) column[k] -= a->end[k] * by;
      }
  }
}
