#include "scaling/halo.h"

#include <math.h>
#include <stdlib.h>

#include "cli/command.h"
#include "module/ranks.h"
#include "study/clock.h"

enum { REFRESHES = 100 /* that are timed at once */ };

/* ---- an exchange alone ---- */

/* Exchange the planes of two neighbours, or of one, with the processes beside this one, whose order
 * does not count. */
static dvi_status pass_planes(const block *own, int workers, double *values)
{
  const dvi_yee_ranks *grid = ranks_grid();
  const int64_t count = own->ghosts / (own->messages > 0 ? own->messages : 1);
  if (grid == NULL) return DVI_SOLVER_FAILED;
  for (int way = 1; way >= -1; way -= 2) {
    const int to = grid->rank + way, from = grid->rank - way;
    if (grid->pass(to < workers ? to : -1, from < workers ? from : -1, count, values,
                   values + count, grid->user) != 0)
      return DVI_SOLVER_FAILED;
  }
  return DVI_OK;
}

/* Refresh all that a step needs of others, or for a grid that some steps need together. */
static dvi_status exchange_once(const timed_march *timed, const block *own, int workers,
                                double *values)
{
  dvi_status status = DVI_OK;
  if (timed->kind == TIMED_GRID) return pass_planes(own, workers, values);
  for (int i = 0; i < timed_times(timed) && status == DVI_OK; i++)
    status = ranks_refresh(timed_degree(timed), values);
  return status;
}

int halo_time(const timed_march *timed, const block *own, long rounds, shared_run *run)
{
  const bool is_grid = timed->kind == TIMED_GRID;
  const int64_t room = is_grid ? 2 * own->ghosts
                               : dvi_mesh_count(timed_mesh(timed), timed_degree(timed));
  const double refreshes = REFRESHES * (is_grid ? own->together : 1); /* steps that they serve */
  double sample[DVI_STUDY_ROUNDS_MAX], ready;
  double *values = calloc((size_t)room + 1, sizeof *values);
  dvi_status status = values != NULL ? DVI_OK : DVI_NO_MEMORY;
  bool good = true;
  for (long round = 0; round < rounds && status == DVI_OK && good; round++) {
    good = slowest_of(run->ranks, 0, &ready);
    const double began = elapsed_now();
    for (int i = 0; i < REFRESHES && status == DVI_OK; i++)
      status = exchange_once(timed, own, run->ranks, values);
    good = slowest_of(run->ranks, (elapsed_now() - began) / refreshes, sample + round) && good;
  }
  free(values);
  if (status != DVI_OK) return library_error(status);
  run->exchange = dvi_study_spread_of((int)rounds, sample).least;
  return good ? DONE : FAILED;
}

/* ---- what comes from others ---- */

/* Give what the ranks have most. */
static void find_cut(const timed_march *timed, shared_run *run)
{
  const int times = timed_times(timed);
  run->cut = (mesh_cut){.parts = run->ranks};
  run->cells = 0;
  for (int r = 0; r < run->ranks; r++) {
    mesh_division share;
    ranks_tell(r, timed_degree(timed), &share);
    run->cells += (double)share.owned;
    run->cut.share = fmax(run->cut.share, (double)(share.owned + share.ghosts));
    run->cut.bytes = fmax(run->cut.bytes, times * (double)share.bytes_in);
    run->cut.messages = fmax(run->cut.messages, times * share.messages_in);
  }
}

/* Do the same for blocks, of which each rank foresees its own. */
static int find_blocks(const timed_request *request, block *own, shared_run *run)
{
  block *all = calloc((size_t)run->ranks, sizeof *all);
  block_cutter *cutter = NULL;
  dvi_march *march = NULL;
  int code = all != NULL ? block_cutter_open(request->scene, request->settings, &cutter)
                         : library_error(DVI_NO_MEMORY);
  if (code == DONE) {
    dvi_status status = block_march(cutter, ranks_number(), run->ranks, request->h, &march);
    if (status == DVI_OK) status = block_count(cutter, march, own);
    if (status != DVI_OK) code = library_error(status);
  }
  if (code == DONE && !ranks_gather(own, sizeof *own, all)) code = FAILED;
  run->cut = (mesh_cut){.parts = run->ranks};
  run->cells = run->plane = 0;
  for (int r = 0; r < run->ranks && all != NULL && code == DONE; r++) {
    const mesh_cut cut = cut_of_block(all + r, run->ranks);
    run->cells += (double)all[r].values;
    run->plane = fmax(run->plane,
                      (double)all[r].ghosts / (all[r].together * fmax(1, all[r].neighbours)));
    run->cut.share = fmax(run->cut.share, cut.share);
    run->cut.bytes = fmax(run->cut.bytes, cut.bytes);
    run->cut.messages = fmax(run->cut.messages, cut.messages);
  }
  dvi_march_destroy(&march);
  block_cutter_close(&cutter);
  free(all);
  return code;
}

int halo_find(const timed_request *request, const timed_march *timed, shared_run *run, block *own)
{
  if (timed->kind == TIMED_GRID) return find_blocks(request, own, run);
  find_cut(timed, run);
  return DONE;
}
