#include "solver.h"

#include <float.h>
#include <math.h>
#include <petscsnes.h>

#include "core/memory.h"
#include "core/status.h"
#include "edges.h"
#include "multigrid.h"
#include "owners.h"
#include "pair.h"
#include "scale.h"
#include "traffic.h"
#include "vector.h"

enum { CORRECTIONS = 25, ITERATIONS = 500 };

/* What conjugate gradients, or minimal residuals, leave of a correction, in the norm of its energy,
 * and of the first one. Corrections end where the next one would be a rounding, or where they do
 * not shrink any more, but are this small a part of the unknowns. */
static const double part_left = 1e-9, roundoff = 1e-17, settled = 1e-10;

typedef struct solver {
  dvi__elliptic equations;
  dvi__world *world;
  PetscInt *place; /* [unknowns] columns of `A` */
  dvi__operator A;
  dvi__multigrid *multigrid; /* of vertices */
  dvi__edges *edges;         /* or of edges */
  dvi__pair pair;            /* of equations of pairs */
  dvi__scale scale;
  int numbers;           /* of each unknown, 1 or 2 */
  double *x, *r;         /* [numbers*unknowns] */
  PetscScalar *diagonal; /* [numbers*own] of the Jacobian beside A */
  SNES snes;
  Mat jacobian;
  Vec solution, residual;
  PetscInt *members;   /* [components] unknowns of all processes */
  double first, start; /* energy norms of the first residual, and of the last correction's */
  double size;         /* norm of the unknowns */
  double last, before; /* norms of corrections */
  dvi__traffic mark;   /* before an iteration */
  int64_t iterations;
  dvi_status status; /* of the functions */
} solver;

/* ---- unknowns of the share ---- */

/* Set s->x to the unknowns, those of others, too. */
static PetscErrorCode spread(solver *s, Vec x)
{
  const PetscScalar *own;
  PetscCall(VecGetArrayRead(x, &own));
  for (int k = 0; k < s->numbers; k++) {
    double *const here = s->x + k * s->equations.unknowns;
    PetscCall(PetscArraycpy(s->A.x, own + k * s->A.own, (size_t)s->A.own));
    PetscCall(dvi__operator_refresh(&s->A, MPIU_SCALAR, s->A.x));
    for (int64_t i = 0; i < s->equations.unknowns; i++) here[i] = s->A.x[s->place[i]];
  }
  return VecRestoreArrayRead(x, &own);
}

/* Set own numbers [numbers*own] to those of an array [numbers*unknowns]. */
static void copy_own(const solver *s, const double *values, PetscScalar *own)
{
  for (int k = 0; k < s->numbers; k++)
    for (int64_t i = 0; i < s->equations.unknowns; i++)
      if (s->place[i] < s->A.own)
        own[k * s->A.own + s->place[i]] = values[k * s->equations.unknowns + i];
}

static PetscErrorCode take_own(const solver *s, const double *values, Vec x)
{
  PetscScalar *own;
  PetscCall(VecGetArray(x, &own));
  copy_own(s, values, own);
  return VecRestoreArray(x, &own);
}

/* ---- functions of SNES ---- */

/* After a failure of one process the iteration ends on all of them. PETSc looks for one of the
 * Jacobian in builds for debugging alone, so that it ends here, too. */
static PetscErrorCode evaluate(SNES snes, Vec x, Vec r, void *user)
{
  solver *s = user;
  PetscCall(spread(s, x));
  if (s->status == DVI_OK)
    s->status = dvi__world_agree(s->world, s->equations.residual(s->equations.of, s->x, s->r));
  if (s->status == DVI_OK) return take_own(s, s->r, r);
  PetscCall(VecSet(r, 0));
  return SNESSetFunctionDomainError(snes);
}

static PetscErrorCode linearize(SNES snes, Vec x, Mat jacobian, Mat of_multigrid, void *user)
{
  solver *s = user;
  const dvi__elliptic *e = &s->equations;
  (void)jacobian, (void)of_multigrid;
  if (e->diagonal == NULL) return 0;
  PetscCall(spread(s, x));
  s->status = dvi__world_agree(s->world, e->diagonal(e->of, s->x, s->r));
  if (s->status != DVI_OK) return SNESSetJacobianDomainError(snes);
  copy_own(s, s->r, s->diagonal);
  return 0;
}

static PetscErrorCode multiply_one(const solver *s, const PetscScalar *in, PetscScalar *out)
{
  PetscCall(dvi__operator_multiply(&s->A, in, out));
  for (PetscInt i = 0; i < s->A.own && s->equations.diagonal != NULL; i++)
    out[i] += s->diagonal[i] * in[i];
  return 0;
}

