#include "edges.h"

#include <math.h>

#include "field/mesh/given.h"
#include "vector.h"

enum {
  SMOOTHINGS = 2,
  ALONE = 8, /* products of the smoother where no vertex is free */
  SPACES = 1 + DVI_MESH_SPACE_MAX
};

/* The functions of free vertices that give gradients (axis -1), or fields along an axis. */
typedef struct space {
  dvi__coarser coarser;
  dvi__multigrid *multigrid;
  Mat shown;
  PC cycle;
  Vec right, left;
} space;

struct dvi__edges {
  dvi__operator *A;
  PetscReal bound;
  PetscInt vertices, own; /* free vertices of all processes, and own ones */
  int spaces;
  space space[SPACES];
  /* The functions of all spaces, one after the other, as a level of multigrid. */
  Mat shown, interpolation, restriction, coarse;
  PetscScalar *part; /* [rows of A] room */
};

/* ---- free vertices ---- */

typedef struct work {
  const dvi__unknowns *edges;
  const double *of_gradients; /* [unknowns] */
  dvi_matrix d;
  dvi__operator vertex; /* without entries */
  PetscInt *place;      /* [vertices] in its columns */
  PetscInt *edge;       /* [unknowns] columns of A */
  PetscInt *number;     /* [columns] PETSc's numbers of free vertices, or -1 */
  const double *period;
} work;

/* A vertex is free if all of its edges are unknowns. Its owner has all of them. */
static PetscErrorCode number_free(work *w, PetscInt *own)
{
  PetscInt first = 0;
  char *is_unknown;
  PetscCall(PetscCalloc1((size_t)w->d.rows, &is_unknown));
  for (int64_t i = 0; i < w->edges->count; i++) is_unknown[w->edges->cell[i]] = 1;
  PetscCall(PetscMalloc1((size_t)w->vertex.columns, &w->number));
  for (PetscInt c = 0; c < w->vertex.columns; c++) w->number[c] = 0;
  for (int64_t e = 0; e < w->d.rows; e++)
    for (int64_t k = 2 * e; k < 2 * e + 2 && !is_unknown[e]; k++)
      w->number[w->place[w->d.column[k]]] = -1;
  *own = 0;
  for (PetscInt c = 0; c < w->vertex.own; c++) *own += w->number[c] == 0;
  PetscCallMPI(MPI_Scan(own, &first, 1, MPIU_INT, MPI_SUM, w->vertex.comm));
  first -= *own;
  for (PetscInt c = 0; c < w->vertex.own; c++)
    if (w->number[c] == 0) w->number[c] = first++;
  PetscCall(PetscFree(is_unknown));
  return dvi__operator_refresh(&w->vertex, MPIU_INT, w->number);
}

/* List the share's vertices as the columns of an operator without entries. */
static PetscErrorCode list_vertices(MPI_Comm comm, work *w)
{
  const int64_t count = dvi_mesh_count(w->edges->share, 0);
  int64_t *start;
  int *cell;
  PetscInt own;
  PetscCall(PetscCalloc2((size_t)count + 1, &start, (size_t)count, &cell));
  PetscCall(PetscMalloc1((size_t)count, &w->place));
  for (int64_t v = 0; v < count; v++) cell[v] = (int)v;
  const dvi__unknowns vertices = {.share = w->edges->share, .count = count, .cell = cell};
  const dvi_matrix none = {.rows = count, .columns = count, .start = start};
  PetscCall(dvi__operator_of_share(comm, &vertices, &none, &w->vertex));
  PetscCall(dvi__place_unknowns(comm, &vertices, w->place, &own));
  return PetscFree2(start, cell);
}

static PetscErrorCode prepare(MPI_Comm comm, work *w, PetscInt *free)
{
  const double *metric;
  PetscInt own;
  if (dvi_mesh_incidence(w->edges->share, 0, &w->d) != DVI_OK) return PETSC_ERR_ARG_WRONG;
  dvi__mesh_axes(w->edges->share, &metric, &w->period);
  PetscCall(list_vertices(comm, w));
  PetscCall(PetscMalloc1((size_t)w->edges->count, &w->edge));
  PetscCall(dvi__place_unknowns(comm, w->edges, w->edge, &own));
  return number_free(w, free);
}

static PetscErrorCode clear(work *w)
{
  PetscCall(dvi__operator_clear(&w->vertex));
  PetscCall(PetscFree(w->place));
  PetscCall(PetscFree(w->edge));
  return PetscFree(w->number);
}

/* ---- spaces ---- */

/* Give the length of an edge along an axis. */
static double length_along(const work *w, int64_t edge, int axis)
{
  const int axes = dvi_mesh_space(w->edges->share);
  const double *point = dvi_mesh_points(w->edges->share), period = w->period[axis];
  double length = 0;
  for (int64_t k = 2 * edge; k < 2 * edge + 2; k++)
    length += w->d.sign[k] * point[w->d.column[k] * axes + axis];
  return period > 0 ? length - period * rint(length / period) : length;
}

