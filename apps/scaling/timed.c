#include "scaling/timed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "load/elastic.h"
#include "load/field.h"
#include "load/open_march.h"
#include "load/scene.h"
#include "shares/share.h"
#include "module/ranks.h"
#include "study/clock.h"

/* ---- meshes in parts ---- */

static dvi_status see_whole(const dvi_mesh *mesh, dvi_mesh **share, void *user)
{
  (void)mesh;
  (void)share;
  (void)user;
  return DVI_UNSUPPORTED;
}

static dvi_status see_parts(const char *path, dvi_mesh **share, void *user)
{
  bool *is_in_parts = user;
  (void)path;
  (void)share;
  *is_in_parts = true;
  return DVI_UNSUPPORTED;
}

/* Tell if the text may name such a file. A scene is read up to its mesh only then. */
static bool names_file(const char *path)
{
  scene_text text;
  bool found = false;
  if (scene_load(path, &text) == DONE)
    for (size_t i = 0; i + 3 <= text.length && !found; i++)
      found = strncmp(text.text + i, ".h5", 3) == 0;
  free(text.text);
  return found;
}

bool timed_is_in_parts(const timed_request *request)
{
  bool found = false;
  const dvi_scene_division division = {
      .size = sizeof division, .divide = see_whole, .read = see_parts, .user = &found};
  dvi_scene *scene = NULL;
  if (!names_file(request->scene)) return false;
  (void)dvi_scene_read_share(request->scene, &division, request->settings->count,
                             request->settings->word, &scene, NULL, 0);
  dvi_scene_destroy(&scene);
  return found;
}

/* ---- marches ---- */

/* Take the method that is asked for, the scene's, or for fields leapfrog. */
static int choose_method(const timed_request *request, timed_march *timed)
{
  static const char *const taken[] = {
      [TIMED_FIELD] = "leapfrog", [TIMED_SOLID] = "verlet", [TIMED_GRID] = "yee"};
  const bool is_solid = elastic_of(timed->scene) != NULL;
  const char *own = timed->scene->method, *method = request->method;
  if (method == NULL && (is_solid || (own != NULL && strcmp(own, "yee") == 0))) method = own;
  if (method == NULL && !is_solid) method = "leapfrog";
  timed->kind = TIMED_FIELD;
  if (method != NULL && strcmp(method, "yee") == 0) timed->kind = TIMED_GRID;
  if (is_solid) timed->kind = TIMED_SOLID;
  timed->method = taken[timed->kind];
  if (method != NULL && strcmp(method, timed->method) == 0) return DONE;
  return usage_error(
      "bench: --scale ranks=: steps of %s are timed, not those of %s; give --method %s",
      is_solid ? "solids by verlet, which are all equal," : "leapfrog and yee",
      method != NULL ? method : "another method", timed->method);
}

int timed_open(const timed_request *request, const dvi_scene_division *division, timed_march *timed)
{
  dvi_march_facts facts;
  *timed = (timed_march){.h = (double)NAN};
  int code = scene_open_share(request->scene, request->settings, division, &timed->scene);
  if (code == DONE) code = choose_method(request, timed);
  if (code == DONE) code = share_check("bench", timed->scene, timed->method, ranks_count());
  if (code != DONE) return code;
  const dvi_march_options options = {
      .size = sizeof options, .method = timed->method, .step = isnan(request->h) ? 0 : request->h};
  code = open_march(timed->scene, &options, &timed->march);
  if (code != DONE) return code;
  dvi_march_facts_of(timed->march, &facts);
  timed->h = facts.step;
  return DONE;
}

double timed_values(const timed_march *timed)
{
  return (double)(dvi_march_size(timed->march, DVI_FORM_E) +
                  dvi_march_size(timed->march, DVI_FORM_B));
}

const dvi_mesh *timed_mesh(const timed_march *timed)
{
  return timed->kind == TIMED_SOLID ? dvi_elastic_mesh(elastic_of(timed->scene))
                                    : field_mesh(dvi_scene_field(timed->scene->scene));
}

int timed_degree(const timed_march *timed)
{
  return timed->kind == TIMED_FIELD ? dvi_field_degree(dvi_scene_field(timed->scene->scene)) : 0;
}

int timed_times(const timed_march *timed)
{
  return timed->kind == TIMED_SOLID ? dvi_mesh_dimension(timed_mesh(timed)) : 1;
}

void timed_close(timed_march *timed)
{
  dvi_march_destroy(&timed->march);
  problem_destroy(&timed->scene);
}

bool slowest_of(int workers, double seconds, double *most)
{
  double *all = calloc((size_t)workers, sizeof *all);
  bool good = all != NULL;
  if (!good) complain("out of memory");
  *most = seconds;
  /* The others wait for this one, with or without memory. */
  if (workers > 1) good = ranks_gather(&seconds, sizeof seconds, all) && good;
  for (int r = 0; r < workers && workers > 1 && good; r++) *most = fmax(*most, all[r]);
  free(all);
  return good;
}

/* Take steps, and give the elapsed time of the slowest process. */
static int take(const timed_march *timed, long steps, int workers, double *spent)
{
  double ready;
  if (!slowest_of(workers, 0, &ready)) return FAILED;
  const double began = elapsed_now();
  const double end = dvi_march_time(timed->march) + (double)steps * timed->h;
  const dvi_status status = dvi_march_advance(timed->march, end);
  if (status != DVI_OK) return library_error(status);
  return slowest_of(workers, elapsed_now() - began, spent) ? DONE : FAILED;
}

int timed_steps(const timed_request *request, const timed_march *timed, int workers,
                dvi_study_spread *seconds)
{
  double sample[DVI_STUDY_ROUNDS_MAX], spent = 0;
  /* The first steps fill memory and caches, and tell how many are enough. */
  int code = take(timed, request->steps, workers, &spent);
  const long steps = request->steps * dvi_study_repeats(spent);
  for (long round = 0; round < request->rounds && code == DONE; round++) {
    code = take(timed, steps, workers, &spent);
    sample[round] = spent / (double)steps;
  }
  if (code == DONE) *seconds = dvi_study_spread_of((int)request->rounds, sample);
  return code;
}
