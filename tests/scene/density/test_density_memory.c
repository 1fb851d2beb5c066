/* labels: invariant */
/* Wherever memory runs out while a scene of fields with a density, or of a solid, is read or its
 * system is made, that is said, nothing leaks, and with memory the same call succeeds. */
#include <dvi/scene.h>
#include <string.h>

#include "core/memory.h"
#include "support/heap.h"
#include "support/suite.h"

static const char *const texts[] = {
    "domain: {x: [0, 1]}\nspace: fem:degree=2,cells=3\nfields: {u: scalar, w: vector(2)}\n"
    "definitions: {strain: 'd(w,x)'}\n"
    "density: u'^2/2 + dot(w',w')/2 - d(u,x)^2/2 - dot(strain, strain)/2 - u^4*w[1]\n"
    "boundary: {left: {u: {fixed: sin(t)}, w: fixed}, right: {robin: 2}}\n"
    "initial: {u: x^2, w: '[x, 0]', u': x}\n"
    "probes: {ear: u(0.5), m: {integral: u'^2}}\nstep: {fraction: 0.5}\nuntil: 1\n"
    "report: {columns: [energy, ear]}\n",
    "domain: {x: [0, 1]}\nspace: fourier:modes=2\nboundary: periodic\n"
    "schroedinger: {potential: cos(2*pi*x), interaction: 2}\ninitial: {psi: '[1, x]'}\n",
    "mesh: {generator: disk, cells: 1}\nfields: {u: scalar}\n"
    "density: (1 + u^2)*u'^2/2 - dot(grad(u), grad(u))/2\nboundary: {rim: {fixed: x}}\n",
    "parameters: {m: 1}\nmesh: {generator: kuhn, cells: [1, 1, 1]}\nfield: elastic\n"
    "definitions: {push: '[0, t, 0]'}\n"
    "materials: {all: {law: 'm*(I1 - 3)/2 - m*log(J)', alpha: 0.1}}\n"
    "boundary: {left: {fixed: push}, bottom: {fixed: {x: 0}}}\ninitial: {u': [y, 0, 0]}\n"
    "loads: {gravity: [0, 0, -1], right: {traction: -t*normal}}\n"
    "obstacles: {floor: {plane: {point: [0, 0, -1], normal: [0, 0, 1]}, restitution: 1}}\n"
    "probes: {a: {of: x, at: [0.5, 0.5, 0.4]}, s: {of: stress, at: [0.5, 0.5, 0.4]}}\n"
    "step: {fraction: 0.5}\nuntil: 1\nreport: {columns: [energy, a_x]}\n"};

enum { TEXTS = sizeof texts / sizeof *texts, MESSAGE_SIZE = 512, MOST = 20000 };

static char message[MESSAGE_SIZE];

static dvi_scene *good_scene(int i)
{
  dvi_scene *scene = NULL;
  ck_assert_msg(dvi_scene_parse("s.yaml", texts[i], strlen(texts[i]), 0, NULL, &scene, message,
                                sizeof message) == DVI_OK,
                "%s", message);
  return scene;
}

/* What libraries keep from their first call on is there afterwards. */
static long bytes_after_a_call(int i)
{
  dvi_scene *scene = good_scene(i);
  ck_assert_ptr_nonnull(dvi_scene_system(scene));
  dvi_scene_destroy(&scene);
  return heap_bytes();
}

START_TEST(reading_says_that_memory_ran_out)
{
  const long before = bytes_after_a_call(_i);
  dvi_status status = DVI_NO_MEMORY;
  for (long k = 0; status != DVI_OK; k++) {
    dvi_scene *scene = NULL;
    dvi__fail_allocations_after(k);
    status = dvi_scene_parse("s.yaml", texts[_i], strlen(texts[_i]), 0, NULL, &scene, message,
                             sizeof message);
    dvi__fail_allocations_after(-1);
    ck_assert_int_lt(k, MOST);
    ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY, "request %ld: %s", k, message);
    if (status != DVI_OK && strstr(message, "memory") == NULL)
      ck_abort_msg("request %ld: '%s'", k, message);
    ck_assert_int_eq(scene != NULL, status == DVI_OK);
    dvi_scene_destroy(&scene);
  }
  ck_assert_int_eq(heap_bytes(), before);
}
END_TEST

START_TEST(a_system_comes_when_there_is_memory)
{
  const long before = bytes_after_a_call(_i);
  const dvi_system *system = NULL;
  for (long k = 0; system == NULL; k++) {
    dvi_scene *scene = good_scene(_i);
    dvi__fail_allocations_after(k);
    system = dvi_scene_system(scene);
    dvi__fail_allocations_after(-1);
    ck_assert_int_lt(k, MOST);
    ck_assert_ptr_nonnull(dvi_scene_system(scene));
    dvi_scene_destroy(&scene);
  }
  ck_assert_int_eq(heap_bytes(), before);
}
END_TEST

SUITE(density_memory)
{
  tcase_add_loop_test(tests, reading_says_that_memory_ran_out, 0, TEXTS);
  tcase_add_loop_test(tests, a_system_comes_when_there_is_memory, 0, TEXTS);
}