/* Make the rows of own edges, and take those of ghosts from their owners. */
static PetscErrorCode make_rows(const work *w, const dvi__operator *A, int axis, dvi__rows *made)
{
  for (PetscInt c = 0, k = 0; c < w->vertex.own; c++)
    if (w->number[c] >= 0) made->number[k++] = w->vertex.number[c];
  for (int64_t i = 0; i < w->edges->count; i++) {
    if (w->edge[i] >= A->own) continue;
    const int64_t edge = w->edges->cell[i];
    const double half = axis < 0 ? 0 : length_along(w, edge, axis) / 2;
    for (int k = 0; k < 2; k++) {
      const PetscInt vertex = w->number[w->place[w->d.column[2 * edge + k]]],
                     p = 2 * w->edge[i] + k;
      const double weight = axis < 0 ? w->d.sign[2 * edge + k] : half;
      if (vertex < 0 || weight == 0) continue;
      made->column[p] = vertex;
      made->weight[p] = weight;
    }
  }
  return dvi__rows_tell(A, made);
}

/* Make the product of the diagonal that A is for gradients. */
static PetscErrorCode make_gradients(const work *w, const dvi__operator *A, const dvi__rows *rows,
                                     dvi__coarser *made)
{
  const size_t count = (size_t)A->rows;
  dvi__operator D = *A;
  PetscCall(PetscMalloc3(count + 1, &D.start, count, &D.column, count, &D.value));
  for (PetscInt i = 0; i < A->rows; i++) D.start[i] = D.column[i] = i;
  D.start[A->rows] = A->rows;
  for (int64_t i = 0; i < w->edges->count; i++)
    if (w->edge[i] < A->own) D.value[w->edge[i]] = w->of_gradients[i];
  PetscCall(dvi__product(&D, rows, NULL, made));
  return PetscFree3(D.start, D.column, D.value);
}

static PetscErrorCode make_space(const work *w, const dvi__edges *e, int axis, space *made)
{
  dvi__rows rows = {0};
  PetscCall(dvi__rows_allocate(e->A, e->own, 2, &rows));
  PetscCall(make_rows(w, e->A, axis, &rows));
  if (axis < 0)
    PetscCall(make_gradients(w, e->A, &rows, &made->coarser));
  else
    PetscCall(dvi__product(e->A, &rows, NULL, &made->coarser));
  PetscCall(dvi__rows_clear(&rows));
  PetscCall(dvi__multigrid_create(&made->coarser.A, &made->multigrid));
  PetscCall(dvi__operator_show(&made->coarser.A, &made->shown));
  PetscCall(MatCreateVecs(made->shown, &made->right, &made->left));
  PetscCall(PCCreate(e->A->comm, &made->cycle));
  PetscCall(PCSetOperators(made->cycle, made->shown, made->shown));
  PetscCall(dvi__multigrid_use(made->multigrid, made->cycle));
  return PCSetUp(made->cycle);
}

/* ---- all spaces together ---- */

static PetscErrorCode interpolate(Mat shown, Vec x, Vec y)
{
  dvi__edges *e;
  const PetscScalar *in;
  PetscScalar *out;
  PetscCall(MatShellGetContext(shown, &e));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArray(y, &out));
  for (PetscInt i = 0; i < e->A->own; i++) out[i] = 0;
  for (int s = 0; s < e->spaces; s++) {
    PetscCall(dvi__operator_multiply(&e->space[s].coarser.P, in + s * e->own, e->part));
    for (PetscInt i = 0; i < e->A->own; i++) out[i] += e->part[i];
  }
  PetscCall(VecRestoreArray(y, &out));
  return VecRestoreArrayRead(x, &in);
}

static PetscErrorCode restrict_to_vertices(Mat shown, Vec x, Vec y)
{
  dvi__edges *e;
  const PetscScalar *in;
  PetscScalar *out;
  PetscCall(MatShellGetContext(shown, &e));
  PetscCall(VecGetArrayRead(x, &in));
  PetscCall(VecGetArray(y, &out));
  for (int s = 0; s < e->spaces; s++)
    PetscCall(dvi__operator_multiply(&e->space[s].coarser.PT, in, out + s * e->own));
  PetscCall(VecRestoreArray(y, &out));
  return VecRestoreArrayRead(x, &in);
}

/* Matrices from functions of all spaces to the edges, and back, have rows and columns by these
 * numbers, which may be equal: PETSc would take one matrix for its transpose then. */
static PetscErrorCode create_vectors(Mat shown, Vec *right, Vec *left)
{
  dvi__edges *e;
  PetscInt rows, columns;
  PetscCall(MatShellGetContext(shown, &e));
  PetscCall(MatGetLocalSize(shown, &rows, &columns));
  if (right != NULL) PetscCall(dvi__vector_create(e->A->comm, columns, right));
  return left != NULL ? dvi__vector_create(e->A->comm, rows, left) : 0;
}

