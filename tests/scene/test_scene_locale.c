/* In a host program with a decimal comma scenes are read, described and written as C as usual. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <locale.h>
#include <stdio.h>
#include <string.h>

#include "support/comma.h"
#include "support/files.h"
#include "support/suite.h"

enum { TEXT_SIZE = 65536, MESSAGE_SIZE = 1024 };

static const char cart[] =
    "parameters: {m: 0.2, M: 1, l: 0.5, g: 9.81}\n"
    "coordinates: {x: scalar, theta: scalar}\n"
    "definitions:\n  bob: [x + l*sin(theta), -l*cos(theta)]\n"
    "lagrangian: M/2*x'^2 + m/2*dot(bob', bob') - m*g*bob[2]\n"
    "initial: {x: 0.125, theta: 1.5e-1}\nmethod: galerkin:degree=2\nstep: 0.02\nuntil: 20.5\n";

/* A text that grows. */
typedef struct collected {
  char text[TEXT_SIZE];
  size_t size;
} collected;

static int collect(const char *text, size_t size, void *user)
{
  collected *all = user;
  ck_assert_uint_lt(all->size + size, TEXT_SIZE);
  memcpy(all->text + all->size, text, size);
  all->size += size;
  return 0;
}

static dvi_status parse(const char *text, const char *setting, dvi_scene **scene, char *message)
{
  return dvi_scene_parse("s.yaml", text, strlen(text), setting != NULL, &setting, scene, message,
                         MESSAGE_SIZE);
}

static void emit(const char *setting, collected *all)
{
  dvi_scene *scene;
  char message[MESSAGE_SIZE];
  ck_assert_msg(parse(cart, setting, &scene, message) == DVI_OK, "%s", message);
  *all = (collected){.size = 0};
  ck_assert_int_eq(dvi_scene_emit_c(scene, "cart", collect, all), DVI_OK);
  dvi_scene_destroy(&scene);
}

START_TEST(scenes_and_settings_are_read_and_written_the_same)
{
  static collected point, comma;
  emit("m=0.375", &point);
  set_comma_locale();
  emit("m=0.375", &comma);
  ck_assert_str_eq(localeconv()->decimal_point, ",");
  set_point_locale();
  ck_assert_uint_eq(comma.size, point.size);
  ck_assert_str_eq(comma.text, point.text);
  ck_assert_ptr_nonnull(strstr(point.text, "0.375"));
}
END_TEST

static const struct {
  const char *text, *setting, *message;
} broken[] = {
    {"coordinates: {x: scalar}\nlagrangian: x'^2\ninitial: {x: 0}\nstep: -0.25\nuntil: 1\n", NULL,
     "s.yaml:4:7: step must be positive, and is -0.25\n  step: -0.25\n        ^~~~~"},
    {cart, "m=0,5", "s.yaml: m=0,5: '0,5' is no finite number"},
};
enum { BROKEN = sizeof broken / sizeof *broken };

START_TEST(errors_are_told_the_same)
{
  dvi_scene *scene;
  char message[MESSAGE_SIZE];
  set_comma_locale();
  ck_assert_int_ne(parse(broken[_i].text, broken[_i].setting, &scene, message), DVI_OK);
  set_point_locale();
  ck_assert_str_eq(message, broken[_i].message);
}
END_TEST

START_TEST(what_is_not_finite_is_told_the_same)
{
  static const char text[] = "coordinates: {x: scalar}\nlagrangian: x'^2/2 - 1/(x - 0.5)\ninitial: "
                             "{x: 0.5}\nstep: 0.25\nuntil: 1\n";
  const double q = 0.5;
  double p = 0;
  dvi_scene *scene;
  dvi_integrator *integrator;
  char message[MESSAGE_SIZE], sentence[MESSAGE_SIZE];
  set_comma_locale();
  ck_assert_msg(parse(text, NULL, &scene, message) == DVI_OK, "%s", message);
  ck_assert_int_eq(dvi_integrator_create(dvi_scene_system(scene), "verlet", &integrator), DVI_OK);
  dvi_status status = dvi_integrator_start(integrator, 0.25, &q, &p);
  if (status == DVI_OK) status = dvi_integrator_step(integrator, 0.25);
  (void)snprintf(sentence, sizeof sentence, "%s", dvi_last_error());
  dvi_integrator_destroy(&integrator);
  dvi_scene_destroy(&scene);
  set_point_locale();
  ck_assert_int_ne(status, DVI_OK);
  ck_assert_msg(strstr(sentence, "0.25") != NULL && strstr(sentence, "0,") == NULL, "%s", sentence);
}
END_TEST

SUITE(scene_locale)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, scenes_and_settings_are_read_and_written_the_same);
  tcase_add_loop_test(tests, errors_are_told_the_same, 0, BROKEN);
  tcase_add_test(tests, what_is_not_finite_is_told_the_same);
}
