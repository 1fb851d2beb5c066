/* IDA on the implicit Euler-Lagrange equations.
 *
 * The unknowns are y = (q, v, p). The equations have index 1, or index 2 if L_v = alpha(q) does not
 * depend on v,
 *     F(t, y, ydot) = ( qdot - v,  pdot - L_q(t,q,v),  p - L_v(t,q,v) ) = 0
 * with the Jacobian dF/dy + c dF/dydot in the columns q, v, p
 *     [  c I     -I      0  ]
 *     [ -L_qq   -L_qv   c I ]
 *     [ -L_vq   -L_vv    I  ]
 * Forces F(t,q,v) are part of L_q, with L_qq + F_q and L_qv + F_v in the Jacobian. Damping adds
 * gamma p to the second row, and gamma to its c.
 *
 * For index 2 the multiplier v is left out of the error test. With a one-form DVI_IDA takes the
 * reduced equations of motion in y = q,
 *     F(t, y, ydot) = Omega(q) qdot - H_q(t,q) = 0,
 * whose Jacobian IDA differences, because it has second derivatives of alpha that no callback
 * gives.
 *
 * Nothing is discretised, inverted or assembled by the code of the methods. Only the callbacks are
 * shared. Sources: Hindmarsh et al. 2005, ACM TOMS 31:363, sec. 2.3, and Brenan, Campbell and
 * Petzold 1996 (error tests at index 2). */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/pattern.h"
#include "reference/ida_run.h"
#include "system/dynamics/one_form.h"

typedef struct lagrange_ida {
  dvi__reference_run *run;
  int reduced;
  dvi__pattern vq; /* the transpose of the system's qv */
  int *in_qv;      /* [entries of vq] index of the same entry in qv */
  dvi__ida_run ida;
} lagrange_ida;

/* ---- the whole equations ---- */

static int lagrange_residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  dvi__reference_run *run = ((lagrange_ida *)user)->run;
  const ptrdiff_t n = run->n;
  const double *q = N_VGetArrayPointer(y), *v = q + n, *p = v + n;
  const double *qdot = N_VGetArrayPointer(ydot), *pdot = qdot + 2 * n;
  double *Fq = N_VGetArrayPointer(F), *Fp = Fq + n, *Fv = Fp + n;
  const dvi_status status = dvi__lagrangian_gradient(run->evaluator, 1, &t, q, v, Fp, Fv);
  for (ptrdiff_t i = 0; status == DVI_OK && i < n; i++) {
    Fq[i] = qdot[i] - v[i];
    Fp[i] = pdot[i] - Fp[i] + run->system->damping * p[i];
    Fv[i] = p[i] - Fv[i];
  }
  return dvi__reference_callback(run, status);
}

/* One of the matrices whose sum is a block. */
typedef struct summand {
  const dvi__pattern *pattern;
  const double *values;
} summand;

static void write_block(dvi__columns *columns, const summand *a, int column, int first_row)
{
  for (int e = a->pattern->start[column]; e < a->pattern->start[column + 1]; e++)
    dvi__columns_put(columns, first_row + a->pattern->row[e], -a->values[e]);
}

/* Write a column of the sum of two matrices, the first of which alone exists without forces. */
static void write_sum(dvi__columns *columns, const summand *a, const summand *b, int column,
                      int first_row)
{
  if (b->values == NULL) {
    write_block(columns, a, column, first_row);
    return;
  }
  int i = a->pattern->start[column], j = b->pattern->start[column];
  const int i_end = a->pattern->start[column + 1], j_end = b->pattern->start[column + 1];
  while (i < i_end || j < j_end) {
    const int in_a = i < i_end && (j == j_end || a->pattern->row[i] <= b->pattern->row[j]),
              in_b = j < j_end && (i == i_end || b->pattern->row[j] <= a->pattern->row[i]),
              row = in_a ? a->pattern->row[i] : b->pattern->row[j];
    double value = 0;
    if (in_a) value += a->values[i++];
    if (in_b) value += b->values[j++];
    dvi__columns_put(columns, first_row + row, -value);
  }
}

