/* Energy, momentum maps of the declared symmetries, and declared invariants. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "system/evaluate/dynamics.h"
#include "system/evaluate/evaluator_struct.h"

static dvi_status invariant_verdict(int returned, const char *name)
{
  if (returned == 0) return DVI_OK;
  char reason[DVI__SENTENCE_SIZE];
  dvi__take_reason(reason);
  return dvi__fail(returned < 0 ? DVI_CALLBACK_FAILED : DVI_CALLBACK_RETRY,
                   "invariant '%s': the callback returned %d%s%s", name, returned,
                   reason[0] != '\0' ? ": " : "", reason);
}

/* Compute J = p.xi(q)  (Marsden and West 2001, eq. 1.2.6). */
static dvi_status momentum_map(dvi__evaluator *e, const dvi_symmetry *symmetry, const double *q,
                               const double *p, double *J)
{
  DVI_TRY(dvi__evaluator_prepare_symmetries(e));
  double *xi = e->point[2];
  *J = 0;
  DVI_TRY(invariant_verdict(symmetry->generator(q, xi, symmetry->user), symmetry->name));
  for (int i = 0; i < e->system->nv; i++) *J += p[i] * xi[i];
  return DVI_OK;
}

dvi_status dvi__invariant(dvi__evaluator *e, double t, const double *q, const double *v,
                          const double *p, int i, double *value)
{
  const dvi_system *s = e->system;
  const char *name = s->invariant_names[i];
  const int declared = i - 1 - s->symmetry_count;
  if (i == 0)
    DVI_TRY(e->system->dynamics->energy(e, t, q, v, p, value));
  else if (declared < 0)
    DVI_TRY(momentum_map(e, &s->symmetries[i - 1], q, p, value));
  else
    DVI_TRY(invariant_verdict(
        s->invariants[declared].value(t, q, p, value, s->invariants[declared].user), name));
  return isfinite(*value)
             ? DVI_OK
             : dvi__fail(DVI_NOT_FINITE, "invariant '%s' is %g at t = %.6g", name, *value, t);
}

dvi_status dvi__invariants(dvi__evaluator *e, double t, const double *q, const double *v,
                           const double *p, double *value)
{
  const int count = dvi_system_invariant_count(e->system);
  for (int i = 0; i < count; i++) DVI_TRY(dvi__invariant(e, t, q, v, p, i, &value[i]));
  return DVI_OK;
}

dvi_status dvi__supply(dvi__evaluator *e, int count, const double *weight, const double *F,
                       const double *q, const double *v, double *supply)
{
  const dvi_system *s = e->system;
  const size_t points = (size_t)count;
  for (int i = 0; i <= s->symmetry_count; i++) supply[i] = 0;
  for (size_t k = 0; k < points; k++) {
    const double *at_q = q, *at_F = F;
    double power = 0;
    if (count > 1) {
      dvi__gather_point(s->n, count, (int)k, q, e->point[0]);
      dvi__gather_point(s->nv, count, (int)k, F, e->point[1]);
      at_q = e->point[0], at_F = e->point[1];
    }
    for (size_t i = 0; i < (size_t)s->nv; i++) power += at_F[i] * v[i * points + k];
    supply[0] += weight[k] * power;
    for (int i = 0; i < s->symmetry_count; i++) {
      double torque;
      DVI_TRY(momentum_map(e, &s->symmetries[i], at_q, at_F, &torque));
      supply[1 + i] += weight[k] * torque;
    }
  }
  return DVI_OK;
}

/* ---- over a step ---- */

/* A difference of energies is known up to a rounding of its summands. */
static const double rounding = 64 * DBL_EPSILON;

