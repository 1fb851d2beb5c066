/* The sentence on a wrong scene names the place and helps to mend it. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { TEXT_SIZE = 1024 };

static void refused(const char *text, const char *place, const char *words)
{
  check_refused(text, DVI_BAD_FILE, place, words);
}

#define X "coordinates: {x: scalar}\n"
#define RUN "initial: {x: 1}\nstep: 0.1\nuntil: 1\n"

/* A Lagrangian in line 2 of a scene with the coordinates x, u in R^3 and y_1 .. y_3. It begins in
 * column 13. */
static void lagrangian_refused(const char *L, int column, const char *words)
{
  char text[TEXT_SIZE], place[32];
  (void)snprintf(text, sizeof text,
                 "parameters: {N: 3, m: [1, 2, 3], A: [[1, 2], [3, 4]]}\nlagrangian: "
                 "%s\ncoordinates:\n  x: scalar\n  u: vector(3)\n"
                 "  y[N]: scalar\n" RUN,
                 L);
  (void)snprintf(place, sizeof place, ":2:%d:", column);
  refused(text, place, words);
}

/* b is made of a and stands in no section, nor does the list c. */
#define PARAMETERS \
  "parameters: {a: 1, b: 2*a, c: [a, b], start: 2, twice: 2*start, size: 3, both: 1}\n"
#define USES                                                                                    \
  "definitions: {V: size*both*x, rest: x^2, twice_V: 2*V}\nlagrangian: x'^2 - V\ninitial: {x: " \
  "twice + both}\nstep: 0.1\n"                                                                  \
  "until: 1\n"

START_TEST(what_nothing_mentions_is_known)
{
  static const int start_only[] = {0, 0, 0, 1, 1, 0, 0};
  static const char *const unused[] = {"a", "b", "c", "rest", "twice_V"}, *const idle[] = {"a=2"};
  ck_assert_msg(parse_scene(PARAMETERS X USES) == DVI_OK, "%s", message);
  for (int i = 0; i < 7; i++)
    ck_assert_int_eq(dvi_scene_parameter_at(scene, i)->start_only, start_only[i]);
  for (int i = 0; i < 5; i++) ck_assert_str_eq(dvi_scene_unused(scene, i), unused[i]);
  ck_assert_ptr_null(dvi_scene_unused(scene, 5));
  ck_assert_ptr_null(dvi_scene_unused(scene, -1));
  ck_assert_int_eq(parse_with(PARAMETERS X USES, 1, idle), DVI_BAD_OPTION);
  ck_assert_ptr_nonnull(strstr(message, "'a' is set, but nothing in the scene mentions it"));
}
END_TEST

START_TEST(unknown_names_are_told_with_the_nearest)
{
  lagrangian_refused("x'^2 + yy[1]", 20, "'yy'; did you mean y?");
  lagrangian_refused("x'^2 + sqr(x)", 20, "'sqr'; did you mean sqrt?");
  refused("kinetc: 1\n" X RUN, ":1:1:", "'kinetc'; did you mean kinetic?");
  refused(X "lagrangian: x'^2\nreport: {evry: 2}\n" RUN, ":3:10:", "'evry'; did you mean every?");
  refused("lagrangian: x'^2\nreport: {columns: [x, energi]}\n" X RUN,
          ":2:23:", "no column 'energi'; did you mean energy?");
  refused(X "lagrangian: x'^2\nreport: {columns: [x, p_x, x]}\n" RUN,
          ":3:28:", "column 'x' stands here twice");
  refused(X "lagrangian: x'^2\ninitial: {x: 1, xx: 2}\nstep: 1\nuntil: 1\n",
          ":3:17:", "'xx'; did you mean x?");
}
END_TEST

