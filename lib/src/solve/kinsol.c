/* KINSOL with line search, on own matrix and linear solver.
 *
 * SUNDIALS' wrapper of KLU analyses and factors anew at the first setup of each call. Here the one
 * analysis of num/linear.h serves Newton's method and KINSOL alike. KINSOL's defaults are loose and
 * reuse old Jacobians, which shows as energy drift over long runs
 * (tests/solve/test_kinsol_drift.c). Therefore every tolerance is set here. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "solve/solver_struct.h"
#include "solve/sundials.h"
#include "solve/vector.h"

struct dvi__kinsol {
  dvi__solver *solver;
  int unknowns;
  /* the unknowns are the equations' own variables, which are only tested, of so many solutions */
  int own;
  double *known; /* [unknowns] residuals that are known, in own variables */
  int is_known;  /* they are tested now */
  SUNContext context;
  void *memory;
  N_Vector x, x_scale, r_scale;
  /* [unknowns] scale of the rows as the equations gave it, and size of the unknowns, from which
   * both scales are made */
  double *row_scale, whole;
  SUNMatrix matrix; /* its content is this struct */
  SUNLinearSolver linear;
  dvi_status fatal; /* failure of a callback, 0 if none */
  dvi_status last;  /* status of the last callback */
};

/* ---- callbacks of KINSOL ---- */

static int callback_return(dvi__kinsol *k, dvi_status status)
{
  k->last = status;
  if (status < 0) k->fatal = status;
  return status == DVI_OK ? 0 : status > 0 ? 1 : -1;
}

/* Find NaN and infinity, which must not reach KINSOL. Its line search halves the step for ever once
 * a NaN is among its numbers. */
static int not_finite(const dvi__kinsol *k, N_Vector x)
{
  return dvi__first_not_finite((size_t)k->unknowns, NV_DATA_S(x)) >= 0;
}

static dvi_status evaluate_residual(const dvi__kinsol *k, const double *x, double *r)
{
  const dvi__equations *equations = &k->solver->equations;
  if (k->is_known) {
    memcpy(r, k->known, (size_t)k->unknowns * sizeof(double));
    return DVI_OK;
  }
  if (!k->own) return dvi__solver_residual(k->solver, x, r);
  k->solver->counters->residuals++;
  return equations->own_residual(equations->of, x, r);
}

static int kinsol_residual(N_Vector x, N_Vector r, void *user)
{
  dvi__kinsol *k = user;
  const int failed = callback_return(k, evaluate_residual(k, NV_DATA_S(x), NV_DATA_S(r)));
  if (failed != 0) return failed;
  /* nothing is searched from a point that is only tested, and NaN does not pass */
  return k->own ? 0 : not_finite(k, r);
}

static int kinsol_jacobian(N_Vector x, N_Vector r, SUNMatrix matrix, void *user, N_Vector work1,
                           N_Vector work2)
{
  dvi__kinsol *k = user;
  (void)r, (void)matrix, (void)work1, (void)work2;
  if (k->own) return -1; /* the test has failed already */
  return callback_return(k, dvi__solver_factor(k->solver, NV_DATA_S(x)));
}

static SUNMatrix_ID matrix_id(SUNMatrix matrix)
{
  (void)matrix;
  return SUNMATRIX_CUSTOM;
}

static int matrix_zero(SUNMatrix matrix)
{
  (void)matrix; /* the Jacobian callback writes every value */
  return 0;
}

static SUNLinearSolver_Type linear_type(SUNLinearSolver linear)
{
  (void)linear;
  return SUNLINEARSOLVER_DIRECT;
}

static int linear_setup(SUNLinearSolver linear, SUNMatrix matrix)
{
  (void)linear, (void)matrix; /* the Jacobian callback has factored already */
  return 0;
}