static PetscErrorCode show(dvi__edges *e, PetscInt rows, PetscInt columns, Mat *shown)
{
  PetscCall(MatCreateShell(e->A->comm, rows, columns, PETSC_DETERMINE, PETSC_DETERMINE, e, shown));
  return MatShellSetOperation(*shown, MATOP_CREATE_VECS, (void (*)(void))create_vectors);
}

static PetscErrorCode show_all(dvi__edges *e)
{
  const PetscInt all = e->spaces * e->own, rows = e->A->rows;
  PetscCall(dvi__operator_show(e->A, &e->shown));
  if (e->vertices == 0) return 0;
  PetscCall(show(e, all, all, &e->coarse));
  PetscCall(show(e, rows, all, &e->interpolation));
  PetscCall(show(e, all, rows, &e->restriction));
  PetscCall(MatShellSetOperation(e->interpolation, MATOP_MULT, (void (*)(void))interpolate));
  return MatShellSetOperation(e->restriction, MATOP_MULT, (void (*)(void))restrict_to_vertices);
}

/* Give each space a cycle of its own. */
static PetscErrorCode cycle(PC pc, Vec b, Vec x)
{
  dvi__edges *e;
  const PetscScalar *in;
  PetscScalar *out, *here;
  PetscCall(PCShellGetContext(pc, &e));
  PetscCall(VecGetArrayRead(b, &in));
  PetscCall(VecGetArray(x, &out));
  for (int k = 0; k < e->spaces; k++) {
    space *s = e->space + k;
    PetscCall(VecGetArray(s->left, &here));
    PetscCall(PetscArraycpy(here, in + k * e->own, (size_t)e->own));
    PetscCall(VecRestoreArray(s->left, &here));
    PetscCall(PCApply(s->cycle, s->left, s->right));
    PetscCall(VecGetArray(s->right, &here));
    PetscCall(PetscArraycpy(out + k * e->own, here, (size_t)e->own));
    PetscCall(VecRestoreArray(s->right, &here));
  }
  PetscCall(VecRestoreArray(x, &out));
  return VecRestoreArrayRead(b, &in);
}

static PetscErrorCode set_spaces(dvi__edges *e, KSP ksp)
{
  PC pc;
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPSetOperators(ksp, e->coarse, e->coarse));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, e));
  return PCShellSetApply(pc, cycle);
}

PetscErrorCode dvi__edges_use(dvi__edges *e, PC pc)
{
  KSP ksp;
  PetscCall(PCSetType(pc, PCMG));
  PetscCall(PCMGSetLevels(pc, e->vertices > 0 ? 2 : 1, NULL));
  PetscCall(PCMGGetCoarseSolve(pc, &ksp));
  if (e->vertices == 0) return dvi__set_smoother(e->shown, e->bound, ALONE, ksp);
  PetscCall(set_spaces(e, ksp));
  PetscCall(PCMGSetInterpolation(pc, 1, e->interpolation));
  PetscCall(PCMGSetRestriction(pc, 1, e->restriction));
  PetscCall(PCMGGetSmoother(pc, 1, &ksp));
  return dvi__set_smoother(e->shown, e->bound, SMOOTHINGS, ksp);
}

/* ---- create ---- */

static PetscErrorCode make(work *w, dvi__edges *e)
{
  PetscCall(dvi__bound_of_jacobi(e->A, &e->bound));
  PetscCall(prepare(e->A->comm, w, &e->own));
  PetscCallMPI(MPI_Allreduce(&e->own, &e->vertices, 1, MPIU_INT, MPI_SUM, e->A->comm));
  e->spaces = 1 + dvi_mesh_space(w->edges->share);
  for (int s = 0; s < e->spaces && e->vertices > 0; s++)
    PetscCall(make_space(w, e, s - 1, e->space + s));
  PetscCall(PetscMalloc1((size_t)e->A->rows, &e->part));
  return show_all(e);
}

PetscErrorCode dvi__edges_create(const dvi__unknowns *edges, dvi__operator *A,
                                 const double *of_gradients, dvi__edges **made)
{
  work w = {.edges = edges, .of_gradients = of_gradients};
  PetscCall(PetscNew(made));
  (*made)->A = A;
  PetscCall(make(&w, *made));
  return clear(&w);
}

PetscErrorCode dvi__edges_destroy(dvi__edges **made)
{
  if (*made == NULL) return 0;
  for (int k = 0; k < (*made)->spaces; k++) {
    space *s = (*made)->space + k;
    PetscCall(PCDestroy(&s->cycle));
    PetscCall(MatDestroy(&s->shown));
    PetscCall(VecDestroy(&s->right));
    PetscCall(VecDestroy(&s->left));
    PetscCall(dvi__multigrid_destroy(&s->multigrid));
    PetscCall(dvi__coarser_clear(&s->coarser));
  }
  PetscCall(MatDestroy(&(*made)->shown));
  PetscCall(MatDestroy(&(*made)->coarse));
  PetscCall(MatDestroy(&(*made)->interpolation));
  PetscCall(MatDestroy(&(*made)->restriction));
  PetscCall(PetscFree((*made)->part));
  return PetscFree(*made);
}
