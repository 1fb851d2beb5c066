#include "scaling/timed.h"

#include <math.h>
#include <stdlib.h>

#include "cli/command.h"
#include "load/open_march.h"
#include "load/scene.h"
#include "shares/share.h"
#include "module/ranks.h"
#include "study/clock.h"

int timed_open(const timed_request *request, const dvi_scene_division *division, timed_march *timed)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = "leapfrog", .step = isnan(request->h) ? 0 : request->h};
  dvi_march_facts facts;
  *timed = (timed_march){.h = (double)NAN};
  int code = scene_open_share(request->scene, request->settings, division, &timed->scene);
  if (code == DONE) code = share_check("bench", timed->scene, "leapfrog", ranks_count());
  if (code == DONE) code = open_march(timed->scene, &options, &timed->march);
  if (code != DONE) return code;
  dvi_march_facts_of(timed->march, &facts);
  timed->h = facts.step;
  return DONE;
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
