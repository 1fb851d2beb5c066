/* Deficits of hinges, and Gauss and Bonnet's theorem. */
#include <dvi/curvature.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

static dvi_mesh *generated(const char *name, int first, int second, int third)
{
  const dvi_generator_options options = {.size = sizeof options, .cells = {first, second, third}};
  dvi_mesh *mesh = NULL;
  ck_assert_msg(dvi_mesh_generate(name, &options, &mesh) == DVI_OK, "%s", dvi_last_error());
  return mesh;
}

static const struct {
  const char *name;
  int cells[3];
  int euler;
} surfaces[] = {
    {"icosphere", {1}, 2}, {"icosphere", {3}, 2}, {"torus", {24, 12}, 0},
    {"genus-2", {2}, -2},  {"disk", {5}, 1},      {"annulus", {4, 24}, 0},
};

START_TEST(deficits_and_turning_sum_to_two_pi_chi)
{
  dvi_gauss_bonnet report;
  dvi_mesh *mesh = generated(surfaces[_i].name, surfaces[_i].cells[0], surfaces[_i].cells[1], 0);
  ck_assert_msg(dvi_gauss_bonnet_of(mesh, NULL, &report) == DVI_OK, "%s", dvi_last_error());
  printf("%s %g\n", surfaces[_i].name, report.difference);
  ck_assert_int_eq(report.euler, surfaces[_i].euler);
  ck_assert_double_le(fabs(report.difference), 1e-14);
  dvi_mesh_destroy(&mesh);
}
END_TEST

#define COUNT(table) (int)(sizeof(table) / sizeof *(table))

SUITE(deficit)
{
  tcase_add_loop_test(tests, deficits_and_turning_sum_to_two_pi_chi, 0, COUNT(surfaces));
}
