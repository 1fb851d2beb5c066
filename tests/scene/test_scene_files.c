/* A scene opens a file in its own folder or below, and no other one. */
#define _XOPEN_SOURCE 700 /* symlink */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "support/files.h"
#include "support/suite.h"

enum { MESSAGE_SIZE = 2048 };

static void write_file(const char *name, const char *text)
{
  write_bytes(path_in_folder(name), (const unsigned char *)text, strlen(text));
}

/* The folder holds outside.tableau, and scenes/ with ralston.tableau, links and below/, which holds
 * ralston.tableau, too. */
static void make_files(void)
{
  static const char tableau[] = "order 2\nc 0 2/3\na\na 2/3\nb 1/4 3/4\n";
  make_folder();
  ck_assert_int_eq(mkdir(path_in_folder("scenes"), 0700), 0);
  ck_assert_int_eq(mkdir(path_in_folder("scenes/below"), 0700), 0);
  ck_assert_int_eq(mkdir(path_in_folder("scenes-beside"), 0700), 0);
  write_file("outside.tableau", tableau);
  write_file("scenes-beside/ralston.tableau", tableau);
  write_file("scenes/ralston.tableau", tableau);
  write_file("scenes/below/ralston.tableau", tableau);
  ck_assert_int_eq(symlink("../ralston.tableau", path_in_folder("scenes/below/inside.tableau")), 0);
  ck_assert_int_eq(symlink("../outside.tableau", path_in_folder("scenes/link.tableau")), 0);
  ck_assert_int_eq(symlink("/etc/passwd", path_in_folder("scenes/passwd")), 0);
  ck_assert_int_eq(symlink("..", path_in_folder("scenes/up")), 0);
  ck_assert_int_eq(symlink("scenes", path_in_folder("by-link")), 0);
}

static void remove_files(void)
{
  char command[512];
  (void)snprintf(command, sizeof command, "rm -r %s*", path_in_folder(""));
  ck_assert_int_eq(system(command), 0); /* NOLINT(cert-env33-c): a folder of the test's own */
  remove_folder();
}

static dvi_status read_scene(const char *scene_path, const char *method, dvi_scene **scene,
                             char *message)
{
  char text[1024];
  (void)snprintf(text, sizeof text,
                 "coordinates: {x: scalar}\nlagrangian: x'^2/2 - x^2/2\ninitial: {x: 1}\nmethod: "
                 "%s\nstep: 0.1\nuntil: 2\n",
                 method);
  write_file(scene_path, text);
  return dvi_scene_read(path_in_folder(scene_path), 0, NULL, scene, message, MESSAGE_SIZE);
}

static const struct {
  const char *scene, *file;
} good[] = {
    {"scenes/s.yaml", "ralston.tableau"},           {"scenes/s.yaml", "./below/ralston.tableau"},
    {"scenes/s.yaml", "below/../ralston.tableau"},  {"scenes/s.yaml", "below/inside.tableau"},
    {"scenes/s.yaml", "../scenes/ralston.tableau"}, {"by-link/s.yaml", "ralston.tableau"},
    {"scenes/up/scenes/s.yaml", "ralston.tableau"},
};
enum { GOOD = sizeof good / sizeof *good };

START_TEST(a_file_in_the_folder_or_below_is_found_from_anywhere)
{
  char message[MESSAGE_SIZE], method[512];
  dvi_scene *scene;
  dvi_integrator *integrator;
  (void)snprintf(method, sizeof method, "shooting:tableau=%s,quadrature=trapezoid", good[_i].file);
  ck_assert_msg(read_scene(good[_i].scene, method, &scene, message) == DVI_OK, "%s", message);
  ck_assert_msg(dvi_integrator_create(dvi_scene_system(scene), dvi_scene_plan_of(scene)->method,
                                      &integrator) == DVI_OK,
                "%s", dvi_last_error());
  ck_assert_int_eq(dvi_integrator_order(integrator), 2);
  dvi_integrator_destroy(&integrator);
  dvi_scene_destroy(&scene);
}
END_TEST

