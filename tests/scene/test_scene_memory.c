/* labels: invariant */
/* Wherever memory runs out while a scene is read, derived, named or written as C, that is said,
 * nothing leaks, and with memory the same call succeeds. */
#include <dvi/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "text/heap.h"
#include "support/heap.h"
#include "support/scene/scene_calls.h"
#include "support/suite.h"

#define RUN "step: 0.1\nuntil: 1\n"

/* One of each form, and all that a scene may hold. */
static const char *const texts[] = {
    "parameters: {N: 5, m: [1, 2, 3, 4, 5], g: 2*N, G: 3}\n"
    "coordinates: {\"q[N]\": vector(2)}\n"
    "definitions: {r: 'q[1] - q[N]'}\n"
    "lagrangian: >-\n  sum(i, m[i]/2*dot(q[i]', q[i]')) + sum(i<j, g*m[i]*m[j]/norm(q[i] - q[j])) "
    "- t*dot(r, r)\n"
    "symmetries: {angular: {\"q[i]\": \"[-q[i][2], q[i][1]]\"}}\n"
    "invariants: {speed: \"q[1]'[1]^2\"}\n"
    "events: {near: {zero: norm(r) - 1, direction: falling, stop: yes}}\n"
    "initial: {\"q[i]\": \"[i, cos(i)]\", \"q[2]\": \"[0, 7]\"}\n"
    "report: {every: 2, columns: [energy]}\nsweep: {N: [5, 5], G: {from: 1, to: 2, count: "
    "3}}\n" RUN,
    "coordinates: {[x, y]: scalar}\nkinetic: x'^2/2 + y'^2 + x'*y'/3\npotentials: {a: x^2*y^2, b: "
    "sqrt(1 + x^2)}\ninitial: {x: 1, "
    "y: 2}\n" RUN,
    "coordinates: {x: scalar, y: scalar}\nlagrangian: (1 + x^2)*y'^2/2 + x'^2*cos(y)/2 - "
    "x*y\ninitial: {x: 1, y: 0.2, x': 1}\n" RUN,
    "coordinates: {x: scalar, y: scalar}\none_form: {x: y + y^3, y: 0}\nhamiltonian: x^2 + "
    "y^2\ninitial: {x: 1, y: 2}\n" RUN,
    "coordinates: {x: scalar, y: scalar}\nhamiltonian: (p(x)^2 + p(y)^2)/2 + y\n"
    "constraints: {on: (x^2 + y^2 - 1)/2, along: x*p(x) + y*p(y)}\ninitial: {x: 0.8, y: 0.6, p(x): "
    "0.6, p(y): -0.8}\n" RUN,
    "coordinates: {R: rotation, B: motion, \"u[2]\": direction}\n"
    "lagrangian: >-\n  omega(R)[1]^2 + omega(R)[2]^2/2 + omega(R)[3]^2/2 + dot(omega(B), "
    "omega(B))/2 + dot(B.x', B.x')/2\n"
    "  + sum(i, dot(u[i]', u[i]')/2) - dot(R*[0, 0, 1], u[1]) - norm(B.x + B.R*u[2])^4\n"
    "symmetries: {about: {omega(R): \"transpose(R)*[0, 0, 1]\"}}\n"
    "initial:\n  R: turn([0, 0, 1], 1)\n  omega(R): [0, 1, 2]\n  B.R: turn([1, 0, 0], 1)\n  B.x: "
    "[1, 2, 3]\n  u[i]: '[0, 0, "
    "1]'\n" RUN};

enum { TEXTS = sizeof texts / sizeof *texts, MESSAGE_SIZE = 512, MOST = 20000 };

static char message[MESSAGE_SIZE];

static dvi_status read_scene(int i, dvi_scene **scene)
{
  return dvi_scene_parse("s.yaml", texts[i], strlen(texts[i]), 0, NULL, scene, message,
                         sizeof message);
}

static dvi_scene *good_scene(int i)
{
  dvi_scene *scene = NULL;
  ck_assert_msg(read_scene(i, &scene) == DVI_OK, "%s", message);
  return scene;
}

typedef void switch_off(long successes);

