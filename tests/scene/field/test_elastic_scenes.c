/* Scenes of solids are those solids: laws written as energies have the motion of those that are
 * named, conditions, loads and probes are where they are said to be. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scene/parsed.h"
#include "support/suite.h"

enum { TEXT_SIZE = 2048, UNKNOWNS_MOST = 200 };

#define BLOCK "mesh: {generator: kuhn, cells: [2, 2, 2], grading: 2}\nfield: elastic\n"
#define PLANE "mesh: {generator: kuhn, cells: [3, 2]}\nfield: elastic\n"
#define SPIN "initial: {u': \"[0.2*y, -0.1*z, 0.15*x*z]\"}\n"
#define SOFT "materials: {all: {law: neo-hookean, lambda: 1, mu: 1}}\n"

static const char *with_law(const char *mesh, const char *law, const char *rest)
{
  static char text[TEXT_SIZE];
  (void)snprintf(text, sizeof text, "%smaterials: {all: {law: %s}}\n%s", mesh, law, rest);
  return text;
}

/* Runs the mechanical system of the scene to a time, and gives the coordinates there. */
static void run_to(const dvi_system *system, double h, int steps, double *q)
{
  const double *at, *v, *p;
  dvi_integrator *integrator = NULL;
  dvi_scene_start(scene, &at, &v, &p);
  ck_assert_msg(dvi_integrator_create(system, "galerkin:degree=4", &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, at, p), DVI_OK);
  for (int i = 0; i < steps; i++)
    ck_assert_msg(dvi_integrator_step(integrator, h) == DVI_OK, "%s", dvi_last_error());
  memcpy(q, dvi_integrator_q(integrator), (size_t)dvi_system_nq(system) * sizeof *q);
  dvi_integrator_destroy(&integrator);
}

static double watched(const dvi_system *system, const char *name, double t, const double *q,
                      const double *p)
{
  double value[32] = {0};
  const int count = dvi_system_invariant_count(system);
  ck_assert_int_le(count, 32);
  ck_assert_msg(dvi_system_invariants(system, t, q, p, value) == DVI_OK, "%s", dvi_last_error());
  for (int i = 0; i < count; i++)
    if (strcmp(dvi_system_invariant_name(system, i), name) == 0) return value[i];
  ck_abort_msg("nothing is watched as %s", name);
  return 0;
}

static double at_start(const dvi_system *system, const char *name)
{
  const double *q, *v, *p;
  dvi_scene_start(scene, &q, &v, &p);
  return watched(system, name, 0, q, p);
}

/* ---- laws ---- */

/* Named laws, and the same as an energy. The corner is the last node. */
static const struct {
  const char *law, *energy;
} laws[] = {{"neo-hookean, lambda: 1, mu: 1", "\"(I1 - 3)/2 - log(J) + log(J)^2/2\""},
            {"svk, lambda: 1, mu: 1", "\"(I1 - 3)^2/8 + (I1^2 - 2*I2 - 2*I1 + 3)/4\""},
            {"mooney-rivlin, lambda: 1, mu: 1, mooney: 0.3",
             "\"0.35*(I1 - 3) + 0.15*(I2 - 3) - 1.3*log(J) + 0.2*log(J)^2\""}};
enum { LAWS = sizeof laws / sizeof *laws };

/* Both are sums of some ten terms, in different orders. */
static void check_law(int i, const char *mesh, const char *rest)
{
  double named[UNKNOWNS_MOST], written[UNKNOWNS_MOST];
  const dvi_system *system = open_scene(with_law(mesh, laws[i].law, rest));
  const int n = dvi_system_nq(system);
  ck_assert_int_le(n, UNKNOWNS_MOST);
  run_to(system, 0.1, 3, named);
  system = open_scene(with_law(mesh, laws[i].energy, rest));
  run_to(system, 0.1, 3, written);
  for (int k = 0; k < n; k++) ck_assert_double_eq_tol(written[k], named[k], 1e-13);
}