static const struct {
  const char *scene, *method, *sentence;
} bad[] = {
    {"scenes/s.yaml", "shooting:tableau=/etc/passwd",
     ":4:9: the file '/etc/passwd' is named from the root; name it from the scene's folder\n"},
    {"scenes/s.yaml", "shooting:tableau=passwd",
     ":4:9: the file 'passwd' is not in the scene's folder or below; put it there, or give "
     "--method\n"},
    {"scenes/s.yaml", "shooting:tableau=../outside.tableau",
     "is not in the scene's folder or below"},
    {"scenes/s.yaml", "shooting:tableau=link.tableau", "is not in the scene's folder or below"},
    {"scenes/s.yaml", "shooting:tableau=up/outside.tableau",
     "is not in the scene's folder or below"},
    {"scenes/s.yaml", "shooting:tableau=../scenes-beside/ralston.tableau",
     "is not in the scene's folder or below"},
    {"by-link/s.yaml", "shooting:tableau=../outside.tableau",
     "is not in the scene's folder or below"},
    {"scenes/s.yaml", "shooting:tableau=.", "is not in the scene's folder or below"},
    {"scenes/s.yaml", "shooting:onestep=file,type=1,tableau=link.tableau",
     "is not in the scene's folder or below"},
    {"scenes/s.yaml", "composition:order=4,tableau=passwd",
     "is not in the scene's folder or below"},
    {"scenes/s.yaml", "shooting:tableau=none.tableau", "cannot be read: No such file or directory"},
};
enum { BAD = sizeof bad / sizeof *bad };

START_TEST(any_other_file_is_refused_unopened)
{
  char message[MESSAGE_SIZE];
  dvi_scene *scene;
  ck_assert_int_eq(read_scene(bad[_i].scene, bad[_i].method, &scene, message), DVI_BAD_FILE);
  ck_assert_msg(strstr(message, bad[_i].sentence) != NULL, "%s", message);
}
END_TEST

START_TEST(a_folder_with_a_comma_is_refused)
{
  char message[MESSAGE_SIZE];
  dvi_scene *scene;
  ck_assert_int_eq(mkdir(path_in_folder("with,comma"), 0700), 0);
  write_file("with,comma/ralston.tableau", "order 1\na\nb 1\n");
  ck_assert_int_eq(
      read_scene("with,comma/s.yaml", "shooting:tableau=ralston.tableau", &scene, message),
      DVI_BAD_FILE);
  ck_assert_msg(strstr(message, "from a folder with a comma; rename the folder") != NULL, "%s",
                message);
}
END_TEST

/* The name of a text sets its folder. */
START_TEST(a_text_has_the_folder_of_its_name)
{
  static const char text[] =
      "coordinates: {x: scalar}\nlagrangian: x'^2/2\ninitial: {x: 1}\nmethod: "
      "shooting:tableau=ralston.tableau\nstep: 1\nuntil: 2\n";
  char message[MESSAGE_SIZE], method[512];
  dvi_scene *scene;
  ck_assert_int_eq(dvi_scene_parse(path_in_folder("scenes/none.yaml"), text, strlen(text), 0, NULL,
                                   &scene, message, MESSAGE_SIZE),
                   DVI_OK);
  (void)snprintf(method, sizeof method, "shooting:tableau=%s",
                 path_in_folder("scenes/ralston.tableau"));
  ck_assert_str_eq(dvi_scene_plan_of(scene)->method, method);
  dvi_scene_destroy(&scene);
  ck_assert_int_eq(
      dvi_scene_parse("none.yaml", text, strlen(text), 0, NULL, &scene, message, MESSAGE_SIZE),
      DVI_BAD_FILE);
}
END_TEST

/* Names that only look like a file's. */
START_TEST(other_keys_name_no_file)
{
  size_t length = 7;
  ck_assert_ptr_null(dvi_method_file(NULL, &length));
  ck_assert_uint_eq(length, 0);
  static const char *const none[] = {"",
                                     "shooting",
                                     "vprk:tableau=gauss",
                                     "galerkin:tableau=x",
                                     "nothing:tableau=x",
                                     "shooting:",
                                     "shooting:tableau=",
                                     "shooting:tableau,onestep=rk4",
                                     ":tableau=x"};
  for (size_t k = 0; k < sizeof none / sizeof *none; k++)
    ck_assert_msg(dvi_method_file(none[k], &length) == NULL, "%s", none[k]);
  const char *specification = "shooting:quadrature=simpson,tableau=a/b=c:d,type=1";
  ck_assert_ptr_eq(dvi_method_file(specification, &length), strstr(specification, "a/b"));
  ck_assert_uint_eq(length, strlen("a/b=c:d"));
}
END_TEST

SUITE(scene_files)
{
  tcase_add_checked_fixture(tests, make_files, remove_files);
  tcase_add_loop_test(tests, a_file_in_the_folder_or_below_is_found_from_anywhere, 0, GOOD);
  tcase_add_loop_test(tests, any_other_file_is_refused_unopened, 0, BAD);
  tcase_add_test(tests, a_folder_with_a_comma_is_refused);
  tcase_add_test(tests, a_text_has_the_folder_of_its_name);
  tcase_add_test(tests, other_keys_name_no_file);
}
