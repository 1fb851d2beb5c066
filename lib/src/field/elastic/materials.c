/* The mesh of a solid, and what it is made of. */
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/cell.h"
#include "field/elastic/create.h"
#include "num/eigen.h"

/* ---- the mesh ---- */

dvi_status dvi__solid_take_mesh(dvi_elastic *e, const dvi_mesh *mesh)
{
  if (mesh == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a mesh is needed");
  if (mesh->kind != DVI_SIMPLICES || mesh->n != mesh->space || mesh->n < 2 || mesh->n > 3)
    return dvi__fail(DVI_UNSUPPORTED,
                     "elastic: the mesh has cells of the kind %s in a space of %d dimensions: "
                     "triangles in a plane or tetrahedra in space are needed",
                     dvi__degree_name(mesh->kind, mesh->n), mesh->space);
  for (int i = 0; i < mesh->space; i++) {
    if (mesh->period[i] != 0)
      return dvi__fail(DVI_UNSUPPORTED,
                       "elastic: the mesh repeats itself along axis %d, where a solid has no "
                       "displacements: leave the period out",
                       i);
    if (mesh->metric[i] < 0)
      return dvi__fail(DVI_UNSUPPORTED,
                       "elastic: axis %d of the mesh is one of time: a solid is in space alone", i);
  }
  e->mesh = dvi_mesh_share(mesh);
  e->n = mesh->n;
  e->vertices = mesh->count[0];
  e->cells = mesh->count[mesh->n];
  e->vertex = mesh->corner[mesh->n];
  e->point = mesh->point;
  return DVI_OK;
}

dvi_status dvi__solid_copy_name(const char *name, const char **copy)
{
  *copy = dvi__duplicate(name, strlen(name) + 1, 1);
  return *copy != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "elastic: no memory for a name");
}

/* ---- one material ---- */

static dvi_status check_range(const char *part, const char *constant, double value, int is_right,
                              const char *range)
{
  if (is_right && isfinite(value)) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "elastic: %s of the material on part \"%s\" is %g; a finite number %s is needed",
                   constant, part, value, range);
}

static dvi_status check_constants(int n, const dvi_elastic_material *m)
{
  const double least = -2 * m->mu / n;
  char range[48];
  DVI_TRY(check_range(m->part, "rho", m->rho, m->rho > 0, "above 0"));
  DVI_TRY(check_range(m->part, "alpha", m->alpha, m->alpha >= 0, "of at least 0"));
  DVI_TRY(check_range(m->part, "beta", m->beta, m->beta >= 0, "of at least 0"));
  if (m->law != DVI_ELASTIC_MOONEY_RIVLIN)
    DVI_TRY(check_range(m->part, "mooney", m->mooney, m->mooney == 0, "of 0 with its law"));
  if (m->law == DVI_ELASTIC_ENERGY) return DVI_OK;
  DVI_TRY(check_range(m->part, "mu", m->mu, m->mu > 0, "above 0"));
  (void)snprintf(range, sizeof range, "above -2 mu/%d = %g", n, least);
  DVI_TRY(check_range(m->part, "lambda", m->lambda, m->lambda > least, range));
  if (m->law != DVI_ELASTIC_MOONEY_RIVLIN) return DVI_OK;
  return check_range(m->part, "mooney", m->mooney, m->mooney >= 0 && m->mooney <= m->mu,
                     "from 0 to mu");
}

static dvi_status check_material(const dvi_elastic *e, const dvi_elastic_material *m)
{
  if (m->part == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a material has no part of the mesh");
  const int64_t count = dvi__part_total(e->mesh, m->part, e->n);
  if (count <= 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: a material is set on part \"%s\", %s: name a part of %s", m->part,
                     count < 0 ? "which the mesh has not" : "which has no cells",
                     e->n == 3 ? "tetrahedra" : "triangles");
  if ((int)m->law < DVI_ELASTIC_LINEAR || m->law > DVI_ELASTIC_ENERGY)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: the material on part \"%s\" has no law %d",
                     m->part, (int)m->law);
  if (m->law == DVI_ELASTIC_ENERGY && m->energy == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: the stored energy of the material on part \"%s\" is missing",
                     m->part);
  return check_constants(e->n, m);
}