/* Two columns with one name could not be selected. */
START_TEST(columns_have_one_name_each)
{
  static const char *const taken[] = {"x", "t", "energy", "p_x"}, *const free_name[] = {
                                                                      "v_x", "x_1", "distance",
                                                                      "constraint"};
  static const char *const twice[] = {"energy: scalar",
                                      "x_1: scalar, 'x[2]': scalar",
                                      "p_x: scalar, x: scalar",
                                      "R_11: scalar, R: rotation",
                                      "B_R: rotation, B: motion",
                                      "B_x_x: scalar, B: motion",
                                      "omega_R_y: scalar, R: rotation",
                                      "x_2_19: scalar, 'x[3]': vector(20)"};
  char text[TEXT_SIZE];
  for (int k = 0; k < 4; k++) {
    (void)snprintf(text, sizeof text, "invariants: {%s: 1}\n" X "lagrangian: x'^2\n" RUN, taken[k]);
    refused(text, ":1:14:", "already; choose another name");
    (void)snprintf(text, sizeof text, "invariants: {%s: 1}\n" X "lagrangian: x'^2\n" RUN,
                   free_name[k]);
    ck_assert_msg(parse_scene(text) == DVI_OK, "%s", message);
  }
  for (size_t k = 0; k < sizeof twice / sizeof *twice; k++) {
    (void)snprintf(text, sizeof text, "coordinates: {%s}\nlagrangian: 1\n" RUN, twice[k]);
    refused(text, ":1:", "there is a column");
  }
  refused("coordinates: {x_2_21: scalar, x_4_1: scalar, 'x[3]': vector(20)}\nlagrangian: 1\n" RUN,
          ":2:", "no velocity in it");
  refused("invariants: {'a,b': x}\n" X "lagrangian: x'^2\n" RUN, ":1:15:", "'a,b' is no name");
  refused(X "kinetic: x'^2\npotentials: {a b: x}\n" RUN, ":3:14:", "'a b' is no name");
  refused(X "kinetic: x'^2\npotentials: {fast: {'': x}}\n" RUN, ":3:22:", "'' is no name");
  refused(X "lagrangian: x'^2\nevents: {a b: {zero: x}}\n" RUN, ":3:10:", "'a b' is no name");
  refused("symmetries: {'': {x: 1}}\n" X "lagrangian: x'^2\n" RUN, ":1:15:", "'' is no name");
  refused("symmetries: {a: {x: 1}}\ninvariants: {a: x}\n" X "lagrangian: x'^2\n" RUN,
          ":2:14:", "a symmetry 'a' already");
}
END_TEST

START_TEST(words_from_elsewhere_are_told_with_those_of_scenes)
{
  lagrangian_refused("x'^2 + ln(x)", 20, "there is no 'ln'; write log(x)");
  lagrangian_refused("xdot^2", 13, "there is no 'xdot'; write x'");
  lagrangian_refused("x_dot^2", 13, "there is no 'x_dot'; write x'");
  lagrangian_refused("x'^2 + p_x", 20, "there is no 'p_x'; write p(x)");
  lagrangian_refused("v_N^2", 13, "there is no 'v_N'"); /* N is no coordinate */
  lagrangian_refused("x'^2 + x(3)", 20, "'x' is a coordinate, no function");
  lagrangian_refused("x'^2 + t(3)", 20, "'t' is a number, no function");
  lagrangian_refused("x'^2 + omega", 20, "'omega' is a function; write omega(..)");
  lagrangian_refused("x'^2#-x^2", 17,
                     "'#' has no meaning in expressions; a blank stands before a comment");
  refused(X "L: x'^2\n" RUN, ":2:1:", "a scene has no 'L'; the section is lagrangian");
  refused(X "lagrangian: x'^2\ndt: 1\n" RUN, ":3:1:", "a scene has no 'dt'; the section is step");
  refused(X "lagrangian: x'^2\nt-end: 1\n" RUN,
          ":3:1:", "a scene has no 't-end'; the section is until");
  refused(X "parameters: {m: 1, g = 9.81}\n" RUN,
          ":2:20:", "a key is followed by a colon and a blank; write g: 9.81");
  refused(X "parameters: {g:9.81}\n" RUN,
          ":2:14:", "a key is followed by a colon and a blank; write g: 9.81");
  refused(X "lagrangian: x'^2\nreport: {dt: 1}\n" RUN, ":3:10:", "report has no 'dt'");
}
END_TEST

START_TEST(a_start_that_is_no_number_is_told)
{
  const char *const L = "coordinates: {\"x[2]\": scalar, y: scalar}\nlagrangian: y'^2 + sum(i, "
                        "x[i]'^2)\nstep: 1\nuntil: 1\n";
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text, "%sinitial: {y: 1, \"x[i]\": 1/(i - 1)}\n", L);
  refused(text, ":5:10:", "the start of x is not finite");
  (void)snprintf(text, sizeof text, "%sinitial: {y: 1, \"x[i]\": 1, \"x[i]'\": sqrt(1 - i)}\n", L);
  refused(text, ":5:10:", "the start of x is not finite");
  refused(X "lagrangian: x'^2\ninitial: {x: 1/0}\nstep: 1\nuntil: 1\n",
          ":3:14:", "this is not a finite number");
}
END_TEST

