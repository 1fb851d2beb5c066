/* Translations and rotations that are found on a scene's expressions, and those that are nearly
 * there and are not. Points that definitions give. */
#include <dvi/scene.h>
#include <math.h>
#include <string.h>

#include "support/suite.h"

#define RUN "method: verlet\nstep: 0.1\nuntil: 1\n"
#define PLANE "coordinates: {x: scalar, y: scalar}\ninitial: {x: 1, y: 0.5}\n" RUN
#define BODIES                                                                                 \
  "parameters: {m: [1, 2, 3]}\ncoordinates: {'q[3]': vector(3)}\ninitial: {'q[i]': '[i, i^2, " \
  "1/i]'}\n" RUN
#define TWO "coordinates: {a: vector(2), b: vector(2)}\ninitial: {a: '[1, 0]', b: '[0, 2]'}\n" RUN

#define MOVES "translation of q along x, translation of q along y, translation of q along z, "
#define TURNS "rotation of q about x, rotation of q about y, rotation of q about z"

static const struct {
  const char *text, *found;
} known[] = {
    {PLANE "lagrangian: (x'^2 + y'^2)/2 + 1/sqrt(x^2 + y^2)", "rotation of x and y"},
    {PLANE "lagrangian: (x'^2 + y'^2)/2 + 1/sqrt(x^2 + 1.0000000000000002*y^2)", ""},
    {PLANE "lagrangian: (x'^2 + y'^2)/2 + exp(x - y)", "translation of x and y"},
    {PLANE "lagrangian: (x'^2 + y'^2)/2 + exp(x - 2*y)", ""},
    /* the kinetic energy does not turn */
    {PLANE "lagrangian: (x'^2 + 2*y'^2)/2 + 1/sqrt(x^2 + y^2)", ""},
    {PLANE "lagrangian: (1 + y^2)*x'^2/2 + y'^2/2 - t*y", "translation of x"},
    {PLANE "one_form: {x: y + y^3, y: 0}\nhamiltonian: y^4", "translation of x"},
    {PLANE "one_form: {x: y, y: -x}\nhamiltonian: hypot(x, y)", "rotation of x and y"},
    {BODIES
     "lagrangian: sum(i, m[i]/2*dot(q[i]', q[i]')) + sum(i<j, m[i]*m[j]/norm(q[i] - q[j])^3)",
     MOVES TURNS},
    {BODIES "lagrangian: sum(i, m[i]/2*dot(q[i]', q[i]')) + sum(i, q[i][3]) + cos(dot(q[1], q[2]))",
     "rotation of q about z"},
    {BODIES "lagrangian: sum(i, m[i]/2*dot(q[i]', q[i]')) + dot(cross(q[1], q[2]), q[3])", TURNS},
    {TWO "lagrangian: (dot(a', a') + dot(b', b'))/2 - norm(a - b)",
     "translation of a and b along x, translation of a and b along y, rotation of a and b"},
    {TWO "lagrangian: (dot(a', a') + dot(b', b'))/2 - norm(a) - b[1]",
     "rotation of a, translation of b along y"},
    {"coordinates: {x: scalar, y: scalar}\nhamiltonian: (p(x)^2 + p(y)^2)/2\nconstraints: {on: "
     "(x^2 + y^2 - 1)/2, along: x*p(x) + "
     "y*p(y)}\ninitial: {x: 0.8, y: 0.6, p(x): 0.6, p(y): -0.8}\n" RUN,
     "rotation of x and y"},
    {"coordinates: {'x[5]': scalar}\nlagrangian: sum(i, x[i]'^2/2) - sum(i=1..4, cosh(x[i+1] - "
     "x[i]))\ninitial: {'x[i]': i}\n" RUN,
     "translation of x"},
    /* No element is kept, but all are together. */
    {"coordinates: {'x[3]': scalar}\nlagrangian: sum(i, x[i]'^2/2) + sum(i, (i - "
     "2)*x[i])\ninitial: {'x[i]': i}\n" RUN,
     "translation of x"},
};
enum { KNOWN = sizeof known / sizeof *known, SIZE = 512 };

