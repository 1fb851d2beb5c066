/* Kepler's orbit by its apsides. The times when the distance is least or largest are located as
 * events, and give the period. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

static const double eccentricity = 0.6, period = 6.283185307179586;

static int apsides_potential(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -1 / hypot(q[0], q[1]);
  return 0;
}

static int apsides_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  const double r = hypot(q[0], q[1]), cubed = r * r * r;
  V_q[0] = q[0] / cubed;
  V_q[1] = q[1] / cubed;
  return 0;
}

/* Half the time derivative of r^2, negative while the distance falls. */
static int apsides_radial_motion(double t, const double *q, const double *v, double *g, void *user)
{
  (void)t, (void)user;
  *g = q[0] * v[0] + q[1] * v[1];
  return 0;
}

typedef struct passages {
  int count;
  double last, worst; /* time of the last passage, and largest error of a period */
} passages;

static int apsides_passed(double t, const double *q, const double *v, void *user)
{
  passages *seen = (passages *)user;
  (void)v;
  const double expected = seen->count == 0 ? period / 2 : seen->last + period;
  seen->worst = fmax(seen->worst, fabs(t - expected));
  printf("pericentre %d at t = %.12f, r = %.12f, error of the period %.1e\n", ++seen->count, t,
         hypot(q[0], q[1]), t - expected);
  seen->last = t;
  return 0;
}

static dvi_status apsides_orbit(dvi_integrator *integrator, passages *seen)
{
  /* start at the apocentre */
  const double q[] = {1 + eccentricity, 0},
               p[] = {0, sqrt((1 - eccentricity) / (1 + eccentricity))};
  const dvi_event event = {.name = "pericentre",
                           .value = apsides_radial_motion,
                           .direction = +1,
                           .occurred = apsides_passed,
                           .user = seen};
  const dvi_run_options options = {
      .h = 0.05, .t_end = 5 * period, .events = &event, .event_count = 1};
  const dvi_status status = dvi_integrator_start(integrator, 0, q, p);
  return status == DVI_OK ? dvi_run(integrator, &options, NULL) : status;
}

int main(void)
{
  const dvi_potential gravity = {
      .name = "gravity", .value = apsides_potential, .gradient = apsides_gradient};
  const dvi_system_terms terms = {
      .dimension = 2, .mass = {.scalar = 1}, .potentials = &gravity, .potential_count = 1};
  dvi_system *system = NULL;
  dvi_integrator *integrator = NULL;
  passages seen = {0};
  dvi_status status = dvi_system_create(&terms, &system);
  if (status == DVI_OK) status = dvi_integrator_create(system, "galerkin:degree=10", &integrator);
  if (status == DVI_OK) status = apsides_orbit(integrator, &seen);
  if (status != DVI_OK) fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  /* Five passages. An event is right to a few roundings of its time, about 30, and a period is the
   * difference of two. */
  return status == DVI_OK && seen.count == 5 && seen.worst < 6e-11 ? 0 : 1;
}