static dvi_status kinetic_size(dvi__evaluator *e, const dvi__instant *at, double *E, double *T,
                               double *size)
{
  double pv = 0;
  DVI_TRY(dvi__legendre_inverse(e, at->t, at->q, at->p, at->v));
  DVI_TRY(e->system->dynamics->energy(e, at->t, at->q, at->v, at->p, E));
  for (int i = 0; i < e->system->n; i++) pv += at->p[i] * at->v[i];
  *size = fabs(pv) + fabs(*E);
  if (e->system->vector != NULL) {
    DVI_TRY(dvi__vector_potential(e, 1, &at->t, at->q, e->point[2]));
    for (int i = 0; i < e->system->n; i++) pv -= e->point[2][i] * at->v[i];
  }
  *T = 0.5 * fabs(pv);
  return DVI_OK;
}

static double along(int n, const double *x, const double *v)
{
  double sum = 0;
  for (int i = 0; i < n; i++) sum += x[i] * v[i];
  return sum;
}

/* Compute the power F.v of the forces without a potential. */
static dvi_status power_of_forces(dvi__evaluator *e, const dvi__instant *at, double *power)
{
  const dvi_system *s = e->system;
  double *F = e->point[2];
  *power = 0;
  if (s->force_count > 0) {
    DVI_TRY(dvi__forces(e, DVI__FORCES, 1, &at->t, at->q, at->v, F));
    *power += along(s->n, F, at->v);
  }
  if (s->damping > 0) *power -= s->damping * along(s->n, at->p, at->v);
  return DVI_OK;
}

/* Compute the power of constraints that move with time, or are affine, which is that of all forces
 * less that of the Lagrangian's own. */
static dvi_status power_of_constraints(dvi__evaluator *e, const dvi__instant *at, double *power)
{
  const dvi_system *s = e->system;
  double *F = e->point[2];
  *power = 0;
  if (s->row_count == 0 || (s->autonomous && s->nonholonomic_count == 0)) return DVI_OK;
  DVI_TRY(s->dynamics->forces(e, at->t, at->q, at->v, F));
  *power += along(s->n, F, at->v);
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &at->t, at->q, at->v, F, NULL));
  *power -= along(s->n, F, at->v);
  return DVI_OK;
}

/* Compute the work of a power over the step, from its mean at both ends. */
static dvi_status
work_by_ends(dvi__evaluator *e, const dvi__instant *before, const dvi__instant *after,
             dvi_status (*power)(dvi__evaluator *e, const dvi__instant *at, double *power),
             double *work)
{
  double power0, power1;
  DVI_TRY(power(e, before, &power0));
  DVI_TRY(power(e, after, &power1));
  *work = 0.5 * (after->t - before->t) * (power0 + power1);
  return DVI_OK;
}

static dvi_status change_of_lagrangian(dvi__evaluator *e, const dvi__instant *before,
                                       const dvi__instant *after, const double *by_forces,
                                       double *change, double *exchanged)
{
  double E0, E1, T0, T1, size0, size1, work = 0, by_constraints;
  DVI_TRY(kinetic_size(e, before, &E0, &T0, &size0));
  DVI_TRY(kinetic_size(e, after, &E1, &T1, &size1));
  if (by_forces != NULL)
    work = *by_forces;
  else
    DVI_TRY(work_by_ends(e, before, after, power_of_forces, &work));
  DVI_TRY(work_by_ends(e, before, after, power_of_constraints, &by_constraints));
  work += by_constraints;
  *change = fmax(fabs(E1 - E0 - work) - rounding * fmax(size0, size1), 0);
  *exchanged = fmax(fmax(T0, T1), fabs(work));
  return DVI_OK;
}

/* Compute sum |L_q dq| + |L_v dp|, with L = -H(q) of a one-form at v = 0, and L = H(q,p) on phase
 * space. */
