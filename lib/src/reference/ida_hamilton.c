/* IDA on the equations of a Hamiltonian, with constraints of second class or without any.
 *
 * DVI_IDA has the unknowns y = (q, p), with the multiplier eliminated by the bracket matrix,
 *     F = ydot - X(t, y) = 0,
 *     X = (H_p + phi_p^T lambda, -H_q - phi_q^T lambda),   {phi, phi} lambda = -{phi, H},
 * and without constraints X = (H_p, -H_q). DVI_IDA_INDEX_2 has the unknowns y = (q, p, lambda),
 *     F = ( (qdot, pdot) - X(t, q, p, lambda),  phi(q,p) ) = 0,
 * of index 2, with lambda in neither the error test nor the test of the iteration's convergence.
 * The Jacobian dF/dy + c dF/dydot of index 2 is written here, because IDA's differences move lambda
 * by its tolerance. The Jacobian of DVI_IDA has derivatives of lambda, and is differenced. Sources:
 * Hindmarsh et al. 2005, ACM TOMS 31:363, sec. 2.3, and Brenan, Campbell and Petzold 1996 (error
 * tests at index 2). */
#include "system/dynamics/constrained_hamiltonian.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "reference/ida_run.h"

typedef struct hamilton_ida {
  dvi__reference_run *run;
  int index_2;                              /* the multiplier is an unknown */
  double *phi_z, *phi_qq, *phi_qp, *phi_pp; /* in the order of the constraint's patterns */
  dvi__ida_run ida;
} hamilton_ida;

static int hamilton_residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  dvi__reference_run *run = ((hamilton_ida *)user)->run;
  const double *q = N_VGetArrayPointer(y), *rate = N_VGetArrayPointer(ydot);
  double *X = N_VGetArrayPointer(F);
  const dvi_status status = dvi__state_rates(run->evaluator, t, q, q + run->n, X, X + run->n, NULL);
  for (int i = 0; status == DVI_OK && i < 2 * run->n; i++) X[i] = rate[i] - X[i];
  return dvi__reference_callback(run, status);
}

/* Evaluate F. The array first holds X, from which ydot - X is formed at the end. */
static dvi_status index_2_value(const hamilton_ida *self, double t, const double *q,
                                const double *rate, double *F)
{
  const dvi__reference_run *run = self->run;
  const int n = run->n;
  DVI_TRY(dvi__lagrangian_gradient(run->evaluator, 1, &t, q, q + n, F + n, F));
  DVI_TRY(dvi__constraint_gradients(run->evaluator, q, q + n, self->phi_z));
  DVI_TRY(dvi__constraint_value(run->evaluator, q, q + n, F + 2 * n));
  for (int i = 0; i < n; i++) F[n + i] = -F[n + i];
  dvi__constraint_push(run->system->constraint, self->phi_z, q + 2 * n, 1, F);
  for (int i = 0; i < 2 * n; i++) F[i] = rate[i] - F[i];
  return DVI_OK;
}

static int index_2_residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  const hamilton_ida *self = user;
  return dvi__reference_callback(self->run,
                                 index_2_value(self, t, N_VGetArrayPointer(y),
                                               N_VGetArrayPointer(ydot), N_VGetArrayPointer(F)));
}

/* Subtract the derivative of the Hamiltonian vector field (F_p, -F_q). */
static void subtract_slope(SUNMatrix matrix, const dvi__lagrangian_term *f, int n, const double *qq,
                           const double *qp, const double *pp)
{
  for (int j = 0; j < n; j++) {
    for (int e = f->qq.start[j]; e < f->qq.start[j + 1]; e++)
      SM_ELEMENT_D(matrix, n + f->qq.row[e], j) += qq[e];
    for (int e = f->vv.start[j]; e < f->vv.start[j + 1]; e++)
      SM_ELEMENT_D(matrix, f->vv.row[e], n + j) -= pp[e];
    for (int e = f->qv.start[j]; e < f->qv.start[j + 1]; e++) {
      SM_ELEMENT_D(matrix, n + f->qv.row[e], n + j) += qp[e];
      SM_ELEMENT_D(matrix, j, f->qv.row[e]) -= qp[e];
    }
  }
}

/* Write the gradient of phi_a in row 2n+a, and minus its Hamiltonian vector field in column
 * 2n+a. */
static void write_gradients(SUNMatrix matrix, const dvi__pattern *gradients, const double *phi_z)
{
  const int z = gradients->rows, n = z / 2;
  for (int a = 0; a < gradients->columns; a++)
    for (int e = gradients->start[a]; e < gradients->start[a + 1]; e++) {
      const int row = gradients->row[e];
      SM_ELEMENT_D(matrix, z + a, row) = phi_z[e];
      SM_ELEMENT_D(matrix, row < n ? n + row : row - n, z + a) = row < n ? phi_z[e] : -phi_z[e];
    }
}

