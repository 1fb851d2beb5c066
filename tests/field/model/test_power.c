/* The balance of energy of electromagnetic fields: what flows through a surface, what a dipole
 * takes, and what walls and conductors take, is missing in the field. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/field/electric.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;
static const dvi_wall conductor = {.part = "boundary", .kind = DVI_PEC},
                      open = {.part = "boundary", .kind = DVI_ABSORBING};

/* ---- the flux through a surface ---- */

static int is_left_below(const double *x)
{
  return x[0] < 0.5 && x[1] < 0.5;
}

static int swirl(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = sin(pi * x[1]) * (1 + x[0]);
  value[1] = sin(pi * x[0]) * cos(x[1]);
  value[2] = sin(pi * x[0]) * sin(pi * x[1]);
  return 0;
}

/* A part, and how its energy is watched. */
typedef struct region {
  const char *name, *mesh;
  int scalar, dimension;
  dvi_star_kind kind;
  const dvi_wall *wall;
  const char *part;
} region;

static dvi_field *field_of(const region *r, int n)
{
  const dvi_field_probe probe[] = {{.name = "inside", .of = "energy", .part = r->part},
                                   {.name = "out", .of = "flux", .part = r->part}};
  dvi_mesh *mesh = generated(r->mesh,
                             (dvi_generator_options){.cells = {n, n, r->dimension == 3 ? n : 0}});
  return electric(
      with_core(mesh, is_left_below), r->kind, NULL,
      (dvi_maxwell_terms){
          .scalar = r->scalar, .wall = r->wall, .walls = 1, .probe = probe, .probes = 2});
}

/* Return the part of the energy that is wrong at t = 0.3, when what has flown out by the rule of
 * trapezoids is added, and which part of it is left. */
static double missing(const region *r, int n, int steps, double *left)
{
  dvi_field *field = field_of(r, n);
  const double dt = 0.3 / steps;
  double *E = form_of(field, r->scalar ? 0 : 1, swirl);
  dvi_march *march = march_of(field, (dvi_march_options){.step = dt}, E, NULL);
  const double before = observe_march(march, "inside");
  double flown = 0, flux = observe_march(march, "out");
  for (int i = 1; i <= steps; i++) {
    advance_march(march, i * dt);
    const double next = observe_march(march, "out");
    flown += dt / 2 * (flux + next);
    flux = next;
  }
  const double after = observe_march(march, "inside");
  *left = after / before;
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  free(E);
  return fabs(after + flown - before) / before;
}

/* H is interpolated, and so is E in space. */
START_TEST(what_flows_out_of_a_part_is_missing_in_it)
{
  static const region regions[] = {
      {"boxes, across the plane", "box", 1, 2, DVI_CIRCUMCENTRIC, &conductor, "core"},
      {"boxes of space", "box", 0, 3, DVI_CIRCUMCENTRIC, &conductor, "core"},
      {"triangles", "kuhn", 0, 2, DVI_WHITNEY, &conductor, "core"},
      {"triangles, across the plane", "kuhn", 1, 2, DVI_WHITNEY, &conductor, "core"},
      {"open boxes, across the plane", "box", 1, 2, DVI_CIRCUMCENTRIC, &open, "all"},
      {"open boxes of space", "box", 0, 3, DVI_CIRCUMCENTRIC, &open, "all"},
      {"a part of open triangles", "kuhn", 0, 2, DVI_WHITNEY, &open, "core"},
  };
  for (int i = 0; i < sampled_count((int)(sizeof regions / sizeof *regions)); i++) {
    const region *r = regions + sampled_case(i);
    double error[2], left;
    for (int level = 0; level < 2; level++)
      error[level] = missing(r, (r->dimension == 3 ? 6 : 12) << level, 120, &left);
    const double order = log2(error[0] / error[1]);
    ck_assert_msg(fabs(left - 1) > 0.05, "%s: nothing has moved", r->name);
    ck_assert_msg(order > 1.8 && error[1] < 0.01, "%s: order %g of %g, %g", r->name, order,
                  error[0], error[1]);
  }
}
END_TEST

/* With an edge a facet, the flux is that of the equations, and what is wrong is the rule of
 * trapezoids alone, of second order in the step. */
