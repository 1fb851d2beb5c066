/* A drum: its shape under a load, its lowest frequencies, and its motion after it is let go. */
#include <dvi/dvi.h>
#include <stdio.h>
#include <stdlib.h>

static int load(const double *x, double *f, void *user)
{
  (void)x, (void)user;
  *f = 1;
  return 0;
}

static dvi_status play(dvi_field *drum, const double *u)
{
  double omega, energy, *q = NULL, *p = NULL;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_status status = dvi_field_system(drum, &system);
  const size_t n = (size_t)dvi_system_nq(system);
  if (!status) status = dvi_field_fastest(drum, &omega);
  q = (double *)calloc(2 * n + 1, sizeof *q);
  if (!status && q == NULL) status = DVI_NO_MEMORY;
  if (q != NULL) p = q + n;
  if (!status) status = dvi_field_project(drum, u, NULL, q, p);
  for (size_t i = 0; i < n && !status; i++) q[i] *= 3; /* let go from three times the depth */
  if (!status) status = dvi_integrator_create(system, "verlet", &integrator);
  if (!status) status = dvi_integrator_start(integrator, 0, q, p);
  for (int i = 0; i < 1000 && !status; i++) status = dvi_integrator_step(integrator, 1.5 / omega);
  if (!status) status = dvi_integrator_invariant(integrator, 0, &energy);
  if (!status) printf("t = %g, energy %.6f\n", dvi_integrator_time(integrator), energy);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  free(q);
  return status;
}

int main(void)
{
  const dvi_condition rim = {.part = "boundary", .kind = DVI_FIXED};
  double eigenvalue[4], *u = NULL;
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  dvi_field *drum = NULL;
  dvi_status status = dvi_mesh_generate("staggered", NULL, &mesh);
  if (!status) status = dvi_star_create(mesh, NULL, &star);
  const dvi_wave_terms terms = {
      .size = sizeof terms, .star = star, .condition = &rim, .conditions = 1, .source = load};
  const dvi_modes_options four = {.size = sizeof four, .count = 4};
  if (!status) status = dvi_wave_create(&terms, &drum);
  if (!status) status = dvi_field_modes(drum, &four, eigenvalue, NULL, NULL);
  for (int i = 0; i < 4 && !status; i++) printf("lambda %.9f\n", eigenvalue[i]);
  u = (double *)calloc((size_t)dvi_mesh_count(mesh, 0) + 1, sizeof *u);
  if (!status && u == NULL) status = DVI_NO_MEMORY;
  if (!status) status = dvi_field_solve(drum, NULL, u, NULL);
  if (!status) status = play(drum, u);
  if (status) fprintf(stderr, "%s\n", dvi_last_error());
  free(u);
  dvi_field_destroy(&drum);
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return status != 0;
}
