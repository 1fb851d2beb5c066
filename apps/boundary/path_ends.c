#include "boundary/path_ends.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "load/open.h"

/* ---- ends ---- */

static const char *const ends_name[] = {
    [DVI_ENDS_FIXED] = "fixed", [DVI_ENDS_INITIAL] = "initial", [DVI_ENDS_PERIODIC] = "periodic"};

dvi_ends ends_from_name(const char *name)
{
  for (int ends = DVI_ENDS_FIXED; ends <= DVI_ENDS_PERIODIC; ends++)
    if (strcmp(name, ends_name[ends]) == 0) return (dvi_ends)ends;
  return (dvi_ends)0;
}

/* Arrays of one path's options. */
typedef struct arrays {
  double *q0, *q1, *p0, *signs, *symmetry;
  int *start, *row;
} arrays;

static bool arrays_allocate(arrays *a, size_t n)
{
  *a = (arrays){.q0 = calloc(n, sizeof(double)),
                .q1 = calloc(n, sizeof(double)),
                .p0 = calloc(n, sizeof(double)),
                .signs = calloc(n, sizeof(double)),
                .symmetry = calloc(n, sizeof(double)),
                .start = calloc(n + 1, sizeof(int)),
                .row = calloc(n, sizeof(int))};
  if (a->q0 && a->q1 && a->p0 && a->signs && a->symmetry && a->start && a->row) return true;
  complain("out of memory");
  return false;
}

static void arrays_release(arrays *a)
{
  free(a->q0);
  free(a->q1);
  free(a->p0);
  free(a->signs);
  free(a->symmetry);
  free(a->start);
  free(a->row);
}

/* Read a text such as "3,4,-1,-2". Coordinate i of the last node is coordinate 3, 4, .. of the
 * first one, or its negative. Each column of the matrix has one entry. */
static int read_symmetry(const char *text, const problem *scene, arrays *a)
{
  const int code = list_read("path: --symmetry", text, scene, a->signs);
  if (code != DONE) return code;
  for (int i = 0; i < scene->nq; i++) {
    const double place = fabs(a->signs[i]);
    if (!(place >= 1.0 && place <= scene->nq && place == floor(place)))
      return usage_error("path: --symmetry: %g is no coordinate; there are 1 to %d", a->signs[i],
                         scene->nq);
    const int column = (int)place - 1;
    if (a->symmetry[column] != 0.0)
      return usage_error("path: --symmetry names coordinate %d twice", column + 1);
    a->symmetry[column] = copysign(1.0, a->signs[i]);
    a->row[column] = i;
  }
  for (int i = 0; i <= scene->nq; i++) a->start[i] = i;
  return DONE;
}

/* Read an end of the command line. The default is that of the guess or of the problem. */
static int read_end(const char *where, const char *text, const problem *scene,
                    const double *otherwise, double *end)
{
  if (text != NULL) return list_read(where, text, scene, end);
  memcpy(end, otherwise, (size_t)scene->nq * sizeof *end);
  return DONE;
}

static int read_ends(const path_request *request, const problem *scene, const points *guess,
                     dvi_path_options *options, arrays *a)
{
  const bool guessed = request->guess != NULL, fixed = options->ends == DVI_ENDS_FIXED;
  int code = DONE;
  if (options->ends == DVI_ENDS_PERIODIC) {
    if (request->symmetry == NULL) return DONE;
    options->symmetry = a->symmetry;
    options->symmetry_pattern = (dvi_pattern){a->start, a->row};
    return read_symmetry(request->symmetry, scene, a);
  }
  options->q0 = a->q0;
  code = read_end("path: --from", request->from, scene, guessed && fixed ? guess->q : scene->q,
                  a->q0);
  if (fixed) {
    dvi_scene_end end = {.q = NULL};
    const bool is_of_scene = dvi_scene_density(scene->scene) != NULL &&
                             dvi_scene_end_of(scene->scene, &end);
    if (request->to == NULL && !guessed && !is_of_scene)
      return usage_error(
          "path: --ends fixed needs --to, or --guess FILE that leads there%s",
          dvi_scene_density(scene->scene) != NULL ? ", or the section final of the scene" : "");
    options->q1 = a->q1;
    if (code == DONE)
      code = read_end("path: --to", request->to, scene,
                      guessed ? guess->q + (size_t)(guess->count - 1) * (size_t)scene->nq : end.q,
                      a->q1);
  } else {
    options->p0 = a->p0;
    if (code == DONE)
      code = read_end("path: --momentum", request->momentum, scene, scene->p, a->p0);
  }
  return code;
}