START_TEST(energies_in_space_are_the_laws_that_they_write)
{
  check_law(_i, BLOCK, SPIN);
}
END_TEST

START_TEST(invariants_in_a_plane_are_those_of_plane_strain)
{
  check_law(_i, PLANE, "initial: {u': \"[0.2*y, 0.15*x*y]\"}\n");
}
END_TEST

START_TEST(derivatives_of_written_energies_agree_with_differences)
{
  double q[UNKNOWNS_MOST], v[UNKNOWNS_MOST];
  const dvi_system *system = open_scene(
      with_law(BLOCK, "\"(I1 - 3)/2 - log(J) + log(J)^2/2 + (F[1,2] + F[2,1])^4\"", SPIN));
  for (int i = 0; i < dvi_system_nq(system); i++) q[i] = v[i] = 0.02 * sin(1.0 + 12.9898 * i);
  ck_assert_msg(dvi_system_check(system, 0.3, q, v, 1e-6, NULL) == DVI_OK, "%s", dvi_last_error());
}
END_TEST

START_TEST(young_and_poisson_are_lame_constants)
{
  double lame[UNKNOWNS_MOST], young[UNKNOWNS_MOST];
  /* E = mu (3 lambda + 2 mu)/(lambda + mu), nu = lambda/2/(lambda + mu) */
  run_to(open_scene(with_law(BLOCK, "linear, lambda: 1, mu: 1", SPIN)), 0.1, 2, lame);
  const dvi_system *system = open_scene(with_law(BLOCK, "linear, young: 2.5, poisson: 0.25", SPIN));
  run_to(system, 0.1, 2, young);
  for (int k = 0; k < dvi_system_nq(system); k++) ck_assert_double_eq_tol(young[k], lame[k], 1e-14);
}
END_TEST

/* The digits of an independent program, of a block that is graded along x. */
START_TEST(one_grading_is_that_of_the_first_axis)
{
  static const double corner[] = {1.121240896990, 0.880808459494, 1.079014224797};
  double q[UNKNOWNS_MOST];
  const dvi_system *system = open_scene(BLOCK SOFT SPIN);
  const int n = dvi_system_nq(system);
  run_to(system, 0.1, 10, q);
  for (int i = 0; i < 3; i++) ck_assert_double_eq_tol(1 + q[n - 3 + i], corner[i], 1e-10);
}
END_TEST

/* ---- conditions and loads ---- */

START_TEST(components_are_held_by_themselves)
{
  int64_t unknowns;
  (void)open_scene(BLOCK SOFT "boundary: {left: {fixed: {x: 0}}, bottom: {fixed: {y: 0.1*t}}}\n");
  (void)dvi_elastic_unknowns(dvi_scene_elastic(scene), &unknowns);
  ck_assert_int_eq(unknowns, 81 - 9 - 9);
  (void)open_scene(BLOCK SOFT "boundary: {left: fixed, right: free}\n");
  (void)dvi_elastic_unknowns(dvi_scene_elastic(scene), &unknowns);
  ck_assert_int_eq(unknowns, 81 - 27);
}
END_TEST

/* The mass is 1, and the weight acts on all of it. The area of a side is 1, too. */
START_TEST(loads_act_with_their_volume_and_area)
{
  const dvi_system *system = open_scene(
      BLOCK SOFT "loads: {gravity: [0, 0, -9.5], all: {force: [2, 0, 0]}, left: {traction: "
                 "3*normal}}\ninitial: {u: [0.5, 0, 2]}\nprobes: {work: {of: load}}\n");
  ck_assert_double_eq_tol(at_start(system, "work"), 9.5 * 2 - 2 * 0.5 + 3 * 0.5, 1e-13);
}
END_TEST

START_TEST(gravity_knows_the_density_of_each_part)
{
  /* of a part that lies in another one, the last density counts */
  const dvi_system *system = open_scene(
      "mesh: {generator: kuhn, cells: [2, 2, 2]}\nfield: elastic\nmaterials: {all: {law: svk, "
      "lambda: 1, mu: 1, rho: 3}}\nloads: {gravity: [0, 0, -1]}\ninitial: {u: [0, 0, 2]}\nprobes: "
      "{work: {of: load}}\n");
  ck_assert_double_eq_tol(at_start(system, "work"), 6, 1e-13);
}
END_TEST

