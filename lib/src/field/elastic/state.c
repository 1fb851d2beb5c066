/* Displacements, coordinates, energies and stresses of a solid. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/elastic/assemble.h"
#include "field/elastic/cell.h"
#include "field/mesh/share.h"

/* ---- displacements and coordinates ---- */

dvi_status dvi_elastic_lift(const dvi_elastic *elastic, double t, const double *q, const double *p,
                            double *u, double *rate)
{
  if (elastic == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "elastic: a solid is needed");
  const int n = elastic->n;
  for (int64_t a = 0; a < elastic->vertices; a++) {
    double at[DVI_ELASTIC_DIMENSION_MAX] = {0}, speed[DVI_ELASTIC_DIMENSION_MAX] = {0};
    const int returned = dvi__solid_place(elastic, a, t, q, at, speed);
    if (returned != 0) return dvi__solid_refuse_given(elastic, a, returned);
    for (int i = 0; i < n; i++) {
      const int k = elastic->unknown[a * n + i];
      if (k >= 0) speed[i] = p != NULL ? p[k] / elastic->mass[a] : 0;
      if (u != NULL) u[a * n + i] = at[i];
      if (rate != NULL) rate[a * n + i] = speed[i];
    }
  }
  return DVI_OK;
}

void dvi_elastic_project(const dvi_elastic *elastic, const double *u, const double *rate, double *q,
                         double *v, double *p)
{
  if (elastic == NULL) return;
  const int n = elastic->n;
  for (int64_t k = 0; k < elastic->vertices * n; k++) {
    const int to = elastic->unknown[k];
    const double speed = rate != NULL ? rate[k] : 0;
    if (to < 0) continue;
    if (q != NULL) q[to] = u != NULL ? u[k] : 0;
    if (v != NULL) v[to] = speed;
    if (p != NULL) p[to] = elastic->mass[k / n] * speed;
  }
}

/* ---- energies ---- */

static dvi_status refuse_load(const dvi_elastic *e, int64_t cell, int returned)
{
  const dvi__cell_name name = dvi__name_cell(e->mesh, e->n, cell);
  return dvi__fail(DVI_CALLBACK_FAILED, "elastic: a load returned %d at %s", returned, name.text);
}

static dvi_status refuse_numbers(const dvi_elastic *e, int64_t cell, const char *numbers)
{
  const dvi__cell_name name = dvi__name_cell(e->mesh, e->n, cell);
  return dvi__fail(DVI_NOT_FINITE, "elastic: displacements, rates or %s of %s are not finite",
                   numbers, name.text);
}

/* Exact sums over cells, which do not depend on the division among processes. */
typedef struct energy_sums {
  dvi__block_sum kinetic, stored, load;
} energy_sums;

static dvi_status add_energies(const dvi_elastic *e, int64_t cell, double t, const double *u,
                               const double *rate, energy_sums *sum)
{
  const int n = e->n, numbers = (n + 1) * n;
  const double part = e->materials[e->material[cell]].rho * e->volume[cell] / (n + 1);
  double own[DVI__SOLID_NUMBERS], speed[DVI__SOLID_NUMBERS] = {0}, f[DVI__SOLID_NUMBERS] = {0},
                                  stored, kinetic = 0, load = 0;
  dvi__solid_gather(e, cell, u, own);
  if (rate != NULL) dvi__solid_gather(e, cell, rate, speed);
  for (int k = 0; k < numbers; k++)
    if (!isfinite(own[k])) return refuse_numbers(e, cell, "energies");
  int returned = dvi__solid_stored(e, cell, own, &stored);
  if (returned != 0) return dvi__solid_refuse(e, cell, returned);
  returned = dvi__solid_add_load(e, cell, t, f);
  if (returned != 0) return refuse_load(e, cell, returned);
  for (int k = 0; k < numbers; k++) {
    kinetic += part * speed[k] * speed[k] / 2;
    load -= f[k] * own[k];
  }
  if (!isfinite(kinetic) || !isfinite(stored) || !isfinite(load))
    return refuse_numbers(e, cell, "energies");
  dvi__block_sum_add(&sum->kinetic, kinetic);
  dvi__block_sum_add(&sum->stored, stored);
  dvi__block_sum_add(&sum->load, load);
  return DVI_OK;
}

/* Add the energies of a part's cells that are this process's. */
static dvi_status add_part(const dvi_elastic *e, double t, const double *u, const double *rate,
                           const char *part, energy_sums *sum)
{
  int64_t count;
  const int *cell = dvi_mesh_part_cells(e->mesh, part, e->n, &count);
  for (int64_t i = 0; i < count; i++)
    if (dvi__owns(e->mesh, e->n, cell[i])) DVI_TRY(add_energies(e, cell[i], t, u, rate, sum));
  return DVI_OK;
}