/* Reading with the k-th request refused, for every k. */
static void read_without_memory(int i, switch_off *fail_after)
{
  dvi_status status = DVI_NO_MEMORY;
  for (long k = 0; status != DVI_OK; k++) {
    dvi_scene *scene = NULL;
    fail_after(k);
    status = read_scene(i, &scene);
    fail_after(-1);
    ck_assert_int_lt(k, MOST);
    ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY, "scene %d, request %ld: %s", i, k,
                  message);
    if (status != DVI_OK && strstr(message, "memory") == NULL)
      ck_abort_msg("scene %d, request %ld: '%s'", i, k, message);
    ck_assert_int_eq(scene != NULL, status == DVI_OK);
    dvi_scene_destroy(&scene);
  }
}

START_TEST(reading_says_that_memory_ran_out)
{
  const long before = heap_bytes();
  read_without_memory(_i, dvi__fail_allocations_after);
  ck_assert_int_eq(heap_bytes(), before);
}
END_TEST

START_TEST(reading_says_that_the_library_has_no_memory)
{
  read_without_memory(_i, dvi__fail_allocations_after);
}
END_TEST

/* Those of libyaml, LAPACK and the C library, too. */
START_TEST(reading_says_that_others_have_no_memory)
{
  if (heap_is_counted()) read_without_memory(_i, heap_fail_after);
}
END_TEST

/* Makes the first calls of all callbacks, each of which derives something. */
START_TEST(deriving_says_that_memory_ran_out)
{
  const long before = heap_bytes();
  int code = -1;
  for (long k = 0; code != 0; k++) {
    dvi_scene *scene = good_scene(_i);
    dvi__fail_allocations_after(k);
    code = call_all(scene);
    dvi__fail_allocations_after(-1);
    ck_assert_int_lt(k, MOST);
    if (code != 0) {
      ck_assert_int_eq(code, DVI_NO_MEMORY);
      ck_assert_str_eq(dvi_scene_fault(), "s.yaml: memory ran out");
    }
    ck_assert_int_eq(call_all(scene), 0);
    dvi_scene_destroy(&scene);
  }
  ck_assert_int_eq(heap_bytes(), before);
}
END_TEST

static int count_bytes(const char *text, size_t size, void *user)
{
  (void)text;
  *(size_t *)user += size;
  return 0;
}

static dvi_status emit(const dvi_scene *scene, size_t *size)
{
  *size = 0;
  return dvi_scene_emit_c(scene, "s", count_bytes, size);
}

static void emit_without_memory(int i, size_t whole)
{
  dvi_status status = DVI_NO_MEMORY;
  for (long k = 0; status != DVI_OK; k++) {
    size_t size = 0;
    dvi_scene *scene = good_scene(i);
    dvi__fail_allocations_after(k);
    status = emit(scene, &size);
    dvi__fail_allocations_after(-1);
    ck_assert_int_lt(k, MOST);
    ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY, "request %ld: %s", k,
                  dvi_status_name(status));
    ck_assert_int_eq(emit(scene, &size), DVI_OK);
    ck_assert_uint_eq(size, whole);
    dvi_scene_destroy(&scene);
  }
}

START_TEST(writing_says_that_memory_ran_out)
{
  const long before = heap_bytes();
  size_t whole = 0;
  dvi_scene *scene = good_scene(_i);
  const dvi_status status = emit(scene, &whole);
  dvi_scene_destroy(&scene);
  if (status == DVI_OK) emit_without_memory(_i, whole);
  ck_assert_int_eq(heap_bytes(), before);
}
END_TEST

START_TEST(names_come_when_there_is_memory)
{
  dvi_scene *scene = good_scene(1);
  dvi__fail_allocations_after(0);
  ck_assert_ptr_null(dvi_scene_coordinate(scene, 1));
  ck_assert_ptr_null(dvi_scene_momentum(scene, 1));
  dvi__fail_allocations_after(-1);
  ck_assert_str_eq(dvi_scene_coordinate(scene, 1), "y");
  ck_assert_str_eq(dvi_scene_momentum(scene, 0), "p_x");
  dvi_scene_destroy(&scene);
}
END_TEST

SUITE(scene_memory)
{
  tcase_add_loop_test(tests, reading_says_that_memory_ran_out, 0, TEXTS);
  tcase_add_loop_test(tests, reading_says_that_the_library_has_no_memory, 0, TEXTS);
  tcase_add_loop_test(tests, reading_says_that_others_have_no_memory, 0, TEXTS);
  tcase_add_loop_test(tests, deriving_says_that_memory_ran_out, 0, TEXTS);
  tcase_add_loop_test(tests, writing_says_that_memory_ran_out, 0, TEXTS);
  tcase_add_test(tests, names_come_when_there_is_memory);
}
