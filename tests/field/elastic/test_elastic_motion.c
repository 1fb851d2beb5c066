/* Elastic solids as mechanical systems in motion. */
#include <dvi/reference.h>
#include <math.h>
#include <stdlib.h>

#include "support/field/solids.h"
#include "support/suite.h"

static void advance(dvi_integrator *integrator, double h, int steps)
{
  for (int i = 0; i < steps; i++)
    ck_assert_msg(dvi_integrator_step(integrator, h) == DVI_OK, "%s", dvi_last_error());
}

/* ---- the free block of 2^3 cells, graded by 2 along x ---- */

/* The positions of the corner (1,1,1), the last node, at t = 1, by an independent program. */
typedef struct corner {
  dvi_elastic_law law;
  double x[3];
} corner;

static const corner corners[] = {
    {DVI_ELASTIC_SVK, {1.120541854504, 0.880670758168, 1.078836923111}},
    {DVI_ELASTIC_NEO_HOOKEAN, {1.121240896990, 0.880808459494, 1.079014224797}}};
enum { CORNERS = sizeof corners / sizeof *corners, NODES = 27 };

static void check_corner(const corner *c, const double *q)
{
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(1 + q[3 * NODES - 3 + i], c->x[i], 1e-12);
}

START_TEST(galerkin_has_the_digits_of_the_free_block)
{
  const corner *c = corners + _i;
  double rate[3 * NODES];
  dvi_elastic *solid = block(3, 2, 2, c->law);
  dvi_system *system = system_of_solid(solid);
  spin_block(solid, 1, rate);
  dvi_integrator *integrator = start_solid(solid, system, "galerkin:degree=4", rate);
  advance(integrator, 0.02, 50);
  check_corner(c, dvi_integrator_q(integrator));
  dvi_integrator_destroy(&integrator);
  dvi_system_destroy(&system);
  dvi_elastic_destroy(&solid);
}
END_TEST

SUITE(elastic_motion)
{
  tcase_add_loop_test(tests, galerkin_has_the_digits_of_the_free_block, 0, CORNERS);
}