static dvi_status energy_exchange(dvi__evaluator *e, const dvi__instant *at,
                                  const dvi__instant *before, const dvi__instant *after, int with_p,
                                  double *sum)
{
  const size_t n = (size_t)e->system->n;
  double *in_q = before->v, *in_p = e->point[2];
  const double *second = at->p;
  if (!with_p) {
    memset(e->point[1], 0, n * sizeof(double));
    second = e->point[1];
  }
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &at->t, at->q, second, in_q, in_p));
  *sum = 0;
  for (size_t i = 0; i < n; i++) {
    *sum += fabs(in_q[i] * (after->q[i] - before->q[i]));
    if (with_p) *sum += fabs(in_p[i] * (after->p[i] - before->p[i]));
  }
  return DVI_OK;
}

static dvi_status change_of_hamiltonian(dvi__evaluator *e, const dvi__instant *before,
                                        const dvi__instant *after, double *change,
                                        double *exchanged)
{
  const int with_p = e->system->dynamics->by_momentum;
  double E0, E1, sum0, sum1;
  DVI_TRY(e->system->dynamics->energy(e, before->t, before->q, before->v, before->p, &E0));
  DVI_TRY(e->system->dynamics->energy(e, after->t, after->q, after->v, after->p, &E1));
  DVI_TRY(energy_exchange(e, before, before, after, with_p, &sum0));
  DVI_TRY(energy_exchange(e, after, before, after, with_p, &sum1));
  *change = fmax(fabs(E1 - E0) - rounding * fmax(fabs(E0), fabs(E1)), 0);
  *exchanged = fmax(sum0, sum1);
  return DVI_OK;
}

dvi_status dvi__energy_change(dvi__evaluator *e, const dvi__instant *before,
                              const dvi__instant *after, const double *work, double *change,
                              double *exchanged)
{
  e->span = fabs(after->t - before->t);
  const dvi_status status = e->system->dynamics->has_kinetic_energy
                                ? change_of_lagrangian(e, before, after, work, change, exchanged)
                                : change_of_hamiltonian(e, before, after, change, exchanged);
  e->span = 0;
  return status;
}

/* Compute the defect of rates r and their variables x, of one kind. A rate that is a rounding of
 * the others is no measure. Nor is a rate that changes x little, if the size of x counts, as a
 * momentum's does. */
static double defect_of(size_t n, double h, int sized, const double *x0, const double *x1,
                        const double *r0, const double *r1)
{
  double worst = 0, largest = 0;
  for (size_t i = 0; i < n; i++) largest = fmax(largest, fmax(fabs(r0[i]), fabs(r1[i])));
  for (size_t i = 0; i < n; i++) {
    const double size = fmax(fabs(x0[i]), fabs(x1[i])) * (sized ? 1 : 1e-10);
    const double way = fmax(fabs(h) * fmax(fmax(fabs(r0[i]), fabs(r1[i])), 1e-9 * largest), size);
    const double off = fabs((x1[i] - x0[i]) - 0.5 * h * (r0[i] + r1[i]));
    if (off > 0) worst = fmax(worst, off / way);
  }
  return worst;
}

dvi_status dvi__motion_defect(dvi__evaluator *e, const dvi__instant *before,
                              const dvi__instant *after, double *forces, double *defect)
{
  const size_t n = (size_t)e->system->n;
  const double h = after->t - before->t;
  const int has_forces = e->system->dynamics->has_kinetic_energy;
  double *f0 = forces, *f1 = forces + n;
  if (!has_forces) {
    DVI_TRY(dvi__legendre_inverse(e, before->t, before->q, before->p, before->v));
    DVI_TRY(dvi__legendre_inverse(e, after->t, after->q, after->p, after->v));
  }
  *defect = defect_of(n, h, 0, before->q, after->q, before->v, after->v);
  if (!has_forces) return DVI_OK;
  e->span = fabs(h);
  dvi_status status = e->system->dynamics->forces(e, before->t, before->q, before->v, f0);
  if (status == DVI_OK) status = e->system->dynamics->forces(e, after->t, after->q, after->v, f1);
  e->span = 0;
  DVI_TRY(status);
  *defect = fmax(*defect, defect_of(n, h, 1, before->p, after->p, f0, f1));
  return DVI_OK;
}
