/* A pendulum for a thousand time units: declare the potential, take steps, watch the energy. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

static int value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -cos(q[0]);
  return 0;
}

static int gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = sin(q[0]);
  return 0;
}

static int observe(dvi_integrator *integrator, void *user)
{
  double energy;
  if (dvi_integrator_invariants(integrator, &energy) != DVI_OK) return -1;
  dvi_drift_add((dvi_drift *)user, dvi_integrator_time(integrator), energy);
  return 0;
}

int main(void)
{
  const dvi_potential gravity = {.name = "gravity", .value = value, .gradient = gradient};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = &gravity, .potential_count = 1};
  const double q = 1.2, p = 0;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_drift energy;
  dvi_drift_fit fit = {.largest = HUGE_VAL};
  const dvi_run_options options = {.h = 0.1, .t_end = 1000, .observe = observe, .user = &energy};
  dvi_drift_init(&energy);
  dvi_status status = dvi_system_create(&terms, &system);
  if (status == DVI_OK) status = dvi_integrator_create(system, "galerkin:degree=2", &integrator);
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0, &q, &p);
  if (status == DVI_OK) status = dvi_run(integrator, &options, NULL);
  if (status == DVI_OK) {
    dvi_drift_result(&energy, &fit);
    printf("t = %g: q = %.10f, energy error %.1e\n", dvi_integrator_time(integrator),
           dvi_integrator_q(integrator)[0], fit.largest);
  } else {
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  }
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return fit.largest < 1e-6 ? 0 : 1; /* order 4 in h = 0.1, and no drift */
}
