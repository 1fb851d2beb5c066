/* CVODE and ARKODE on Hamilton's equations, with the velocity from the inverse Legendre map,
 *     y = (q, p),   qdot = v(t,q,p),   pdot = L_q(t,q,v(t,q,p)).
 * A one-form has only the reduced equations, y = q, qdot = v(t,q). A Hamiltonian has q' and p' with
 * the multiplier eliminated. Factors have the lifted equations, y = (kappa, p) (lift.h). Sources:
 * Hindmarsh et al. 2005, ACM TOMS 31:363, sec. 2.1 (CVODE), and Reynolds et al. 2023, ACM TOMS
 * 49:19 (ARKODE). */
#include <string.h>

#include "core/status.h"
#include "reference/lift.h"
#include "system/evaluate/dynamics.h"

static int has_momenta(const dvi__reference_run *run)
{
  return run->system->dynamics->equations != DVI__FIRST_ORDER;
}

static int has_factors(const dvi__reference_run *run)
{
  return run->system->dynamics->equations == DVI__LIFTED;
}

typedef struct ode_run {
  dvi__reference_run *run;
  dvi__lift lift; /* only with factors */
  int positions;  /* number of entries of y before p */
  N_Vector y;
  SUNMatrix matrix;               /* matrix of a direct solver, else NULL */
  SUNLinearSolver linear;         /* linear solver of BDF, else NULL */
  SUNNonlinearSolver fixed_point; /* iteration of Adams, else NULL */
  void *memory;                   /* memory of CVODE or ARKODE */
} ode_run;

static dvi_status ode_rate(dvi__reference_run *run, double t, const double *q, const double *p,
                           double *qdot, double *pdot)
{
  const dvi__dynamics *dynamics = run->system->dynamics;
  DVI_TRY(dynamics->motion(run->evaluator, t, q, p, run->v, has_momenta(run) ? pdot : NULL, NULL));
  memcpy(qdot, run->v, (size_t)run->n * sizeof *qdot);
  return DVI_OK;
}

static int ode_right_side(double t, N_Vector y, N_Vector ydot, void *user)
{
  dvi__reference_run *run = ((ode_run *)user)->run;
  const double *q = N_VGetArrayPointer(y), *p = q + run->n;
  double *qdot = N_VGetArrayPointer(ydot), *pdot = qdot + run->n;
  return dvi__reference_callback(run, ode_rate(run, t, q, p, qdot, pdot));
}

static int ode_lifted_right_side(double t, N_Vector y, N_Vector ydot, void *user)
{
  ode_run *self = user;
  dvi__reference_run *run = self->run;
  const double *kappa = N_VGetArrayPointer(y), *p = kappa + self->positions;
  double *rate = N_VGetArrayPointer(ydot);
  dvi__lift_down(&self->lift, kappa, run->q);
  dvi_status status = dvi__legendre_inverse(run->evaluator, t, run->q, p, run->v);
  if (status == DVI_OK)
    status = dvi__lift_equations(&self->lift, t, kappa, run->v, rate, rate + self->positions,
                                 run->force);
  return dvi__reference_callback(run, status);
}

static CVRhsFn ode_right_side_of(const dvi__reference_run *run)
{
  return has_factors(run) ? ode_lifted_right_side : ode_right_side;
}

/* Test for a diagonal mass without forces, damping and vector potential. Only then M^-1 is as
 * sparse as M, and the Jacobian has a simple form. */
static int jacobian_is_simple(const dvi_system *system)
{
  return system->mass_diagonal != NULL && !system->dynamics->on_manifold &&
         system->force_count == 0 && system->damping == 0 && system->row_count == 0 &&
         system->vector == NULL;
}

/* Write d(qdot, pdot)/d(q, p) = [ 0, M^-1; L_qq, 0 ] with its diagonal, to which CVODE adds the
 * identity in place. */
