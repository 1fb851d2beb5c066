/* The sentence on a wrong scene of fields with a density names the place and helps to mend it. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <stdio.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { TEXT_SIZE = 1024 };

#define LINE "domain: {x: [0, 1]}\nspace: fem:degree=2,cells=4\nfields: {u: scalar}\n"
#define WAVE "density: u'^2/2 - d(u,x)^2/2\n"

static void refused(const char *text, const char *place, const char *words)
{
  check_refused(text, DVI_BAD_FILE, place, words);
}

/* A density in line 4, which begins in column 10. */
static void density_refused(const char *density, int column, const char *words)
{
  char text[TEXT_SIZE], place[32];
  (void)snprintf(text, sizeof text, LINE "density: %s\n", density);
  (void)snprintf(place, sizeof place, ":4:%d:", column);
  refused(text, place, words);
}

/* A section in line 5 of a scene of a wave. */
static void section_refused(const char *section, int column, const char *words)
{
  char text[TEXT_SIZE], place[32];
  (void)snprintf(text, sizeof text, LINE WAVE "%s\n", section);
  (void)snprintf(place, sizeof place, ":5:%d:", column);
  refused(text, place, words);
}

START_TEST(derivatives_are_along_axes_of_fields)
{
  density_refused("u'^2 - d(u,y)^2", 21, "a derivative is taken along an axis, x");
  density_refused("u'^2 - d(v,x)^2", 19, "there is no 'v'");
  density_refused("u'^2 - u_x^2", 17, "there is no 'u_x'; a derivative is d(u,x)");
  density_refused("u_t^2", 10, "there is no 'u_t'; a rate is u'");
  density_refused("u'^2 - diff(u,x)^2", 17, "there is no 'diff'; write d(u,x), or u' for a rate");
  density_refused("u'^2 - d(u)", 17, "d takes an expression and axes");
  density_refused("u'^2 - d(u,x,x,x,x,x)", 17, "more than order 4 in space");
  density_refused("u'^2 - d(u,x,x)^2", 17,
                  "derivatives to order 1 along x, and this one is of order 2");
  density_refused("u'^2 - re(u)", 17, "re is taken of a complex field");
  density_refused("u'^2 - grad([u, u])", 17, "grad is taken of a number");
  density_refused("u'^2 - grad(u, x)", 17, "grad takes 1 argument, not 2");
}
END_TEST

START_TEST(a_density_moves_all_of_its_fields)
{
  density_refused("u''^2", 12, "there are no second rates");
  refused(LINE "density: -d(u,x)^2/2\nstep: 0.1\n",
          ":4:10:", "there is no rate in it, so nothing would move; without 'step'");
  refused("domain: {x: [0, 1]}\nspace: fem:degree=1,cells=4\nfields: {u: scalar, w: scalar}\n"
          "density: u'^2 - w^2\n",
          ":4:10:", "no rate of w stands in the density");
  density_refused("t*u'*u + u'", 10, "with coefficients without the time");
  check_refused(LINE "density: u*u'\n", DVI_SINGULAR, ":4:10:", "two-form");
  refused(LINE "density: u*u'\ninitial: {u: 1, u': 0}\n",
          ":5:10:", "of first degree in the rates a density tells them");
}
END_TEST

START_TEST(sections_of_densities_belong_together)
{
  refused(LINE, ":1:1:", "the section 'density' is missing");
  refused("fields: {u: scalar}\n" WAVE, ":2:10:", "fields live on a domain");
  refused("domain: {x: [0, 1]}\nmesh: {generator: disk}\nfields: {u: scalar}\n" WAVE,
          ":2:7:", "beside 'domain' there is no mesh");
  refused("domain: {x: [0, 1]}\nfields: {u: scalar}\n" WAVE,
          ":1:9:", "the section 'space' is missing");
  refused("domain: {x: [0, 1]}\nspace: fem:cells=4\n" WAVE,
          ":1:9:", "the section 'fields' is missing");
  section_refused("schroedinger: {}", 15, "beside it there is no other one");
  section_refused("coordinates: {y: scalar}", 1, "has no section 'coordinates'");
  section_refused("solve: {mean: 1}", 8, "asks for a ground state");
}
END_TEST

