#include "inverse.h"

#include "core/status.h"
#include "owners.h"

/* As in libdvi's own iterations. */
static const double tolerance_of_solutions = 1e-10;
enum { MOST_ITERATIONS = 10000 };

/* ---- a factor ---- */

#ifdef PETSC_HAVE_MUMPS
static PetscErrorCode use_factor(const dvi__equations *equations, dvi__inverse *inverse)
{
  PC pc;
  inverse->solver = "mumps";
  PetscCall(MatSetOption(equations->matrix, MAT_SYMMETRIC, PETSC_TRUE));
  PetscCall(
      MatSetOption(equations->matrix, MAT_SPD, equations->is_definite ? PETSC_TRUE : PETSC_FALSE));
  PetscCall(KSPSetType(inverse->ksp, KSPPREONLY));
  PetscCall(KSPGetPC(inverse->ksp, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  return PCFactorSetMatSolverType(pc, MATSOLVERMUMPS);
}
#endif

/* ---- multigrid methods ---- */

#ifdef PETSC_HAVE_HYPRE
static PetscErrorCode use_edges(PC pc, const dvi__edges *edges, dvi__inverse *inverse)
{
  inverse->solver = "ams";
  PetscCall(PCSetType(pc, PCHYPRE));
  PetscCall(PCHYPRESetType(pc, "ams"));
  PetscCall(PCHYPRESetDiscreteGradient(pc, edges->d));
  return PCHYPRESetEdgeConstantVectors(pc, edges->constant[0], edges->constant[1],
                                       edges->constant[2]);
}

static PetscErrorCode use_vertices(PC pc, dvi__inverse *inverse)
{
  inverse->solver = "boomeramg";
  PetscCall(PCSetType(pc, PCHYPRE));
  return PCHYPRESetType(pc, "boomeramg");
}
#else
static PetscErrorCode use_vertices(PC pc, dvi__inverse *inverse)
{
  inverse->solver = "gamg";
  return PCSetType(pc, PCGAMG);
}
#endif

static PetscErrorCode use_gradients(const dvi__equations *equations, dvi__inverse *inverse)
{
  PC pc;
  inverse->is_iterated = 1;
  PetscCall(KSPSetType(inverse->ksp, KSPCG));
  PetscCall(KSPSetNormType(inverse->ksp, KSP_NORM_NATURAL));
  PetscCall(KSPSetTolerances(inverse->ksp, tolerance_of_solutions, 1e-300, 1e10, MOST_ITERATIONS));
  PetscCall(KSPGetPC(inverse->ksp, &pc));
#ifdef PETSC_HAVE_HYPRE
  if (equations->edges != NULL) return use_edges(pc, equations->edges, inverse);
#endif
  return use_vertices(pc, inverse);
}

/* ---- choose ---- */

#ifdef PETSC_HAVE_HYPRE
static const int has_edges = 1;
#else
static const int has_edges = 0;
#endif

static int can_iterate(const dvi__equations *equations)
{
  return equations->is_definite && (equations->edges == NULL || has_edges);
}

static dvi_status choose(const dvi__equations *equations, dvi__inverse *inverse)
{
#ifdef PETSC_HAVE_MUMPS
  if (!equations->is_large || !can_iterate(equations))
    return dvi__check_petsc(use_factor(equations, inverse));
#endif
  if (can_iterate(equations)) return dvi__check_petsc(use_gradients(equations, inverse));
  return dvi__fail(DVI_UNSUPPORTED,
                   "modes: this PETSc has no MUMPS, which modes near a shift above "
                   "0 and those of Maxwell's fields need");
}

dvi_status dvi__inverse_create(const dvi__equations *equations, dvi__inverse *inverse)
{
  MPI_Comm comm;
  *inverse = (dvi__inverse){.ksp = NULL};
  DVI_TRY(dvi__check_petsc(PetscObjectGetComm((PetscObject)equations->matrix, &comm)));
  dvi_status status = dvi__check_petsc(KSPCreate(comm, &inverse->ksp));
  if (status == DVI_OK)
    status = dvi__check_petsc(KSPSetOperators(inverse->ksp, equations->matrix, equations->matrix));
  if (status == DVI_OK) status = choose(equations, inverse);
  if (status == DVI_OK) status = dvi__check_petsc(KSPSetUp(inverse->ksp));
  if (status != DVI_OK) dvi__inverse_clear(inverse);
  return status;
}

void dvi__inverse_clear(dvi__inverse *inverse)
{
  (void)KSPDestroy(&inverse->ksp);
}

PetscErrorCode dvi__inverse_apply(dvi__inverse *inverse, Vec b, Vec x)
{
  KSPConvergedReason reason;
  PetscInt iterations;
  PetscCall(KSPSolve(inverse->ksp, b, x));
  PetscCall(KSPGetConvergedReason(inverse->ksp, &reason));
  PetscCall(KSPGetIterationNumber(inverse->ksp, &iterations));
  inverse->solutions++;
  inverse->iterations += inverse->is_iterated ? iterations : 0;
  return reason < 0 ? PETSC_ERR_CONV_FAILED : (PetscErrorCode)0;
}