START_TEST(displacements_that_are_given_have_rates)
{
  double u[81], rate[81];
  (void)open_scene(BLOCK SOFT "boundary: {left: {fixed: \"[0, 0.1*sin(2*t), y*t]\"}}\n");
  ck_assert_int_eq(dvi_elastic_lift(dvi_scene_elastic(scene), 0.5, NULL, NULL, u, rate), DVI_OK);
  const double *X = dvi_mesh_points(dvi_elastic_mesh(dvi_scene_elastic(scene)));
  for (int k = 0; k < 27; k++) {
    if (X[3 * k] > 0) continue;
    ck_assert_double_eq_tol(u[3 * k + 1], 0.1 * sin(1.0), 1e-15);
    ck_assert_double_eq_tol(rate[3 * k + 1], 0.2 * cos(1.0), 1e-15);
    ck_assert_double_eq_tol(u[3 * k + 2], 0.5 * X[3 * k + 1], 1e-15);
    ck_assert_double_eq_tol(rate[3 * k + 2], X[3 * k + 1], 1e-15);
  }
}
END_TEST

/* ---- probes ---- */

#define STRETCHED                                                                              \
  "initial: {u: [0.1*x, -0.05*y, 0.02*x], u': [y, 0, z]}\nprobes: {u: {of: u, at: [0.3, 0.4, " \
  "0.6]}, place: {of: x, at: [0.3, 0.4, 0.6], along: [0, 2, 0]}, v: {of: u', at: [0.3, 0.4, "  \
  "0.6]}, s: {of: stress, at: [0.3, 0.4, 0.6]}, m: {of: von_mises, at: [0.3, 0.4, 0.6]}, n: "  \
  "{of: stress, at: [0.3, 0.4, 0.6], along: [3, 0, 0]}, T: {of: kinetic}, W: {of: stored}}\n"

START_TEST(probes_of_a_uniform_strain_are_exact)
{
  const dvi_system *system = open_scene(with_law(BLOCK, "linear, lambda: 1, mu: 1", STRETCHED));
  /* e = diag(0.1, -0.05, 0) with e_xz = 0.01, and sigma = tr e + 2 e */
  const double xx = 0.25, yy = -0.05, zz = 0.05, xz = 0.02,
               mises = sqrt(
                   ((xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx)) / 2 +
                   3 * xz * xz);
  ck_assert_double_eq_tol(at_start(system, "u_x"), 0.03, 1e-15);
  ck_assert_double_eq_tol(at_start(system, "place"), 2 * 0.38, 1e-15);
  ck_assert_double_eq_tol(at_start(system, "v_x"), 0.4, 1e-15);
  ck_assert_double_eq_tol(at_start(system, "v_z"), 0.6, 1e-15);
  ck_assert_double_eq_tol(at_start(system, "s_xx"), xx, 1e-14);
  ck_assert_double_eq_tol(at_start(system, "s_yy"), yy, 1e-14);
  ck_assert_double_eq_tol(at_start(system, "s_zz"), zz, 1e-14);
  ck_assert_double_eq_tol(at_start(system, "s_xz"), xz, 1e-14);
  ck_assert_double_eq_tol(at_start(system, "n"), xx, 1e-14);
  ck_assert_double_eq_tol(at_start(system, "m"), mises, 1e-14);
  /* W = (tr e)^2/2 + e:e of the volume 1 */
  ck_assert_double_eq_tol(at_start(system, "W"), 0.00125 + 0.0127, 1e-15);
}
END_TEST

