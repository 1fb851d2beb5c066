/* IDA on the implicit Euler-Lagrange equations.
 *
 * Unknowns y = (q, v, p), equations of index 1, or of index 2 if L_v = alpha(q) does not depend on
 * v:
 *     F(t, y, ydot) = ( qdot - v,  pdot - L_q(t,q,v),  p - L_v(t,q,v) ) = 0
 * with the Jacobian dF/dy + c dF/dydot, columns q, v, p:
 *     [  c I     -I      0  ]
 *     [ -L_qq   -L_qv   c I ]
 *     [ -L_vq   -L_vv    I  ]
 * For index 2 the multiplier v is left out of the error test. With a one-form the first choice are
 * the reduced equations of motion, unknowns y = q,
 *     F(t, y, ydot) = Omega(q) qdot - H_q(t,q) = 0,
 * whose Jacobian IDA differences: it has second derivatives of alpha that no callback gives.
 *
 * Nothing is discretised, inverted or assembled by the code that the methods use; only the
 * callbacks are shared. Source: Hindmarsh et al. 2005, ACM TOMS 31:363, sec. 2.3; Brenan, Campbell
 * and Petzold 1996 (error tests at index 2). */
#include <float.h>
#include <math.h>
#include <string.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/pattern.h"
#include "reference/ida_run.h"
#include "system/dynamics/one_form.h"

typedef struct judge {
  dvi__reference_run *run;
  int reduced;
  dvi__pattern vq; /* the transpose of the system's qv */
  int *in_qv;      /* [entries of vq]: the same entry of qv */
  dvi__ida_run ida;
} judge;

/* ---- the whole equations ---- */

static int residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  dvi__reference_run *run = ((judge *)user)->run;
  const ptrdiff_t n = run->n;
  const double *q = N_VGetArrayPointer(y), *v = q + n, *p = v + n;
  const double *qdot = N_VGetArrayPointer(ydot), *pdot = qdot + 2 * n;
  double *Fq = N_VGetArrayPointer(F), *Fp = Fq + n, *Fv = Fp + n;
  const dvi_status status = dvi__lagrangian_gradient(run->evaluator, 1, &t, q, v, Fp, Fv);
  for (ptrdiff_t i = 0; status == DVI_OK && i < n; i++) {
    Fq[i] = qdot[i] - v[i];
    Fp[i] = pdot[i] - Fp[i];
    Fv[i] = p[i] - Fv[i];
  }
  return dvi__reference_callback(run, status);
}

static void write_block(dvi__columns *columns, const dvi__pattern *pattern, int column,
                        int first_row, const double *values)
{
  for (int e = pattern->start[column]; e < pattern->start[column + 1]; e++)
    dvi__columns_put(columns, first_row + pattern->row[e], -values[e]);
}

static void write_jacobian(const judge *self, double c, SUNMatrix matrix)
{
  const dvi__reference_run *run = self->run;
  const dvi_system *system = run->system;
  const int n = run->n;
  dvi__columns columns;
  dvi__columns_start(&columns, matrix);
  for (int j = 0; j < n; j++) {
    dvi__columns_next(&columns);
    dvi__columns_put(&columns, j, c);
    write_block(&columns, &system->qq, j, n, run->L_qq);
    for (int e = self->vq.start[j]; e < self->vq.start[j + 1]; e++)
      dvi__columns_put(&columns, 2 * n + self->vq.row[e], -run->L_qv[self->in_qv[e]]);
  }
  for (int j = 0; j < n; j++) {
    dvi__columns_next(&columns);
    dvi__columns_put(&columns, j, -1.0);
    write_block(&columns, &system->qv, j, n, run->L_qv);
    write_block(&columns, &system->vv, j, 2 * n, run->L_vv);
  }
  for (int j = 0; j < n; j++) {
    dvi__columns_next(&columns);
    dvi__columns_put(&columns, n + j, c);
    dvi__columns_put(&columns, 2 * n + j, 1.0);
  }
}

