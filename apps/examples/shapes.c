/* Two modes of frequency 1 that exchange their energy (Henon and Heiles): paths of polynomials, and
 * paths of waves, in steps of up to a whole period.
 *
 *     L = v.v/2 - q.q/2 - (q1^2 q2 - q2^3/3)
 *
 * A function space of one's own, its error beside that of as many polynomials, and what every such
 * space keeps. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

static int value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = 0.5 * (q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] - q[1] * q[1] * q[1] / 3;
  return 0;
}

static int gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  V_q[0] = q[0] + 2 * q[0] * q[1];
  V_q[1] = q[1] + q[0] * q[0] - q[1] * q[1];
  return 0;
}

/* Waves of the frequency of the modes, and of twice that, which their squares have: sin and cos of
 * k h tau, tau from 0 to 1 over a step of length h. */
static int waves(double h, double tau, double *value, double *derivative, void *user)
{
  (void)user;
  for (int k = 1; k <= 2; k++, value += 2, derivative += 2) {
    value[0] = sin(k * h * tau);
    value[1] = cos(k * h * tau);
    derivative[0] = k * h * cos(k * h * tau);
    derivative[1] = -k * h * sin(k * h * tau);
  }
  return 0;
}

enum { LENGTH = 60 };
static const double q_start[] = {0.1, 0}, p_start[] = {0, 0.05};

/* The state after so many steps. */
static dvi_status arrive(dvi_integrator *integrator, int steps, double *q)
{
  dvi_status status = dvi_integrator_start(integrator, 0, q_start, p_start);
  for (int i = 0; status == DVI_OK && i < steps; i++)
    status = dvi_integrator_step(integrator, (double)LENGTH / steps);
  for (int i = 0; status == DVI_OK && i < 2; i++) q[i] = dvi_integrator_q(integrator)[i];
  return status;
}

/* Errors for four lengths of steps, and the last one. */
static dvi_status compare(dvi_integrator *integrator, const double *exact, double *error)
{
  dvi_status status = DVI_OK;
  printf("%s\n", dvi_integrator_method(integrator));
  for (int steps = 10; status == DVI_OK && steps <= 80; steps *= 2) {
    double q[2] = {0, 0};
    status = arrive(integrator, steps, q);
    *error = hypot(q[0] - exact[0], q[1] - exact[1]);
    if (status == DVI_OK) printf("  h = %-4g error %.1e\n", (double)LENGTH / steps, *error);
  }
  return status;
}

typedef struct findings {
  double exact[2], polynomials, waves, symplectic, way_back;
} findings;

static dvi_status study(const dvi_system *system, findings *found)
{
  const dvi_shapes shapes = {.name = "waves", .functions = 4, .evaluate = waves, .h = 1};
  dvi_integrator *judge = NULL, *polynomials = NULL, *own = NULL;
  dvi_status status = dvi_integrator_create(system, "galerkin:degree=10", &judge);
  if (status == DVI_OK)
    status = dvi_integrator_create(system, "galerkin:degree=5,nodes=16", &polynomials);
  const dvi_integrator_options options = {
      .size = sizeof options, .method = "shaped-galerkin:nodes=16", .shapes = &shapes};
  if (status == DVI_OK) status = dvi_integrator_create_with(system, &options, &own);
  if (status == DVI_OK) status = arrive(judge, 240, found->exact);
  if (status == DVI_OK) status = compare(polynomials, found->exact, &found->polynomials);
  if (status == DVI_OK) status = compare(own, found->exact, &found->waves);
  if (status == DVI_OK) status = dvi_symplecticity(own, 0, q_start, p_start, 2, &found->symplectic);
  if (status == DVI_OK)
    status = dvi_reversibility(own, 0, q_start, p_start, 2, 100, &found->way_back);
  dvi_integrator_destroy(&judge);
  dvi_integrator_destroy(&polynomials);
  dvi_integrator_destroy(&own);
  return status;
}

int main(void)
{
  const dvi_potential modes = {.name = "modes", .value = value, .gradient = gradient};
  const dvi_system_terms terms = {
      .dimension = 2, .mass = {.scalar = 1}, .potentials = &modes, .potential_count = 1};
  dvi_system *system = NULL;
  findings found = {.exact = {0}};
  dvi_status status = dvi_system_create(&terms, &system);
  if (status == DVI_OK) status = study(system, &found);
  dvi_system_destroy(&system);
  if (status != DVI_OK) {
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
    return 1;
  }
  printf("not symplectic by %.1e, way back %.1e\n", found.symplectic, found.way_back);
  return found.waves < found.polynomials && found.symplectic < 1e-11 && found.way_back < 1e-11 ? 0
                                                                                               : 1;
}
