/* Scenes of components: names with prefixes, what is merged and what is left out, multipliers as
 * the efforts of ports, and places that are refused. */
#define _XOPEN_SOURCE 700 /* symlink */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/files.h"
#include "support/suite.h"

enum { TEXT_SIZE = 2048 };

static char message[TEXT_SIZE];

static void write_file(const char *name, const char *text)
{
  write_bytes(path_in_folder(name), (const unsigned char *)text, strlen(text));
}

static const char oscillator[] = "title: a mass on a spring\n"
                                 "parameters: {m: 1, k: 1, start: 1}\n"
                                 "coordinates: {x: scalar}\n"
                                 "definitions: {stretch: x}\n"
                                 "lagrangian: m/2*x'^2 - k/2*stretch^2\n"
                                 "invariants: {E: (p(x)^2/m + k*x^2)/2}\n"
                                 "initial: {x: start}\n"
                                 "method: verlet\n"
                                 "step: 0.05\n"
                                 "until: 50\n";

static const char ending[] = "method: galerkin:degree=2\nstep: 0.05\nuntil: 50\n";

static void make_files(void)
{
  make_folder();
  ck_assert_int_eq(mkdir(path_in_folder("scenes"), 0700), 0);
  ck_assert_int_eq(mkdir(path_in_folder("scenes/parts"), 0700), 0);
  write_file("outside.yaml", oscillator);
  write_file("scenes/oscillator.yaml", oscillator);
  write_file("scenes/parts/spring.yml", oscillator);
  write_file("scenes/parts/pair.yaml", "include: {a: spring.yml, b: spring.yml}\n"
                                       "constraints: {port: a_x - b_x}\n");
  write_file("scenes/self.yaml", "include: {me: self.yaml}\ncoordinates: {x: scalar}\n");
  ck_assert_int_eq(symlink("../outside.yaml", path_in_folder("scenes/link.yaml")), 0);
  ck_assert_int_eq(symlink("..", path_in_folder("scenes/up")), 0);
  ck_assert_int_eq(mkdir(path_in_folder("scenes/folder.yaml"), 0700), 0);
}

static void remove_files(void)
{
  char command[512];
  (void)snprintf(command, sizeof command, "rm -r %s*", path_in_folder(""));
  ck_assert_int_eq(system(command), 0); /* NOLINT(cert-env33-c): a folder of the test's own */
  remove_folder();
}

/* Read a scene of this text in the folder scenes. */
static dvi_status read_main(const char *text, dvi_scene **scene)
{
  char whole[TEXT_SIZE];
  (void)snprintf(whole, sizeof whole, "%s%s", text, ending);
  write_file("scenes/main.yaml", whole);
  return dvi_scene_read(path_in_folder("scenes/main.yaml"), 0, NULL, scene, message,
                        sizeof message);
}

static dvi_scene *open_main(const char *text)
{
  dvi_scene *scene;
  ck_assert_msg(read_main(text, &scene) == DVI_OK, "%s", message);
  return scene;
}

static dvi_integrator *start(const dvi_scene *scene, const char *method)
{
  const double *q, *v, *p;
  dvi_integrator *integrator;
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_msg(dvi_integrator_create(dvi_scene_system(scene), method, &integrator) == DVI_OK, "%s",
                dvi_last_error());
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, q, p), DVI_OK);
  return integrator;
}

static const char welded[] = "include: {left: oscillator.yaml, right: oscillator.yaml}\n"
                             "parameters: {right_m: 2, right_k: 3}\n"
                             "constraints: {port: left_x - right_x}\n";

static const char *const methods[] = {"galerkin:degree=1", "galerkin:degree=2", "verlet",
                                      "galerkin:degree=4"};

/* The discretised interconnection is the interconnection of discretisations: two welded oscillators
 * move as one with the sum of masses and of stiffnesses, to rounding errors. */
