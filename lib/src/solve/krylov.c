/* KINSOL with line search and GMRES, without a matrix.
 *
 * The line search leads near the solution. Full steps of Newton's method from there, which no test
 * of the residual stops, make the error a rounding. All tolerances are set here, and all memory is
 * taken at creation. */
#include "solve/krylov.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"
#include "solve/sundials.h"
#include "solve/vector.h"

/* Directions that GMRES keeps at least and at most, numbers in those beyond the least, restarts,
 * steps with line search, and full steps. */
enum { LEAST = 40, MOST = 400, NUMBERS = 2000000, RESTARTS = 20, SEARCHES = 100, FULL_STEPS = 10 };

/* Part of a residual that GMRES leaves, and sizes of residuals where the search ends, where full
 * steps begin, and where residuals are roundings. */
static const double left = 1e-5, found = 1e-8, near = 1e-3, rounding = 1e-12;

struct dvi__krylov {
  dvi__smooth_equations equations;
  SUNContext context;
  void *memory;
  N_Vector x, scale, f;
  SUNLinearSolver linear;
};

/* ---- callbacks ---- */

static int is_bad(const dvi__krylov *k, N_Vector x)
{
  return dvi__first_not_finite((size_t)k->equations.unknowns, N_VGetArrayPointer(x)) >= 0;
}

static int krylov_residual(N_Vector x, N_Vector f, void *user)
{
  const dvi__krylov *k = user;
  k->equations.residual(k->equations.of, N_VGetArrayPointer(x), N_VGetArrayPointer(f));
  return is_bad(k, f);
}

static int krylov_times(N_Vector v, N_Vector Jv, N_Vector x, sunbooleantype *is_new, void *user)
{
  const dvi__krylov *k = user;
  if (*is_new) k->equations.stand_at(k->equations.of, N_VGetArrayPointer(x));
  *is_new = 0;
  k->equations.times(k->equations.of, N_VGetArrayPointer(v), N_VGetArrayPointer(Jv));
  return is_bad(k, Jv);
}

/* ---- creation ---- */

static N_Vector make_vector(const dvi__krylov *k)
{
  N_Vector made = N_VNew_Serial(k->equations.unknowns, k->context);
  if (made != NULL) dvi__vector_use_own_operations(made);
  return made;
}

static int make_vectors(dvi__krylov *k)
{
  k->x = make_vector(k);
  k->scale = make_vector(k);
  k->f = make_vector(k);
  return k->x != NULL && k->scale != NULL && k->f != NULL;
}

static int smaller(int a, int b)
{
  return a < b ? a : b;
}

/* As many directions as there are unknowns leave no restarts, which may stagnate. */
static int directions_of(int unknowns)
{
  const int affordable = smaller(MOST, NUMBERS / unknowns);
  return smaller(unknowns, affordable > LEAST ? affordable : LEAST);
}

static int make_linear(dvi__krylov *k)
{
  const int directions = directions_of(k->equations.unknowns);
  k->linear = SUNLinSol_SPGMR(k->x, SUN_PREC_NONE, directions, k->context);
  return k->linear != NULL && SUNLinSol_SPGMRSetMaxRestarts(k->linear, RESTARTS) == 0;
}

static int configure(dvi__krylov *k)
{
  void *m = k->memory = KINCreate(k->context);
  return m != NULL && DVI__SUNDIALS_SILENCE(KINSetErrHandlerFn, m) == 0 &&
         KINInit(m, krylov_residual, k->x) == 0 && KINSetUserData(m, k) == 0 &&
         KINSetLinearSolver(m, k->linear, NULL) == 0 && KINSetJacTimesVecFn(m, krylov_times) == 0 &&
         KINSetEtaForm(m, KIN_ETACONSTANT) == 0 && KINSetEtaConstValue(m, left) == 0 &&
         KINSetNoMinEps(m, 1) == 0 && KINSetScaledStepTol(m, 1e-17) == 0 &&
         KINSetMaxNewtonStep(m, 1e3 * sqrt(k->equations.unknowns)) == 0 &&
         SUNLinSolInitialize(k->linear) == 0;
}

dvi_status dvi__krylov_create(const dvi__smooth_equations *equations, dvi__krylov **made)
{
  *made = NULL;
  DVI_TRY(dvi__sundials_load());
  dvi__krylov *k = *made = DVI_NEW(dvi__krylov, 1);
  if (k == NULL) return dvi__fail(DVI_NO_MEMORY, "KINSOL: no memory");
  k->equations = *equations;
  if (dvi__sundials->new_context(&k->context) == 0 && make_vectors(k) && make_linear(k) &&
      configure(k))
    return DVI_OK;
  dvi__krylov_destroy(made);
  return dvi__fail(DVI_NO_MEMORY, "KINSOL: no memory for %d directions of %d unknowns",
                   directions_of(equations->unknowns), equations->unknowns);
}

void dvi__krylov_destroy(dvi__krylov **krylov)
{
  dvi__krylov *k = *krylov;
  if (k == NULL) return;
  KINFree(&k->memory);
  if (k->linear != NULL) (void)SUNLinSolFree(k->linear);
  if (k->x != NULL) N_VDestroy(k->x);
  if (k->scale != NULL) N_VDestroy(k->scale);
  if (k->f != NULL) N_VDestroy(k->f);
  if (k->context != NULL) SUNContext_Free(&k->context);
  dvi__release(k);
  *krylov = NULL;
}

/* ---- solution ---- */

/* Search for a solution, and return the largest residual that is left beside the size. What KINSOL
 * says of its success does not matter. */
static double search(dvi__krylov *k, int strategy, double tolerance, int steps, double size)
{
  double *x = N_VGetArrayPointer(k->x), *f = N_VGetArrayPointer(k->f);
  (void)KINSetFuncNormTol(k->memory, tolerance);
  (void)KINSetNumMaxIters(k->memory, steps);
  (void)KINSol(k->memory, k->x, strategy, k->scale, k->scale);
  k->equations.residual(k->equations.of, x, f);
  return dvi__largest((size_t)k->equations.unknowns, f) / size;
}

dvi_status dvi__krylov_solve(dvi__krylov *k, double size, double *x, double *residual)
{
  const size_t bytes = (size_t)k->equations.unknowns * sizeof *x;
  double before = INFINITY, now;
  memcpy(N_VGetArrayPointer(k->x), x, bytes);
  N_VConst(1 / size, k->scale);
  now = search(k, KIN_LINESEARCH, found, SEARCHES, size);
  for (int i = 0; i < FULL_STEPS && now < near && (now > rounding || now < 0.5 * before); i++) {
    before = now;
    now = search(k, KIN_NONE, 1e-300, 1, size);
  }
  memcpy(x, N_VGetArrayPointer(k->x), bytes);
  *residual = now;
  return now <= rounding ? DVI_OK : DVI_NOT_CONVERGED;
}