static int linear_solve(SUNLinearSolver linear, SUNMatrix matrix, N_Vector x, N_Vector b,
                        sunrealtype tolerance)
{
  const dvi__kinsol *k = linear->content;
  (void)matrix, (void)tolerance;
  N_VScale(1.0, b, x);
  if (dvi__solver_correction(k->solver, NV_DATA_S(x)) != DVI_OK) return 1;
  return not_finite(k, x);
}

/* ---- create ---- */

static int kinsol_create_matrix(dvi__kinsol *k)
{
  k->matrix = SUNMatNewEmpty(k->context);
  k->linear = SUNLinSolNewEmpty(k->context);
  if (k->matrix == NULL || k->linear == NULL) return 0;
  k->matrix->content = k;
  k->matrix->ops->getid = matrix_id;
  k->matrix->ops->zero = matrix_zero;
  k->linear->content = k;
  k->linear->ops->gettype = linear_type;
  k->linear->ops->setup = linear_setup;
  k->linear->ops->solve = linear_solve;
  return 1;
}

static N_Vector kinsol_new_vector(const dvi__kinsol *k)
{
  N_Vector made = N_VNew_Serial(k->unknowns, k->context);
  if (made != NULL) dvi__vector_use_own_operations(made);
  return made;
}

static int kinsol_create_vectors(dvi__kinsol *k)
{
  k->x = kinsol_new_vector(k);
  k->x_scale = kinsol_new_vector(k);
  k->r_scale = kinsol_new_vector(k);
  k->row_scale = DVI_NEW(double, k->unknowns);
  if (k->x_scale != NULL) dvi__vector_is_constant(k->x_scale);
  if (k->own > 0) k->known = DVI_NEW(double, k->unknowns);
  return k->x != NULL && k->x_scale != NULL && k->r_scale != NULL && k->row_scale != NULL &&
         (k->own == 0 || k->known != NULL);
}

/* KINSOL accepts a guess whose scaled norm is a hundredth of its tolerance. Roundings of the rows
 * make 1e-15 to 1e-13 of the unknowns, and more at higher degrees. */
static const double tolerance = 1e-13, tolerance_of_guess = 1e-10;

static int kinsol_configure(dvi__kinsol *k)
{
  void *m = k->memory = KINCreate(k->context);
  return m != NULL && DVI__SUNDIALS_SILENCE(KINSetErrHandlerFn, m) == 0 &&
         KINInit(m, kinsol_residual, k->x) == 0 && KINSetUserData(m, k) == 0 &&
         KINSetLinearSolver(m, k->linear, k->matrix) == 0 && KINSetJacFn(m, kinsol_jacobian) == 0 &&
         KINSetFuncNormTol(m, k->own ? tolerance_of_guess : tolerance) == 0 &&
         KINSetScaledStepTol(m, 1e-15) == 0 && KINSetMaxSetupCalls(m, 1) == 0 &&
         KINSetMaxNewtonStep(m, 1e3) == 0 && KINSetNumMaxIters(m, 100) == 0;
}

static dvi_status kinsol_create(dvi__solver *solver, int own, dvi__kinsol **kinsol)
{
  DVI_TRY(dvi__sundials_load());
  dvi__kinsol *k = *kinsol = DVI_NEW(dvi__kinsol, 1);
  if (k == NULL) return dvi__fail(DVI_NO_MEMORY, "KINSOL: no memory");
  k->solver = solver;
  k->own = own;
  k->unknowns = own ? own * solver->equations.own_unknowns : solver->equations.unknowns;
  if (dvi__sundials->new_context(&k->context) == 0 && kinsol_create_vectors(k) &&
      kinsol_create_matrix(k) && kinsol_configure(k)) {
    N_VConst(0, k->x);
    N_VConst(1, k->x_scale);
    return DVI_OK;
  }
  dvi__kinsol_destroy(kinsol);
  /* Only memory can be missing, because all arguments are valid. */
  return dvi__fail(DVI_NO_MEMORY, "KINSOL: no memory for %d unknowns",
                   own ? own * solver->equations.own_unknowns : solver->equations.unknowns);
}

