/* IDA on the equations of motion with constraints, in the form of Gear, Gupta and Leimkuhler.
 *
 * The unknowns are y = (q, v, p, lambda, mu), and the equations have index 2,
 *     F = ( qdot - v + G^T mu,  pdot - L_q + G^T lambda,  p - L_v,  G v + g,  phi ) = 0,
 * with L_q including forces, and the rows d phi/dq v + d phi/dt and A v + a in G v + g. The
 * multipliers mu, which vanish, keep both phi and its rate at 0. Nonholonomic constraints have mu =
 * 0 in the place of phi = 0. lambda and mu are in neither the error test nor the test of the
 * iteration's convergence. Rows that depend on others at the start have lambda = mu = 0 in the
 * place of their equations. The Jacobian dF/dy + c dF/dydot is written here, but for the
 * derivatives of g and of A by q, which are differenced. Sources: Gear, Leimkuhler and Gupta 1985;
 * Hindmarsh et al. 2005, ACM TOMS 31:363, sec. 2.3. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "reference/ida_run.h"
#include "system/dynamics/holonomic.h"

typedef struct holonomic_ida {
  dvi__reference_run *run;
  int n, m;
  double *phi_q, *phi_qq, *rate, *moved; /* [entries], [entries], [m], [n] */
  char *keep;                            /* [m] independent rows */
  dvi__ida_run ida;
} holonomic_ida;

/* ---- residual ---- */

static dvi_status holonomic_value(const holonomic_ida *self, double t, const double *y,
                                  const double *ydot, double *F)
{
  dvi__evaluator *e = self->run->evaluator;
  const dvi_system *s = self->run->system;
  const dvi__pattern *G = &s->rows_q;
  const int n = self->n, m = self->m;
  const double *q = y, *v = q + n, *p = v + n, *lambda = p + n, *mu = lambda + m;
  double *Fq = F, *Fp = F + n, *Fv = Fp + n, *F_rate = Fv + n, *F_phi = F_rate + m;
  DVI_TRY(dvi__lagrangian_gradient(e, 1, &t, q, v, Fp, Fv));
  DVI_TRY(dvi__rows_gradients(e, t, q, self->phi_q));
  DVI_TRY(dvi__rows_rate(e, t, q, F_rate));
  DVI_TRY(dvi__rows_value(e, t, q, F_phi));
  for (int i = 0; i < n; i++) {
    Fq[i] = ydot[i] - v[i];
    Fp[i] = ydot[2 * n + i] - Fp[i];
    Fv[i] = p[i] - Fv[i];
  }
  for (int a = s->place_rows; a < m; a++) F_phi[a] = mu[a];
  dvi__rows_pull(s, self->phi_q, mu, 1, Fq);
  dvi__rows_pull(s, self->phi_q, lambda, 1, Fp);
  for (int a = 0; a < m; a++)
    for (int k = G->start[a]; k < G->start[a + 1]; k++) F_rate[a] += self->phi_q[k] * v[G->row[k]];
  for (int a = 0; a < m; a++) {
    if (self->keep[a]) continue;
    F_rate[a] = lambda[a];
    F_phi[a] = mu[a];
  }
  return DVI_OK;
}

static int holonomic_residual(double t, N_Vector y, N_Vector ydot, N_Vector F, void *user)
{
  const holonomic_ida *self = user;
  return dvi__reference_callback(self->run,
                                 holonomic_value(self, t, N_VGetArrayPointer(y),
                                                 N_VGetArrayPointer(ydot), N_VGetArrayPointer(F)));
}

/* ---- Jacobian ---- */

static void add_block(SUNMatrix matrix, int row, int column, const dvi__pattern *pattern,
                      const double *values, double factor)
{
  for (int j = 0; j < pattern->columns; j++)
    for (int k = pattern->start[j]; k < pattern->start[j + 1]; k++)
      SM_ELEMENT_D(matrix, row + pattern->row[k], column + j) += factor * values[k];
}

static void add_transposed(SUNMatrix matrix, int row, int column, const dvi__pattern *pattern,
                           const double *values, double factor)
{
  for (int j = 0; j < pattern->columns; j++)
    for (int k = pattern->start[j]; k < pattern->start[j + 1]; k++)
      SM_ELEMENT_D(matrix, row + j, column + pattern->row[k]) += factor * values[k];
}

