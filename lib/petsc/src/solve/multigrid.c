#include "multigrid.h"

#include "coarsest.h"
#include "vector.h"

enum {
  LEVELS = 24,
  SMOOTHINGS = 2, /* products of a smoother on the way down, and as many on the way up */
  LAST = 8        /* where the coarsest level is too large for a factor */
};

/* The part of the eigenvalues of D^-1 A that smoothers are for: from a tenth of the bound to it. */
static const double smoothest = 0.1;

typedef struct level {
  dvi__operator *A;
  dvi__coarser coarser; /* what leads to the next level */
  PetscReal bound;
  PetscInt unknowns;
  Mat shown, interpolation;
} level;

struct dvi__multigrid {
  int levels;
  level level[LEVELS]; /* 0 is the finest */
  dvi__coarsest coarsest;
};

int dvi__multigrid_levels(const dvi__multigrid *m)
{
  return m->levels;
}

PetscInt dvi__multigrid_unknowns(const dvi__multigrid *m, int k)
{
  return m->level[k].unknowns;
}

/* ---- interpolation ---- */

static PetscErrorCode apply(const dvi__operator *A, Vec x, Vec y)
{
  const PetscScalar *in;
  PetscScalar *out;
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArray(y, &out));
  PetscCall(dvi__operator_multiply(A, in, out));
  PetscCall(VecRestoreArray(y, &out));
  return VecRestoreArrayRead(x, &in);
}

static PetscErrorCode interpolate(Mat shown, Vec x, Vec y)
{
  const dvi__coarser *c;
  PetscCall(MatShellGetContext(shown, &c));
  return apply(&c->P, x, y);
}

static PetscErrorCode restrict_to_coarser(Mat shown, Vec x, Vec y)
{
  const dvi__coarser *c;
  PetscCall(MatShellGetContext(shown, &c));
  return apply(&c->PT, x, y);
}

/* `right` is of the coarser level. */
static PetscErrorCode create_vectors(Mat shown, Vec *right, Vec *left)
{
  const dvi__coarser *c;
  PetscCall(MatShellGetContext(shown, &c));
  if (right != NULL) PetscCall(dvi__vector_create(c->P.comm, c->P.own, right));
  return left != NULL ? dvi__vector_create(c->P.comm, c->P.rows, left) : 0;
}

static PetscErrorCode show_interpolation(dvi__coarser *c, Mat *shown)
{
  PetscCall(
      MatCreateShell(c->P.comm, c->P.rows, c->P.own, PETSC_DETERMINE, PETSC_DETERMINE, c, shown));
  PetscCall(MatShellSetOperation(*shown, MATOP_MULT, (void (*)(void))interpolate));
  PetscCall(
      MatShellSetOperation(*shown, MATOP_MULT_TRANSPOSE, (void (*)(void))restrict_to_coarser));
  return MatShellSetOperation(*shown, MATOP_CREATE_VECS, (void (*)(void))create_vectors);
}

/* ---- levels ---- */

/* Add coarser levels until one is small enough, or cannot be made coarser. */
static PetscErrorCode add_levels(dvi__multigrid *m)
{
  for (;;) {
    level *l = m->level + m->levels++;
    PetscCall(dvi__operator_show(l->A, &l->shown));
    PetscCall(dvi__bound_of_jacobi(l->A, &l->bound));
    PetscCallMPI(MPI_Allreduce(&l->A->rows, &l->unknowns, 1, MPIU_INT, MPI_SUM, l->A->comm));
    if (l->unknowns <= DVI__COARSEST || m->levels == LEVELS) break;
    PetscCall(dvi__coarsen(l->A, l->bound, &l->coarser));
    if (l->coarser.A.forest == NULL) break;
    PetscCall(show_interpolation(&l->coarser, &l->interpolation));
    l[1].A = &l->coarser.A;
  }
  const level *last = m->level + m->levels - 1;
  return last->unknowns <= DVI__COARSEST ? dvi__coarsest_create(last->A, &m->coarsest) : 0;
}

PetscErrorCode dvi__multigrid_create(dvi__operator *A, dvi__multigrid **made)
{
  PetscCall(PetscNew(made));
  (*made)->level[0].A = A;
  return add_levels(*made);
}

PetscErrorCode dvi__multigrid_destroy(dvi__multigrid **made)
{
  if (*made == NULL) return 0;
  for (int k = 0; k < (*made)->levels; k++) {
    level *l = (*made)->level + k;
    PetscCall(MatDestroy(&l->shown));
    PetscCall(MatDestroy(&l->interpolation));
    PetscCall(dvi__coarser_clear(&l->coarser));
  }
  PetscCall(dvi__coarsest_clear(&(*made)->coarsest));
  return PetscFree(*made);
}

/* ---- a cycle ---- */

PetscErrorCode dvi__set_smoother(Mat shown, PetscReal bound, int products, KSP ksp)
{
  PC pc;
  PetscCall(KSPSetType(ksp, KSPCHEBYSHEV));
  PetscCall(KSPChebyshevSetEigenvalues(ksp, bound, smoothest * bound));
  PetscCall(KSPSetOperators(ksp, shown, shown));
  PetscCall(KSPSetNormType(ksp, KSP_NORM_NONE));
  PetscCall(KSPSetConvergenceTest(ksp, KSPConvergedSkip, NULL, NULL));
  PetscCall(KSPSetTolerances(ksp, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, products));
  PetscCall(KSPGetPC(ksp, &pc));
  return PCSetType(pc, PCJACOBI);
}

static PetscErrorCode solve_coarsest(PC pc, Vec b, Vec x)
{
  dvi__coarsest *c;
  const PetscScalar *in;
  PetscScalar *out;
  PetscCall(PCShellGetContext(pc, &c));
  PetscCall(VecGetArrayRead(b, &in));
  PetscCall(VecGetArray(x, &out));
  PetscCall(dvi__coarsest_solve(c, in, out));
  PetscCall(VecRestoreArray(x, &out));
  return VecRestoreArrayRead(b, &in);
}

static PetscErrorCode set_coarsest(dvi__multigrid *m, KSP ksp)
{
  const level *l = m->level + m->levels - 1;
  PC pc;
  if (l->unknowns > DVI__COARSEST) return dvi__set_smoother(l->shown, l->bound, LAST, ksp);
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPSetOperators(ksp, l->shown, l->shown));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, &m->coarsest));
  return PCShellSetApply(pc, solve_coarsest);
}

PetscErrorCode dvi__multigrid_use(dvi__multigrid *m, PC pc)
{
  KSP ksp;
  PetscCall(PCSetType(pc, PCMG));
  PetscCall(PCMGSetLevels(pc, m->levels, NULL));
  PetscCall(PCMGSetCycleType(pc, PC_MG_CYCLE_W));
  PetscCall(PCMGGetCoarseSolve(pc, &ksp));
  PetscCall(set_coarsest(m, ksp));
  for (int k = 0; k < m->levels - 1; k++) {
    const level *l = m->level + k;
    const int here = m->levels - 1 - k; /* PETSc counts from the coarsest */
    PetscCall(PCMGSetInterpolation(pc, here, l->interpolation));
    PetscCall(PCMGSetRestriction(pc, here, l->interpolation));
    PetscCall(PCMGGetSmoother(pc, here, &ksp));
    PetscCall(dvi__set_smoother(l->shown, l->bound, SMOOTHINGS, ksp));
  }
  return 0;
}