START_TEST(shapes_that_do_not_fit_are_told)
{
  lagrangian_refused("x'^2 + u", 13, "a number plus a vector of 3");
  lagrangian_refused("u - [1, 2]", 13, "a vector of 3 minus a vector of 2");
  lagrangian_refused("u*u", 13, "say dot(a,b) or cross(a,b)");
  lagrangian_refused("u^2", 13, "say dot(a,a), or norm(a)");
  lagrangian_refused("x'^2 + A*u", 20, "a 2 x 2 matrix times a vector of 3");
  lagrangian_refused("x/u", 13, "a number by a vector of 3");
  lagrangian_refused("sin(u)", 17, "sin is taken of a number, not of a vector of 3");
  lagrangian_refused("dot(u, m[1])", 13, "dot takes two vectors of one size");
  lagrangian_refused("cross(A, u)", 13, "cross takes two vectors of 2, or of 3");
  lagrangian_refused("atan2(x)", 13, "atan2 takes 2 arguments, not 1");
  lagrangian_refused("u'", 13, "a vector of 3 where a number is needed");
  lagrangian_refused("dot([x, u], u)", 21, "a list holds numbers, or vectors of one size");
}
END_TEST

START_TEST(indices_are_checked_for_every_element)
{
  lagrangian_refused("sum(i, y[i]'^2) - sum(i=1..N, y[i+1]^2)", 45,
                     "the index 4 is not between 1 and 3, where i = 3");
  lagrangian_refused("y[0]'^2", 15, "the index 0 is not between 1 and 3");
  lagrangian_refused("y[1/2]'^2", 15, "must be a whole number, and is 0.5");
  lagrangian_refused("y[x]'^2", 15, "coordinates cannot stand in an index or a bound");
  lagrangian_refused("m[1, 2]*x'^2", 13, "m has 1 index, not 2");
  lagrangian_refused("y'^2", 13, "y is a family of 3; take one of it, as y[1]");
  lagrangian_refused("x[1]'^2", 13, "a number has no elements");
  lagrangian_refused("sum(i, A[1,i]*y[i]'^2)", 20, "i runs over the 3 of y, but A has 2");
  lagrangian_refused("sum(i, x'^2)", 13, "nothing is indexed by i alone");
  lagrangian_refused("sum(x=1..2, x)", 13, "the index 'x' is a coordinate, too");
  lagrangian_refused("sum(t=1..2, t)", 13, "'t' is a word of the language");
  lagrangian_refused("sum(sin=1..2, sin(sin))", 13, "'sin' is a word of the language");
  lagrangian_refused("sum(i=1..2, sum(i=1..2, y[i]))", 25,
                     "'i' is an index around this sum already");
  lagrangian_refused("i*sum(i=1..2, y[i]'^2)", 13, "there is no 'i'");
}
END_TEST

START_TEST(velocities_and_momenta_stand_where_they_make_sense)
{
  refused(X "kinetic: x'^2\npotentials: {V: x*x'}\n" RUN,
          ":3:19:", "velocities cannot stand in a potential");
  refused(X "lagrangian: x'^2 + p(x)\n" RUN, ":2:20:", "momenta cannot stand in a Lagrangian");
  refused(X "kinetic: x'^2\npotentials: {stiff: {V: x}}\n" RUN,
          ":3:14:", "only slow and fast hold some by name");
  refused(X "kinetic: x'^2\npotentials: {fast: {slow: {V: x}}}\n" RUN,
          ":3:27:", "an expression belongs here");
  refused(X "lagrangian: x'^2\nevents: {up: {zero: p(x)}}\n" RUN,
          ":3:21:", "momenta cannot stand in an event");
  refused("parameters: {a: t}\n" X "lagrangian: x'^2\n" RUN,
          ":1:17:", "the time cannot stand in a parameter");
  refused(X "definitions: {w: x'^2}\nlagrangian: w'\n" RUN, ":3:13:", "there are no accelerations");
  refused("coordinates: {x: scalar, y: scalar}\nlagrangian: x'*y*(1 + t) - x^2 - y^2\n" RUN,
          ":2:13:", "this is a one-form");
  refused(X "lagrangian: x^2\n" RUN, ":2:13:", "no velocity in it");
  refused("coordinates: {x: scalar, y: scalar}\nlagrangian: x'^2 + y^2\ninitial: {x: 1, y: "
          "1}\nstep: 1\nuntil: 1\n",
          ":1:26:", "the rate of y has no mass");
}
END_TEST