/* Add the derivatives of G^T mu, G^T lambda and G v by q. */
static dvi_status add_curvatures(const holonomic_ida *self, double t, const double *y,
                                 SUNMatrix matrix)
{
  dvi__evaluator *e = self->run->evaluator;
  const dvi__pattern *qq = &self->run->system->rows_qq;
  const int n = self->n, m = self->m;
  const double *q = y, *v = q + n, *lambda = v + 2 * n, *mu = lambda + m;
  DVI_TRY(dvi__rows_hessian(e, t, q, mu, self->phi_qq));
  add_block(matrix, 0, 0, qq, self->phi_qq, 1);
  DVI_TRY(dvi__rows_hessian(e, t, q, lambda, self->phi_qq));
  add_block(matrix, n, 0, qq, self->phi_qq, 1);
  for (int a = 0; a < m; a++) {
    memset(self->rate, 0, (size_t)m * sizeof(double));
    self->rate[a] = 1;
    DVI_TRY(dvi__rows_hessian(e, t, q, self->rate, self->phi_qq));
    for (int j = 0; j < n; j++)
      for (int k = qq->start[j]; k < qq->start[j + 1]; k++)
        SM_ELEMENT_D(matrix, 3 * n + a, j) += self->phi_qq[k] * v[qq->row[k]];
  }
  return DVI_OK;
}

/* Add factor times g, A v and A^T lambda at a moved point to a column of the matrix. The rows of
 * holonomic constraints count in g alone. */
static dvi_status add_moved_rows(const holonomic_ida *self, double t, const double *y, int column,
                                 double factor, SUNMatrix matrix)
{
  const dvi_system *s = self->run->system;
  const dvi__pattern *G = &s->rows_q;
  const int n = self->n;
  const double *v = y + n, *lambda = v + 2 * n;
  DVI_TRY(dvi__rows_rate(self->run->evaluator, t, self->moved, self->rate));
  for (int a = 0; a < self->m; a++)
    SM_ELEMENT_D(matrix, 3 * n + a, column) += factor * self->rate[a];
  if (s->nonholonomic_count == 0) return DVI_OK;
  DVI_TRY(dvi__rows_gradients(self->run->evaluator, t, self->moved, self->phi_q));
  for (int a = s->place_rows; a < self->m; a++)
    for (int k = G->start[a]; k < G->start[a + 1]; k++) {
      SM_ELEMENT_D(matrix, 3 * n + a, column) += factor * self->phi_q[k] * v[G->row[k]];
      SM_ELEMENT_D(matrix, n + G->row[k], column) += factor * self->phi_q[k] * lambda[a];
    }
  return DVI_OK;
}

/* Add the derivatives of g, A v and A^T lambda by q, by differences. They serve the iteration
 * alone. */
static dvi_status add_row_slopes(const holonomic_ida *self, double t, const double *y,
                                 SUNMatrix matrix)
{
  const dvi_system *s = self->run->system;
  const double *q = y;
  const int n = self->n;
  if (s->autonomous && s->nonholonomic_count == 0) return DVI_OK;
  memcpy(self->moved, q, (size_t)n * sizeof(double));
  for (int j = 0; j < n; j++) {
    const double step = sqrt(DBL_EPSILON) * fmax(fabs(q[j]), 1e-2);
    for (int side = -1; side <= 1; side += 2) {
      self->moved[j] = q[j] + side * step;
      DVI_TRY(add_moved_rows(self, t, y, j, side / (2 * step), matrix));
    }
    self->moved[j] = q[j];
  }
  return DVI_OK;
}

/* Replace the rows of equations that are left out. */
static void leave_out_rows(const holonomic_ida *self, SUNMatrix matrix)
{
  const int n = self->n, m = self->m, size = 3 * n + 2 * m;
  for (int a = 0; a < m; a++) {
    if (self->keep[a]) continue;
    for (int column = 0; column < size; column++)
      SM_ELEMENT_D(matrix, 3 * n + a, column) = SM_ELEMENT_D(matrix, 3 * n + m + a, column) = 0;
    SM_ELEMENT_D(matrix, 3 * n + a, 3 * n + a) = 1;
    SM_ELEMENT_D(matrix, 3 * n + m + a, 3 * n + m + a) = 1;
  }
}

static dvi_status holonomic_write_jacobian(const holonomic_ida *self, double t, double c,
                                           const double *y, SUNMatrix matrix)
{
  dvi__reference_run *run = self->run;
  dvi__evaluator *e = run->evaluator;
  const dvi_system *s = run->system;
  const int n = self->n, m = self->m;
  const double *q = y, *v = q + n;
  const dvi__pattern places = {n, s->place_rows, s->rows_q.start, s->rows_q.row};
  DVI_TRY(dvi__lagrangian_hessian(e, 1, &t, q, v, run->L_qq, run->L_qv, run->L_vv));
  for (int i = 0; i < n; i++) {
    SM_ELEMENT_D(matrix, i, i) = c;
    SM_ELEMENT_D(matrix, i, n + i) = -1;
    SM_ELEMENT_D(matrix, n + i, 2 * n + i) = c;
    SM_ELEMENT_D(matrix, 2 * n + i, 2 * n + i) = 1;
  }
  add_block(matrix, n, 0, &s->qq, run->L_qq, -1);
  add_block(matrix, n, n, &s->qv, run->L_qv, -1);
  add_transposed(matrix, 2 * n, 0, &s->qv, run->L_qv, -1);
  add_block(matrix, 2 * n, n, &s->vv, run->L_vv, -1);
  if (run->F_q != NULL) {
    DVI_TRY(dvi__forces_jacobian(e, 1, &t, q, v, run->F_q, run->F_v));
    add_block(matrix, n, 0, &s->by_q, run->F_q, -1);
    add_block(matrix, n, n, &s->by_v, run->F_v, -1);
  }
  DVI_TRY(add_curvatures(self, t, y, matrix));
  DVI_TRY(add_row_slopes(self, t, y, matrix));
  DVI_TRY(dvi__rows_gradients(e, t, q, self->phi_q));
  add_block(matrix, n, 3 * n, &s->rows_q, self->phi_q, 1);
  add_block(matrix, 0, 3 * n + m, &s->rows_q, self->phi_q, 1);
  add_transposed(matrix, 3 * n, n, &s->rows_q, self->phi_q, 1);
  add_transposed(matrix, 3 * n + m, 0, &places, self->phi_q, 1);
  for (int a = s->place_rows; a < m; a++) SM_ELEMENT_D(matrix, 3 * n + m + a, 3 * n + m + a) = 1;
  leave_out_rows(self, matrix);
  return DVI_OK;
}