dvi_status dvi__kinsol_prepare(dvi__solver *s, int own, dvi__kinsol **kinsol)
{
  if (*kinsol != NULL) return DVI_OK;
  DVI_TRY(kinsol_create(s, own, kinsol));
  s->counters->preparations++;
  return DVI_OK;
}

void dvi__kinsol_destroy(dvi__kinsol **kinsol)
{
  dvi__kinsol *k = *kinsol;
  if (k == NULL) return;
  KINFree(&k->memory);
  if (k->linear != NULL) SUNLinSolFreeEmpty(k->linear);
  if (k->matrix != NULL) SUNMatFreeEmpty(k->matrix);
  if (k->x != NULL) N_VDestroy(k->x);
  if (k->x_scale != NULL) N_VDestroy(k->x_scale);
  if (k->r_scale != NULL) N_VDestroy(k->r_scale);
  if (k->context != NULL) SUNContext_Free(&k->context);
  dvi__release(k->row_scale);
  dvi__release(k->known);
  dvi__release(k);
  *kinsol = NULL;
}

/* ---- solve ---- */

/* Set the scales of the rows to 1 / (row * whole). Rows of one coordinate have the same scale, and
 * a division costs more than all else here. */
static int invert_rows(dvi__kinsol *k)
{
  double *r_scale = NV_DATA_S(k->r_scale), row = 0, inverse = 0;
  int usable = 1;
  for (int i = 0; i < k->unknowns; i++) {
    if (k->row_scale[i] != row) {
      row = k->row_scale[i];
      inverse = 1 / (row * k->whole);
      usable &= inverse > 0 && inverse <= DBL_MAX;
    }
    r_scale[i] = inverse;
  }
  return usable;
}

/* Give the power of two just above, where that is a number. */
static double power_above(double x)
{
  int exponent;
  (void)frexp(x, &exponent);
  return exponent < DBL_MAX_EXP ? ldexp(1.0, exponent) : x;
}

/* Give the size of a solution to a factor of 2, which seldom changes from the last one. Zeros have
 * the size of the state. */
static double size_to_a_power(double last, double whole, double size)
{
  if (whole == 0) whole = size > 0 ? size : 1;
  return whole >= 0.5 * last && whole < last ? last : power_above(whole);
}

/* KINSOL would call this a fault of its caller, but a smaller step may have a finite path. */
static dvi_status fail_to_scale(double whole)
{
  return dvi__fail(DVI_NOT_FINITE,
                   "the guess of the path is too large or too small to be scaled (size %g)", whole);
}

/* Set the scales of own variables, whose residual is a change of a variable. The row scales, which
 * they do not need, hold the size of each solution. */
static dvi_status scale_solution(dvi__kinsol *k, int i, double whole, double size)
{
  const int numbers = k->solver->equations.own_unknowns;
  double *restrict scale = NV_DATA_S(k->x_scale) + i * numbers;
  whole = size_to_a_power(k->row_scale[i], whole, size);
  if (whole == k->row_scale[i]) return DVI_OK;
  k->row_scale[i] = 1 / whole > 0 && 1 / whole <= DBL_MAX ? whole : 0;
  if (k->row_scale[i] == 0) return fail_to_scale(whole);
  for (int j = 0; j < numbers; j++) scale[j] = 1 / whole;
  return DVI_OK;
}

/* Set the scales of both norms in units of the unknowns' size. A residual row over row_scale is a
 * change of an unknown. */
