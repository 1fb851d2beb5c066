#include "gradients.h"

#include <dvi/forms.h>
#include <dvi/petsc.h>

#include "core/memory.h"
#include "core/status.h"
#include "owners.h"

/* ---- vertices ---- */

/* Mark the vertices of edges that are held, which are on their owners' shares. */
static dvi_status find_held(const dvi__edge_field *of, double *room, char *held)
{
  const dvi_mesh *share = of->division->share;
  const int64_t vertices = dvi_mesh_count(share, 0);
  dvi_matrix d;
  DVI_TRY(dvi_mesh_incidence(share, 0, &d));
  for (int64_t v = 0; v < vertices; v++) room[v] = 0;
  for (int64_t e = 0; e < d.rows; e++)
    for (int c = 0; c < 2 && of->unknowns->number[e] < 0; c++) room[d.column[2 * e + c]] = 1;
  DVI_TRY(dvi_division_refresh(of->division, 0, room));
  for (int64_t v = 0; v < vertices; v++) held[v] = room[v] > 0;
  return DVI_OK;
}

/* Number the vertices whose functions have independent gradients that vanish where the form is
 * held: those that are on no held edge, but one of each component that has none. */
static dvi_status number_vertices(const dvi__edge_field *of, dvi__numbering *chosen)
{
  const dvi_mesh *share = of->division->share;
  const int64_t vertices = dvi_mesh_count(share, 0), *number = dvi_mesh_share_numbers(share, 0);
  double *label = DVI_NEW(double, vertices);
  char *mark = DVI_NEW(char, vertices);
  dvi_status status = dvi__world_agree(
      &of->division->world, label != NULL && mark != NULL
                                ? DVI_OK
                                : dvi__fail(DVI_NO_MEMORY, "modes: no memory for gradients"));
  if (status == DVI_OK) status = find_held(of, label, mark);
  if (status == DVI_OK) status = dvi__label_components(of->division, mark, label);
  for (int64_t v = 0; v < vertices && status == DVI_OK; v++)
    mark[v] = !mark[v] && label[v] != (double)number[v];
  if (status == DVI_OK) status = dvi__number_cells(of->division, 0, mark, chosen);
  dvi__release(label);
  dvi__release(mark);
  return status;
}

static dvi_status make_incidence(const dvi__edge_field *of, dvi__gradients *g)
{
  dvi__numbering vertices = {.own = 0};
  dvi_matrix d;
  DVI_TRY(number_vertices(of, &vertices));
  g->count = vertices.total;
  const dvi__cell_matrix part = {.matrix = &d, .rows = of->unknowns, .columns = &vertices};
  dvi_status status = dvi__world_agree(&of->division->world,
                                       dvi_mesh_incidence(of->division->share, 0, &d));
  if (status == DVI_OK) status = dvi__matrix_of_all(of->division, &part, &g->edges.d);
  dvi__numbering_clear(&vertices);
  return status;
}

/* ---- Poisson's equation ---- */

static PetscErrorCode multiply_incidences(Mat d, Vec mass, Mat *square)
{
  Mat scaled;
  PetscCall(MatDuplicate(d, MAT_COPY_VALUES, &scaled));
  PetscCall(MatDiagonalScale(scaled, mass, NULL));
  PetscCall(MatTransposeMatMult(d, scaled, MAT_INITIAL_MATRIX, PETSC_DEFAULT, square));
  return MatDestroy(&scaled);
}

static PetscErrorCode make_vectors(dvi__gradients *g)
{
  PetscCall(MatCreateVecs(g->edges.d, &g->charge, &g->form));
  return VecDuplicate(g->charge, &g->phi);
}

static dvi_status prepare_poisson(const dvi__edge_field *of, dvi__gradients *g)
{
  dvi__equations equations = {.is_definite = 1, .is_large = of->is_large};
  DVI_TRY(dvi__check_petsc(make_vectors(g)));
  dvi_status status = dvi__check_petsc(
      multiply_incidences(g->edges.d, of->mass, &equations.matrix));
  if (status == DVI_OK) status = dvi__inverse_create(&equations, &g->poisson);
  (void)MatDestroy(&equations.matrix);
  return status;
}

/* ---- constant fields ---- */

enum { AXES = 3 };

static int constant_field(const double *x, double *value, void *axis)
{
  (void)x;
  for (int i = 0; i < AXES; i++) value[i] = i == *(const int *)axis;
  return 0;
}

static PetscErrorCode fill_vector(const dvi__numbering *n, const double *form, Vec x)
{
  PetscScalar *value;
  PetscCall(VecGetArrayWrite(x, &value));
  for (PetscInt i = 0; i < n->own; i++) value[i] = form[n->cell[i]];
  return VecRestoreArrayWrite(x, &value);
}

static dvi_status fill_constant(const dvi__edge_field *of, int axis, double *form, Vec x)
{
  DVI_TRY(dvi_form_integrate(of->division->share, 1, constant_field, &axis, form));
  return dvi__check_petsc(fill_vector(of->unknowns, form, x));
}

static dvi_status make_constants(const dvi__edge_field *of, dvi__edges *edges)
{
  double *form = DVI_NEW(double, dvi_mesh_count(of->division->share, 1));
  dvi_status status = dvi__world_agree(
      &of->division->world,
      form != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "modes: no memory for constant fields"));
  for (int axis = 0; axis < AXES && status == DVI_OK; axis++) {
    status = dvi__check_petsc(VecDuplicate(of->mass, &edges->constant[axis]));
    if (status == DVI_OK) status = fill_constant(of, axis, form, edges->constant[axis]);
  }
  dvi__release(form);
  return status;
}

/* ---- for others ---- */

dvi_status dvi__gradients_create(const dvi__edge_field *of, dvi__gradients *g)
{
  *g = (dvi__gradients){.count = 0};
  DVI_TRY(make_incidence(of, g));
  if (g->count == 0) return DVI_OK;
  DVI_TRY(prepare_poisson(of, g));
  return of->is_large ? make_constants(of, &g->edges) : DVI_OK;
}

void dvi__gradients_clear(dvi__gradients *g)
{
  dvi__inverse_clear(&g->poisson);
  for (int axis = 0; axis < AXES; axis++) (void)VecDestroy(&g->edges.constant[axis]);
  (void)VecDestroy(&g->charge);
  (void)VecDestroy(&g->phi);
  (void)VecDestroy(&g->form);
  (void)MatDestroy(&g->edges.d);
}

PetscErrorCode dvi__gradients_project(dvi__gradients *g, Vec My, Vec y)
{
  PetscCall(MatMultTranspose(g->edges.d, My, g->charge));
  PetscCall(dvi__inverse_apply(&g->poisson, g->charge, g->phi));
  PetscCall(MatMult(g->edges.d, g->phi, g->form));
  return VecAXPY(y, -1, g->form);
}
