#include "problem.h"

#include <dvi/forms.h>
#include <dvi/petsc.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "owners.h"

enum { MOST_IN_PLANE = 1000000, SPACE = 3 };

/* ---- matrices ---- */

static dvi_status number_unknowns(dvi__modes_problem *p, const int *cell, int64_t unknowns)
{
  char *chosen = DVI_NEW(char, dvi_mesh_count(p->division->share, p->degree));
  for (int64_t i = 0; i < unknowns && chosen != NULL; i++) chosen[cell[i]] = 1;
  dvi_status status = dvi__world_agree(
      &p->division->world,
      chosen != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "modes: no memory for unknowns"));
  if (status == DVI_OK) status = dvi__number_cells(p->division, p->degree, chosen, &p->unknowns);
  dvi__release(chosen);
  return status;
}

static PetscErrorCode make_vectors(dvi__modes_problem *p)
{
  PetscCall(MatCreateVecs(p->K, &p->mass, &p->start));
  PetscCall(VecDuplicate(p->mass, &p->root));
  PetscCall(VecDuplicate(p->mass, &p->room[0]));
  return VecDuplicate(p->mass, &p->room[1]);
}

/* Take over the diagonal of M, whose rows are the unknowns at the cells. */
static PetscErrorCode fill_mass(dvi__modes_problem *p, const dvi_matrix *M, const int *cell)
{
  PetscScalar *value;
  PetscInt row = 0;
  PetscCall(VecGetArrayWrite(p->mass, &value));
  for (int64_t i = 0; i < M->rows && row < p->unknowns.own; i++)
    if (cell[i] == p->unknowns.cell[row]) value[row++] = M->value[i];
  PetscCall(VecRestoreArrayWrite(p->mass, &value));
  PetscCall(VecCopy(p->mass, p->root));
  return VecSqrtAbs(p->root);
}

static dvi_status check_mass(const dvi__modes_problem *p)
{
  PetscReal least;
  DVI_TRY(dvi__check_petsc(VecMin(p->mass, NULL, &least)));
  if (least > 0) return DVI_OK;
  return dvi__fail(DVI_SINGULAR, "modes: an entry of the diagonal of M is %g, not positive", least);
}

static dvi_status make_matrices(dvi__modes_problem *p)
{
  dvi_matrix K, M;
  int64_t count;
  const int *cell = dvi_field_unknowns(p->field, &count);
  DVI_TRY(number_unknowns(p, cell, count));
  DVI_TRY(dvi_field_matrix(p->field, DVI_FIELD_STIFFNESS, &K));
  DVI_TRY(dvi_field_matrix(p->field, DVI_FIELD_MASS, &M));
  const dvi__cell_matrix part = {
      .matrix = &K, .row = cell, .column = cell, .rows = &p->unknowns, .columns = &p->unknowns};
  DVI_TRY(dvi__matrix_of_all(p->division, &part, &p->K));
  DVI_TRY(dvi__check_petsc(make_vectors(p)));
  DVI_TRY(dvi__check_petsc(fill_mass(p, &M, cell)));
  return check_mass(p);
}

/* An entry of the diagonal of K over that of M is about 4 n/h^2, and a length of the mesh about
 * h N^(1/n). */
static PetscErrorCode find_sizes(dvi__modes_problem *p)
{
  PetscScalar k, m;
  PetscCall(MatGetDiagonal(p->K, p->room[0]));
  PetscCall(VecSum(p->room[0], &k));
  PetscCall(VecSum(p->mass, &m));
  p->mean = k / m;
  p->below = -0.1 * p->mean *
             pow((double)p->unknowns.total, -2.0 / dvi_mesh_dimension(p->division->share));
  return 0;
}

/* ---- constants ---- */

/* Give the labels [*count] of all components without a held vertex, for dvi__release. */
static dvi_status gather_labels(dvi_division *division, const double *label, double **all,
                                int64_t *count)
{
  const dvi__world *world = &division->world;
  const int64_t *number = dvi_mesh_share_numbers(division->share, 0);
  const int *owner = dvi_mesh_share_owners(division->share, 0);
  int64_t own = 0, first = 0, next = 0;
  for (int64_t v = 0; v < dvi_mesh_count(division->share, 0); v++)
    own += label[v] == (double)number[v] && owner[v] == world->rank;
  *count = own;
  if (MPI_Exscan(&own, &first, 1, MPI_INT64_T, MPI_SUM, world->comm) != MPI_SUCCESS ||
      MPI_Allreduce(MPI_IN_PLACE, count, 1, MPI_INT64_T, MPI_SUM, world->comm) != MPI_SUCCESS)
    return dvi__world_fail(world);
  if (world->rank > 0) next = first;
  *all = DVI_NEW(double, *count);
  DVI_TRY(dvi__world_agree(
      world, *all != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "modes: no memory for components")));
  for (int64_t v = 0; *all != NULL && v < dvi_mesh_count(division->share, 0); v++)
    if (label[v] == (double)number[v] && owner[v] == world->rank) (*all)[next++] = label[v];
  /* the others' are 0, and a label is not below 0 */
  if (dvi__world_largest((int)*count, *all, (void *)world) != 0) return dvi__world_fail(world);
  return DVI_OK;
}