static dvi_status set_scales(dvi__kinsol *k, double size, const double *x)
{
  double whole = k->own ? k->solver->whole : dvi__largest((size_t)k->unknowns, x);
  int unchanged = 0;
  if (k->own) return scale_solution(k, 0, whole, size);
  whole = size_to_a_power(k->whole, whole, size);
  DVI_TRY(k->solver->equations.row_scale(k->solver->equations.of, k->row_scale, &unchanged));
  if (unchanged && whole == k->whole) return DVI_OK;
  k->whole = whole;
  N_VConst(1 / whole, k->x_scale);
  if (invert_rows(k) && 1 / whole > 0 && 1 / whole <= DBL_MAX) return DVI_OK;
  k->whole = 0;
  return fail_to_scale(whole);
}

dvi_status dvi__kinsol_certify(dvi__kinsol *k, double size, const double *x, int *certified,
                               dvi__solve_report *report)
{
  DVI_TRY(set_scales(k, size, x));
  memcpy(NV_DATA_S(k->x), x, (size_t)k->unknowns * sizeof(double));
  k->fatal = DVI_OK;
  if (!k->own) (void)KINSetFuncNormTol(k->memory, tolerance_of_guess);
  *certified = KINSol(k->memory, k->x, KIN_LINESEARCH, k->x_scale,
                      k->own ? k->x_scale : k->r_scale) == KIN_INITIAL_GUESS_OK;
  if (!k->own) (void)KINSetFuncNormTol(k->memory, tolerance);
  (void)KINGetFuncNorm(k->memory, &report->residual);
  return k->fatal;
}

double *dvi__kinsol_point(dvi__kinsol *k, int i)
{
  return NV_DATA_S(k->x) + i * k->solver->equations.own_unknowns;
}

dvi_status dvi__kinsol_note(dvi__kinsol *k, int i, const double *next, double whole, double size)
{
  const int numbers = k->solver->equations.own_unknowns;
  const double *restrict point = dvi__kinsol_point(k, i);
  double *restrict residual = k->known + i * numbers;
  for (int j = 0; j < numbers; j++) residual[j] = point[j] - next[j];
  return scale_solution(k, i, whole, size);
}

int dvi__kinsol_certify_known(dvi__kinsol *k, int count)
{
  const size_t first = (size_t)count * (size_t)k->solver->equations.own_unknowns;
  memset(k->known + first, 0, ((size_t)k->unknowns - first) * sizeof(double));
  k->is_known = 1;
  const int flag = KINSol(k->memory, k->x, KIN_LINESEARCH, k->x_scale, k->x_scale);
  k->is_known = 0;
  return flag == KIN_INITIAL_GUESS_OK;
}

dvi_status dvi__kinsol_solve(dvi__kinsol *k, double size, double *x, dvi__solve_report *report)
{
  const size_t bytes = (size_t)k->unknowns * sizeof(double);
  long iterations = 0;
  DVI_TRY(set_scales(k, size, x));
  memcpy(NV_DATA_S(k->x), x, bytes);
  k->fatal = k->last = DVI_OK;
  const int flag = KINSol(k->memory, k->x, KIN_LINESEARCH, k->x_scale, k->r_scale);
  (void)KINGetNumNonlinSolvIters(k->memory, &iterations);
  (void)KINGetFuncNorm(k->memory, &report->residual);
  report->iterations = (int)iterations;
  if (k->fatal < 0) return k->fatal;
  memcpy(x, NV_DATA_S(k->x), bytes);
  if (flag == KIN_SUCCESS || flag == KIN_INITIAL_GUESS_OK) return DVI_OK;
  if (flag == KIN_ILL_INPUT && k->last > 0)
    return k->last; /* KINSOL takes a first residual that fails for its caller's fault */
  if (flag == KIN_MEM_NULL || flag == KIN_ILL_INPUT || flag == KIN_NO_MALLOC ||
      flag == KIN_MEM_FAIL)
    return dvi__fail(DVI_SOLVER_FAILED, "KINSOL refused the step's equations (flag %d)", flag);
  return dvi__fail(DVI_NOT_CONVERGED,
                   "KINSOL with line search found no solution (flag %d, scaled residual %.1e)",
                   flag, report->residual);
}
