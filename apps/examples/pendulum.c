/* A pendulum for a thousand time units: declare the potential, record a run, look at the energy. */
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

int main(void)
{
  const dvi_potential gravity = {.name = "gravity", .value = value, .gradient = gradient};
  const dvi_system_terms terms = {
      .dimension = 1, .mass = {.scalar = 1}, .potentials = &gravity, .potential_count = 1};
  const dvi_run_options run = {.h = 0.1, .t_end = 1000};
  const dvi_record_options kept = {.size = sizeof kept,
                                   .parts = DVI_RECORD_Q | DVI_RECORD_INVARIANTS};
  const double q = 1.2, p = 0;
  double error = HUGE_VAL;
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_recording *rows = NULL;
  dvi_status status = dvi_system_create(&terms, &system);
  if (status == DVI_OK) status = dvi_integrator_create(system, "galerkin:degree=2", &integrator);
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0, &q, &p);
  if (status == DVI_OK) status = dvi_record(integrator, &run, &kept, &rows);
  if (status == DVI_OK) {
    const double *angle = dvi_recording_part(rows, DVI_RECORD_Q, NULL);
    const double *energy = dvi_recording_part(rows, DVI_RECORD_INVARIANTS, NULL);
    const int64_t last = dvi_recording_rows(rows) - 1;
    error = 0;
    for (int64_t k = 0; k <= last; k++) error = fmax(error, fabs(energy[k] - energy[0]));
    printf("q(1000) = %.10f, energy error %.1e at most\n", angle[last], error);
  } else {
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  }
  dvi_recording_destroy(&rows);
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return error < 1e-6 ? 0 : 1; /* order 4 in h = 0.1, and no drift */
}