START_TEST(names_are_declared_once_and_before_their_use)
{
  refused(X "lagrangian: x'^2\ninitial: {x: 1}\nstep: x\nuntil: 1\n",
          ":4:7:", "coordinates cannot stand in step");
  refused(X "definitions: {d: 1}\nlagrangian: x'^2\ninitial: {x: 1}\nstep: d\nuntil: 1\n",
          ":5:7:", "definitions cannot stand in step");
  refused(X "lagrangian: x'^2\ninitial: {t: 1}\nstep: 1\nuntil: 1\n",
          ":3:11:", "'t' is a word of the language, no coordinate");
  refused("parameters: {a: 1}\nsweep: {a: {from: -1e308, to: 1e308, count: 3}}\n" X
          "lagrangian: a*x'^2\n" RUN,
          ":2:12:", "is too wide");
  refused(X "lagrangian: x'^2\nsweep: {t: [1]}\n" RUN,
          ":3:9:", "'t' is no parameter that is a number");
  refused("parameters: {a: b, b: 1}\n" X "lagrangian: x'^2\n" RUN, ":1:17:", "it is not known yet");
  refused(X "definitions: {a: b, b: x}\nlagrangian: x'^2\n" RUN, ":2:18:", "it is not known yet");
  refused("parameters: {x: 1}\n" X "lagrangian: x'^2\n" RUN,
          ":2:15:", "there is a parameter 'x' already");
  refused("parameters: {sin: 1}\n" X "lagrangian: x'^2\n" RUN,
          ":1:14:", "'sin' is a word of the language");
  refused(X "definitions: {d: dot(x, x)/2}\nlagrangian: x'^2\n" RUN,
          ":2:21:", "a text with commas needs quotes");
  refused("parameters: {2a: 1}\n" X "lagrangian: x'^2\n" RUN, ":1:14:", "'2a' is no name");
}
END_TEST

START_TEST(sections_that_are_missing_or_do_not_go_together_are_told)
{
  refused(X "lagrangian: x'^2\ninitial: {x: 1}\nuntil: 1\n", ":",
          "the section 'step' is missing, as in 'step: 0.01'");
  refused("step: 1\ncoordinates: {x: \n\n", ":2:17:", "this is no YAML");
  refused(X RUN, ":", "what moves it is missing");
  refused(X "lagrangian: x'^2\nkinetic: x'^2\n" RUN, ":3:10:", "there must be one of these");
  refused(X "lagrangian: x'^2\nhamiltonian: 1\n" RUN,
          ":3:14:", "beside lagrangian there is no hamiltonian");
  refused(X "lagrangian: x'^2\npotentials: {a: 1}\n" RUN,
          ":3:13:", "potentials stand beside kinetic");
  refused(X "one_form: {x: 1}\n" RUN, ":2:11:", "one_form needs a hamiltonian");
  refused(X "hamiltonian: p(x)^2\n" RUN, ":3:10:", "the momentum p(x) is not given");
  refused(X "hamiltonian: p(x)^2\npotentials: {a: x}\n" RUN, ":3:13:", "not beside hamiltonian");
  refused(X "hamiltonian: x\nconstraints: {a: x}\n" RUN, ":3:14:", "an even number is needed");
  refused(X "lagrangian: x'^2\ncontacts: {x: 1}\n" RUN, ":3:15:", "a contact");
  refused(X "lagrangian: x'^2\ncontacts: {f: {restitution: 1}}\n" RUN, ":3:15:", "needs 'gap'");
  refused(X "lagrangian: x'^2\ncontacts: {f: {gap: x}}\n" RUN, ":3:15:", "needs 'restitution'");
  refused(X "lagrangian: x'^2\ncontacts: {f: {gap: x, restitution: -1}}\n" RUN,
          ":3:37:", "the restitution is -1; it is a number from 0 to 1");
  refused(X "lagrangian: x'^2\ncontacts: {f: {gap: x, restitution: 2}}\n" RUN,
          ":3:37:", "the restitution is 2");
  refused(X "lagrangian: x'^2\ncontacts: {f: {gap: x, restitution: 1, friction: -1}}\n" RUN,
          ":3:50:", "the friction is -1");
  refused(X "lagrangian: x'^2\ncontacts: {f: {gap: x, restitution: 1, friction: 1}}\n" RUN,
          ":3:50:", "friction needs 'tangent'");
  refused(X "lagrangian: x'^2\ncontacts: {f: {gap: x, restitution: 1, hold: 1}}\n" RUN,
          ":3:46:", "hold is no or yes");
  refused(X "lagrangian: x'^2\ncontacts: {f: {gap: x, restitution: 1, hold: no}}\n" RUN
            "report: {columns: [force_f]}\n",
          ":", "there is no column 'force_f'");
  refused(X "lagrangian: x'^2\n"
            "contacts: {f: {gap: x, restitution: 1, friction: 1, tangent: x}}\n" RUN,
          ":3:62:", "a tangent is linear in the velocities");
  refused(X "lagrangian: x'^2\n"
            "contacts: {f: {gap: x, restitution: 1, tangent: [x', x', x']}}\n" RUN,
          ":3:49:", "a tangent has 3 numbers");
  refused(X "lagrangian: x'^2\ncontacts: {f: {gap: x', restitution: 1}}\n" RUN, ":3:21:", "a gap");
  refused(X "lagrangian: x'^2\nconstraints: {a: x}\n"
            "contacts: {f: {gap: x, restitution: 1}}\n" RUN,
          ":4:11:", "beside constraints there are no contacts");
  refused(X "hamiltonian: p(x)^2\ncontacts: {f: {gap: x, restitution: 1}}\n" RUN, ":",
          "there are no contacts");
  refused("coordinates: {x: skalar}\nlagrangian: 1\n" RUN, ":1:18:", "did you mean scalar?");
  refused("coordinates: {x: vector}\nlagrangian: 1\n" RUN,
          ":1:18:", "a vector has its size, as in vector(3)");
}
END_TEST

