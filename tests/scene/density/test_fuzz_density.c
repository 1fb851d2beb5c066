/* labels: invariant */
/* Any text of a scene of fields with a density is a scene, whose callbacks give finite numbers or a
 * sentence, or it gives a sentence that can be printed. */
#include <dvi/scene.h>
#include <math.h>
#include <string.h>

#include "support/scene/fuzz.h"
#include "support/suite.h"
#include "text/utf8.h"

enum { MESSAGE_SIZE = 1024, COORDINATES_MAX = 60, FUNCTIONS_MAX = 2000 };

static const char *const corpus[] = {
    "domain: {x: [0, 2*pi]}\nspace: fem:degree=2,cells=3\nfields: {u: scalar}\n"
    "density: u'^2/2 - d(u,x)^2/2 - (1 - cos(u))\nboundary: periodic\n"
    "initial: {u: 1.5 + 0.5*cos(x), u': 0.3*sin(x)}\n"
    "probes: {ear: u(1), m: {integral: u}, s: {of: 'd(u,x)', at: 1}}\nmethod: verlet\nstep: 0.1\n",
    "domain: {x: [0, 1, 2], y: [0, 1]}\nspace: {x: 'fem:degree=1', y: 'fem:degree=1,cells=2'}\n"
    "fields: {u: scalar, w: vector(2)}\nparameters: {a: 2, n: 4}\n"
    "definitions: {strain: 'grad(u)'}\n"
    "density: u'^2/2 + a*dot(w',w')/2 - dot(strain, strain)/2 - (1 + x^2)*d(w[1],y)*w[2] - u^n/4\n"
    "boundary: {left: {u: {fixed: t*y}, w: fixed}, y: {robin: a}}\nstep: {fraction: 0.5}\nuntil: "
    "1\n",
    "domain: {x: [-5, 5]}\nspace: fourier:modes=3\nboundary: periodic\n"
    "schroedinger: {potential: x^2/2, interaction: 10, hbar: 2, mass: 1}\n"
    "initial: {psi: '[exp(-x^2), 0]'}\nprobes: {norm: {integral: 'dot(psi,psi)'}}\n",
    "domain: {x: [0, 1]}\nspace: spline:degree=3,cells=4\nfields: {w: scalar}\n"
    "boundary: periodic\ndensity: d(w,x)*w'/2 + d(w,x)^3 - d(w,x,x)^2/2\n",
    "mesh: {generator: disk, cells: 1}\nspace: fem:degree=1\nfields: {psi: complex}\n"
    "boundary: {rim: {fixed: '[x, y]'}}\n"
    "density: (1 + re(psi)^2)*dot(psi', psi')/2 - dot(grad(im(psi)), grad(re(psi))) + log(2 + x)\n",
    NULL};

static const char *const tokens[] = {"domain: ",
                                     "space: ",
                                     "fields: ",
                                     "density: ",
                                     "schroedinger: ",
                                     "boundary: ",
                                     "initial: ",
                                     "probes: ",
                                     "mesh: ",
                                     "definitions: ",
                                     "scalar",
                                     "complex",
                                     "vector(2)",
                                     "rotation",
                                     "periodic",
                                     "fixed",
                                     "free",
                                     "robin: ",
                                     "{fixed: x*t}",
                                     "{free: 1}",
                                     "left: ",
                                     "boundary: free",
                                     "top: ",
                                     "d(u,x)",
                                     "d(u',x)",
                                     "d(u,x,x)",
                                     "grad(u)",
                                     "re(psi)",
                                     "im(psi)",
                                     "psi[1]",
                                     "d(",
                                     "u'",
                                     "u(1)",
                                     "{integral: u}",
                                     "{of: u, at: 1}",
                                     "fem:",
                                     "degree=2",
                                     ",cells=3",
                                     ",lumped=yes",
                                     "spline:degree=3,cells=4",
                                     "fourier:modes=2",
                                     "legendre:degree=3",
                                     "chebyshev:degree=3",
                                     ",points=5",
                                     "[0, 1]",
                                     "dot(",
                                     "sqrt(",
                                     "if(x < 0, ",
                                     "^",
                                     "^-1",
                                     "/",
                                     "*",
                                     "+",
                                     "-",
                                     "(",
                                     ")",
                                     "[",
                                     "]",
                                     "0",
                                     "1",
                                     "2",
                                     "1e300",
                                     "0.5",
                                     "t",
                                     "pi",
                                     "x",
                                     "y",
                                     "u",
                                     "w",
                                     "psi",
                                     "\n",
                                     ": ",
                                     ", ",
                                     "{",
                                     "}",
                                     "'",
                                     "\"",
                                     NULL};

