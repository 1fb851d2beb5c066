/* Every method takes a scene or refuses it by a sentence, and the methods that such a sentence
 * suggests start: for all forms of scenes, and for all pairs of sections beside them. */
#include <dvi/dvi.h>
#include <dvi/scene.h>
#include <stdio.h>
#include <string.h>

#include "support/suite.h"

enum { TEXT_SIZE = 1024, MESSAGE_SIZE = 1024, METHODS_MAX = 64 };

static const char flat[] = "coordinates: {x: scalar, y: scalar, a: scalar, b: scalar}\n"
                           "initial: {x: 1, y: 0, a: 0, b: 0, a': 1}\n";
static const char turning[] = "coordinates: {R: rotation}\n"
                              "initial: {R: \"turn([1, 0, 0], 0)\", omega(R): [0, 0, 1]}\n";

static const struct {
  const char *coordinates, *motion;
} forms[] = {
    {flat,
     "kinetic: (x'^2 + 2*y'^2 + a'^2 + b'^2)/2\npotentials: {spring: (x^2 + y^2)/2, well: a^4}\n"},
    {flat, "kinetic: (x'^2 + y'^2 + a'^2 + b'^2)/2\n"
           "potentials: {fast: {spring: 20*(x^2 + y^2 + a^2 + b^2)}, slow: {well: a^4}}\n"},
    {flat, "lagrangian: (x'^2 + y'^2 + b'^2 + (1 + x^2)*a'^2 - x^2)/2\n"},
    {flat, "lagrangian: (x'^2 + y'^2 + a'^2 + b'^2 - x^2)/2 + x*y'\n"},
    {"coordinates: {x: scalar, y: scalar}\ninitial: {x: 1, y: 0, p(x): 0, p(y): 1}\n",
     "hamiltonian: (p(x)^2 + p(y)^2 + x^2 + x*p(y))/2\n"},
    {"coordinates: {x: scalar, y: scalar}\ninitial: {x: 1, y: 0}\n",
     "one_form: {x: y}\nhamiltonian: x^2 + y^2\n"},
    {turning, "lagrangian: (omega(R)[1]^2 + 1.5*omega(R)[2]^2 + 2*omega(R)[3]^2)/2 - R[3,3]\n"},
    {turning, "lagrangian: (omega(R)[1]^2 + 1.5*omega(R)[2]^2 + 2*omega(R)[3]^2)/2\n"},
    {"coordinates: {u: direction}\ninitial: {u: [1, 0, 0], u': [0, 1, 0]}\n",
     "lagrangian: dot(u', u')/2 - u[3]\n"},
};
enum { FORMS = sizeof forms / sizeof *forms };

/* Sections of flat scenes and of others. Two of one name do not stand in one scene. */
static const char *const sections[] = {
    "",
    "forces: {x: sin(t) - x}\n",
    "forces: {x: -x'}\n",
    "forces: {omega(R): [0.1, 0, 0]}\n",
    "forces: {omega(R): -0.1*omega(R)}\n",
    "forces: {u: -0.1*u'}\n",
    "dissipation: (x'^2 + y'^2)/10\n",
    "dissipation: dot(omega(R), omega(R))/10\n",
    "damping: 0.1\n",
    "constraints: {circle: x^2 + b^2 - 1}\n",
    "constraints: {tilt: 'R[1,3]'}\n",
    "constraints: {level: 'u[3]'}\n",
    "noise: {temperature: 0.5, friction: 1}\n",
    "nonholonomic: {blade: sin(a)*x' - cos(a)*y'}\n",
    "contacts: {wall: {gap: 5 - x, restitution: 1}}\n",
    "contacts: {wall: {gap: 5 - x, restitution: 0.5, hold: yes}}\n",
    "contacts: {wall: {gap: 5 - x, friction: 0.3, tangent: y}}\n",
};
enum { SECTIONS = sizeof sections / sizeof *sections };

static char message[MESSAGE_SIZE];