/* IDA has set the matrix to 0. */
static int holonomic_jacobian(double t, double c, N_Vector y, N_Vector ydot, N_Vector F,
                              SUNMatrix matrix, void *user, N_Vector work1, N_Vector work2,
                              N_Vector work3)
{
  const holonomic_ida *self = user;
  (void)ydot, (void)F, (void)work1, (void)work2, (void)work3;
  return dvi__reference_callback(
      self->run, holonomic_write_jacobian(self, t, c, N_VGetArrayPointer(y), matrix));
}

/* ---- a run ---- */

/* Start with the rates of the equations of index 1. */
static dvi_status holonomic_start(const holonomic_ida *self)
{
  const dvi__reference_run *run = self->run;
  const size_t n = (size_t)self->n, bytes = n * sizeof(double);
  double *y = N_VGetArrayPointer(self->ida.y), *ydot = N_VGetArrayPointer(self->ida.ydot);
  memset(y, 0, (size_t)self->ida.size * sizeof *y);
  memset(ydot, 0, (size_t)self->ida.size * sizeof *ydot);
  memcpy(y, run->q, bytes);
  memcpy(y + n, run->v, bytes);
  memcpy(y + 2 * n, run->p, bytes);
  memcpy(ydot, run->v, bytes);
  memcpy(ydot + 2 * n, run->force, bytes);
  DVI_TRY(dvi__rows_acceleration(run->evaluator, run->t, run->q, run->v, ydot + n, y + 3 * n));
  for (int a = 0; a < self->m; a++) y[3 * (int)n + a] *= self->keep[a];
  return DVI_OK;
}

static dvi_status holonomic_reserve(holonomic_ida *self)
{
  const dvi_system *s = self->run->system;
  const int size = 3 * self->n + 2 * self->m;
  self->phi_q = DVI_NEW(double, dvi__pattern_entries(&s->rows_q));
  self->phi_qq = DVI_NEW(double, dvi__pattern_entries(&s->rows_qq));
  self->rate = DVI_NEW(double, self->m);
  self->moved = DVI_NEW(double, self->n);
  self->keep = DVI_NEW(char, self->m);
  if (!self->keep || !self->phi_q || !self->phi_qq || !self->rate || !self->moved)
    return dvi__reference_no_setup(self->run);
  dvi__rows_choose(self->run->evaluator, self->keep);
  return dvi__ida_run_create(self->run, size, SUNDenseMatrix(size, size, self->run->context),
                             &self->ida);
}

static void holonomic_clear(holonomic_ida *self)
{
  dvi__ida_run_clear(&self->ida);
  dvi__release(self->phi_q);
  dvi__release(self->phi_qq);
  dvi__release(self->rate);
  dvi__release(self->moved);
  dvi__release(self->keep);
}

static dvi_status holonomic_run(holonomic_ida *self)
{
  dvi__reference_run *run = self->run;
  const size_t bytes = (size_t)self->n * sizeof(double);
  DVI_TRY(holonomic_reserve(self));
  DVI_TRY(holonomic_start(self));
  if (dvi__ida_run_configure(&self->ida, holonomic_residual, self) != 0 ||
      IDASetJacFn(self->ida.memory, holonomic_jacobian) != 0 ||
      dvi__ida_run_leave_untested(&self->ida, 3 * self->n, 2 * self->m) != 0)
    return dvi__reference_no_setup(run);
  DVI_TRY(dvi__ida_run_solve(&self->ida));
  memcpy(run->q, N_VGetArrayPointer(self->ida.y), bytes);
  memcpy(run->p, N_VGetArrayPointer(self->ida.y) + 2 * run->n, bytes);
  return DVI_OK;
}

dvi_status dvi__reference_holonomic(dvi__reference_run *run)
{
  holonomic_ida self = {.run = run, .n = run->n, .m = run->system->row_count};
  const dvi_status status = holonomic_run(&self);
  holonomic_clear(&self);
  return status;
}