static int ode_jacobian(double t, N_Vector y, N_Vector ydot, SUNMatrix matrix, void *user,
                        N_Vector work1, N_Vector work2, N_Vector work3)
{
  (void)ydot, (void)work1, (void)work2, (void)work3;
  dvi__reference_run *run = ((ode_run *)user)->run;
  const dvi_system *system = run->system;
  const int n = run->n;
  const dvi_status status = dvi__lagrangian_hessian(run->evaluator, 1, &t, N_VGetArrayPointer(y),
                                                    run->v, run->L_qq, NULL, NULL);
  if (status != DVI_OK) return dvi__reference_callback(run, status);
  dvi__columns columns;
  dvi__columns_start(&columns, matrix);
  for (int j = 0; j < n; j++) {
    dvi__columns_next(&columns);
    dvi__columns_put(&columns, j, 0.0);
    for (int e = system->qq.start[j]; e < system->qq.start[j + 1]; e++)
      dvi__columns_put(&columns, n + system->qq.row[e], run->L_qq[e]);
  }
  for (int j = 0; j < n; j++) {
    dvi__columns_next(&columns);
    dvi__columns_put(
        &columns, j,
        1.0 / (system->mass_diagonal != NULL ? system->mass_diagonal[j] : system->mass_scalar));
    dvi__columns_put(&columns, n + j, 0.0);
  }
  return dvi__reference_callback(run, DVI_OK);
}

static int ode_size(const ode_run *self)
{
  return self->positions + (has_momenta(self->run) ? self->run->n : 0);
}

static dvi_status ode_start(ode_run *self)
{
  dvi__reference_run *run = self->run;
  const size_t n = (size_t)run->n;
  if (has_factors(run) && run->system->row_count > 0)
    return dvi__fail(DVI_UNSUPPORTED, "CVODE and ARKODE do not take holonomic constraints on "
                                      "rotations, directions and angles; IDA does");
  if (has_factors(run)) DVI_TRY(dvi__lift_create(run, &self->lift));
  self->positions = has_factors(run) ? self->lift.size : run->n;
  self->y = N_VNew_Serial(ode_size(self), run->context);
  if (self->y == NULL) return dvi__reference_no_setup(run);
  double *y = N_VGetArrayPointer(self->y);
  if (has_factors(run))
    dvi__lift_up(&self->lift, run->q, y);
  else
    memcpy(y, run->q, n * sizeof *y);
  if (has_momenta(run)) memcpy(y + self->positions, run->p, n * sizeof *y);
  return DVI_OK;
}

static dvi_status ode_finish(const ode_run *self)
{
  const double *y = N_VGetArrayPointer(self->y);
  dvi__reference_run *run = self->run;
  const size_t n = (size_t)run->n;
  if (has_factors(run))
    dvi__lift_down(&self->lift, y, run->q);
  else
    memcpy(run->q, y, n * sizeof *y);
  if (!has_momenta(run)) return dvi__reference_form_momentum(run);
  memcpy(run->p, y + self->positions, n * sizeof *y);
  if (has_factors(run)) dvi__lift_tangent(&self->lift, run->q, run->p);
  return DVI_OK;
}

static void ode_clear(ode_run *self)
{
  if (self->fixed_point != NULL) (void)SUNNonlinSolFree(self->fixed_point);
  if (self->linear != NULL) (void)SUNLinSolFree(self->linear);
  if (self->matrix != NULL) SUNMatDestroy(self->matrix);
  if (self->y != NULL) N_VDestroy(self->y);
  dvi__lift_clear(&self->lift);
}

/* Make the linear solver: a direct one if the Jacobian is known or small enough to be differenced,
 * else a Krylov method without a matrix. */
static dvi_status ode_make_linear(ode_run *self)
{
  const dvi__reference_run *run = self->run;
  const int n = run->n, entries = dvi__pattern_entries(&run->system->qq),
            known = jacobian_is_simple(run->system);
  const int size = ode_size(self);
  if (known || dvi__reference_is_dense(size)) {
    self->matrix = dvi__reference_matrix(run, size, entries + 3 * n);
    if (self->matrix == NULL) return dvi__reference_no_setup(run);
    self->linear = dvi__reference_linear(run, self->y, self->matrix);
  } else {
    self->linear = SUNLinSol_SPGMR(self->y, SUN_PREC_NONE, 0, run->context);
  }
  return self->linear == NULL ? dvi__reference_no_setup(run) : DVI_OK;
}

static dvi_status ode_make_solver(ode_run *self)
{
  if (self->run->options.code == DVI_CVODE_BDF) return ode_make_linear(self);
  self->fixed_point = SUNNonlinSol_FixedPoint(self->y, 0, self->run->context);
  return self->fixed_point == NULL ? dvi__reference_no_setup(self->run) : DVI_OK;
}

