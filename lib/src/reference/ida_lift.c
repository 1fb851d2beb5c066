/* IDA on the equations of systems with factors (lift.h), of index 1 in the unknowns y = (kappa, v,
 * p),
 *     F(t, y, ydot) = ( kappa' - K(kappa, v),  p' - f(t, kappa, v),  p - T^t C(kappa, v) ) = 0
 * with K and f as there. IDA differences the Jacobian.
 *
 * With holonomic constraints phi(t,q) = 0 there are also lambda and mu, which vanishes, with
 * w(x) = T^t phi_q^t x (Gear, Gupta and Leimkuhler 1985),
 *     F = ( kappa' - K(kappa, v - w(mu)),  p' - f + w(lambda),  p - T^t C,  phi_q y' + phi_t,
 *           phi ) = 0
 * of index 2. IDA tests neither of them for errors. Source: Hindmarsh et al. 2005, ACM TOMS 31:363,
 * sec. 2.3. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "reference/ida_run.h"
#include "reference/lift.h"
#include "system/dynamics/holonomic.h"
#include "system/evaluate/dynamics.h"

/* Limit of the number of unknowns, because a differenced Jacobian is dense. */
enum { UNKNOWNS_MAX = 2000 };

typedef struct lifted_ida {
  dvi__reference_run *run;
  dvi__lift lift;
  dvi__ida_run ida;
  int rows;                     /* of constraints */
  double *phi_q, *covector, *w; /* [entries], [nq], [nv] */
  N_Vector moved, moved_F;      /* for differences of the Jacobian */
} lifted_ida;

/* Compute w = T^t phi_q^t x at the point of the last equations, whose gradients are known. */
static void pull_rows(const lifted_ida *self, const double *x)
{
  const dvi_system *s = self->run->system;
  memset(self->covector, 0, (size_t)s->n * sizeof(double));
  dvi__rows_pull(s, self->phi_q, x, 1, self->covector);
  dvi__lift_pull(&self->lift, self->covector, self->w);
}

/* Take the constraints into the rates K and f, and write their own rows. */
static dvi_status lifted_rows(const lifted_ida *self, double t, const double *y, double *kappa_rate,
                              double *p_rate, double *F_rate)
{
  const dvi_system *s = self->run->system;
  dvi__evaluator *e = self->run->evaluator;
  const dvi__pattern *G = &s->rows_q;
  const double *lambda = y + self->lift.size + 2 * self->run->n, *mu = lambda + self->rows,
               *q = self->lift.y;
  DVI_TRY(dvi__rows_gradients(e, t, q, self->phi_q));
  DVI_TRY(dvi__rows_rate(e, t, q, F_rate));
  DVI_TRY(dvi__rows_value(e, t, q, F_rate + self->rows));
  for (int a = 0; a < self->rows; a++)
    for (int k = G->start[a]; k < G->start[a + 1]; k++)
      F_rate[a] += self->phi_q[k] * self->lift.rate[G->row[k]];
  pull_rows(self, mu);
  dvi__lift_slow(&self->lift, y, self->w, kappa_rate);
  pull_rows(self, lambda);
  for (int i = 0; i < self->run->n; i++) p_rate[i] -= self->w[i];
  return DVI_OK;
}

static int lifted_residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  lifted_ida *self = user;
  const int size = self->lift.size, nv = self->run->n;
  const double *kappa = N_VGetArrayPointer(y), *v = kappa + size, *p = v + nv,
               *rate = N_VGetArrayPointer(ydot), *p_rate = rate + size + nv;
  double *F_kappa = N_VGetArrayPointer(F), *F_p = F_kappa + size, *F_v = F_p + nv;
  dvi_status status = dvi__lift_equations(&self->lift, t, kappa, v, F_kappa, F_p, F_v);
  if (status == DVI_OK && self->rows > 0)
    status = lifted_rows(self, t, kappa, F_kappa, F_p, F_v + nv);
  for (int i = 0; i < size; i++) F_kappa[i] = rate[i] - F_kappa[i];
  for (int i = 0; i < nv; i++) {
    F_p[i] = p_rate[i] - F_p[i];
    F_v[i] = p[i] - F_v[i];
  }
  return dvi__reference_callback(self->run, status);
}

/* Difference the residual. Neither of the multipliers has a size, but all is linear in them. IDA
 * has set the matrix to 0. */