START_TEST(a_start_agrees_with_what_is_fixed)
{
  refused(LINE WAVE "boundary: {left: {fixed: cos(t)}}\ninitial: {u': 0}\n",
          ":6:10:", "the start of u is 0 at 'left', where 1 is fixed at t = 0; they must agree");
  refused(LINE WAVE "boundary: {left: {fixed: cos(t)}}\n", ":5:11:", "the start of u is 0");
  refused(LINE WAVE "boundary: fixed\ninitial: {u: cos(pi*x)}\n",
          ":6:10:", "the start of u is 1 at 'boundary', where 0 is fixed");
  (void)open_scene(LINE WAVE "boundary: fixed\ninitial: {u: exp(-40*(x - 0.5)^2)}\n");
  refused("domain: {x: [0, 1]}\nspace: fem:degree=1,cells=4\nfields: {u: scalar}\n" WAVE
          "moving: {mu: 1}\nboundary: {right: {fixed: 2}}\ninitial: {u: x}\n",
          ":7:10:", "the start of u is 1 at x = 1, where 2 is fixed");
  (void)open_scene(LINE WAVE "boundary: {left: {fixed: 1}}\n"); /* of a static state */
}
END_TEST

START_TEST(a_start_has_a_finite_energy)
{
  check_refused(LINE WAVE "initial: {u: 1e160*x}\n", DVI_NOT_FINITE, ":5:10:",
                "the start of u is 1.25e+159 at x = 0.125, and its energy would overflow");
  check_refused(LINE WAVE "initial: {u': -1e200}\n", DVI_NOT_FINITE,
                ":5:10:", "the start of u' is -1e+200 at x = 0, ");
}
END_TEST

START_TEST(axes_and_spaces_are_as_described)
{
  refused("domain: {x: [1, 0]}\n" WAVE, ":1:17:", "the ends of an axis ascend");
  refused("domain: {x: 1}\n" WAVE, ":1:13:", "an axis is a list of its ends");
  refused("domain: {}\n" WAVE, ":1:9:", "a domain has one to three axes");
  refused("domain: {t: [0, 1]}\nfields: {u: scalar}\n" WAVE,
          ":1:10:", "'t' is a word of the language");
  refused("domain: {u: [0, 1]}\nfields: {u: scalar}\n" WAVE,
          ":2:10:", "there is a coordinate 'u' already");
  refused("domain: {x: [0, 1]}\nspace: {y: 'fem:cells=3'}\nfields: {u: scalar}\n" WAVE,
          ":2:9:", "the domain has no 'y'");
  refused("domain: {x: [0, 1], y: [0, 1]}\nspace: {y: 'fem:cells=3'}\nfields: {u: scalar}\n" WAVE,
          ":2:8:", "the axis x has no space");
  check_refused("domain: {x: [0, 1]}\nspace: fen:degree=1\nfields: {u: scalar}\n" WAVE,
                DVI_BAD_OPTION, ":2:8:", "fen");
  refused("domain: {x: [0, 1]}\nspace: fourier:modes=3\nfields: {u: scalar}\n" WAVE,
          ":2:8:", "fourier is periodic, and the axis x is not");
  refused("domain: {x: [0, 1]}\nspace: msfem:cells=2,fine=8\nfields: {u: scalar}\n"
          "density: u'^2/2 - u^2\n",
          ":4:10:", "msfem has the coefficient a of the summand -a*d(u,x)^2/2");
  refused("mesh: {generator: disk}\nspace: {x: 'fem:degree=1'}\nfields: {u: scalar}\n" WAVE,
          ":2:8:", "a mesh has no axes");
  refused("mesh: {generator: icosphere}\nfields: {u: scalar}\n" WAVE,
          ":1:7:", "triangles in a plane");
}
END_TEST

START_TEST(fields_are_numbers_and_vectors)
{
  refused("domain: {x: [0, 1]}\nfields: {R: spinor}\ndensity: 1\n",
          ":2:13:", "a field is scalar, complex, vector(d) or rotation");
  refused("domain: {x: [0, 1]}\nfields: {u: vector}\ndensity: 1\n",
          ":2:13:", "a field is scalar, complex, vector(d) or rotation");
  refused("domain: {x: [0, 1]}\nfields: {R: rotation, u: scalar}\ndensity: 1\n",
          ":2:9:", "is the only one of its scene");
  check_refused("domain: {x: [0, 1]}\nfields: {u: vector(17)}\ndensity: 1\n", DVI_BAD_SIZE,
                ":2:10:", "more than 16 components");
}
END_TEST