static dvi_scene *read_scene(const char *text)
{
  char message[SIZE];
  dvi_scene *scene;
  ck_assert_msg(dvi_scene_parse("s.yaml", text, strlen(text), 0, NULL, &scene, message, SIZE) ==
                    DVI_OK,
                "%s", message);
  return scene;
}

START_TEST(what_leaves_the_lagrangian_as_it_is_is_found)
{
  char found[SIZE], part[8];
  dvi_scene *scene = read_scene(known[_i].text);
  const int count = dvi_scene_invariance(scene, found, SIZE);
  ck_assert_str_eq(found, known[_i].found);
  ck_assert_int_eq(dvi_scene_invariance(scene, part, sizeof part), count);
  ck_assert(strncmp(part, found, sizeof part - 1) == 0 && strlen(part) < sizeof part);
  dvi_scene_destroy(&scene);
}
END_TEST

START_TEST(what_turns_is_not_looked_at)
{
  char found[SIZE];
  dvi_scene *turns = read_scene("coordinates: {R: rotation}\nlagrangian: dot(omega(R), "
                                "omega(R))/2\ninitial: {R: 'turn([0, 0, 1], 0)'}\n"
                                "method: lie-verlet\nstep: 0.1\nuntil: 1\n");
  ck_assert_int_eq(dvi_scene_invariance(turns, found, SIZE), -1);
  ck_assert_int_eq(dvi_scene_invariance(turns, NULL, 0), -1);
  ck_assert_int_eq(dvi_scene_invariance(NULL, found, SIZE), -1);
  dvi_scene_destroy(&turns);
}
END_TEST

/* A pendulum on a cart, whose pivot moves in time, in a scene with definitions that are none. */
START_TEST(definitions_of_places_are_points)
{
  const double q[] = {0.5, 0.3};
  double x[3];
  dvi_scene_point bob, tip, none = {.size = 7};
  dvi_scene *cart = read_scene(
      "parameters: {l: 2}\ncoordinates: {s: scalar, a: scalar}\ndefinitions:\n  fixed: [1, 2]\n"
      "  height: -l*cos(a)\n  bob: '[s + l*sin(a), height]'\n  speed: bob'\n"
      "  tip: '[2*bob[1], t, a]'\n  four: '[s, a, s, a]'\n"
      "lagrangian: s'^2/2 + dot(speed, speed)/2 - height\ninitial: {s: 0, a: 1}\n" RUN);
  ck_assert_int_eq(dvi_scene_point_of(cart, 0, &bob), DVI_OK);
  ck_assert_int_eq(dvi_scene_point_of(cart, 1, &tip), DVI_OK);
  ck_assert_str_eq(bob.name, "bob");
  ck_assert_str_eq(tip.name, "tip");
  ck_assert_int_eq(bob.size, 2);
  ck_assert_int_eq(tip.size, 3);
  for (int k = 0; k < 2; k++) ck_assert_int_eq(bob.value(0, q, NULL, &x[k], bob.user[k]), 0);
  ck_assert_double_eq_tol(x[0], 0.5 + 2 * sin(0.3), 1e-15);
  ck_assert_double_eq_tol(x[1], -2 * cos(0.3), 1e-15);
  for (int k = 0; k < 3; k++) ck_assert_int_eq(tip.value(4, q, NULL, &x[k], tip.user[k]), 0);
  ck_assert_double_eq_tol(x[0], 1 + 4 * sin(0.3), 1e-15);
  ck_assert_double_eq(x[1], 4);
  ck_assert_double_eq(x[2], 0.3);
  ck_assert_int_eq(dvi_scene_point_of(cart, 2, &none), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_scene_point_of(cart, -1, &none), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_scene_point_of(cart, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_scene_point_of(NULL, 0, &none), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(none.size, 7);
  dvi_scene_destroy(&cart);
}
END_TEST

SUITE(scene_invariance)
{
  tcase_add_loop_test(tests, what_leaves_the_lagrangian_as_it_is_is_found, 0, KNOWN);
  tcase_add_test(tests, what_turns_is_not_looked_at);
  tcase_add_test(tests, definitions_of_places_are_points);
}