static int lifted_jacobian(double t, double c, N_Vector y, N_Vector ydot, N_Vector F,
                           SUNMatrix matrix, void *user, N_Vector work1, N_Vector work2,
                           N_Vector work3)
{
  lifted_ida *self = user;
  const int size = self->lift.size, nv = self->run->n, multipliers = size + 2 * nv;
  double *moved = N_VGetArrayPointer(self->moved), *G = N_VGetArrayPointer(self->moved_F);
  const double *at = N_VGetArrayPointer(y), *here = N_VGetArrayPointer(F);
  (void)work1, (void)work2, (void)work3;
  memcpy(moved, at, (size_t)self->ida.size * sizeof *moved);
  for (int j = 0; j < self->ida.size; j++) {
    const double step = j < multipliers ? sqrt(DBL_EPSILON) * fmax(fabs(at[j]), 1) : 1;
    moved[j] = at[j] + step;
    const int verdict = lifted_residual(t, self->moved, ydot, self->moved_F, user);
    if (verdict != 0) return verdict;
    for (int i = 0; i < self->ida.size; i++)
      SM_ELEMENT_D(matrix, i, j) = (G[i] - here[i]) / (moved[j] - at[j]);
    moved[j] = at[j];
  }
  for (int i = 0; i < size; i++) SM_ELEMENT_D(matrix, i, i) += c;
  for (int i = 0; i < nv; i++) SM_ELEMENT_D(matrix, size + i, size + nv + i) += c;
  return 0;
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

/* Start with the multipliers of the equations of index 1. */
static dvi_status lifted_multipliers(const lifted_ida *self, double *multipliers)
{
  const dvi__reference_run *run = self->run;
  memset(multipliers, 0, 2 * (size_t)self->rows * sizeof *multipliers);
  if (self->rows == 0) return DVI_OK;
  return run->system->dynamics->reactions(run->evaluator, run->t, run->q, run->v, multipliers);
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
  dvi_status status = lifted_multipliers(self, y + size + 2 * nv);
  if (status == DVI_OK)
    status = dvi__lift_equations(&self->lift, run->t, y, run->v, ydot, ydot + size + nv, room);
  if (status == DVI_OK && self->rows > 0)
    status = lifted_rows(self, run->t, y, ydot, ydot + size + nv, ydot + size + 2 * nv);
  memset(ydot + size + 2 * nv, 0, 2 * (size_t)self->rows * sizeof *ydot);
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

static dvi_status lifted_reserve_rows(lifted_ida *self)
{
  const dvi__reference_run *run = self->run;
  self->phi_q = DVI_NEW(double, dvi__pattern_entries(&run->system->rows_q));
  self->covector = DVI_NEW(double, run->system->n);
  self->w = DVI_NEW(double, run->n);
  self->moved = N_VClone(self->ida.y);
  self->moved_F = N_VClone(self->ida.y);
  return self->phi_q && self->covector && self->w && self->moved && self->moved_F
             ? DVI_OK
             : dvi__reference_no_setup(run);
}

/* Rows that are independent at the start may not be so later, where IDA's steps would end. */
static dvi_status refuse_dependent_rows(const dvi__reference_run *run)
{
  char rows[512];
  if (run->system->row_count == 0 || dvi__rows_dependent(run->evaluator, rows, sizeof rows) == 0)
    return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "ida: constraint %s depends on others; on rotations and directions IDA takes "
                   "independent rows alone",
                   rows);
}

static dvi_status lifted_reserve(lifted_ida *self)
{
  dvi__reference_run *run = self->run;
  DVI_TRY(refuse_dependent_rows(run));
  DVI_TRY(dvi__lift_create(run, &self->lift));
  const int size = self->lift.size + 2 * run->n + 2 * self->rows;
  if (size > UNKNOWNS_MAX)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "ida: the system's factors give %d unknowns, and a dense Jacobian; %d are possible", size,
        UNKNOWNS_MAX);
  DVI_TRY(dvi__ida_run_create(run, size, SUNDenseMatrix(size, size, run->context), &self->ida));
  return self->rows > 0 ? lifted_reserve_rows(self) : DVI_OK;
}

static void lifted_clear(lifted_ida *self)
{
  dvi__ida_run_clear(&self->ida);
  dvi__lift_clear(&self->lift);
  dvi__release(self->phi_q);
  dvi__release(self->covector);
  dvi__release(self->w);
  if (self->moved != NULL) N_VDestroy(self->moved);
  if (self->moved_F != NULL) N_VDestroy(self->moved_F);
}

static dvi_status lifted_run(lifted_ida *self)
{
  DVI_TRY(lifted_reserve(self));
  DVI_TRY(lifted_start(self));
  const int first = self->lift.size + 2 * self->run->n;
  if (dvi__ida_run_configure(&self->ida, lifted_residual, self) != 0 ||
      (self->rows > 0 && (IDASetJacFn(self->ida.memory, lifted_jacobian) != 0 ||
                          dvi__ida_run_leave_untested(&self->ida, first, 2 * self->rows) != 0)))
    return dvi__reference_no_setup(self->run);
  return lifted_integrate(self);
}

dvi_status dvi__reference_ida_lift(dvi__reference_run *run)
{
  lifted_ida self = {.run = run, .rows = run->system->row_count};
  const dvi_status status = lifted_run(&self);
  lifted_clear(&self);
  return status;
}