static int read_energy(const path_request *request, const problem *scene, dvi_path_options *options)
{
  if (!request->free_period) return DONE;
  options->free_span = 1;
  options->energy = request->energy;
  if (!isnan(request->energy)) return DONE;
  double *invariant = calloc((size_t)dvi_system_invariant_count(scene->system), sizeof *invariant);
  if (invariant == NULL) return complain("out of memory"), FAILED;
  const dvi_status status = dvi_system_invariants(scene->system, 0.0, scene->q, scene->p,
                                                  invariant);
  options->energy = invariant[0];
  free(invariant);
  return status == DVI_OK ? DONE : library_error(status);
}

/* ---- guesses ---- */

/* Make a guess by steps forward with the method itself, from the start of the options or of the
 * problem. */
static int guess_by_steps(const dvi_path_options *o, const char *method, const problem *scene,
                          points *guess)
{
  dvi_integrator *integrator = NULL;
  int code = open_integrator(scene, method, &integrator);
  if (code != DONE) return code;
  const double *q = o->q0 != NULL ? o->q0 : scene->q, *p = o->p0 != NULL ? o->p0 : scene->p;
  dvi_status status = dvi_integrator_start(integrator, 0.0, q, p);
  bool added = points_add(guess, scene->nq, 0.0, q);
  for (int k = 1; k <= o->steps && status == DVI_OK && added; k++) {
    status = dvi_integrator_step(integrator, o->span / o->steps);
    added = points_add(guess, scene->nq, k, dvi_integrator_q(integrator));
  }
  dvi_integrator_destroy(&integrator);
  if (status != DVI_OK)
    complain("path: the guess by steps forward fails; give another one with --guess, or take more "
             "steps");
  if (status != DVI_OK) return library_error(status);
  return added ? DONE : FAILED;
}

static int make_guess(const path_request *request, const dvi_path_options *o, const problem *scene,
                      const points *given, dvi_path *path)
{
  points steps = {0};
  int code = DONE;
  if (request->guess == NULL && o->ends == DVI_ENDS_FIXED) return DONE; /* the straight line */
  if (request->guess == NULL) code = guess_by_steps(o, request->method, scene, &steps);
  const points *guess = request->guess != NULL ? given : &steps;
  if (code == DONE) {
    const dvi_status status = dvi_path_guess(path, guess->count, scene->nq, guess->t, guess->q);
    code = status == DVI_OK ? DONE : library_error(status);
  }
  points_clear(&steps);
  return code;
}

/* ---- one path ---- */

/* Create the path by the options of the request, whose arrays are `a`. */
static int create_path(const path_request *request, const problem *scene, const points *guess,
                       arrays *a, dvi_path **path)
{
  const double span = !isnan(request->period)  ? request->period
                      : !isnan(request->t_end) ? request->t_end
                                               : scene->t_end;
  dvi_path_options options = {.ends = ends_from_name(request->ends),
                              .steps = (int)request->steps,
                              .span = span,
                              .dimension = scene->nq};
  int code = read_ends(request, scene, guess, &options, a);
  if (code == DONE) code = read_energy(request, scene, &options);
  if (code != DONE) return code;
  const dvi_status status = dvi_path_create(scene->system, request->method, &options, path);
  if (status != DVI_OK)
    return library_error(status) == USAGE || status == DVI_BAD_ARGUMENT || status == DVI_BAD_SIZE
               ? USAGE
               : FAILED;
  return make_guess(request, &options, scene, guess, *path);
}

int path_open(const path_request *request, const problem *scene, const points *guess,
              dvi_path **path)
{
  arrays a = {0};
  const int code = arrays_allocate(&a, (size_t)scene->nq)
                       ? create_path(request, scene, guess, &a, path)
                       : FAILED;
  arrays_release(&a);
  return code;
}