START_TEST(forces_that_do_not_go_are_told)
{
  refused(X "lagrangian: x'^2\nforces: {y: 1}\n" RUN, ":3:10:", "there is no 'y'");
  refused(X "lagrangian: x'^2\nforces: {x': 1}\n" RUN,
          ":3:10:", "a force is given by coordinate, neither by rate nor by momentum");
  refused(X "lagrangian: x'^2\nforces: {x: p(x)}\n" RUN,
          ":3:13:", "momenta cannot stand in a force");
  refused(X "lagrangian: x'^2\nforces: {x: [1, 2]}\n" RUN, ":3:13:", "a vector of 2 for x");
  refused(X "lagrangian: x'^2\nforces: 1\n" RUN, ":3:9:", "a force is a mapping");
  refused(X "lagrangian: x'^2\ndissipation: x\n" RUN, ":3:14:", "there is no velocity in it");
  refused(X "hamiltonian: p(x)^2\nforces: {x: 1}\n" RUN,
          ":3:9:", "beside a Hamiltonian there is no force;");
  refused("coordinates: {x: scalar, y: scalar}\none_form: {x: y}\nhamiltonian: x\n"
          "dissipation: x'^2\ninitial: {x: 1, y: 1}\nstep: 1\nuntil: 1\n",
          ":4:14:", "beside a one-form there is no dissipation");
  refused(X "lagrangian: x'^2\ndamping: -1\n" RUN,
          ":3:10:", "damping must not be negative, and is -1");
  check_refused(X "lagrangian: x'^2\ndamping: 1\nconstraints: {a: x}\n" RUN, DVI_UNSUPPORTED,
                ":3:10:", "damping does not stand beside holonomic constraints");
  refused("coordinates: {x: scalar, y: scalar}\none_form: {x: y}\nhamiltonian: x^2 + y^2\n"
          "damping: 1\ninitial: {x: 1, y: 1}\nstep: 1\nuntil: 1\n",
          ":4:10:", "beside a one-form there is no damping");
  refused("coordinates: {u: angle}\nlagrangian: rate(u)^2\nforces: {u: 1}\n"
          "initial: {u: 1}\nstep: 1\nuntil: 1\n",
          ":3:10:", "a force of a rotation or an angle is given by its velocity, rate(u)");
  refused("coordinates: {u: angle}\nlagrangian: rate(u)^2\ndissipation: u[1]\n"
          "initial: {u: 1}\nstep: 1\nuntil: 1\n",
          ":3:14:", "there is no velocity in it");
}
END_TEST

