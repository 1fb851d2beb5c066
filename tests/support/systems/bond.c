#include "support/systems/bond.h"

#include <check.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/systems/systems.h"

/* The gradient of a function of r^2, `slope` its derivative. */
static void along(const double *q, double slope, double *V_q)
{
  for (int i = 0; i < 2; i++) {
    V_q[i] = 2 * slope * (q[i] - q[i + 2]);
    V_q[i + 2] = -V_q[i];
  }
}

static double square(const double *q)
{
  return (q[0] - q[2]) * (q[0] - q[2]) + (q[1] - q[3]) * (q[1] - q[3]);
}

static int stiff(double t, const double *q, double *V, void *user)
{
  const bond *own = user;
  const double s = square(q);
  (void)t;
  *V = own->stiffness * (s / 2 + own->bend * s * s / 4);
  return 0;
}

static int stiff_gradient(double t, const double *q, double *V_q, void *user)
{
  const bond *own = user;
  (void)t;
  along(q, own->stiffness * (1 + own->bend * square(q)) / 2, V_q);
  return 0;
}

static int attraction(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -1 / sqrt(1 + square(q));
  return 0;
}

static int attraction_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  along(q, pow(1 + square(q), -1.5) / 2, V_q);
  return 0;
}

static int shift(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  memcpy(xi, (const double[]){1, -2, 1, -2}, 4 * sizeof(double));
  return 0;
}

static int turn(const double *q, double *xi, void *user)
{
  (void)user;
  memcpy(xi, (const double[]){-q[1], q[0], -q[3], q[2]}, 4 * sizeof(double));
  return 0;
}

void make_bond(double stiffness, double bend, bond *made)
{
  static const double mass[] = {1, 1, 2, 2};
  const dvi_symmetry symmetries[] = {{.name = "momentum", .generator = shift},
                                     {.name = "angular", .generator = turn}};
  const dvi_potential potentials[] = {
      {.name = "bond",
       .value = stiff,
       .gradient = stiff_gradient,
       .user = made,
       .fast = 1,
       .quadratic = bend == 0},
      {.name = "attraction", .value = attraction, .gradient = attraction_gradient}};
  *made = (bond){.stiffness = stiffness,
                 .bend = bend,
                 .q = {0.6, 0.1, -0.3, -0.2},
                 .p = {0.4, -0.7, 0.3, 0.9}};
  made->system = make_system(&(dvi_system_terms){.dimension = 4,
                                                 .mass.diagonal = mass,
                                                 .potentials = potentials,
                                                 .potential_count = 2,
                                                 .symmetries = symmetries,
                                                 .symmetry_count = 2,
                                                 .autonomous = 1});
}

void destroy_bond(bond *made)
{
  dvi_system_destroy(&made->system);
}

dvi_integrator *bond_integrator(const bond *of, const char *method)
{
  dvi_integrator *made = made_integrator(of->system, method);
  ck_assert_msg(dvi_integrator_start(made, 0, of->q, of->p) == DVI_OK, "%s", dvi_last_error());
  return made;
}