START_TEST(the_flux_between_rectangles_is_exact)
{
  static const region planes[] = {
      {"between rectangles", "box", 0, 2, DVI_CIRCUMCENTRIC, &conductor, "core"},
      {"out of open rectangles", "box", 0, 2, DVI_CIRCUMCENTRIC, &open, "all"}};
  for (int i = 0; i < 2; i++) {
    double left;
    const double coarse = missing(planes + i, 12, 60, &left),
                 fine = missing(planes + i, 12, 120, &left);
    ck_assert_msg(fine < 1e-4 && fabs(log2(coarse / fine) - 2) < 0.1, "%s: %g and %g",
                  planes[i].name, coarse, fine);
  }
}
END_TEST

/* No power flows through a conductor or a magnetic wall. */
START_TEST(walls_that_reflect_let_nothing_through)
{
  static const dvi_wall magnetic = {.part = "boundary", .kind = DVI_PMC};
  for (int i = 0; i < 2; i++) {
    const region closed = {"", "box", 0, 2, DVI_CIRCUMCENTRIC, i ? &magnetic : &conductor, "all"};
    dvi_field *field = field_of(&closed, 6);
    double *E = form_of(field, 1, swirl);
    dvi_march *march = march_of(field, (dvi_march_options){.fraction = 0.5}, E, NULL);
    advance_march(march, 0.4);
    ck_assert_double_eq(observe_march(march, "out"), 0);
    dvi_march_destroy(&march);
    dvi_field_destroy(&field);
    free(E);
  }
}
END_TEST

/* ---- the work of a dipole ---- */

static int ramp(double t, double *value, void *user)
{
  (void)user;
  *value = sin(5 * t) * t;
  return 0;
}

/* The field loses J.E, which the probe at the dipole's place sees. On a mesh both are sums with the
 * same weights, so that the balance holds but for the times at which they are looked at. */
static double misses_work(const char *name, dvi_star_kind kind, int scalar, int steps)
{
  static const double at[] = {0.43, 0.37}, along[] = {1, -0.5};
  const dvi_current current = {
      .at = {at[0], at[1]}, .along = {along[0], scalar ? 0 : along[1]}, .signal = ramp};
  const dvi_field_probe probe[] = {
      {.name = "E", .of = "E", .at = {at[0], at[1]}, .along = {along[0], scalar ? 0 : along[1]}},
      {.name = "all", .of = "energy", .part = "all"}};
  dvi_field *field = electric(generated(name, (dvi_generator_options){.cells = {6, 6}}), kind, NULL,
                              (dvi_maxwell_terms){.scalar = scalar,
                                                  .wall = &conductor,
                                                  .walls = 1,
                                                  .current = &current,
                                                  .currents = 1,
                                                  .probe = probe,
                                                  .probes = 2});
  const double t_end = 0.7, dt = t_end / steps;
  dvi_march *march = march_of(field, (dvi_march_options){.step = dt}, NULL, NULL);
  double work = 0, J, last = 0;
  for (int i = 1; i <= steps; i++) {
    advance_march(march, i * dt);
    (void)ramp(i * dt, &J, NULL);
    const double power = -J * observe_march(march, "E");
    work += dt / 2 * (last + power);
    last = power;
  }
  const double energy = observe_march(march, "all");
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  ck_assert_double_gt(energy, 0.01);
  return fabs(energy - work) / energy;
}

START_TEST(the_work_of_a_dipole_is_what_its_place_sees)
{
  static const struct {
    const char *mesh;
    dvi_star_kind kind;
  } cases[] = {{"box", DVI_CIRCUMCENTRIC}, {"staggered", DVI_CIRCUMCENTRIC}, {"kuhn", DVI_WHITNEY}};
  for (int i = 0; i < 6; i++) {
    const double coarse = misses_work(cases[i / 2].mesh, cases[i / 2].kind, i % 2, 100),
                 fine = misses_work(cases[i / 2].mesh, cases[i / 2].kind, i % 2, 200);
    ck_assert_msg(fine < 1e-2 && fabs(log2(coarse / fine) - 2) < 0.2, "%s: %g and %g",
                  cases[i / 2].mesh, coarse, fine);
  }
}
END_TEST

SUITE(power)
{
  tcase_add_test(tests, what_flows_out_of_a_part_is_missing_in_it);
  tcase_add_test(tests, the_flux_between_rectangles_is_exact);
  tcase_add_test(tests, walls_that_reflect_let_nothing_through);
  tcase_add_test(tests, the_work_of_a_dipole_is_what_its_place_sees);
}
