/* A solid from its terms. */
#include "field/elastic/create.h"

#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic/system.h"
#include "field/mesh/share.h"
#include "field/mesh/volume.h"

/* ---- cells ---- */

/* Give the gradients of the barycentric coordinates [(n+1)*n] from the edges that leave the first
 * node. They are the rows of the inverse of the matrix whose columns are the edges. */
static void find_gradients(int n, const double *edge, double *g)
{
  const double *a = edge, *b = edge + n, *c = edge + (n > 2 ? 2 * n : 0);
  if (n == 2) {
    g[2] = b[1], g[3] = -b[0], g[4] = -a[1], g[5] = a[0];
  } else {
    for (int i = 0; i < 3; i++) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      g[3 + i] = b[j] * c[k] - b[k] * c[j];
      g[6 + i] = c[j] * a[k] - c[k] * a[j];
      g[9 + i] = a[j] * b[k] - a[k] * b[j];
    }
  }
  double determinant = 0;
  for (int i = 0; i < n; i++) determinant += a[i] * g[n + i];
  for (int k = n; k < (n + 1) * n; k++) g[k] /= determinant;
  for (int i = 0; i < n; i++) {
    double sum = 0;
    for (int m = 1; m <= n; m++) sum += g[m * n + i];
    g[i] = -sum;
  }
}

static dvi_status make_cells(dvi_elastic *e)
{
  const int n = e->n;
  e->gradient = DVI_NEW(double, e->cells *(n + 1) * n);
  e->volume = DVI_NEW(double, e->cells);
  e->mass = DVI_NEW(double, e->vertices);
  if (e->gradient == NULL || e->volume == NULL || e->mass == NULL)
    return dvi__fail(DVI_NO_MEMORY, "elastic: no memory for %lld cells", (long long)e->cells);
  for (int64_t c = 0; c < e->cells; c++) {
    double edge[DVI_MESH_DIMENSION_MAX * DVI_MESH_SPACE_MAX];
    dvi__cell_edges(e->mesh, n, c, edge);
    find_gradients(n, edge, e->gradient + c * (n + 1) * n);
    e->volume[c] = dvi__cell_volume(e->mesh, n, c);
    const double part = e->materials[e->material[c]].rho * e->volume[c] / (n + 1);
    for (int a = 0; a <= n; a++) e->mass[e->vertex[c * (n + 1) + a]] += part;
  }
  return DVI_OK;
}

/* ---- all ---- */

static dvi_status make(const dvi_elastic_terms *terms, dvi_elastic *e)
{
  DVI_TRY(dvi__solid_take_mesh(e, terms->mesh));
  DVI_TRY(dvi__solid_take_materials(e, terms));
  DVI_TRY(make_cells(e));
  DVI_TRY(dvi__solid_take_conditions(e, terms));
  DVI_TRY(dvi__solid_take_loads(e, terms));
  DVI_TRY(dvi__solid_take_obstacles(e, terms));
  e->is_split = terms->split != 0;
  return DVI_OK;
}

/* What needs all processes: masses of nodes at the edge of a share, and what is found nowhere. */
static dvi_status join(dvi_elastic *e)
{
  DVI_TRY(dvi__refresh(e->mesh, 0, e->mass));
  DVI_TRY(dvi__solid_count_unknowns(e));
  return dvi__solid_check_loads(e);
}

dvi_status dvi_elastic_create(const dvi_elastic_terms *terms, dvi_elastic **elastic)
{
  if (terms == NULL || elastic == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: terms and a place for the solid are needed");
  *elastic = NULL;
  if (terms->size != sizeof *terms)
    return dvi__fail(DVI_BAD_ARGUMENT, "elastic: the size of the terms is %zu, not %zu",
                     terms->size, sizeof *terms);
  dvi_elastic *e = DVI_NEW(dvi_elastic, 1);
  dvi_status status = e != NULL ? make(terms, e)
                                : dvi__fail(DVI_NO_MEMORY, "elastic: no memory for a solid");
  if (terms->mesh != NULL) status = dvi__agree(terms->mesh, status);
  if (status == DVI_OK && e != NULL) status = join(e);
  *elastic = e;
  if (status != DVI_OK) dvi_elastic_destroy(elastic);
  return status;
}

void dvi_elastic_destroy(dvi_elastic **elastic)
{
  if (elastic == NULL || *elastic == NULL) return;
  dvi_elastic *e = *elastic;
  dvi__solid_system_destroy(&e->system);
  for (int i = 0; i < e->obstacles; i++) dvi__release((void *)e->obstacle[i].name);
  for (int i = 0; i < e->load_count; i++) dvi__release((void *)e->loads[i].part);
  for (int i = 0; i < e->condition_count; i++) dvi__release((void *)e->conditions[i].part);
  void *const arrays[] = {e->gradient, e->volume,    e->mass,       e->material, e->materials,
                          e->unknown,  e->condition, e->conditions, e->steady,   e->load_start,
                          e->load_of,  e->loads,     e->obstacle,   e->is_outer};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) dvi__release(arrays[i]);
  dvi_mesh_destroy(&e->mesh);
  dvi__release(e);
  *elastic = NULL;
}

const dvi_mesh *dvi_elastic_mesh(const dvi_elastic *elastic)
{
  return elastic != NULL ? elastic->mesh : NULL;
}

const int *dvi_elastic_unknowns(const dvi_elastic *elastic, int64_t *unknowns)
{
  if (unknowns != NULL) *unknowns = elastic != NULL ? elastic->unknowns : 0;
  return elastic != NULL ? elastic->unknown : NULL;
}

const double *dvi_elastic_masses(const dvi_elastic *elastic)
{
  return elastic != NULL ? elastic->mass : NULL;
}