static int have_one_name(const char *a, const char *b)
{
  const size_t length = strcspn(a, ":");
  return length > 0 && strncmp(a, b, length + 1) == 0;
}

/* Methods that need keys, with keys. */
static const char *specification_of(const char *method)
{
  return strcmp(method, "multiscale") == 0 ? "multiscale:fast=0,omega=5" : method;
}

/* Create a method, start it and take a step. */
static dvi_status try_method(const dvi_scene *scene, const char *method)
{
  const double *q, *v, *p;
  dvi_integrator *integrator;
  const dvi_status status = dvi_integrator_create(dvi_scene_system(scene), specification_of(method),
                                                  &integrator);
  if (status != DVI_OK) return status;
  dvi_scene_start(scene, &q, &v, &p);
  ck_assert_msg(dvi_integrator_start(integrator, 0, q, p) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_integrator_step(integrator, 0.01) == DVI_OK, "%s", dvi_last_error());
  dvi_integrator_destroy(&integrator);
  return DVI_OK;
}

/* Test if a name stands in a list with commas. */
static int lists(const char *list, const char *name)
{
  const size_t length = strlen(name);
  for (const char *at = strstr(list, name); at != NULL; at = strstr(at + 1, name))
    if ((at == list || at[-1] == ' ') && (at[length] == ',' || at[length] == '\0')) return 1;
  return 0;
}

/* Try all methods, and compare those that take the scene with those that refusals suggest. */
static int check_methods(const dvi_scene *scene, const char *text)
{
  static const char before[] = "methods for this system:", none[] = "no method takes all";
  char suggested[MESSAGE_SIZE] = "";
  int takes[METHODS_MAX] = {0}, taken = 0, refused = 0;
  for (int i = 0; i < dvi_method_count(); i++) {
    const dvi_status status = try_method(scene, dvi_method_name(i));
    takes[i] = status == DVI_OK;
    taken += takes[i];
    if (status == DVI_OK) continue;
    ck_assert_msg(status == DVI_UNSUPPORTED, "%s%s", text, dvi_last_error());
    const char *list = strstr(dvi_last_error(), before);
    if (list == NULL) list = strstr(dvi_last_error(), none);
    if (list == NULL) continue;
    ck_assert_msg(refused == 0 || strcmp(suggested, list) == 0, "%s%s", text, list);
    (void)snprintf(suggested, sizeof suggested, "%s", list);
    refused++;
  }
  for (int i = 0; i < dvi_method_count() && refused > 0; i++)
    ck_assert_msg(lists(suggested, dvi_method_name(i)) == takes[i], "%s%s: %s", text,
                  dvi_method_name(i), suggested);
  ck_assert_msg(refused == 0 || (strncmp(suggested, none, sizeof none - 1) == 0) == (taken == 0),
                "%s%s", text, suggested);
  return refused > 0;
}

START_TEST(a_method_that_is_suggested_starts)
{
  int scenes = 0;
  for (int i = 0; i < SECTIONS; i++)
    for (int j = i + (i > 0); j < SECTIONS; j++) {
      char text[TEXT_SIZE];
      dvi_scene *scene;
      if (have_one_name(sections[i], sections[j])) continue;
      const int size = snprintf(text, sizeof text, "%s%s%s%sstep: 0.01\nuntil: 1\n",
                                forms[_i].coordinates, forms[_i].motion, sections[i], sections[j]);
      const dvi_status status = dvi_scene_parse("s.yaml", text, (size_t)size, 0, NULL, &scene,
                                                message, sizeof message);
      if (status != DVI_OK) {
        ck_assert_msg(strncmp(message, "s.yaml:", 7) == 0, "%s", message);
        continue;
      }
      scenes += check_methods(scene, text);
      dvi_scene_destroy(&scene);
    }
  ck_assert_int_gt(scenes, 0);
}
END_TEST

SUITE(scene_methods)
{
  ck_assert_int_le(dvi_method_count(), METHODS_MAX);
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, a_method_that_is_suggested_starts, 0, FORMS);
}
