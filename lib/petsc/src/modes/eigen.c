#include "eigen.h"

#include <math.h>
#include <slepceps.h>

#include "core/status.h"
#include "owners.h"

/* Where solutions are iterated, vectors are as good as these, and eigenvalues as their squares. */
static const double tolerance_of_factors = 1e-12, tolerance_of_iterations = 1e-8,
                    tolerance_of_estimates = 1e-2;
enum { RESTARTS = 1000 };

/* ---- the product ---- */

/* z = M^(1/2) (K - shift M)^-1 M^(1/2) y, without gradients. */
static PetscErrorCode multiply(Mat product, Vec y, Vec z)
{
  const dvi__pencil_of_all *p;
  PetscCall(MatShellGetContext(product, &p));
  PetscCall(VecPointwiseMult(p->room[0], p->root, y));
  PetscCall(dvi__inverse_apply(p->inverse, p->room[0], p->room[1]));
  if (p->gradients != NULL) {
    PetscCall(VecPointwiseMult(p->room[0], p->mass, p->room[1]));
    PetscCall(dvi__gradients_project(p->gradients, p->room[0], p->room[1]));
  }
  return VecPointwiseMult(z, p->root, p->room[1]);
}

static PetscErrorCode create_product(const dvi__pencil_of_all *pencil, Mat *product)
{
  PetscInt own, total;
  PetscCall(VecGetLocalSize(pencil->mass, &own));
  PetscCall(VecGetSize(pencil->mass, &total));
  PetscCall(MatCreateShell(pencil->comm, own, own, total, total, (void *)pencil, product));
  PetscCall(MatShellSetOperation(*product, MATOP_MULT, (void (*)(void))multiply));
  return MatSetOption(*product, MAT_SYMMETRIC, PETSC_TRUE);
}

/* ---- the iteration ---- */

/* What is looked for, beside the pairs that are found. */
typedef struct search {
  const dvi__pencil_of_all *pencil;
  const dvi__pairs *found;
  PetscInt count;
  double tolerance;
} search;

static PetscErrorCode set_up(const search *s, EPS eps)
{
  Vec start = s->pencil->start;
  PetscInt total;
  PetscCall(VecGetSize(start, &total));
  const PetscInt wished = s->count < 8 ? 20 : 2 * s->count + 4,
                 directions = PetscMin(wished, total);
  PetscCall(EPSSetProblemType(eps, EPS_HEP));
  PetscCall(EPSSetType(eps, EPSKRYLOVSCHUR));
  PetscCall(EPSSetWhichEigenpairs(eps, EPS_LARGEST_MAGNITUDE));
  PetscCall(EPSSetDimensions(eps, s->count, directions, directions));
  PetscCall(EPSSetTolerances(eps, s->tolerance, RESTARTS));
  PetscCall(EPSSetInitialSpace(eps, 1, &start));
  if (s->found->count > 0) PetscCall(EPSSetDeflationSpace(eps, s->found->count, s->found->vector));
  return 0;
}

static dvi_status explain(const dvi__pencil_of_all *pencil, PetscErrorCode code)
{
  if (code != PETSC_ERR_CONV_FAILED) return dvi__check_petsc(code);
  if (!pencil->inverse->is_iterated)
    return dvi__fail(DVI_SINGULAR, "modes: the shift %g is an eigenvalue", pencil->shift);
  return dvi__fail(DVI_NOT_CONVERGED, "modes: conjugate gradients (%s) did not converge",
                   pencil->inverse->solver);
}

static dvi_status solve(const search *s, EPS eps)
{
  PetscInt converged = 0;
  DVI_TRY(dvi__check_petsc(set_up(s, eps)));
  DVI_TRY(explain(s->pencil, EPSSolve(eps)));
  DVI_TRY(dvi__check_petsc(EPSGetConverged(eps, &converged)));
  if (converged >= s->count) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "modes: %lld of %lld eigenvalues converged in %d restarts of Krylov and "
                   "Schur's method",
                   (long long)converged, (long long)s->count, RESTARTS);
}

/* Start SLEPc, which ends with PETSc. */
static PetscErrorCode start_slepc(void)
{
  PetscBool is_started;
  PetscCall(SlepcInitialized(&is_started));
  if (is_started) return 0;
  PetscCall(SlepcInitializeNoArguments());
  return PetscRegisterFinalize(SlepcFinalize);
}

/* Search, for EPSDestroy in any case. */
static dvi_status run(const search *s, EPS *eps)
{
  Mat product = NULL;
  *eps = NULL;
  dvi_status status = dvi__check_petsc(start_slepc());
  if (status == DVI_OK) status = dvi__check_petsc(create_product(s->pencil, &product));
  if (status == DVI_OK) status = dvi__check_petsc(EPSCreate(s->pencil->comm, eps));
  if (status == DVI_OK) status = dvi__check_petsc(EPSSetOperators(*eps, product, NULL));
  if (status == DVI_OK) status = solve(s, *eps);
  (void)MatDestroy(&product);
  return status;
}

/* ---- results ---- */

/* Give Rayleigh's quotient of y, whose error is the square of that of the vector, and what is left
 * of the equation. */
static PetscErrorCode measure(const dvi__pencil_of_all *p, Vec y, double *value, double *residual)
{
  PetscCall(VecPointwiseDivide(p->room[0], y, p->root));
  PetscCall(MatMult(p->K, p->room[0], p->room[1]));
  PetscCall(VecPointwiseDivide(p->room[1], p->room[1], p->root));
  PetscCall(VecDot(y, p->room[1], value));
  PetscCall(VecAXPY(p->room[1], -*value, y));
  return VecNorm(p->room[1], NORM_2, residual);
}

static PetscErrorCode take_pairs(const dvi__pencil_of_all *pencil, EPS eps, PetscInt count,
                                 dvi__pairs *pairs)
{
  for (PetscInt i = 0; i < count; i++) {
    Vec *y = pairs->vector + pairs->count;
    PetscCall(VecDuplicate(pencil->start, y));
    pairs->count++;
    PetscCall(EPSGetEigenvector(eps, i, *y, NULL));
    PetscCall(VecNormalize(*y, NULL));
    PetscCall(
        measure(pencil, *y, pairs->value + pairs->count - 1, pairs->residual + pairs->count - 1));
  }
  return 0;
}

dvi_status dvi__find_pairs(const dvi__pencil_of_all *pencil, PetscInt count, dvi__pairs *pairs)
{
  EPS eps;
  const search s = {.pencil = pencil,
                    .found = pairs,
                    .count = count,
                    .tolerance = pencil->inverse->is_iterated ? tolerance_of_iterations
                                                              : tolerance_of_factors};
  dvi_status status = run(&s, &eps);
  if (status == DVI_OK) status = dvi__check_petsc(take_pairs(pencil, eps, count, pairs));
  (void)EPSDestroy(&eps);
  return status;
}

dvi_status dvi__estimate_next(const dvi__pencil_of_all *pencil, const dvi__pairs *pairs,
                              double *distance)
{
  EPS eps;
  PetscScalar inverse = 0;
  const search s = {
      .pencil = pencil, .found = pairs, .count = 1, .tolerance = tolerance_of_estimates};
  dvi_status status = run(&s, &eps);
  if (status == DVI_OK) status = dvi__check_petsc(EPSGetEigenvalue(eps, 0, &inverse, NULL));
  *distance = 1 / fabs(inverse);
  (void)EPSDestroy(&eps);
  return status;
}