/* In a plane sigma_zz = lambda tr e of small strains belongs to von Mises' stress. */
START_TEST(von_mises_in_a_plane_has_the_stress_across_it)
{
  const dvi_system *system = open_scene(
      with_law(PLANE, "linear, lambda: 3, mu: 1",
               "initial: {u: [0.1*x, 0]}\nprobes: {m: {of: von_mises, at: [0.3, 0.4]}}\n"));
  ck_assert_double_eq_tol(at_start(system, "m"), 0.2, 1e-14); /* 2 mu e_xx */
}
END_TEST

/* ---- what is refused ---- */

static void refused(const char *text, const char *place, const char *words)
{
  check_refused(text, DVI_BAD_FILE, place, words);
}

/* A section in line 4 of the scene of a block. */
static void section_refused(const char *section, int column, const char *words)
{
  char text[TEXT_SIZE], place[32];
  (void)snprintf(text, sizeof text, BLOCK SOFT "%s\n", section);
  (void)snprintf(place, sizeof place, ":4:%d:", column);
  refused(text, place, words);
}

static void law_refused(const char *law, int column, const char *words)
{
  char place[32];
  (void)snprintf(place, sizeof place, ":3:%d:", column);
  refused(with_law(BLOCK, law, ""), place, words);
}

START_TEST(materials_have_a_law_and_its_constants)
{
  law_refused("neohooke", 24, "a law is linear, svk, neo-hookean or mooney-rivlin");
  law_refused("svk, lambda: 1", 18, "a material has lambda and mu, or young and poisson");
  law_refused("svk, lambda: 1, mu: 1, young: 1, poisson: 0.2", 18, "lambda and mu, or young");
  law_refused("svk, lambda: 1, mu: -1", 44, "mu is -1, where a number above 0 is wanted");
  law_refused("svk, lambda: -1, mu: 1", 37, "above -2 mu/3 is wanted, here -0.666667");
  law_refused("svk, young: 1, poisson: 0.5", 48, "above -1 and below 0.5");
  law_refused("svk, lambda: 1, mu: 1, rho: 0", 52, "rho is 0");
  law_refused("svk, lambda: 1, mu: 1, beta: -2", 53, "beta is -2");
  law_refused("svk, lambda: 1, mu: 1, mooney: 0.2", 55, "'mooney' is of 'law: mooney-rivlin'");
  law_refused("x^2*I1", 24, "a function of F, I1, I2 and J alone");
  refused(BLOCK, ":2:8:", "a solid has materials");
  refused(BLOCK "materials: {core: {law: svk, lambda: 1, mu: 1}}\n",
          ":3:13:", "no part 'core' of cells");
}
END_TEST

START_TEST(energies_with_a_stress_at_rest_are_refused)
{
  check_refused(with_law(BLOCK, "I1", ""), DVI_BAD_ARGUMENT,
                ":3:12:", "has a stress of 2 at F = I");
  check_refused(with_law(BLOCK, "3 - I1 + 2*log(J)", ""), DVI_BAD_ARGUMENT,
                ":3:12:", "no minimum at F = I");
}
END_TEST

START_TEST(conditions_and_loads_fit_the_solid)
{
  section_refused("boundary: {lft: fixed}", 12, "no part 'lft'");
  section_refused("boundary: {left: {fixed: [0, 1]}}", 26,
                  "a displacement is a vector of 2 here, where a vector of 3 is needed");
  section_refused("boundary: {left: {fixed: {w: 0}}}", 27, "has no 'w'; it has x, y and z");
  section_refused("boundary: {left: {free: 0}}", 19, "a condition");
  section_refused("loads: {all: {traction: [1, 0, 0]}}", 9, "of facets for a traction");
  section_refused("loads: {left: {force: [1, 0, 0]}}", 9, "'left' has no volume for a force");
  section_refused("loads: {left: {traction: [1, 0]}}", 26, "a traction is a vector of 2 here");
  section_refused("loads: {all: {force: normal}}", 22, "a force has no normal; a traction has one");
  section_refused("loads: {gravity: [0, -1]}", 18, "gravity has 3 coordinates here");
  check_refused(BLOCK SOFT "boundary: {all: fixed}\n", DVI_BAD_ARGUMENT,
                ":4:11:", "nothing is unknown");
}
END_TEST