/* ---- its state of rest ---- */

static dvi_status refuse_rest(const char *part, int returned)
{
  if (returned < 0)
    return dvi__fail(DVI_CALLBACK_FAILED,
                     "elastic: the stored energy of the material on part \"%s\" returned %d at "
                     "F = I",
                     part, returned);
  return dvi__fail(DVI_NOT_FINITE,
                   "elastic: the stored energy of the material on part \"%s\" or a derivative of "
                   "it is not finite or not defined at F = I",
                   part);
}

/* Refuse an energy that is given unless F = I is a minimum of it. */
static dvi_status check_rest(int n, const char *part, const dvi__solid_material *m)
{
  static const double still[DVI__SOLID_ENTRIES];
  const double roundoff = 1e-9; /* that of differenced derivatives */
  double P[DVI__SOLID_ENTRIES], A[DVI__SOLID_ENTRIES * DVI__SOLID_ENTRIES],
      lambda[DVI__SOLID_ENTRIES], work[8 * DVI__SOLID_ENTRIES], largest = 0;
  const int entries = n * n, returned = dvi__given_stress(n, m, still, P);
  if (returned != 0) return refuse_rest(part, returned);
  memcpy(A, m->rest, (size_t)(entries * entries) * sizeof *A);
  if (!dvi__symmetric_eigenvalues(entries, A, lambda, work)) return refuse_rest(part, 1);
  for (int k = 0; k < entries; k++) largest = fmax(largest, fabs(P[k]));
  if (largest > roundoff * lambda[entries - 1])
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: the stored energy of the material on part \"%s\" has a stress of %g "
                     "at F = I; 0 is needed, because the mesh is the solid at rest: subtract it",
                     part, largest);
  if (lambda[entries - 1] > 0 && lambda[0] >= -roundoff * lambda[entries - 1]) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "elastic: the stored energy of the material on part \"%s\" has no minimum at "
                   "F = I, since its Hessian has the eigenvalue %g: change its signs",
                   part, lambda[0]);
}

static dvi_status take_material(int n, const dvi_elastic_material *given, dvi__solid_material *m)
{
  static const double still[DVI__SOLID_ENTRIES];
  *m = (dvi__solid_material){.law = given->law,
                             .lambda = given->lambda,
                             .mu = given->mu,
                             .mooney = given->mooney,
                             .rho = given->rho,
                             .alpha = given->alpha,
                             .beta = given->beta,
                             .energy = given->energy,
                             .user = given->user};
  const int returned = dvi__law_hessian(n, m, still, m->rest);
  if (returned != 0) return refuse_rest(given->part, returned);
  return m->law == DVI_ELASTIC_ENERGY ? check_rest(n, given->part, m) : DVI_OK;
}

/* ---- all materials ---- */

/* The last material of a cell counts. */
static dvi_status spread(dvi_elastic *e, const dvi_elastic_terms *terms)
{
  for (int64_t c = 0; c < e->cells; c++) e->material[c] = -1;
  for (int m = 0; m < terms->materials; m++) {
    int64_t count;
    const int *cell = dvi_mesh_part_cells(e->mesh, terms->material[m].part, e->n, &count);
    for (int64_t i = 0; i < count; i++) e->material[cell[i]] = m;
  }
  for (int64_t c = 0; c < e->cells; c++) {
    if (e->material[c] >= 0) continue;
    const dvi__cell_name name = dvi__name_cell(e->mesh, e->n, c);
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: %s has no material: add a first one on part \"all\"", name.text);
  }
  return DVI_OK;
}

dvi_status dvi__solid_take_materials(dvi_elastic *e, const dvi_elastic_terms *terms)
{
  if (terms->materials < 1 || terms->material == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a material is needed, and %d are given",
                     terms->material != NULL ? terms->materials : 0);
  e->material = DVI_NEW(int, e->cells);
  e->materials = DVI_NEW(dvi__solid_material, terms->materials);
  if (e->material == NULL || e->materials == NULL)
    return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for materials");
  e->material_count = terms->materials;
  for (int m = 0; m < terms->materials; m++) {
    DVI_TRY(check_material(e, terms->material + m));
    DVI_TRY(take_material(e->n, terms->material + m, e->materials + m));
  }
  return spread(e, terms);
}
