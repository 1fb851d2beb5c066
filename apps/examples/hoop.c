/* A bead on a hoop that turns freely, as a Lagrangian whose mass depends on the coordinates.
 *
 *     L = v1^2/2 + (J + sin^2 q1) v2^2/2 + cos q1,
 *     q1 the bead's angle from below, q2 the hoop's turn.
 *
 * The program checks the derivatives, the Legendre map, a momentum map and the reversed motion. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

static const double J = 0.5;

static int hoop_lagrangian(double t, const double *q, const double *v, double *L, void *user)
{
  (void)t, (void)user;
  const double s = sin(q[0]);
  *L = 0.5 * v[0] * v[0] + 0.5 * (J + s * s) * v[1] * v[1] + cos(q[0]);
  return 0;
}

static int hoop_gradient(double t, const double *q, const double *v, double *L_q, double *L_v,
                         void *user)
{
  (void)t, (void)user;
  const double s = sin(q[0]);
  L_q[0] = s * cos(q[0]) * v[1] * v[1] - s;
  L_q[1] = 0;
  L_v[0] = v[0];
  L_v[1] = (J + s * s) * v[1];
  return 0;
}

/* Turning the hoop is a symmetry. Its momentum map is the angular momentum about the vertical. */
static int hoop_rotation(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  xi[0] = 0;
  xi[1] = 1;
  return 0;
}

static dvi_status hoop_system(dvi_system **system)
{
  /* the Hessian is computed by differences */
  const dvi_lagrangian lagrangian = {.value = hoop_lagrangian, .gradient = hoop_gradient};
  const dvi_symmetry symmetry = {.name = "angular_momentum", .generator = hoop_rotation};
  const dvi_system_terms terms = {
      .dimension = 2, .lagrangian = &lagrangian, .symmetries = &symmetry, .symmetry_count = 1};
  return dvi_system_create(&terms, system);
}

/* Largest errors of the energy and of the angular momentum along the run, and of the state after
 * the way back. */
typedef struct hoop_errors {
  double energy, momentum, way_back;
} hoop_errors;

static dvi_status hoop_run(const dvi_system *system, const double *q, const double *p,
                           hoop_errors *found)
{
  const double h = 0.1;
  double first[2] = {0}, now[2] = {0};
  dvi_integrator *integrator = NULL;
  dvi_status status = dvi_integrator_create(system, "galerkin:degree=3", &integrator);
  if (status == DVI_OK) status = dvi_integrator_start(integrator, 0, q, p);
  if (status == DVI_OK) status = dvi_integrator_invariants(integrator, first);
  for (int step = 0; status == DVI_OK && step < 1000; step++) {
    status = dvi_integrator_step(integrator, h);
    if (status == DVI_OK) status = dvi_integrator_invariants(integrator, now);
    found->energy = fmax(found->energy, fabs(now[0] - first[0]));
    found->momentum = fmax(found->momentum, fabs(now[1] - first[1]));
  }
  if (status == DVI_OK) status = dvi_reversibility(integrator, 0, q, p, h, 100, &found->way_back);
  dvi_integrator_destroy(&integrator);
  return status;
}

int main(void)
{
  const double q[] = {1, 0}, v[] = {0.2, 1.5};
  double p[2], again[2] = {0, 0};
  hoop_errors found = {0};
  dvi_system *system = NULL;
  dvi_status status = hoop_system(&system);
  if (status == DVI_OK) status = dvi_system_check(system, 0, q, v, 0, NULL);
  if (status == DVI_OK) status = dvi_system_momentum(system, 0, q, v, p);
  if (status == DVI_OK) status = dvi_system_velocity(system, 0, q, p, again);
  if (status == DVI_OK) status = hoop_run(system, q, p, &found);
  dvi_system_destroy(&system);
  if (status != DVI_OK) {
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
    return 1;
  }
  const double map = fmax(fabs(again[0] - v[0]), fabs(again[1] - v[1]));
  printf("Legendre map there and back %.1e\nenergy error %.1e, angular momentum error %.1e\nway "
         "back %.1e\n",
         map, found.energy, found.momentum, found.way_back);
  /* The bounds are roundoff, except for the energy, which has order 6 in h = 0.1. */
  return map < 1e-14 && found.energy < 1e-6 && found.momentum < 1e-12 && found.way_back < 1e-11 ? 0
                                                                                                : 1;
}
