/* IDA on the equations of systems with factors (lift.h), of index 1 in the unknowns y = (kappa, v,
 * p),
 *     F(t, y, ydot) = ( kappa' - K(kappa, v),  p' - f(t, kappa, v),  p - T^t C(kappa, v) ) = 0
 * with K and f as there. IDA differences the Jacobian. Source: Hindmarsh et al. 2005, ACM TOMS
 * 31:363, sec. 2.3. */
#include <float.h>
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "core/memory.h"
#include "core/status.h"
#include "reference/ida_run.h"
#include "reference/lift.h"

/* Limit of the number of unknowns, because a differenced Jacobian is dense. */
enum { UNKNOWNS_MAX = 2000 };

typedef struct lifted_ida {
  dvi__reference_run *run;
  dvi__lift lift;
  dvi__ida_run ida;
} lifted_ida;

static int lifted_residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  lifted_ida *self = user;
  const int size = self->lift.size, nv = self->run->n;
  const double *kappa = N_VGetArrayPointer(y), *v = kappa + size, *p = v + nv,
               *rate = N_VGetArrayPointer(ydot), *p_rate = rate + size + nv;
  double *F_kappa = N_VGetArrayPointer(F), *F_p = F_kappa + size, *F_v = F_p + nv;
  const dvi_status status = dvi__lift_equations(&self->lift, t, kappa, v, F_kappa, F_p, F_v);
  for (int i = 0; i < size; i++) F_kappa[i] = rate[i] - F_kappa[i];
  for (int i = 0; i < nv; i++) {
    F_p[i] = p_rate[i] - F_p[i];
    F_v[i] = p[i] - F_v[i];
  }
  return dvi__reference_callback(self->run, status);
}

/* Evaluate vdot at the start by a difference along the flow. No equation has vdot, but IDA's first
 * predictor and first error test use it. moved [size + 2 nv + nq] is work. */
static dvi_status lifted_acceleration(lifted_ida *self, const double *y, double *ydot,
                                      double *moved)
{
  const dvi__reference_run *run = self->run;
  const int size = self->lift.size, nv = run->n;
  const double span = run->t_end - run->t,
               e = copysign(fmax(1e-8 * fabs(span), 16 * DBL_EPSILON * fabs(run->t)), span);
  double *v = moved + size, *p = v + nv, *q = p + nv;
  for (int i = 0; i < size; i++) moved[i] = y[i] + e * ydot[i];
  for (int i = 0; i < nv; i++) p[i] = y[size + nv + i] + e * ydot[size + nv + i];
  dvi__lift_down(&self->lift, moved, q);
  dvi__lift_tangent(&self->lift, q, p);
  DVI_TRY(dvi__legendre_inverse(run->evaluator, run->t + e, q, p, v));
  for (int i = 0; i < nv; i++) ydot[size + i] = (v[i] - run->v[i]) / e;
  return DVI_OK;
}

static dvi_status lifted_start(lifted_ida *self)
{
  const dvi__reference_run *run = self->run;
  const size_t size = (size_t)self->lift.size, nv = (size_t)run->n;
  double *y = N_VGetArrayPointer(self->ida.y), *ydot = N_VGetArrayPointer(self->ida.ydot);
  double *room = DVI_NEW(double, size + 2 * nv + (size_t)run->system->n);
  if (room == NULL) return dvi__reference_no_setup(run);
  dvi__lift_up(&self->lift, run->q, y);
  memcpy(y + size, run->v, nv * sizeof *y);
  memcpy(y + size + nv, run->p, nv * sizeof *y);
  dvi_status status = dvi__lift_equations(&self->lift, run->t, y, run->v, ydot, ydot + size + nv,
                                          room);
  if (status == DVI_OK) status = lifted_acceleration(self, y, ydot, room);
  dvi__release(room);
  return status;
}

static dvi_status lifted_integrate(const lifted_ida *self)
{
  dvi__reference_run *run = self->run;
  DVI_TRY(dvi__ida_run_solve(&self->ida));
  const double *y = N_VGetArrayPointer(self->ida.y);
  dvi__lift_down(&self->lift, y, run->q);
  memcpy(run->p, y + self->lift.size + run->n, (size_t)run->n * sizeof *y);
  dvi__lift_tangent(&self->lift, run->q, run->p);
  return DVI_OK;
}

static dvi_status lifted_reserve(lifted_ida *self)
{
  dvi__reference_run *run = self->run;
  DVI_TRY(dvi__lift_create(run, &self->lift));
  const int size = self->lift.size + 2 * run->n;
  if (size > UNKNOWNS_MAX)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "ida: the system's factors give %d unknowns, and a dense Jacobian; %d are possible", size,
        UNKNOWNS_MAX);
  return dvi__ida_run_create(run, size, SUNDenseMatrix(size, size, run->context), &self->ida);
}

static void lifted_clear(lifted_ida *self)
{
  dvi__ida_run_clear(&self->ida);
  dvi__lift_clear(&self->lift);
}

static dvi_status lifted_run(lifted_ida *self)
{
  DVI_TRY(lifted_reserve(self));
  DVI_TRY(lifted_start(self));
  if (dvi__ida_run_configure(&self->ida, lifted_residual, self) != 0)
    return dvi__reference_no_setup(self->run);
  return lifted_integrate(self);
}

dvi_status dvi__reference_ida_lift(dvi__reference_run *run)
{
  lifted_ida self = {.run = run};
  const dvi_status status = lifted_run(&self);
  lifted_clear(&self);
  return status;
}