static dvi_status index_2_write_jacobian(const hamilton_ida *self, double t, double c,
                                         const double *q, SUNMatrix matrix)
{
  const dvi__reference_run *run = self->run;
  const dvi__constraint_term *constraint = run->system->constraint;
  const int n = run->n;
  DVI_TRY(
      dvi__lagrangian_hessian(run->evaluator, 1, &t, q, q + n, run->L_qq, run->L_qv, run->L_vv));
  DVI_TRY(dvi__constraint_gradients(run->evaluator, q, q + n, self->phi_z));
  DVI_TRY(dvi__constraint_hessian(run->evaluator, q, q + n, q + 2 * n, self->phi_qq, self->phi_qp,
                                  self->phi_pp));
  for (int i = 0; i < 2 * n; i++) SM_ELEMENT_D(matrix, i, i) = c;
  subtract_slope(matrix, run->system->lagrangian, n, run->L_qq, run->L_qv, run->L_vv);
  subtract_slope(matrix, &constraint->weighted, n, self->phi_qq, self->phi_qp, self->phi_pp);
  write_gradients(matrix, &constraint->gradients, self->phi_z);
  return DVI_OK;
}

/* Write the Jacobian of index 2. IDA has set the matrix to 0. */
static int index_2_jacobian(double t, double c, N_Vector y, N_Vector ydot, N_Vector F,
                            SUNMatrix matrix, void *user, N_Vector work1, N_Vector work2,
                            N_Vector work3)
{
  const hamilton_ida *self = user;
  (void)ydot, (void)F, (void)work1, (void)work2, (void)work3;
  return dvi__reference_callback(self->run,
                                 index_2_write_jacobian(self, t, c, N_VGetArrayPointer(y), matrix));
}

static void hamilton_start(const hamilton_ida *self)
{
  const dvi__reference_run *run = self->run;
  const size_t n = (size_t)run->n, bytes = n * sizeof(double);
  double *y = N_VGetArrayPointer(self->ida.y), *ydot = N_VGetArrayPointer(self->ida.ydot);
  memset(ydot, 0, (size_t)self->ida.size * sizeof *ydot);
  memcpy(y, run->q, bytes);
  memcpy(y + n, run->p, bytes);
  memcpy(ydot, run->v, bytes);
  memcpy(ydot + n, run->force, bytes);
  if (self->index_2)
    memcpy(y + 2 * n, run->multiplier, ((size_t)self->ida.size - 2 * n) * sizeof *y);
}

static int hamilton_configure(hamilton_ida *self)
{
  const dvi__ida_run *ida = &self->ida;
  const int states = 2 * self->run->n;
  if (dvi__ida_run_configure(ida, self->index_2 ? index_2_residual : hamilton_residual, self) != 0)
    return -1;
  return self->index_2 ? IDASetJacFn(ida->memory, index_2_jacobian) ||
                             dvi__ida_run_leave_untested(ida, states, ida->size - states)
                       : 0;
}

static dvi_status hamilton_integrate(const hamilton_ida *self)
{
  dvi__reference_run *run = self->run;
  const size_t bytes = (size_t)run->n * sizeof(double);
  DVI_TRY(dvi__ida_run_solve(&self->ida));
  memcpy(run->q, N_VGetArrayPointer(self->ida.y), bytes);
  memcpy(run->p, N_VGetArrayPointer(self->ida.y) + run->n, bytes);
  return DVI_OK;
}

static dvi_status hamilton_reserve_index_2(hamilton_ida *self, const dvi__constraint_term *c)
{
  self->phi_z = DVI_NEW(double, dvi__pattern_entries(&c->gradients));
  self->phi_qq = DVI_NEW(double, dvi__pattern_entries(&c->weighted.qq));
  self->phi_qp = DVI_NEW(double, dvi__pattern_entries(&c->weighted.qv));
  self->phi_pp = DVI_NEW(double, dvi__pattern_entries(&c->weighted.vv));
  if (self->phi_z == NULL || self->phi_qq == NULL || self->phi_qp == NULL || self->phi_pp == NULL)
    return dvi__reference_no_setup(self->run);
  return DVI_OK;
}

static dvi_status hamilton_reserve(hamilton_ida *self)
{
  dvi__reference_run *run = self->run;
  const dvi__constraint_term *c = run->system->constraint;
  const int size = 2 * run->n + (self->index_2 ? c->callbacks.count : 0);
  if (self->index_2) DVI_TRY(hamilton_reserve_index_2(self, c));
  return dvi__ida_run_create(run, size, SUNDenseMatrix(size, size, run->context), &self->ida);
}

static void hamilton_clear(hamilton_ida *self)
{
  dvi__ida_run_clear(&self->ida);
  dvi__release(self->phi_z);
  dvi__release(self->phi_qq);
  dvi__release(self->phi_qp);
  dvi__release(self->phi_pp);
}

static dvi_status hamilton_run(hamilton_ida *self)
{
  DVI_TRY(hamilton_reserve(self));
  hamilton_start(self);
  if (hamilton_configure(self) != 0) return dvi__reference_no_setup(self->run);
  return hamilton_integrate(self);
}

dvi_status dvi__reference_hamilton(dvi__reference_run *run)
{
  hamilton_ida self = {.run = run, .index_2 = run->options.code == DVI_IDA_INDEX_2};
  const dvi_status status = hamilton_run(&self);
  hamilton_clear(&self);
  return status;
}