dvi_status dvi_elastic_energy(const dvi_elastic *elastic, double t, const double *u,
                              const double *rate, const char *part, dvi_elastic_energies *energies)
{
  if (elastic == NULL || u == NULL || energies == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: a solid, displacements and a place for energies are needed");
  const char *name = part != NULL ? part : "all";
  const dvi_mesh *mesh = elastic->mesh;
  const int64_t count = dvi__part_total(mesh, name, elastic->n);
  if (count <= 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: the energy of part \"%s\" is asked, %s: name a part of %s", name,
                     count < 0 ? "which the mesh has not" : "which has no cells",
                     elastic->n == 3 ? "tetrahedra" : "triangles");
  energy_sums sum = {.kinetic = {.count = 0}};
  dvi_elastic_energies found;
  DVI_TRY(dvi__agree(mesh, add_part(elastic, t, u, rate, name, &sum)));
  DVI_TRY(dvi__sum_of_all(mesh, dvi__block_sum_end(&sum.kinetic), &found.kinetic));
  DVI_TRY(dvi__sum_of_all(mesh, dvi__block_sum_end(&sum.stored), &found.stored));
  DVI_TRY(dvi__sum_of_all(mesh, dvi__block_sum_end(&sum.load), &found.load));
  if (!isfinite(found.kinetic) || !isfinite(found.stored) || !isfinite(found.load))
    return dvi__fail(DVI_NOT_FINITE, "elastic: the energies are not finite");
  *energies = found;
  return DVI_OK;
}

/* ---- stresses ---- */

/* P F^T/J = (P + P H^T)/J. That of the linear law is P. Gives H, too. */
static dvi_status find_stress(const dvi_elastic *e, int64_t cell, const double *u, double *H,
                              double *stress)
{
  const int n = e->n;
  const dvi__solid_material *material = e->materials + e->material[cell];
  double own[DVI__SOLID_NUMBERS] = {0}, P[DVI__SOLID_ENTRIES];
  dvi__solid_gather(e, cell, u, own);
  dvi__solid_strain(e, cell, own, H);
  const double J = 1 + dvi__trace(n, H) + dvi__higher_volume(n, H);
  if (!isfinite(J)) return refuse_numbers(e, cell, "stresses");
  const int is_linear = material->law == DVI_ELASTIC_LINEAR,
            returned = dvi__law_stress(n, material, H, P);
  if (returned != 0) return dvi__solid_refuse(e, cell, returned);
  if (!is_linear && !(J > 0)) return dvi__solid_refuse(e, cell, 1);
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double sum = P[i * n + j];
      for (int k = 0; k < n && !is_linear; k++) sum += P[i * n + k] * H[j * n + k];
      stress[i * n + j] = is_linear ? sum : sum / J;
      if (!isfinite(sum)) return refuse_numbers(e, cell, "stresses");
    }
  return DVI_OK;
}

static dvi_status check_stress(const dvi_elastic *e, int64_t count, const int *cell,
                               const double *u, const double *stress)
{
  if (e == NULL || u == NULL || stress == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "elastic: a solid, displacements and a place for stresses are needed");
  for (int64_t i = 0; i < count && cell != NULL; i++)
    if (cell[i] < 0 || cell[i] >= e->cells)
      return dvi__fail(DVI_BAD_ARGUMENT, "elastic: the stress of cell %d is asked, of 0 to %lld",
                       cell[i], (long long)e->cells - 1);
  return DVI_OK;
}

dvi_status dvi_elastic_stress(const dvi_elastic *elastic, int64_t count, const int *cell,
                              const double *u, double *stress)
{
  double H[DVI__SOLID_ENTRIES];
  DVI_TRY(check_stress(elastic, count, cell, u, stress));
  if (cell == NULL) count = elastic->cells;
  for (int64_t i = 0; i < count; i++)
    DVI_TRY(find_stress(elastic, cell != NULL ? cell[i] : i, u, H,
                        stress + i * elastic->n * elastic->n));
  return DVI_OK;
}

/* Cauchy's stress across a plane, in which E_33 = 0 and F_33 = 1. */
static double stress_across(const dvi__solid_material *m, const double *H)
{
  double E[DVI__SOLID_ENTRIES];
  const double growth = dvi__trace(2, H) + dvi__higher_volume(2, H);
  if (m->law == DVI_ELASTIC_LINEAR) return m->lambda * dvi__trace(2, H);
  dvi__green_strain(2, H, E);
  if (m->law == DVI_ELASTIC_SVK) return m->lambda * dvi__trace(2, E) / (1 + growth);
  return ((m->lambda - 2 * m->mooney) * log1p(growth) + 2 * m->mooney * dvi__trace(2, E)) /
         (1 + growth);
}

/* von Mises' stress, of sigma [9] row by row. */
static double equivalent(const double *sigma)
{
  const double x = sigma[0] - sigma[4], y = sigma[4] - sigma[8], z = sigma[8] - sigma[0],
               shear = sigma[1] * sigma[1] + sigma[2] * sigma[2] + sigma[5] * sigma[5];
  return sqrt((x * x + y * y + z * z) / 2 + 3 * shear);
}

static dvi_status find_von_mises(const dvi_elastic *e, int64_t cell, const double *u,
                                 double *stress)
{
  double sigma[9] = {0}, H[DVI__SOLID_ENTRIES];
  const dvi__solid_material *material = e->materials + e->material[cell];
  if (e->n == 2 && material->law == DVI_ELASTIC_ENERGY)
    return dvi__fail(DVI_UNSUPPORTED, "elastic: an energy that is given in a plane does not tell "
                                      "the stress across it, and so not von Mises' stress");
  DVI_TRY(find_stress(e, cell, u, H, sigma));
  if (e->n == 2) {
    sigma[4] = sigma[3];
    sigma[3] = sigma[2];
    sigma[2] = 0;
    sigma[8] = stress_across(material, H);
  }
  *stress = equivalent(sigma);
  return DVI_OK;
}

dvi_status dvi_elastic_von_mises(const dvi_elastic *elastic, int64_t count, const int *cell,
                                 const double *u, double *stress)
{
  DVI_TRY(check_stress(elastic, count, cell, u, stress));
  if (cell == NULL) count = elastic->cells;
  for (int64_t i = 0; i < count; i++)
    DVI_TRY(find_von_mises(elastic, cell != NULL ? cell[i] : i, u, stress + i));
  return DVI_OK;
}