static void lagrange_write_jacobian(const lagrange_ida *self, double c, SUNMatrix matrix)
{
  const dvi__reference_run *run = self->run;
  const dvi_system *system = run->system;
  const int n = run->n;
  const summand qq = {&system->qq, run->L_qq}, qv = {&system->qv, run->L_qv},
                vv = {&system->vv, run->L_vv}, by_q = {&system->by_q, run->F_q},
                by_v = {&system->by_v, run->F_v};
  dvi__columns columns;
  dvi__columns_start(&columns, matrix);
  for (int j = 0; j < n; j++) {
    dvi__columns_next(&columns);
    dvi__columns_put(&columns, j, c);
    write_sum(&columns, &qq, &by_q, j, n);
    for (int e = self->vq.start[j]; e < self->vq.start[j + 1]; e++)
      dvi__columns_put(&columns, 2 * n + self->vq.row[e], -run->L_qv[self->in_qv[e]]);
  }
  for (int j = 0; j < n; j++) {
    dvi__columns_next(&columns);
    dvi__columns_put(&columns, j, -1.0);
    write_sum(&columns, &qv, &by_v, j, n);
    write_block(&columns, &vv, j, 2 * n);
  }
  for (int j = 0; j < n; j++) {
    dvi__columns_next(&columns);
    dvi__columns_put(&columns, n + j, c + system->damping);
    dvi__columns_put(&columns, 2 * n + j, 1.0);
  }
}

static int lagrange_jacobian(double t, double c, N_Vector y, N_Vector ydot, N_Vector F,
                             SUNMatrix matrix, void *user, N_Vector work1, N_Vector work2,
                             N_Vector work3)
{
  (void)ydot, (void)F, (void)work1, (void)work2, (void)work3;
  const lagrange_ida *self = user;
  dvi__reference_run *run = self->run;
  const double *q = N_VGetArrayPointer(y);
  dvi_status status = dvi__lagrangian_hessian(run->evaluator, 1, &t, q, q + run->n, run->L_qq,
                                              run->L_qv, run->L_vv);
  if (status == DVI_OK && run->F_q != NULL)
    status = dvi__forces_jacobian(run->evaluator, 1, &t, q, q + run->n, run->F_q, run->F_v);
  if (status == DVI_OK) lagrange_write_jacobian(self, c, matrix);
  return dvi__reference_callback(run, status);
}

/* Evaluate vdot at the start, exactly for a constant mass, else by a difference along the flow. No
 * equation has vdot, but IDA's first predictor and first error test use it. */
static dvi_status lagrange_acceleration(dvi__reference_run *run, double *vdot)
{
  const int n = run->n;
  if (run->system->lagrangian == NULL && run->system->vector == NULL) {
    dvi__mass_solve(run->evaluator, 1, run->force, vdot);
    return DVI_OK;
  }
  const double span = run->t_end - run->t,
               e = copysign(fmax(1e-8 * fabs(span), 16 * DBL_EPSILON * fabs(run->t)), span);
  double *moved = DVI_NEW(double, 3 * (size_t)n);
  if (moved == NULL) return dvi__fail(DVI_NO_MEMORY, "ida: no memory for the start");
  double *q = moved, *p = q + n, *v = p + n;
  for (int i = 0; i < n; i++) {
    q[i] = run->q[i] + e * run->v[i];
    p[i] = run->p[i] + e * run->force[i];
    v[i] = run->v[i];
  }
  const dvi_status status = dvi__legendre_inverse(run->evaluator, run->t + e, q, p, v);
  for (int i = 0; status == DVI_OK && i < n; i++) vdot[i] = (v[i] - run->v[i]) / e;
  dvi__release(moved);
  return status;
}

/* ---- the reduced equations of a one-form ---- */

static int one_form_residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  dvi__reference_run *run = ((lagrange_ida *)user)->run;
  const dvi_status status = dvi__two_form_residual(run->evaluator, t, N_VGetArrayPointer(y),
                                                   N_VGetArrayPointer(ydot), N_VGetArrayPointer(F));
  return dvi__reference_callback(run, status);
}

/* ---- a run ---- */

static dvi_status lagrange_start(const lagrange_ida *self)
{
  dvi__reference_run *run = self->run;
  const size_t n = (size_t)run->n, size = n * sizeof(double);
  double *y = N_VGetArrayPointer(self->ida.y), *ydot = N_VGetArrayPointer(self->ida.ydot);
  memcpy(y, run->q, size);
  memcpy(ydot, run->v, size);
  if (self->reduced) return DVI_OK;
  memcpy(y + n, run->v, size);
  memcpy(y + 2 * n, run->p, size);
  memcpy(ydot + 2 * n, run->force, size);
  return lagrange_acceleration(run, ydot + n);
}