static PetscErrorCode multiply(Mat jacobian, Vec x, Vec y)
{
  solver *s;
  const PetscScalar *in;
  PetscScalar *out;
  PetscCall(MatShellGetContext(jacobian, &s));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArray(y, &out));
  if (s->numbers == 1)
    PetscCall(multiply_one(s, in, out));
  else
    PetscCall(dvi__pair_multiply(&s->pair, s->diagonal, in, out));
  PetscCall(VecRestoreArray(y, &out));
  return VecRestoreArrayRead(x, &in);
}

static PetscErrorCode create_vectors(Mat jacobian, Vec *right, Vec *left)
{
  solver *s;
  PetscCall(MatShellGetContext(jacobian, &s));
  const PetscInt own = s->numbers * s->A.own;
  if (right != NULL) PetscCall(dvi__vector_create(s->A.comm, own, right));
  return left != NULL ? dvi__vector_create(s->A.comm, own, left) : 0;
}

/* Subtract the mean of each component that the kernel has. */
static PetscErrorCode subtract_means(MatNullSpace kernel, Vec x, void *user)
{
  const solver *s = user;
  const dvi__elliptic *e = &s->equations;
  (void)kernel;
  for (int64_t c = 0; c < e->components; c++) {
    dvi__accumulator sum = {.terms = 0};
    PetscScalar *own, mean;
    PetscCall(VecGetArray(x, &own));
    for (int64_t i = 0; i < e->unknowns; i++)
      if (e->component[i] == c && s->place[i] < s->A.own) dvi__accumulate(&sum, own[s->place[i]]);
    PetscCall(dvi__sum_of_world(s->A.comm, &sum, &mean));
    mean /= (double)s->members[c];
    for (int64_t i = 0; i < e->unknowns; i++)
      if (e->component[i] == c && s->place[i] < s->A.own) own[s->place[i]] -= mean;
    PetscCall(VecRestoreArray(x, &own));
  }
  return 0;
}

/* ---- ends ---- */

/* Note what an iteration of conjugate gradients has received. */
static void note_iteration(solver *s, PetscInt iteration)
{
  const dvi__traffic now = dvi__traffic_so_far();
  if (iteration > 0) s->world->iteration = dvi__traffic_since(now, s->mark);
  s->mark = now;
}

static PetscErrorCode end_gradients(KSP ksp, PetscInt iteration, PetscReal norm,
                                    KSPConvergedReason *reason, void *user)
{
  solver *s = user;
  note_iteration(s, iteration);
  *reason = KSP_CONVERGED_ITERATING;
  norm *= s->scale.factor;
  if (iteration == 0) s->start = norm;
  if (s->first == 0) s->first = norm;
  if (!isfinite(norm))
    *reason = KSP_DIVERGED_NANORINF;
  else if (norm <= fmax(part_left * s->start, roundoff * s->first))
    *reason = KSP_CONVERGED_RTOL;
  else if (iteration >= ITERATIONS)
    *reason = KSP_DIVERGED_ITS;
  (void)ksp;
  return 0;
}

/* Set the norms of what Newton's method has come to. PETSc's line search would add up squares of
 * each process by the BLAS, and the number of corrections could depend on the division. */
static PetscErrorCode find_norms(solver *s, PetscReal *residual)
{
  Vec x, correction;
  PetscCall(SNESGetSolution(s->snes, &x));
  PetscCall(SNESGetSolutionUpdate(s->snes, &correction));
  s->before = s->last;
  PetscCall(VecNorm(x, NORM_2, &s->size));
  PetscCall(VecNorm(correction, NORM_2, &s->last));
  return VecNorm(s->residual, NORM_2, residual);
}

/* Newton's corrections shrink by the square of what they shrank by before, until conjugate
 * gradients leave more. The norms are PETSc's, of which the last one is right before the first
 * correction. */
static PetscErrorCode end_newton(SNES snes, PetscInt iteration, PetscReal size,
                                 PetscReal correction, PetscReal residual,
                                 SNESConvergedReason *reason, void *user)
{
  solver *s = user;
  (void)snes, (void)size, (void)correction;
  if (iteration > 0) PetscCall(find_norms(s, &residual));
  *reason = SNES_CONVERGED_ITERATING;
  if (!isfinite(residual) || !isfinite(s->size)) {
    *reason = SNES_DIVERGED_FNORM_NAN;
    return 0;
  }
  if (residual <= s->equations.rounding) *reason = SNES_CONVERGED_FNORM_ABS;
  if (iteration == 0) return 0;
  const double shrunk = iteration > 1 ? fmax(s->last / s->before, part_left) : 1;
  if (shrunk * s->last <= DBL_EPSILON * s->size || (shrunk > 0.5 && s->last <= settled * s->size))
    *reason = SNES_CONVERGED_SNORM_RELATIVE;
  else if (residual != 0 && iteration == CORRECTIONS)
    *reason = SNES_DIVERGED_MAX_IT;
  return 0;
}