static PetscErrorCode add_constant(dvi__modes_problem *p, const double *label, double component)
{
  const dvi__numbering *n = &p->unknowns;
  Vec *y = p->pairs.vector + p->pairs.count;
  PetscScalar *value;
  PetscCall(VecDuplicate(p->root, y));
  p->pairs.count++;
  PetscCall(VecGetArrayWrite(*y, &value));
  for (PetscInt i = 0; i < n->own; i++) value[i] = label[n->cell[i]] == component;
  PetscCall(VecRestoreArrayWrite(*y, &value));
  PetscCall(VecPointwiseMult(*y, *y, p->root));
  return VecNormalize(*y, NULL);
}

static dvi_status add_constants(dvi__modes_problem *p, const double *label)
{
  double *component = NULL;
  int64_t count = 0;
  dvi_status status = gather_labels(p->division, label, &component, &count);
  if (status == DVI_OK)
    status = dvi__world_agree(&p->division->world, dvi__pairs_reserve((PetscInt)count, &p->pairs));
  for (int64_t i = 0; component != NULL && i < count && status == DVI_OK; i++)
    status = dvi__check_petsc(add_constant(p, label, component[i]));
  p->constants = p->pairs.count;
  dvi__release(component);
  return status;
}

/* Find the constants on the components of the mesh without a fixed vertex. */
static dvi_status find_constants(dvi__modes_problem *p)
{
  const int64_t vertices = dvi_mesh_count(p->division->share, 0);
  double *label = DVI_NEW(double, vertices);
  char *held = DVI_NEW(char, vertices);
  dvi_status status = dvi__world_agree(
      &p->division->world, label != NULL && held != NULL
                               ? DVI_OK
                               : dvi__fail(DVI_NO_MEMORY, "modes: no memory for components"));
  for (int64_t v = 0; v < vertices && status == DVI_OK; v++) held[v] = p->unknowns.number[v] < 0;
  if (status == DVI_OK) status = dvi__label_components(p->division, held, label);
  if (status == DVI_OK) status = add_constants(p, label);
  dvi__release(label);
  dvi__release(held);
  return status;
}

/* ---- the start ---- */

/* Return a number from -1 to 1 (splitmix64). */
static double draw_number(uint64_t seed)
{
  uint64_t z = seed * UINT64_C(0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

static PetscErrorCode fill_start(dvi__modes_problem *p, int draw)
{
  const int64_t *number = dvi_mesh_share_numbers(p->division->share, p->degree);
  PetscScalar *value;
  PetscCall(VecGetArrayWrite(p->start, &value));
  for (PetscInt i = 0; i < p->unknowns.own; i++)
    value[i] = draw_number((uint64_t)number[p->unknowns.cell[i]] * 64 + (uint64_t)draw + 1);
  PetscCall(VecRestoreArrayWrite(p->start, &value));
  if (p->gradients.count == 0) return 0;
  PetscCall(VecPointwiseMult(p->room[0], p->root, p->start)); /* M x for x = M^(-1/2) y */
  PetscCall(VecPointwiseDivide(p->start, p->start, p->root));
  PetscCall(dvi__gradients_project(&p->gradients, p->room[0], p->start));
  return VecPointwiseMult(p->start, p->start, p->root);
}

dvi_status dvi__modes_draw_start(dvi__modes_problem *p, int draw)
{
  return dvi__check_petsc(fill_start(p, draw));
}

/* ---- for others ---- */

static int is_large(const dvi__modes_problem *p)
{
  const dvi_mesh *share = p->division->share;
  const int n = dvi_mesh_dimension(share);
  if (p->degree > 0 && (n < SPACE || dvi_mesh_space(share) != SPACE)) return 0;
  return p->unknowns.total > (n < SPACE ? MOST_IN_PLANE : p->most);
}

dvi_status dvi__modes_problem_create(dvi__modes_problem *p)
{
  p->degree = dvi_field_degree(p->field);
  DVI_TRY(make_matrices(p));
  DVI_TRY(dvi__check_petsc(find_sizes(p)));
  p->is_large = is_large(p);
  if (p->degree == 0) return find_constants(p);
  const dvi__edge_field of = {
      .division = p->division, .unknowns = &p->unknowns, .mass = p->mass, .is_large = p->is_large};
  return dvi__gradients_create(&of, &p->gradients);
}

void dvi__modes_problem_clear(dvi__modes_problem *p)
{
  dvi__pairs_clear(&p->pairs);
  dvi__gradients_clear(&p->gradients);
  for (int i = 0; i < 2; i++) (void)VecDestroy(&p->room[i]);
  (void)VecDestroy(&p->start);
  (void)VecDestroy(&p->root);
  (void)VecDestroy(&p->mass);
  (void)MatDestroy(&p->K);
  dvi__numbering_clear(&p->unknowns);
}