START_TEST(conditions_are_of_parts_and_do_not_contradict)
{
  section_refused("boundary: {left: periodic}", 18, "periodic is a whole axis");
  section_refused("boundary: {x: periodic, left: fixed}", 25, "has a condition of its own");
  section_refused("boundary: {top: fixed}", 12, "has no part 'top'; it has x, left, right");
  section_refused("boundary: {left: {fixed: u}}", 26, "without the fields");
  section_refused("boundary: {left: {fixed: u'}}", 26, "velocities cannot stand");
  section_refused("boundary: {left: {}}", 18, "a condition is fixed, or free");
  section_refused("boundary: {left: {fixed: 1, robin: 2}}", 18, "a condition is fixed, or free");
  section_refused("boundary: {left: {u: fixed, w: fixed}}", 29, "there is no field 'w'");
  section_refused("boundary: loose", 11, "there is no condition 'loose'; there are fixed, free");
  section_refused("boundary: {left: dirichlet}", 18, "{fixed: value}, {free: flux} and {robin: a}");
  section_refused("boundary: {fixed: sin(t)}", 12, "as in 'boundary: {boundary: {fixed: ..}}'");
  refused("mesh: {generator: disk}\nfields: {u: scalar}\nboundary: periodic\n" WAVE,
          ":3:11:", "periods of a mesh are those of its generator");
  refused("mesh: {generator: disk}\nfields: {u: scalar}\nboundary: {edge: fixed}\n" WAVE,
          ":3:12:", "has no part 'edge'; it has all, boundary and rim");
}
END_TEST

START_TEST(starts_and_probes_are_of_fields)
{
  section_refused("initial: {w: 1}", 11, "no 'w'; it has u");
  section_refused("initial: {u': t}", 15, "the time cannot stand in a start");
  section_refused("initial: {u: u}", 14, "a start is a function of position");
  section_refused("initial: {u: [1, 2]}", 14, "a vector of 2 here, where a number is needed");
  check_refused(LINE WAVE "initial: {u: 1/x}\n", DVI_NOT_FINITE,
                ":5:14:", "at the start: 1/x is not finite");
  section_refused("probes: {ear: w(0.5)}", 15, "a probe is a field at a point, as in 'u(0.5)'");
  check_refused(LINE WAVE "probes: {ear: u(2)}\n", DVI_BAD_ARGUMENT,
                ":5:10:", "the probe 'ear': space: the point x = 2");
  section_refused("probes: {ear: {at: 0.5}}", 15, "a probe has an expression and a point");
  section_refused("probes: {ear: {of: u, at: [0, 1]}}", 27, "a point has 1 coordinate here");
  section_refused("probes: {ear: {integral: d(u,x)}}", 30, "a text with commas needs quotes");
  section_refused("probes: {energy: u(0)}", 10, "there is a column 'energy' already");
  section_refused("probes: {u_3: u(0)}", 10, "there is a column 'u_3' already");
  section_refused("probes: {bend: {integral: 'd(u,x,x)'}}", 28, "of order 2");
  section_refused("step: {fraction: 2}", 7, "is below 1, and is 2");
}
END_TEST

START_TEST(expressions_without_a_value_are_shown)
{
  check_refused(LINE "density: u'^2/2 - log(x - 0.5)*d(u,x)^2\n", DVI_NOT_FINITE,
                ":4:19:", "at the start: log(x - 0.5), x - 0.5 = -0.");
  check_refused(LINE WAVE "boundary: {left: {fixed: 1/t}}\n", DVI_NOT_FINITE,
                ":5:26:", "at the start: 1/t is not finite");
}
END_TEST

START_TEST(schroedingers_equation_has_a_potential_of_position)
{
  static const char line[] = "domain: {x: [0, 1]}\nspace: fem:degree=2,cells=4\n";
  char text[TEXT_SIZE];
  static const struct {
    const char *rest, *place, *words;
  } list[] = {
      {"schroedinger: {potential: \"psi[1]\"}\n", ":3:28:", "without the field"},
      {"schroedinger: {mass: 0}\n", ":3:22:", "mass must be positive"},
      {"schroedinger: {charge: 0}\n", ":3:16:", "schroedinger has no 'charge'"},
      {"fields: {u: scalar}\nschroedinger: {}\n", ":3:9:", "one field, which is complex"},
  };
  for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
    (void)snprintf(text, sizeof text, "%s%s", line, list[i].rest);
    refused(text, list[i].place, list[i].words);
  }
}
END_TEST

SUITE(density_errors)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, derivatives_are_along_axes_of_fields);
  tcase_add_test(tests, a_density_moves_all_of_its_fields);
  tcase_add_test(tests, sections_of_densities_belong_together);
  tcase_add_test(tests, a_start_agrees_with_what_is_fixed);
  tcase_add_test(tests, a_start_has_a_finite_energy);
  tcase_add_test(tests, axes_and_spaces_are_as_described);
  tcase_add_test(tests, fields_are_numbers_and_vectors);
  tcase_add_test(tests, conditions_are_of_parts_and_do_not_contradict);
  tcase_add_test(tests, starts_and_probes_are_of_fields);
  tcase_add_test(tests, expressions_without_a_value_are_shown);
  tcase_add_test(tests, schroedingers_equation_has_a_potential_of_position);
}