static int jacobian(double t, double c, N_Vector y, N_Vector ydot, N_Vector F, SUNMatrix matrix,
                    void *user, N_Vector work1, N_Vector work2, N_Vector work3)
{
  (void)ydot, (void)F, (void)work1, (void)work2, (void)work3;
  const judge *self = user;
  dvi__reference_run *run = self->run;
  const double *q = N_VGetArrayPointer(y);
  const dvi_status status = dvi__lagrangian_hessian(run->evaluator, 1, &t, q, q + run->n, run->L_qq,
                                                    run->L_qv, run->L_vv);
  if (status == DVI_OK) write_jacobian(self, c, matrix);
  return dvi__reference_callback(run, status);
}

/* vdot is in no equation, but IDA's first predictor and first error test use it: exact for a
 * constant mass, and a difference along the flow otherwise. */
static dvi_status acceleration(dvi__reference_run *run, double *vdot)
{
  const int n = run->n;
  if (run->system->lagrangian == NULL) {
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

static int reduced_residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  dvi__reference_run *run = ((judge *)user)->run;
  const dvi_status status = dvi__two_form_residual(run->evaluator, t, N_VGetArrayPointer(y),
                                                   N_VGetArrayPointer(ydot), N_VGetArrayPointer(F));
  return dvi__reference_callback(run, status);
}

/* ---- a run ---- */

static dvi_status start(const judge *self)
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
  return acceleration(run, ydot + n);
}

static int configure(judge *self)
{
  const dvi__ida_run *ida = &self->ida;
  const int n = self->run->n;
  if (dvi__ida_run_configure(ida, self->reduced ? reduced_residual : residual, self) != 0)
    return -1;
  if (self->run->options.code == DVI_IDA_INDEX_2 && dvi__ida_run_leave_untested(ida, n, n) != 0)
    return -1;
  return self->reduced ? 0 : IDASetJacFn(ida->memory, jacobian);
}

static dvi_status integrate(const judge *self)
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

static dvi_status transpose(judge *self)
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

static dvi_status reserve(judge *self)
{
  dvi__reference_run *run = self->run;
  const int n = run->n, size = self->reduced ? n : 3 * n,
            qq = dvi__pattern_entries(&run->system->qq),
            qv = dvi__pattern_entries(&run->system->qv),
            vv = dvi__pattern_entries(&run->system->vv);
  DVI_TRY(transpose(self));
  SUNMatrix matrix = self->reduced ? SUNDenseMatrix(n, n, run->context)
                                   : dvi__reference_matrix(run, size, 4 * n + qq + 2 * qv + vv);
  return dvi__ida_run_create(run, size, matrix, &self->ida);
}

static void clear(judge *self)
{
  dvi__ida_run_clear(&self->ida);
  dvi__release(self->in_qv);
  dvi__pattern_clear(&self->vq);
}

dvi_status dvi__reference_ida(dvi__reference_run *run)
{
  const dvi__dynamics *dynamics = run->system->dynamics;
  if (dynamics->constraint == NULL && run->options.code == DVI_IDA_INDEX_2)
    return dvi__fail(DVI_UNSUPPORTED, "ida-index-2: the system declares neither a one-form nor a "
                                      "Hamiltonian with constraints; its equations are of index 1");
  if (dynamics->equations == DVI__HAMILTON) return dvi__reference_hamilton(run);
  if (dynamics->equations == DVI__LIFTED) return dvi__reference_ida_lift(run);
  judge self = {.run = run,
                .reduced = dynamics->equations == DVI__FIRST_ORDER && run->options.code == DVI_IDA};
  dvi_status status = reserve(&self);
  if (status == DVI_OK) status = start(&self);
  if (status == DVI_OK && configure(&self) != 0) status = dvi__reference_no_setup(run);
  if (status == DVI_OK) status = integrate(&self);
  clear(&self);
  return status;
}
