/* An arm of two bodies swings under its weight, on hinges at the shoulder and at the elbow. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>

enum { BODIES = 2, NQ = 12 * BODIES, NV = 6 * BODIES, ROWS = 10 };

static const double weight = 9.81;

/* The heights of the bodies' centres are q[11] and q[23]. */
static int value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = weight * (q[11] + q[23]);
  return 0;
}

static int gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)q, (void)user;
  for (int i = 0; i < NQ; i++) V_q[i] = i % 12 == 11 ? weight : 0;
  return 0;
}

static int follow(const dvi_system *system, const double *q, const double *p)
{
  dvi_integrator *arm = NULL;
  double first = 0, last = 1, off = 1;
  const dvi_run_options options = {.h = 0.02, .t_end = 100};
  dvi_status status = dvi_integrator_create(system, "lie-galerkin:degree=3", &arm);
  if (status == DVI_OK) status = dvi_integrator_start(arm, 0, q, p);
  if (status == DVI_OK) status = dvi_integrator_invariant(arm, 0, &first);
  if (status == DVI_OK) status = dvi_run(arm, &options, NULL);
  if (status == DVI_OK) status = dvi_integrator_invariant(arm, 0, &last);
  if (status == DVI_OK) status = dvi_integrator_constraint(arm, &off);
  double lambda[ROWS] = {0};
  if (status == DVI_OK) status = dvi_integrator_reactions(arm, lambda);
  if (status == DVI_OK)
    printf("t = %g: joints hold to 1e-14: %s, energy to 1e-4: %s; the shoulder pulls with %.4f N\n",
           dvi_integrator_time(arm), off < 1e-14 ? "yes" : "no",
           fabs(last - first) < 1e-4 ? "yes" : "no",
           sqrt(lambda[0] * lambda[0] + lambda[1] * lambda[1] + lambda[2] * lambda[2]));
  else
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  dvi_integrator_destroy(&arm);
  return off < 1e-14 && fabs(last - first) < 1e-4;
}

int main(void)
{
  const double inertia[] = {0.02, 0, 0, 0, 0.1, 0, 0, 0, 0.1};
  const dvi_factor bodies[BODIES] = {{.kind = DVI_SE3, .mass = 1, .inertia = inertia},
                                     {.kind = DVI_SE3, .mass = 1, .inertia = inertia}};
  /* The arm is assembled along the x axis. */
  const double q[NQ] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1.5, 0, 0};
  const double p[NV] = {0};
  const dvi_joint hinges[BODIES] = {
      {.name = "shoulder", .kind = DVI_HINGE, .body = {DVI_GROUND, 0}, .axis = {0, 1, 0}},
      {.name = "elbow", .kind = DVI_HINGE, .body = {0, 1}, .at = {1, 0, 0}, .axis = {0, 0.8, 0.6}}};
  const dvi_potential gravity = {.name = "gravity", .value = value, .gradient = gradient};
  dvi_joints *joints = NULL;
  dvi_system *system = NULL;
  dvi_status status = dvi_joints_create(bodies, BODIES, hinges, BODIES, q, &joints);
  const dvi_system_terms terms = {.potentials = &gravity,
                                  .potential_count = 1,
                                  .autonomous = 1,
                                  .factors = bodies,
                                  .factor_count = BODIES,
                                  .holonomics = dvi_joints_constraints(joints),
                                  .holonomic_count = 1};
  int good = 0;
  if (status == DVI_OK) status = dvi_system_create(&terms, &system);
  if (status == DVI_OK)
    good = follow(system, q, p);
  else
    fprintf(stderr, "%s: %s\n", dvi_status_name(status), dvi_last_error());
  dvi_system_destroy(&system);
  dvi_joints_destroy(&joints);
  return good ? 0 : 1;
}