START_TEST(noise_that_does_not_go_is_told)
{
  refused(X "lagrangian: x'^2\nnoise: {seed: 1}\n" RUN,
          ":3:8:", "noise needs a temperature and a friction");
  refused(X "lagrangian: x'^2\nnoise: {temperature: -1, friction: 0}\n" RUN,
          ":3:22:", "a temperature cannot be negative");
  refused(X "lagrangian: x'^2\nnoise: {functions: 3}\n" RUN, ":3:20:", "functions is a mapping");
  refused(X "lagrangian: x'^2\nnoise: {functions: {f: 0.3}}\n" RUN,
          ":3:24:", "a noise function of no coordinate has no force");
  refused(X "lagrangian: x'^2\nnoise: {functions: {f: t*x}}\n" RUN,
          ":3:24:", "the time cannot stand in a noise function");
  refused(X "lagrangian: x'^2\nnoise: {functions: {f: x'}}\n" RUN,
          ":3:24:", "velocities cannot stand in a noise function");
}
END_TEST

START_TEST(constraints_that_do_not_go_are_told)
{
  refused(X "lagrangian: x'^2\nconstraints: {}\n" RUN, ":3:14:", "there are 0 constraints");
  refused(X "lagrangian: x'^2\nconstraints: {a: x, b: x^2}\n" RUN,
          ":3:14:", "there are 2 constraints; at least 1 is needed");
  refused(X "lagrangian: x'^2\nconstraints: {a: x'}\n" RUN,
          ":3:18:", "velocities cannot stand in a constraint");
  refused(X "lagrangian: x'^2\nnonholonomic: {}\n" RUN,
          ":3:15:", "there are 0 nonholonomic constraints");
  refused(X "lagrangian: x'^2\nnonholonomic: {a: x}\n" RUN,
          ":3:19:", "there is no velocity in it; a constraint phi(t,q) = 0 stands under");
  refused(X "lagrangian: x'^2\nnonholonomic: {a: x'^2}\n" RUN,
          ":3:19:", "it is not linear in the velocities");
  refused(X "lagrangian: x'^2\nnonholonomic: {a: sin(x')}\n" RUN,
          ":3:19:", "it is not linear in the velocities");
  refused(X "lagrangian: x'^2\nnonholonomic: {a: p(x)}\n" RUN, ":3:19:", "p(x)");
  refused(X "hamiltonian: p(x)^2\nnonholonomic: {a: x'}\n" RUN,
          ":3:15:", "beside a Hamiltonian there are no nonholonomic constraints");
  refused("coordinates: {R: rotation}\nlagrangian: dot(omega(R), omega(R))/2\nnonholonomic: {a: "
          "1}\n" RUN,
          ":3:", "beside nonholonomic there are no rotations");
  refused("coordinates: {x: scalar, y: scalar}\nlagrangian: x'*y - y\nconstraints: {a: x - y}\n"
          "initial: {x: 1, y: 1}\nstep: 1\nuntil: 1\n",
          ":3:14:", "beside a one-form there are no constraints");
}
END_TEST

#define MOVES "lagrangian: x'^2\nstep: 1\nuntil: 1\n" X

START_TEST(what_no_system_can_be_made_of_has_its_place)
{
  const char *const two = "coordinates: {x: scalar, y: scalar}\n",
                    *const three = "coordinates: {x: scalar, y: scalar, z: scalar}\n";
  char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text,
                 "%slagrangian: (x' + y')^2/2\ninitial: {x: 1, y: 1}\nstep: 1\nuntil: 1\n", two);
  check_refused(text, DVI_SINGULAR, ":2:13:", "singular");
  (void)snprintf(
      text, sizeof text,
      "%sone_form: {x: y, z: x}\nhamiltonian: x\ninitial: {x: 1, y: 1, z: 1}\nstep: 1\nuntil: 1\n",
      three);
  check_refused(text, DVI_BAD_SIZE, ":2:11:", "even");
  check_refused(X "lagrangian: x'^2*log(x)\ninitial: {x: 0}\nstep: 1\nuntil: 1\n",
                DVI_CALLBACK_RETRY, ":2:18:", "at the start: log(x), x = 0 is not finite");
  check_refused(
      "coordinates: {R: rotation}\nlagrangian: R[1,1]'^2\nstep: 1\nuntil: 1\ninitial: {R: "
      "\"turn([1, 0, 0], 1)\"}\n",
      DVI_SINGULAR, ":2:13:", "the Lagrangian is degenerate");
}
END_TEST

START_TEST(starts_are_complete_and_fit)
{
  refused(MOVES "initial: {x': 1}\n", ":5:10:", "the start of x is not given");
  refused(MOVES "initial: {x: [1, 2]}\n", ":5:14:", "a vector of 2 for x, which is a number");
  refused(MOVES "initial: {x: 1, x': 2, p(x): 3}\n",
          ":5:10:", "give velocities or momenta, not both");
  refused(MOVES "initial:\n  x[1]: 1\n", ":6:3:", "'x' is no family");
  refused(MOVES "initial: {x: 1/0}\n", ":5:14:", "not a finite number");
  refused(MOVES "initial: {x: t}\n", ":5:14:", "the time cannot stand in a start");
}
END_TEST