/* ---- create ---- */

static PetscErrorCode make_jacobian(solver *s)
{
  const PetscInt own = s->numbers * s->A.own;
  PetscCall(MatCreateShell(s->A.comm, own, own, PETSC_DETERMINE, PETSC_DETERMINE, s, &s->jacobian));
  PetscCall(MatShellSetOperation(s->jacobian, MATOP_MULT, (void (*)(void))multiply));
  PetscCall(MatShellSetOperation(s->jacobian, MATOP_CREATE_VECS, (void (*)(void))create_vectors));
  return MatSetOption(s->jacobian, MAT_SYMMETRIC, PETSC_TRUE);
}

/* Let corrections have no part in the kernel. */
static PetscErrorCode make_kernel(solver *s)
{
  const dvi__elliptic *e = &s->equations;
  MatNullSpace kernel;
  if (e->components == 0) return 0;
  PetscCall(PetscCalloc1((size_t)e->components, &s->members));
  for (int64_t i = 0; i < e->unknowns; i++)
    if (e->component[i] >= 0 && s->place[i] < s->A.own) s->members[e->component[i]]++;
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, s->members, (int)e->components, MPIU_INT, MPI_SUM, s->A.comm));
  PetscCall(MatNullSpaceCreate(s->A.comm, PETSC_FALSE, 0, NULL, &kernel));
  PetscCall(MatNullSpaceSetFunction(kernel, subtract_means, s));
  PetscCall(MatSetNullSpace(s->jacobian, kernel));
  return MatNullSpaceDestroy(&kernel);
}

static PetscErrorCode make_gradients(solver *s)
{
  KSP ksp;
  PC pc;
  PetscCall(SNESGetKSP(s->snes, &ksp));
  PetscCall(KSPSetType(ksp, s->numbers == 1 ? KSPCG : KSPMINRES));
  PetscCall(KSPSetNormType(ksp, s->numbers == 1 ? KSP_NORM_NATURAL : KSP_NORM_PRECONDITIONED));
  PetscCall(KSPSetConvergenceTest(ksp, end_gradients, s, NULL));
  PetscCall(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, ITERATIONS));
  PetscCall(KSPSetReusePreconditioner(ksp, PETSC_TRUE));
  PetscCall(dvi__scale_use(&s->scale, ksp));
  PetscCall(KSPGetPC(ksp, &pc));
  if (s->numbers == 2) return dvi__pair_use(&s->pair, ksp);
  return s->edges != NULL ? dvi__edges_use(s->edges, pc) : dvi__multigrid_use(s->multigrid, pc);
}

