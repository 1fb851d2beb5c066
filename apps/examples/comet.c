/* A comet of eccentricity 0.99 in a time that runs with its distance from the sun. The equal steps
 * of that time, a hundred in an orbit, are short at the perihelion. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

static const double eccentricity = 0.99, period = 6.283185307179586;

static int comet_potential(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -1 / hypot(q[0], q[1]);
  return 0;
}

static int comet_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  const double r = hypot(q[0], q[1]), cubed = r * r * r;
  V_q[0] = q[0] / cubed;
  V_q[1] = q[1] / cubed;
  return 0;
}

/* Half the time derivative of r^2, negative while the distance falls. */
static int comet_radial_motion(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)user;
  *g = q[0] * v[0] + q[1] * v[1];
  return 0;
}

/* Print a passage. From the aphelion, the k-th perihelion is at (k + 1/2) periods. */
static int comet_perihelion(double t, const double *q, const double *v, void *user)
{
  int *passages = (int *)user;
  (void)v;
  printf("perihelion %3d at t = %.9f, error %8.1e, r = %.12f\n", *passages, t,
         t - (*passages + 0.5) * period, hypot(q[0], q[1]));
  ++*passages;
  return 0;
}

static dvi_status comet_run(dvi_integrator *integrator, int count, dvi_run_report *report)
{
  int passages = 0;
  const double q[] = {1 + eccentricity, 0},
               p[] = {0, sqrt((1 - eccentricity) / (1 + eccentricity))};
  const dvi_event event = {.name = "perihelion",
                           .value = comet_radial_motion,
                           .direction = +1,
                           .occurred = comet_perihelion,
                           .user = &passages};
  const dvi_run_options options = {
      .h = 0.1, .t_end = count * period, .events = &event, .event_count = 1};
  const dvi_status status = dvi_integrator_start(integrator, 0, q, p);
  return status == DVI_OK ? dvi_run(integrator, &options, report) : status;
}

int main(void)
{
  const dvi_potential gravity = {
      .name = "gravity", .value = comet_potential, .gradient = comet_gradient};
  const dvi_system_terms terms = {.dimension = 2,
                                  .mass = {.scalar = 1},
                                  .potentials = &gravity,
                                  .potential_count = 1,
                                  .autonomous = 1};
  const dvi_monitor distance = {.kind = DVI_MONITOR_DISTANCE, .power = 1.5}; /* dt = r^1.5 dtau */
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  dvi_run_report report = {.end = DVI_RUN_FAILED};
  double energy = 0;
  dvi_status status = dvi_system_create(&terms, &system);
  const dvi_integrator_options options = {.size = sizeof options,
                                          .method = "galerkin:degree=4",
                                          .pacing = DVI_TIME_TRANSFORM,
                                          .monitor = &distance};
  if (status == DVI_OK) status = dvi_integrator_create_with(system, &options, &integrator);
  if (status == DVI_OK) status = comet_run(integrator, 5, &report);
  if (status == DVI_OK) status = dvi_integrator_invariants(integrator, &energy);
  if (status == DVI_OK)
    printf("%ld steps, t_end missed by %.0e, energy error %.1e\n", report.steps,
           fabs(dvi_integrator_time(integrator) - 5 * period), fabs(energy + 0.5));
  else
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  return status == DVI_OK && report.events == 5 && fabs(energy + 0.5) < 1e-10 ? 0 : 1;
}