static int configure_cvode(ode_run *self)
{
  const dvi__reference_run *run = self->run;
  void *cvode = self->memory;
  if (DVI__SUNDIALS_SILENCE(CVodeSetErrHandlerFn, cvode) ||
      CVodeInit(cvode, ode_right_side_of(run), run->t, self->y) ||
      CVodeSStolerances(cvode, run->options.relative_tolerance, run->options.absolute_tolerance) ||
      CVodeSetUserData(cvode, self) || CVodeSetMaxNumSteps(cvode, run->options.max_steps) ||
      CVodeSetStopTime(cvode, run->t_end) || CVodeSetMinStep(cvode, dvi__reference_least_step(run)))
    return -1;
  if (self->fixed_point != NULL) return CVodeSetNonlinearSolver(cvode, self->fixed_point);
  if (CVodeSetLinearSolver(cvode, self->linear, self->matrix)) return -1;
  return jacobian_is_simple(run->system) ? CVodeSetJacFn(cvode, ode_jacobian) : 0;
}

static dvi_status integrate_cvode(ode_run *self)
{
  dvi__reference_run *run = self->run;
  if (configure_cvode(self) != 0) return dvi__reference_no_setup(run);
  const int flag = CVode(self->memory, run->t_end, self->y, &run->reached, CV_NORMAL);
  (void)CVodeGetNumSteps(self->memory, &run->steps);
  (void)CVodeGetCurrentTime(self->memory, &run->reached);
  if (flag < 0) return dvi__reference_stopped(run, flag, CVodeGetReturnFlagName(flag));
  return ode_finish(self);
}

dvi_status dvi__reference_cvode(dvi__reference_run *run)
{
  ode_run self = {.run = run};
  dvi_status status = ode_start(&self);
  if (status == DVI_OK) status = ode_make_solver(&self);
  if (status == DVI_OK) {
    self.memory = CVodeCreate(run->options.code == DVI_CVODE_BDF ? CV_BDF : CV_ADAMS, run->context);
    status = self.memory == NULL ? dvi__reference_no_setup(run) : integrate_cvode(&self);
    if (self.memory != NULL) CVodeFree(&self.memory);
  }
  ode_clear(&self);
  return status;
}

static int configure_arkode(ode_run *self)
{
  const dvi__reference_run *run = self->run;
  void *arkode = self->memory;
  return DVI__SUNDIALS_SILENCE(ARKStepSetErrHandlerFn, arkode) ||
         ARKodeSStolerances(arkode, run->options.relative_tolerance,
                            run->options.absolute_tolerance) ||
         ARKodeSetUserData(arkode, self) ||
         ARKStepSetTableNum(arkode, ARKODE_DIRK_NONE, ARKODE_FEHLBERG_13_7_8) ||
         ARKodeSetMaxNumSteps(arkode, run->options.max_steps) ||
         ARKodeSetStopTime(arkode, run->t_end) ||
         ARKodeSetMinStep(arkode, dvi__reference_least_step(run));
}

static dvi_status integrate_arkode(ode_run *self)
{
  dvi__reference_run *run = self->run;
  if (configure_arkode(self) != 0) return dvi__reference_no_setup(run);
  const int flag = ARKodeEvolve(self->memory, run->t_end, self->y, &run->reached, ARK_NORMAL);
  (void)ARKodeGetNumSteps(self->memory, &run->steps);
  (void)ARKodeGetCurrentTime(self->memory, &run->reached);
  if (flag < 0) return dvi__reference_stopped(run, flag, ARKodeGetReturnFlagName(flag));
  return ode_finish(self);
}

dvi_status dvi__reference_arkode(dvi__reference_run *run)
{
  ode_run self = {.run = run};
  dvi_status status = ode_start(&self);
  if (status == DVI_OK) {
    self.memory = ARKStepCreate(ode_right_side_of(run), NULL, run->t, self.y, run->context);
    status = self.memory == NULL ? dvi__reference_no_setup(run) : integrate_arkode(&self);
    if (self.memory != NULL) ARKodeFree(&self.memory);
  }
  ode_clear(&self);
  return status;
}