START_TEST(welded_oscillators_are_one)
{
  dvi_scene *pair = open_main(welded);
  dvi_scene *one = open_main("include: {only: oscillator.yaml}\n"
                             "parameters: {only_m: 3, only_k: 4}\n");
  dvi_integrator *a = start(pair, methods[_i]), *b = start(one, methods[_i]);
  double worst = 0;
  for (int k = 0; k < 1000; k++) {
    ck_assert_msg(dvi_integrator_step(a, 0.05) == DVI_OK, "%s", dvi_last_error());
    ck_assert_int_eq(dvi_integrator_step(b, 0.05), DVI_OK);
    const double *qa = dvi_integrator_q(a), *pa = dvi_integrator_p(a);
    const double *qb = dvi_integrator_q(b), *pb = dvi_integrator_p(b);
    worst = fmax(worst, fabs(qa[0] - qb[0]));
    worst = fmax(worst, fabs(qa[1] - qb[0]));
    worst = fmax(worst, fabs(pa[0] + pa[1] - pb[0]));
  }
  ck_assert_double_lt(worst, 2e-12);
  dvi_integrator_destroy(&a);
  dvi_integrator_destroy(&b);
  dvi_scene_destroy(&pair);
  dvi_scene_destroy(&one);
}
END_TEST

/* The left mass moves by x'' = -(k/m) x of the whole, so that the port's force on it is
 * -lambda = m_l x'' + k_l x. */
START_TEST(the_multiplier_is_the_effort_of_the_port)
{
  dvi_scene *pair = open_main(welded);
  dvi_integrator *integrator = start(pair, "galerkin:degree=4");
  for (int k = 1; k <= 200; k++) {
    double lambda;
    ck_assert_int_eq(dvi_integrator_step(integrator, 0.05), DVI_OK);
    ck_assert_int_eq(dvi_integrator_reactions(integrator, &lambda), DVI_OK);
    const double x = cos(sqrt(4.0 / 3) * 0.05 * k);
    ck_assert_double_eq_tol(lambda, 4.0 / 3 * x - x, 1e-12);
  }
  dvi_integrator_destroy(&integrator);
  dvi_scene_destroy(&pair);
}
END_TEST

START_TEST(names_have_the_prefixes_of_all_levels)
{
  dvi_scene *scene = open_main("include: {left: parts/pair.yaml, right: ./oscillator.yaml}\n"
                               "parameters: {K: 5, left_a_k: 2*K, right_start: 0.5}\n"
                               "initial: {left_a_x: 0.5, left_b_x: 0.5}\n"
                               "forces: {right_x: -left_a_stretch}\n"
                               "constraints: {port: left_a_x - right_x}\n");
  static const char *const coordinate[] = {"left_a_x", "left_b_x", "right_x"};
  static const char *const constraint[] = {"left_port", "port"};
  const dvi_system_terms *terms = dvi_scene_terms(scene);
  const double *q, *v, *p;
  dvi_scene_start(scene, &q, &v, &p);
  for (int i = 0; i < 3; i++) {
    ck_assert_str_eq(dvi_scene_coordinate(scene, i), coordinate[i]);
    ck_assert_double_eq(q[i], 0.5);
  }
  ck_assert_int_eq(terms->holonomic_count, 2);
  for (int i = 0; i < 2; i++) ck_assert_str_eq(terms->holonomics[i].name, constraint[i]);
  ck_assert_int_eq(terms->invariant_count, 0);
  ck_assert_ptr_null(dvi_scene_plan_of(scene)->title);
  ck_assert_str_eq(dvi_scene_plan_of(scene)->method, "galerkin:degree=2");
  double K = 0;
  const dvi_scene_parameter *parameter;
  for (int i = 0; (parameter = dvi_scene_parameter_at(scene, i)) != NULL; i++)
    if (strcmp(parameter->name, "left_a_k") == 0) K = parameter->value;
  ck_assert_double_eq(K, 10);
  dvi_scene_destroy(&scene);
}
END_TEST

