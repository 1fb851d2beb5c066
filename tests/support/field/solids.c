#include "support/field/solids.h"

#include <stdlib.h>

#include "support/field/generated.h"
#include "support/suite.h"

dvi_elastic_material unit_material(dvi_elastic_law law)
{
  return (dvi_elastic_material){.part = "all",
                                .law = law,
                                .lambda = 1,
                                .mu = 1,
                                .rho = 1,
                                .mooney = law == DVI_ELASTIC_MOONEY_RIVLIN ? 0.3 : 0};
}

dvi_elastic *solid_on(dvi_mesh *mesh, dvi_elastic_material material, dvi_elastic_terms terms)
{
  dvi_elastic *solid = NULL;
  terms.size = sizeof terms;
  terms.mesh = mesh;
  terms.material = &material;
  terms.materials = 1;
  ck_assert_msg(dvi_elastic_create(&terms, &solid) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  return solid;
}

dvi_elastic *block(int dimension, int cells, double grading, dvi_elastic_law law)
{
  const dvi_generator_options options = {.cells = {cells, cells, dimension == 3 ? cells : 0},
                                         .grading = {grading}};
  return solid_on(generated("kuhn", options), unit_material(law), (dvi_elastic_terms){.size = 0});
}

void spin_block(const dvi_elastic *solid, double scale, double *rate)
{
  const dvi_mesh *mesh = dvi_elastic_mesh(solid);
  const double *X = dvi_mesh_points(mesh);
  const int n = dvi_mesh_dimension(mesh);
  for (int64_t a = 0; a < dvi_mesh_count(mesh, 0); a++, X += n, rate += n) {
    rate[0] = scale * 0.2 * X[1];
    rate[1] = n == 3 ? scale * -0.1 * X[2] : scale * 0.15 * X[0] * X[1];
    if (n == 3) rate[2] = scale * 0.15 * X[0] * X[2];
  }
}

dvi_system *system_of_solid(dvi_elastic *solid)
{
  dvi_system *system = NULL;
  ck_assert_msg(dvi_elastic_system(solid, &system) == DVI_OK, "%s", dvi_last_error());
  return system;
}

dvi_integrator *start_solid(const dvi_elastic *solid, const dvi_system *system, const char *method,
                            const double *rate)
{
  const size_t unknowns = (size_t)dvi_system_nq(system);
  double *q = calloc(2 * unknowns, sizeof *q), *p = q + unknowns;
  dvi_integrator *integrator = NULL;
  dvi_elastic_project(solid, NULL, rate, q, NULL, p);
  ck_assert_msg(dvi_integrator_create(system, method, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  free(q);
  return integrator;
}

dvi_march *march_of_solid(const dvi_elastic *solid, const char *method, double fraction)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction};
  dvi_march *march = NULL;
  ck_assert_msg(dvi_elastic_march_create(solid, &options, &march) == DVI_OK, "%s",
                dvi_last_error());
  return march;
}

void start_march_of_solid(dvi_march *march, const double *u, const double *rate)
{
  const int64_t numbers = dvi_march_size(march, DVI_FORM_E);
  double *E = calloc((size_t)numbers, sizeof *E);
  for (int64_t i = 0; i < numbers && rate != NULL; i++) E[i] = -rate[i];
  const dvi_march_state state = {.size = sizeof state, .A = u, .E = E};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
  free(E);
}