static int lagrange_configure(lagrange_ida *self)
{
  const dvi__ida_run *ida = &self->ida;
  const int n = self->run->n;
  if (dvi__ida_run_configure(ida, self->reduced ? one_form_residual : lagrange_residual, self) != 0)
    return -1;
  if (self->run->options.code == DVI_IDA_INDEX_2 && dvi__ida_run_leave_untested(ida, n, n) != 0)
    return -1;
  return self->reduced ? 0 : IDASetJacFn(ida->memory, lagrange_jacobian);
}

static dvi_status lagrange_integrate(const lagrange_ida *self)
{
  dvi__reference_run *run = self->run;
  const size_t n = (size_t)run->n;
  DVI_TRY(dvi__ida_run_solve(&self->ida));
  const double *y = N_VGetArrayPointer(self->ida.y);
  memcpy(run->q, y, n * sizeof *y);
  if (self->reduced) return dvi__reference_form_momentum(run);
  memcpy(run->p, y + 2 * n, n * sizeof *y);
  return DVI_OK;
}

static dvi_status lagrange_transpose_qv(lagrange_ida *self)
{
  const dvi__pattern *qv = &self->run->system->qv;
  DVI_TRY(dvi__pattern_transpose(qv, &self->vq));
  self->in_qv = DVI_NEW(int, dvi__pattern_entries(qv));
  if (self->in_qv == NULL)
    return dvi__fail(DVI_NO_MEMORY, "ida: no memory for the Jacobian's pattern");
  for (int j = 0; j < qv->columns; j++)
    for (int e = qv->start[j]; e < qv->start[j + 1]; e++)
      self->in_qv[dvi__pattern_find(&self->vq, j, qv->row[e])] = e;
  return DVI_OK;
}

static dvi_status lagrange_reserve(lagrange_ida *self)
{
  dvi__reference_run *run = self->run;
  const int n = run->n, size = self->reduced ? n : 3 * n,
            qq = dvi__pattern_entries(&run->system->qq),
            qv = dvi__pattern_entries(&run->system->qv),
            vv = dvi__pattern_entries(&run->system->vv),
            forces = dvi__pattern_entries(&run->system->by_q) +
                     dvi__pattern_entries(&run->system->by_v);
  DVI_TRY(lagrange_transpose_qv(self));
  SUNMatrix matrix = self->reduced
                         ? SUNDenseMatrix(n, n, run->context)
                         : dvi__reference_matrix(run, size, 4 * n + qq + 2 * qv + vv + forces);
  return dvi__ida_run_create(run, size, matrix, &self->ida);
}

static void lagrange_clear(lagrange_ida *self)
{
  dvi__ida_run_clear(&self->ida);
  dvi__release(self->in_qv);
  dvi__pattern_clear(&self->vq);
}

static dvi_status lagrange_run(lagrange_ida *self)
{
  DVI_TRY(lagrange_reserve(self));
  DVI_TRY(lagrange_start(self));
  if (lagrange_configure(self) != 0) return dvi__reference_no_setup(self->run);
  return lagrange_integrate(self);
}

dvi_status dvi__reference_ida(dvi__reference_run *run)
{
  const dvi__dynamics *dynamics = run->system->dynamics;
  if (dynamics->constraint == NULL && run->options.code == DVI_IDA_INDEX_2)
    return dvi__fail(DVI_UNSUPPORTED, "ida-index-2: the system declares neither a one-form nor a "
                                      "Hamiltonian with constraints; its equations are of index 1");
  if (dynamics->equations == DVI__CONSTRAINED_LAGRANGE) return dvi__reference_holonomic(run);
  if (dynamics->equations == DVI__HAMILTON) return dvi__reference_hamilton(run);
  if (dynamics->equations == DVI__LIFTED) return dvi__reference_ida_lift(run);
  lagrange_ida self = {.run = run,
                       .reduced = dynamics->equations == DVI__FIRST_ORDER &&
                                  run->options.code == DVI_IDA};
  const dvi_status status = lagrange_run(&self);
  lagrange_clear(&self);
  return status;
}