/* Indices, families, parts of motions, words that are no names, and the ground have no prefix. */
START_TEST(a_component_may_have_families_and_joints)
{
  write_file("scenes/arm.yaml",
             "parameters: {m: 2, J: [0.1, 0.2, 0.3], g: 9.81}\n"
             "coordinates:\n  B: motion\n  u[3]: scalar\n"
             "definitions: {w: omega(B)}\n"
             "lagrangian: m/2*dot(B.x', B.x') + sum(i, J[i]*w[i]^2)/2 - m*g*B.x[3]\n"
             "  + sum(i, u[i]'^2 - u[i]^2*(1 + cos(pi*t))^2)/2\n"
             "joints: {pivot: {ball: [ground, B], at: [0, 0, 0]}}\n"
             "forces:\n  u[i]: -u[i]'*i\n"
             "initial:\n  B.x: [0.5, 0, 0]\n  u[i]: sin(i)\n  u[2]: 7\n"
             "  B.R: turn([0, 0, 1], 0)\n  omega(B): [0, 1, 0]\n  B.x': [0, 0, -0.5]\n");
  dvi_scene *scene = open_main(
      "include: {a: arm.yaml, b: arm.yaml}\n"
      "initial:\n  b_B.x: [-0.5, 0, 0]\n  b_B.x': [0, 0, 0.5]\n  b_u[3]: 8\n"
      "joints: {both: {distance: [a_B, b_B], at: [0.5, 0, 0.1], to: [-0.5, 0, 0.2]}}\n");
  ck_assert_str_eq(dvi_scene_coordinate(scene, 0), "a_B_R_11");
  ck_assert_int_eq(dvi_system_constraint_count(dvi_scene_system(scene)), 7);
  const double *q, *v, *p;
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_double_eq(q[9], 0.5);
  ck_assert_double_eq(q[13], 7);
  ck_assert_double_eq(q[15 + 9], -0.5);
  ck_assert_double_eq(q[15 + 14], 8);
  dvi_integrator *integrator = start(scene, "lie-galerkin:degree=2");
  for (int k = 0; k < 20; k++)
    ck_assert_msg(dvi_integrator_step(integrator, 0.01) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_scene_destroy(&scene);
}
END_TEST

/* Potentials keep their groups, kinetic energies, dissipations and forces are added. */
START_TEST(sections_of_all_files_are_added)
{
  write_file("scenes/bond.yaml", "coordinates: {x: scalar}\nkinetic: x'^2\n"
                                 "potentials: {fast: {bond: 50*x^2}, slow: {well: x^4}}\n"
                                 "dissipation: x'^2/2\nforces: {x: 1}\ninitial: {x: 1}\n");
  dvi_scene *scene = open_main("include: {a: bond.yaml, b: bond.yaml}\n"
                               "potentials: {fast: {tie: (a_x - b_x)^2}, pull: -a_x}\n"
                               "forces: {b_x: 2, a_x: 3}\ninitial: {b_x: 2}\n");
  const dvi_system_terms *terms = dvi_scene_terms(scene);
  ck_assert_int_eq(terms->potential_count, 6);
  int fast = 0;
  for (int k = 0; k < terms->potential_count; k++) fast += terms->potentials[k].fast;
  ck_assert_int_eq(fast, 3);
  const double q[] = {1, 2}, v[] = {10, 20}, t = 0;
  double F[2], sum[2] = {0, 0};
  for (int k = 0; k < terms->force_count; k++) {
    const dvi_force *force = &terms->forces[k];
    ck_assert_int_eq(force->value_batch != NULL ? force->value_batch(1, &t, q, v, F, force->user)
                                                : force->value(t, q, v, F, force->user),
                     0);
    for (int i = 0; i < 2; i++) sum[i] += F[i];
  }
  ck_assert_double_eq(sum[0], 1 + 3 - 10);
  ck_assert_double_eq(sum[1], 1 + 2 - 20);
  dvi_scene_destroy(&scene);
}
END_TEST

START_TEST(the_files_of_a_scene_are_listed)
{
  dvi_scene *scene = open_main(welded);
  dvi_scene_file file;
  ck_assert_int_eq(dvi_scene_file_of(scene, 0, &file), 1);
  ck_assert_str_eq(file.name, path_in_folder("scenes/main.yaml"));
  for (int i = 1; i < 3; i++) {
    ck_assert_int_eq(dvi_scene_file_of(scene, i, &file), 1);
    ck_assert_str_eq(file.name, path_in_folder("scenes/oscillator.yaml"));
    ck_assert_uint_eq(file.size, strlen(oscillator));
    ck_assert_mem_eq(file.text, oscillator, file.size);
  }
  ck_assert_int_eq(dvi_scene_file_of(scene, 3, &file), 0);
  ck_assert_int_eq(dvi_scene_file_of(scene, -1, &file), 0);
  ck_assert_int_eq(dvi_scene_file_of(NULL, 0, &file), 0);
  dvi_scene_destroy(&scene);
}
END_TEST

/* Another value in an included file makes another system, whose states are refused. */
START_TEST(a_checkpoint_knows_the_included_files)
{
  char path[512];
  dvi_scene *scene = open_main(welded);
  dvi_integrator *integrator = start(scene, "galerkin:degree=2");
  (void)snprintf(path, sizeof path, "%s", path_in_folder("state"));
  ck_assert_int_eq(dvi_integrator_step(integrator, 0.05), DVI_OK);
  ck_assert_int_eq(dvi_integrator_save(integrator, path), DVI_OK);
  ck_assert_int_eq(dvi_integrator_restore(integrator, path), DVI_OK);
  dvi_integrator_destroy(&integrator);
  dvi_scene_destroy(&scene);
  write_file("scenes/oscillator.yaml", "parameters: {m: 1, k: 1, start: 1}\n"
                                       "coordinates: {x: scalar}\n"
                                       "lagrangian: m/2*x'^2 - k/2*x^2 - x^4/4\n"
                                       "initial: {x: start}\n");
  scene = open_main(welded);
  integrator = start(scene, "galerkin:degree=2");
  ck_assert_int_eq(dvi_integrator_restore(integrator, path), DVI_BAD_FILE);
  dvi_integrator_destroy(&integrator);
  dvi_scene_destroy(&scene);
}
END_TEST

/* ---- refusals ---- */

static const struct {
  const char *text;
  dvi_status status;
  const char *sentence;
} bad[] = {
    {"include: {a: /etc/passwd}\n", DVI_BAD_FILE,
     "main.yaml:1:14: the file '/etc/passwd' is named from the root; name it from the scene's "
     "folder\n"},
    {"include: {a: ../outside.yaml}\n", DVI_BAD_FILE,
     "main.yaml:1:14: the file '../outside.yaml' is named by way of '..'; such files lie in the "
     "folder of the scene or below\n"},
    {"include: {a: parts/../oscillator.yaml}\n", DVI_BAD_FILE, "is named by way of '..'"},
    {"include: {a: link.yaml}\n", DVI_BAD_FILE,
     "main.yaml:1:14: the file 'link.yaml' is not in the scene's folder or below; put it there\n"},
    {"include: {a: up/outside.yaml}\n", DVI_BAD_FILE, "is not in the scene's folder or below"},
    {"include: {a: folder.yaml}\n", DVI_BAD_FILE, "'folder.yaml' is no file that can be read"},
    {"include: {a: none.yaml}\n", DVI_BAD_FILE, "cannot be read: No such file or directory"},
    {"include: {a: oscillator}\n", DVI_BAD_FILE,
     "'oscillator' is no scene: its name ends in .yaml or .yml"},
    {"include: {a-b: oscillator.yaml}\n", DVI_BAD_FILE, "main.yaml:1:11: 'a-b' is no name"},
    {"include: [oscillator.yaml]\n", DVI_BAD_FILE, "main.yaml:1:10: include is a mapping"},
    {"include: {a: [oscillator.yaml]}\n", DVI_BAD_FILE, "the file of a component is one line"},
    {"include: {a: self.yaml}\n", DVI_BAD_SIZE,
     "self.yaml:1:15: more than 8 levels of components; does one include itself?\n"},
    {"include: {a: oscillator.yaml}\ndefinitions: {a_stretch: 2}\n", DVI_BAD_FILE,
     "main.yaml:2:15: the name 'a_stretch' stands in '"},
    {"include: {a: oscillator.yaml}\ndefinitions: [a_stretch]\n", DVI_BAD_FILE,
     "main.yaml:2:14: definitions is a mapping"},
    {"include: {a: oscillator.yaml}\nkinetic: a_x'^2\n", DVI_BAD_FILE,
     "there must be one of these"},
    {"include: {a: oscillator.yaml}\nconstraints: {port: x}\n", DVI_BAD_FILE,
     "main.yaml:2:21: there is no 'x'\n"},
    {"include: {a: damped.yaml}\n", DVI_BAD_FILE,
     "/scenes/damped.yaml:1:1: a component has no 'damping'; it stands in the scene that includes "
     "the component\n"},
    {"include: {a: bad.yaml}\n", DVI_BAD_FILE,
     "/scenes/bad.yaml:3:20: there is no 'a_y'; did you mean a_x?\n  lagrangian: x'^2 - y\n"},
};
enum { BAD = sizeof bad / sizeof *bad };

START_TEST(a_refusal_names_the_file_and_the_place)
{
  dvi_scene *scene;
  write_file("scenes/bad.yaml", "# a comment\ncoordinates: {x: scalar}\n"
                                "lagrangian: x'^2 - y\ninitial: {x: 1}\n");
  write_file("scenes/damped.yaml", "damping: 0.1\ncoordinates: {x: scalar}\n");
  const dvi_status status = read_main(bad[_i].text, &scene);
  ck_assert_msg(status == bad[_i].status, "%s: %s", dvi_status_name(status), message);
  ck_assert_ptr_null(scene);
  ck_assert_msg(strstr(message, bad[_i].sentence) != NULL, "%s", message);
}
END_TEST

static const struct {
  const char *text, *sentence;
} slips[] = {
    {"coordinates: {x: scalar", "/scenes/slip.yaml:1:"},
    {"# two\ncoordinates: {x: scalar}\nnonsense: 1\n",
     "/scenes/slip.yaml:3:1: a scene has no 'nonsense'"},
    {"- 1\n", "/scenes/slip.yaml:1:1: this is a list, and no scene"},
    {"", "/scenes/slip.yaml: the file is empty, and no scene"},
    {"coordinates: {2x: scalar}\nlagrangian: 1\n", "/scenes/slip.yaml:1:16: "},
    {"coordinates: {x: scalar}\nlagrangian: log(x - 1)*x'^2\ninitial: {x: 1}\n",
     "/scenes/slip.yaml:2:"},
    {"coordinates: {x: scalar}\nlagrangian: x'^2\ninitial:\n  x: sum(j, j)\n",
     "/scenes/slip.yaml:4:6: "},
};
enum { SLIPS = sizeof slips / sizeof *slips };

START_TEST(a_slip_in_a_component_is_shown_there)
{
  dvi_scene *scene;
  write_file("scenes/slip.yaml", slips[_i].text);
  ck_assert_int_ne(read_main("include: {good: oscillator.yaml, a: slip.yaml}\n", &scene), DVI_OK);
  ck_assert_msg(strstr(message, slips[_i].sentence) != NULL, "%s", message);
}
END_TEST

/* Components that include twice what they are, to the depth that is allowed, and a long list. */
START_TEST(the_number_and_the_size_of_components_are_bounded)
{
  char text[TEXT_SIZE], *large = malloc((1 << 20) + 2);
  dvi_scene *scene;
  ck_assert_ptr_nonnull(large);
  for (int k = 0; k < 9; k++) {
    char name[32];
    (void)snprintf(name, sizeof name, "scenes/level%d.yaml", k);
    (void)snprintf(text, sizeof text,
                   "include: {a: level%d.yaml, b: level%d.yaml, c: level%d.yaml}\n"
                   "coordinates: {x: scalar}\n",
                   k + 1, k + 1, k + 1);
    write_file(name, text);
  }
  write_file("scenes/level9.yaml", oscillator);
  ck_assert_int_eq(read_main("include: {a: level3.yaml}\n", &scene), DVI_BAD_SIZE);
  ck_assert_msg(strstr(message, "more than 256 components") != NULL, "%s", message);
  memset(large, '#', (1 << 20) + 1);
  large[(1 << 20) + 1] = '\0';
  write_file("scenes/large.yaml", large);
  ck_assert_int_eq(read_main("include: {a: large.yaml}\n", &scene), DVI_BAD_SIZE);
  ck_assert_msg(strstr(message, "large.yaml: the file has more than 1 MiB") != NULL, "%s", message);
  free(large);
}
END_TEST

SUITE(scene_include)
{
  tcase_add_checked_fixture(tests, make_files, remove_files);
  tcase_add_loop_test(tests, welded_oscillators_are_one, 0,
                      (int)(sizeof methods / sizeof *methods));
  tcase_add_test(tests, the_multiplier_is_the_effort_of_the_port);
  tcase_add_test(tests, names_have_the_prefixes_of_all_levels);
  tcase_add_test(tests, a_component_may_have_families_and_joints);
  tcase_add_test(tests, sections_of_all_files_are_added);
  tcase_add_test(tests, the_files_of_a_scene_are_listed);
  tcase_add_test(tests, a_checkpoint_knows_the_included_files);
  tcase_add_loop_test(tests, a_refusal_names_the_file_and_the_place, 0, BAD);
  tcase_add_loop_test(tests, a_slip_in_a_component_is_shown_there, 0, SLIPS);
  tcase_add_test(tests, the_number_and_the_size_of_components_are_bounded);
}