static char message[MESSAGE_SIZE];

static void check_message(void)
{
  const size_t length = strlen(message);
  unsigned code = 0;
  fuzz_requires(length > 0);
  for (size_t k = 0, width = 0; k < length; k += width) {
    width = dvi__utf8(message + k, length - k, &code);
    fuzz_requires(width > 0 && dvi__utf8_printable(code));
  }
}

/* Evaluates the system at the start. Results are finite where there is no failure. */
static unsigned evaluate(const dvi_system *system, const dvi_scene *scene)
{
  enum { WATCHED_MAX = 64 };
  double p[COORDINATES_MAX] = {0}, value[WATCHED_MAX] = {0}, L = 0;
  const double *q, *v, *unused;
  const int n = dvi_system_nq(system), count = dvi_system_invariant_count(system);
  fuzz_requires(dvi_scene_coordinate(scene, n - 1) != NULL);
  dvi_scene_start(scene, &q, &v, &unused);
  dvi_status status = dvi_system_lagrangian(system, 0, q, v, &L);
  fuzz_requires(status != DVI_OK || isfinite(L));
  if (status == DVI_OK) status = dvi_system_momentum(system, 0, q, v, p);
  if (status == DVI_OK && count <= WATCHED_MAX)
    status = dvi_system_invariants(system, 0, q, p, value);
  for (int i = 0; i < count && i < WATCHED_MAX && status == DVI_OK; i++)
    fuzz_requires(isfinite(value[i]));
  return (unsigned)(status + 20);
}

/* A scene that cannot be a system is refused, or has no rates. */
static unsigned try_scene(const dvi_scene *scene)
{
  char text[128];
  dvi_scene_facts facts;
  const dvi_density *density = dvi_scene_density(scene);
  if (density == NULL || dvi_space_functions(dvi_density_space(density)) > FUNCTIONS_MAX) return 1;
  dvi_scene_density_explain(scene, text, sizeof text);
  fuzz_requires(strlen(text) > 0 && strlen(text) < sizeof text);
  dvi_scene_facts_of(scene, &facts);
  fuzz_requires(facts.form != NULL);
  const dvi_system *system = dvi_scene_system(scene);
  if (system == NULL) return 2;
  if (dvi_system_nq(system) > COORDINATES_MAX) return 3;
  return fuzz_hash(facts.form) + 17U * (unsigned)facts.kernels + 257U * evaluate(system, scene);
}

static unsigned try_text(const char *text, size_t size)
{
  dvi_scene *scene = NULL;
  const dvi_status status = dvi_scene_parse("s.yaml", text, size, 0, NULL, &scene, message,
                                            sizeof message);
  fuzz_requires((status == DVI_OK) == (scene != NULL));
  if (status != DVI_OK) {
    check_message();
    return 0; /* what is no scene leads to no other scene */
  }
  const unsigned kind = try_scene(scene);
  dvi_scene_destroy(&scene);
  return kind;
}

START_TEST(any_text_is_a_scene_of_fields_or_a_sentence)
{
  const fuzz_target target = {"density", corpus, tokens, try_text, NULL};
  ck_assert_int_gt(fuzz(&target), 0);
}
END_TEST

SUITE(fuzz_density)
{
  tcase_set_timeout(tests, fuzz_timeout());
  tcase_add_test(tests, any_text_is_a_scene_of_fields_or_a_sentence);
}