START_TEST(settings_replace_numbers_and_nothing_else)
{
  static const char text[] = "parameters: {speed: 1, list: [1, 2], twice: 2*speed}\n" X
                             "lagrangian: x'^2\n"
                             "initial: {x: twice}\nstep: 1\nuntil: 1\n";
  static const char *const wrong[] = {"sped=1",    "list=1", "speed=fast", "speed",
                                      "speed=inf", "x=1",    "speed=0x10"};
  static const char *const words[] = {
      "did you mean speed?",        "'list' is a list",
      "'fast' is no finite number", "not of the form name=value",
      "'inf' is no finite number",  "a start is set through a parameter",
      "'0x10' is no finite number"};
  const double *q, *v, *p;
  for (int k = 0; k < 7; k++) {
    ck_assert_int_eq(parse_with(text, 1, &wrong[k]), DVI_BAD_OPTION);
    ck_assert_msg(strstr(message, words[k]) != NULL, "%s", message);
  }
  ck_assert_int_eq(parse_with(text, 2, (const char *const[]){"speed=1", "speed=2"}),
                   DVI_BAD_OPTION);
  ck_assert_int_eq(parse_with(text, 1, &(const char *){"speed=3"}), DVI_OK);
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert(fabs(q[0] - 6) < 1e-15);
  ck_assert(dvi_scene_parameter_at(scene, 0)->settable &&
            !dvi_scene_parameter_at(scene, 1)->settable);
}
END_TEST

START_TEST(limits_are_told)
{
  static char chain[8192] = "coordinates: {x: scalar}\nlagrangian: x'^2\n" RUN
                            "definitions:\n  a0: x\n";
  for (int k = 1; k < 300; k++) {
    const size_t used = strlen(chain);
    (void)snprintf(chain + used, sizeof chain - used, "  a%d: a%d + 1\n", k, k - 1);
  }
  refused(chain, ":263:9:", "definitions of definitions, more than 512 levels deep");
  check_refused("coordinates:\n  x[100000001]: scalar\n" RUN "lagrangian: 1\n", DVI_BAD_SIZE,
                ":2:3:", "more than 100000000 coordinates");
  check_refused("parameters: {N: 100000}\n" X "lagrangian: x'^2 + sum(i<j=1..N, i*j*x)\n" RUN,
                DVI_BAD_SIZE, ":3:20:", "a sum of more than");
  check_refused(X "lagrangian: x'^2 + sqrt(sum(i=1..100000000, sin(i*x)))\n" RUN, DVI_BAD_SIZE,
                ":2:", "2000000 parts");
}
END_TEST

START_TEST(what_is_not_finite_is_told_with_its_place)
{
  double L;
  ck_assert_int_eq(parse_scene(X "lagrangian: x'^2 - log(x - 1)\n" RUN), DVI_OK);
  ck_assert_int_ne(
      dvi_system_lagrangian(dvi_scene_system(scene), 2.5, &(double){0.75}, &(double){0}, &L),
      DVI_OK);
  ck_assert_str_eq(
      dvi_scene_fault(),
      "test.yaml:2:20: log(x - 1), x - 1 = -0.25 is not finite, at t = 2.5, where x = 0.75");
}
END_TEST

/* Two derivatives exist, but no series. The last one has a series, but with coefficients larger
 * than any double. */
START_TEST(what_has_no_series_is_told_with_its_place)
{
  static const char *const texts[] = {
      X "lagrangian: x'^2/2 - (x^2)^2.25\n" RUN,
      X "lagrangian: x'^2/2 - x^4 - (x^2 + x^4)^2.5\n" RUN,
      X "lagrangian: x'^2/2 + x^2*hypot(x, x^2)^3\n" RUN,
      X "lagrangian: x'^2/2 - 1e-290*sin(1e90*x)\n" RUN,
  };
  static const char *const words[] = {
      "test.yaml:2:22: (x^2)^2.25, (x^2) = 0 has no Taylor series, at t = 0, where x = 0",
      "test.yaml:2:28: (x^2 + x^4)^2.5, (x^2 + x^4) = 0 has no Taylor series, at t = 0, where x = "
      "0",
      "test.yaml:2:26: hypot(x, x^2)^3, hypot(x, x^2) = 0 has no Taylor series, at t = 0, where x "
      "= 0",
      "test.yaml: the Taylor series of all terms is not finite",
  };
  for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
    dvi_integrator *integrator = NULL;
    ck_assert_int_eq(parse_scene(texts[k]), DVI_OK);
    ck_assert_int_eq(dvi_integrator_create(dvi_scene_system(scene),
                                           "prolongation-collocation:derivatives=6", &integrator),
                     DVI_OK);
    ck_assert_int_eq(dvi_integrator_start(integrator, 0, &(double){0}, &(double){1}), DVI_OK);
    ck_assert_int_ne(dvi_integrator_step(integrator, 0.01), DVI_OK);
    ck_assert_str_eq(dvi_scene_fault(), words[k]);
    dvi_integrator_destroy(&integrator);
  }
}
END_TEST

