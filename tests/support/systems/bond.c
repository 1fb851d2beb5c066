#include "support/systems/bond.h"

#include <check.h>
#include <math.h>
#include <string.h>

#include "support/runs.h"
#include "support/systems/systems.h"

/* Gives the gradient of a function of r^2 with the derivative `slope`. */
static void radial_gradient(const double *q, double slope, double *V_q)
{
  for (int i = 0; i < 2; i++) {
    V_q[i] = 2 * slope * (q[i] - q[i + 2]);
    V_q[i + 2] = -V_q[i];
  }
}

static double distance_squared(const double *q)
{
  return (q[0] - q[2]) * (q[0] - q[2]) + (q[1] - q[3]) * (q[1] - q[3]);
}

static int stiff_value(double t, const double *q, double *V, void *user)
{
  const bond *own = user;
  const double s = distance_squared(q);
  (void)t;
  *V = own->stiffness * (s / 2 + own->bend * s * s / 4);
  return 0;
}

static int stiff_gradient(double t, const double *q, double *V_q, void *user)
{
  const bond *own = user;
  (void)t;
  radial_gradient(q, own->stiffness * (1 + own->bend * distance_squared(q)) / 2, V_q);
  return 0;
}

static int attraction_value(double t, const double *q, double *V, void *user)
{
  (void)t, (void)user;
  *V = -1 / sqrt(1 + distance_squared(q));
  return 0;
}

static int attraction_gradient(double t, const double *q, double *V_q, void *user)
{
  (void)t, (void)user;
  radial_gradient(q, pow(1 + distance_squared(q), -1.5) / 2, V_q);
  return 0;
}

static int generate_shift(const double *q, double *xi, void *user)
{
  (void)q, (void)user;
  memcpy(xi, (const double[]){1, -2, 1, -2}, 4 * sizeof(double));
  return 0;
}

static int generate_turn(const double *q, double *xi, void *user)
{
  (void)user;
  memcpy(xi, (const double[]){-q[1], q[0], -q[3], q[2]}, 4 * sizeof(double));
  return 0;
}

void make_bond(double stiffness, double bend, bond *made)
{
  static const double mass[] = {1, 1, 2, 2};
  const dvi_symmetry symmetries[] = {{.name = "momentum", .generator = generate_shift},
                                     {.name = "angular", .generator = generate_turn}};
  const dvi_potential potentials[] = {
      {.name = "bond",
       .value = stiff_value,
       .gradient = stiff_gradient,
       .user = made,
       .fast = 1,
       .quadratic = bend == 0},
      {.name = "attraction", .value = attraction_value, .gradient = attraction_gradient}};
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

dvi_integrator *bond_integrator(const bond *pair, const char *method)
{
  dvi_integrator *made = create_integrator(pair->system, method);
  ck_assert_msg(dvi_integrator_start(made, 0, pair->q, pair->p) == DVI_OK, "%s", dvi_last_error());
  return made;
}