/* PETSc evaluates no residual behind the last of its iterations, which therefore is one more. */
static PetscErrorCode make_newton(solver *s)
{
  SNESLineSearch search;
  PetscCall(SNESCreate(s->A.comm, &s->snes));
  PetscCall(SNESSetType(s->snes, SNESNEWTONLS));
  PetscCall(SNESGetLineSearch(s->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  PetscCall(SNESLineSearchSetComputeNorms(search, PETSC_FALSE));
  PetscCall(SNESSetFunction(s->snes, s->residual, evaluate, s));
  PetscCall(SNESSetJacobian(s->snes, s->jacobian, s->jacobian, linearize, s));
  PetscCall(SNESSetConvergenceTest(s->snes, end_newton, s, NULL));
  PetscCall(SNESSetTolerances(s->snes, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, CORRECTIONS + 1,
                              10 * CORRECTIONS));
  return make_gradients(s);
}

static PetscErrorCode make(solver *s, const dvi__elliptic *e)
{
  const dvi__unknowns unknowns = {
      .share = e->share, .degree = e->degree, .count = e->unknowns, .cell = e->cell};
  PetscInt own;
  const size_t count = (size_t)e->unknowns, numbers = (size_t)s->numbers;
  PetscCall(PetscMalloc3(count, &s->place, numbers * count, &s->x, numbers * count, &s->r));
  PetscCall(dvi__place_unknowns(s->world->comm, &unknowns, s->place, &own));
  PetscCall(dvi__operator_of_share(s->world->comm, &unknowns, &e->A, &s->A));
  PetscCall(PetscCalloc1(numbers * (size_t)own, &s->diagonal));
  PetscCall(dvi__scale_create(&s->A, &s->scale));
  if (e->degree == 0)
    PetscCall(dvi__multigrid_create(&s->A, &s->multigrid));
  else
    PetscCall(dvi__edges_create(&unknowns, &s->A, e->of_gradients, &s->edges));
  if (s->numbers == 2) PetscCall(dvi__pair_create(&s->A, s->multigrid, e, s->place, &s->pair));
  PetscCall(dvi__vector_create(s->A.comm, s->numbers * own, &s->solution));
  PetscCall(VecDuplicate(s->solution, &s->residual));
  PetscCall(make_jacobian(s));
  PetscCall(make_kernel(s));
  return make_newton(s);
}

static void destroy(void *of)
{
  solver *s = of;
  if (s == NULL) return;
  (void)SNESDestroy(&s->snes);
  (void)dvi__pair_clear(&s->pair);
  (void)dvi__scale_clear(&s->scale);
  (void)dvi__multigrid_destroy(&s->multigrid);
  (void)dvi__edges_destroy(&s->edges);
  (void)MatDestroy(&s->jacobian);
  (void)VecDestroy(&s->solution);
  (void)VecDestroy(&s->residual);
  (void)dvi__operator_clear(&s->A);
  (void)PetscFree(s->members);
  (void)PetscFree(s->diagonal);
  (void)PetscFree3(s->place, s->x, s->r);
  dvi__release(s);
}

static dvi_status create(const dvi__elliptic *equations, void *user, void **made)
{
  solver *s = DVI_NEW(solver, 1);
  *made = s;
  dvi_status status = dvi__world_agree(
      user, s != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a solver"));
  if (status == DVI_OK) {
    s->equations = *equations;
    s->world = user;
    s->numbers = equations->mass != NULL ? 2 : 1;
    (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
    status = dvi__world_agree(user, dvi__check_petsc(make(s, equations)));
    (void)PetscPopErrorHandler();
  }
  if (status == DVI_OK) return DVI_OK;
  destroy(s);
  *made = NULL;
  return status;
}

/* ---- solve ---- */

static const char *explain(const solver *s, SNESConvergedReason reason)
{
  switch (reason) {
  case SNES_DIVERGED_LINEAR_SOLVE:
    return s->numbers == 1
               ? "conjugate gradients did not end, or their matrix is not positive definite"
               : "minimal residuals did not end";
  case SNES_DIVERGED_FNORM_NAN: return "a number is not finite";
  default: return "corrections did not become small";
  }
}

static PetscErrorCode run(solver *s, double *x, dvi__elliptic_report *report, int *is_solved)
{
  SNESConvergedReason reason;
  PetscInt corrections, iterations;
  PetscReal residual;
  s->first = s->last = s->size = 0;
  s->status = DVI_OK;
  PetscCall(take_own(s, x, s->solution));
  PetscCall(SNESSolve(s->snes, NULL, s->solution));
  PetscCall(SNESGetConvergedReason(s->snes, &reason));
  PetscCall(SNESGetIterationNumber(s->snes, &corrections));
  PetscCall(SNESGetLinearSolveIterations(s->snes, &iterations));
  PetscCall(VecNorm(s->residual, NORM_2, &residual));
  s->world->corrections += corrections;
  s->world->iterations += iterations;
  *is_solved = reason > 0;
  *report = (dvi__elliptic_report){.corrections = (int)corrections,
                                   .iterations = iterations,
                                   .residual = residual,
                                   .correction = s->size > 0 ? s->last / s->size : 0,
                                   .why = reason > 0 ? NULL : explain(s, reason)};
  if (reason <= 0) return 0;
  PetscCall(spread(s, s->solution));
  return PetscArraycpy(x, s->x, (size_t)(s->numbers * s->equations.unknowns));
}

static dvi_status solve(void *of, double *x, dvi__elliptic_report *report)
{
  solver *s = of;
  int is_solved = 0;
  (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  const PetscErrorCode code = run(s, x, report, &is_solved);
  (void)PetscPopErrorHandler();
  const dvi_status status = dvi__world_agree(s->world, dvi__check_petsc(code));
  if (status != DVI_OK) return status;
  if (s->status != DVI_OK) return s->status;
  return is_solved ? DVI_OK : DVI_NOT_CONVERGED;
}

const dvi_ranks_solver dvi__solver_of_petsc = {
    .create = create, .solve = solve, .destroy = destroy};