START_TEST(null_is_no_scene_and_no_setting)
{
  const double *q, *v, *p;
  dvi_scene_facts facts;
  dvi_scene_start(NULL, &q, &v, &p);
  ck_assert(q == NULL && v == NULL && p == NULL);
  dvi_scene_facts_of(NULL, &facts);
  ck_assert(facts.form == NULL && facts.kernels == 0);
  ck_assert_int_eq(parse_with(X "lagrangian: x'^2\n" RUN, 1, &(const char *){NULL}),
                   DVI_BAD_ARGUMENT);
}
END_TEST

START_TEST(a_file_that_is_not_there_is_told)
{
  ck_assert_int_eq(dvi_scene_read("/nowhere/a.yaml", 0, NULL, &scene, message, sizeof message),
                   DVI_IO_ERROR);
  ck_assert_ptr_nonnull(strstr(message, "/nowhere/a.yaml"));
}
END_TEST

/* Counts what is written, and refuses it once `left` is 0. */
typedef struct paper {
  long written, left;
} paper;

static int append_text(const char *text, size_t size, void *user)
{
  paper *own = user;
  (void)text;
  own->written += (long)size;
  return own->left-- == 0;
}

START_TEST(c_is_written_under_a_name_and_to_its_end)
{
  paper whole = {0, -1}, cut = {0, 3};
  ck_assert_int_eq(parse_scene(X "lagrangian: x'^2 - x^4\n" RUN), DVI_OK);
  ck_assert_int_eq(dvi_scene_emit_c(scene, "no name", append_text, &whole), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_scene_emit_c(scene, "", append_text, &whole), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(whole.written, 0);
  ck_assert_int_eq(dvi_scene_emit_c(scene, "quartic", append_text, &cut), DVI_IO_ERROR);
  ck_assert_int_eq(dvi_scene_emit_c(scene, "quartic", append_text, &whole), DVI_OK);
  ck_assert_int_gt(whole.written, cut.written);
}
END_TEST

SUITE(scene_errors)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_test(tests, what_nothing_mentions_is_known);
  tcase_add_test(tests, unknown_names_are_told_with_the_nearest);
  tcase_add_test(tests, columns_have_one_name_each);
  tcase_add_test(tests, words_from_elsewhere_are_told_with_those_of_scenes);
  tcase_add_test(tests, a_start_that_is_no_number_is_told);
  tcase_add_test(tests, shapes_that_do_not_fit_are_told);
  tcase_add_test(tests, indices_are_checked_for_every_element);
  tcase_add_test(tests, velocities_and_momenta_stand_where_they_make_sense);
  tcase_add_test(tests, names_are_declared_once_and_before_their_use);
  tcase_add_test(tests, sections_that_are_missing_or_do_not_go_together_are_told);
  tcase_add_test(tests, forces_that_do_not_go_are_told);
  tcase_add_test(tests, noise_that_does_not_go_is_told);
  tcase_add_test(tests, constraints_that_do_not_go_are_told);
  tcase_add_test(tests, what_no_system_can_be_made_of_has_its_place);
  tcase_add_test(tests, starts_are_complete_and_fit);
  tcase_add_test(tests, settings_replace_numbers_and_nothing_else);
  tcase_add_test(tests, limits_are_told);
  tcase_add_test(tests, what_is_not_finite_is_told_with_its_place);
  tcase_add_test(tests, what_has_no_series_is_told_with_its_place);
  tcase_add_test(tests, null_is_no_scene_and_no_setting);
  tcase_add_test(tests, a_file_that_is_not_there_is_told);
  tcase_add_test(tests, c_is_written_under_a_name_and_to_its_end);
}