START_TEST(starts_are_whole_and_away_from_obstacles)
{
  section_refused("initial: {u: [0, 0]}", 14, "a start is a vector of 2 here");
  section_refused("initial: {u: [-3*x, 0, 0]}", 10, "tetrahedron 0");
  section_refused("initial: {u: [log(x - 2), 0, 0]}", 10, "the start is not finite at node 0");
  section_refused("obstacles: {floor: {plane: {point: [0, 0, 0.5], normal: [0, 0, 1]}, "
                  "restitution: 0.5}}",
                  20, "is 0.5 inside of the obstacle 'floor'");
  section_refused("obstacles: {bowl: {hollow: {centre: [0, 0, 0], radius: 1}, restitution: 1}}", 19,
                  "inside of the obstacle 'bowl'");
  section_refused("obstacles: {floor: {ball: {centre: [0, 0, -3], radius: 1}}}", 20,
                  "an obstacle needs 'restitution'");
  section_refused("obstacles: {floor: {restitution: 1}}", 20, "a plane, a ball, or the hollow");
}
END_TEST

START_TEST(probes_know_what_they_are_of)
{
  section_refused("probes: {a: {of: stres, at: [0, 0, 0]}}", 18, "u, u', x, stress, von_mises");
  section_refused("probes: {a: {of: stress}}", 13, "a probe of stress is at a point");
  section_refused("probes: {a: {at: [3, 0, 0]}}", 18, "outside of the mesh");
  section_refused("probes: {hits: {of: kinetic}}", 10, "there is a column 'hits' already");
  section_refused("probes: {a: {of: kinetic, part: left}}", 33, "no part 'left' of cells");
}
END_TEST

START_TEST(what_is_of_other_fields_is_refused)
{
  section_refused("star: whitney", 7, "'star' is not of 'field: elastic'");
  section_refused("damping: 0.1", 10, "a material has alpha and beta");
  section_refused("source: x", 9, "'source' is of 'field: wave'");
  section_refused("parameters: {J: 3}", 14, "'J' is a name of a solid's place or strain");
  refused("mesh: {generator: box, cells: [2, 2, 2]}\nfield: elastic\n" SOFT,
          ":1:7:", "which are boxes");
  refused("mesh: {generator: kuhn, cells: [2, 2]}\nfield: wave\nloads: {gravity: 1}\n",
          ":3:8:", "'loads' is of 'field: elastic'");
}
END_TEST

SUITE(elastic_scenes)
{
  tcase_add_checked_fixture(tests, NULL, release_scene);
  tcase_add_loop_test(tests, energies_in_space_are_the_laws_that_they_write, 0, LAWS);
  tcase_add_loop_test(tests, invariants_in_a_plane_are_those_of_plane_strain, 0, LAWS);
  tcase_add_test(tests, derivatives_of_written_energies_agree_with_differences);
  tcase_add_test(tests, young_and_poisson_are_lame_constants);
  tcase_add_test(tests, one_grading_is_that_of_the_first_axis);
  tcase_add_test(tests, components_are_held_by_themselves);
  tcase_add_test(tests, loads_act_with_their_volume_and_area);
  tcase_add_test(tests, gravity_knows_the_density_of_each_part);
  tcase_add_test(tests, displacements_that_are_given_have_rates);
  tcase_add_test(tests, probes_of_a_uniform_strain_are_exact);
  tcase_add_test(tests, von_mises_in_a_plane_has_the_stress_across_it);
  tcase_add_test(tests, materials_have_a_law_and_its_constants);
  tcase_add_test(tests, energies_with_a_stress_at_rest_are_refused);
  tcase_add_test(tests, conditions_and_loads_fit_the_solid);
  tcase_add_test(tests, starts_are_whole_and_away_from_obstacles);
  tcase_add_test(tests, probes_know_what_they_are_of);
  tcase_add_test(tests, what_is_of_other_fields_is_refused);
}
