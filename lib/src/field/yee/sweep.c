/* Steps of the whole grid.
 *
 * Rows of B and E at (j, k) are updated one after the other, since E needs only B at smaller j and
 * k, and B needs only E at larger ones that are not yet updated. So one step goes through memory
 * once. Several steps go through it once together: step s follows s planes behind the first one,
 * and in a tile of rows it also lies s rows lower, so that all that it reads is in the tile or in
 * the one before (Wolf and Lam 1991, skewing of loops). Threads take the tiles in turn, each behind
 * the tile before by one plane at least. */
#include <limits.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

enum { CACHE = 3 << 18, DEFAULT_TOGETHER = 6, LEAST_TILE = 8 };

typedef struct sweep {
  const dvi__yee *yee;
  int steps, tiles;
} sweep;

static int rows_of(const dvi__yee *y)
{
  return y->own[1][1] - y->own[1][0];
}

static int has_ghosts(const dvi__yee *y)
{
  return y->ghosts[1][0] + y->ghosts[1][1] + y->ghosts[2][0] + y->ghosts[2][1] > 0;
}

/* Give the first row, or plane, of the first of several steps. */
static int first_of(const dvi__yee *y, int axis, int steps)
{
  int range[2];
  dvi__yee_reach(y, axis, 1, steps - 1, range);
  return range[0];
}

static int tiles_of(const dvi__yee *y, int steps)
{
  const int lower = y->axis[1].is_trivial ? 0 : steps - 1,
            rows = y->own[1][1] - first_of(y, 1, steps);
  return (rows + lower + y->tile - 1) / y->tile;
}

static dvi__yee_worker worker_of(const dvi__yee *y, int member, int step)
{
  const dvi__yee_worker worker = {y, y->scratch + (size_t)member * DVI__YEE_SCRATCH * y->width,
                                  y->drive != NULL ? y->drive + (size_t)step * (size_t)y->drives
                                                   : NULL};
  return worker;
}

/* Give the place along an axis whose faces come before all others, because E at the first node
 * needs them, or another process does, or -1. */
static int early(const dvi__yee *y, int axis)
{
  if (has_ghosts(y)) return -1;
  if (dvi__yee_is_divided(y, axis)) return dvi__yee_last_boxes(y, axis);
  return y->axis[axis].wraps ? y->axis[axis].cells - 1 : -1;
}

/* Rows first to last-1 of a plane. If that is bare, or the first row, B is updated there alone,
 * which E behind it needs. */
typedef struct row_range {
  int first, last, k, is_bare, bare_row; /* INT_MIN without one */
} row_range;

/* Take a step of rows. If y is divided, the early ones are done. */
static void take_rows(const dvi__yee_worker *w, const row_range *r)
{
  const dvi__yee *y = w->yee;
  const int k = dvi__yee_around(y, 2, r->k), is_done = k == early(y, 2), early_row = early(y, 1);
  if (early_row >= 0 && !dvi__yee_is_divided(y, 1) && r->first == 0 && !is_done)
    dvi__yee_update_faces(w, early_row, k);
  for (int row = r->first; row < r->last; row++) {
    const int j = dvi__yee_around(y, 1, row);
    if (!is_done && j != early_row) dvi__yee_update_faces(w, j, k);
    if (!r->is_bare && row != r->bare_row) dvi__yee_update_edges(w, j, k);
  }
}

/* Take those of the last plane, and where y is divided those of the last row of other planes. */
static void take_early_faces(void *user, int member)
{
  const sweep *s = user;
  const dvi__yee *y = s->yee;
  const dvi__yee_worker worker = worker_of(y, member, 0);
  const int plane = early(y, 2), row = dvi__yee_is_divided(y, 1) ? early(y, 1) : -1;
  for (int j = y->own[1][0] + member; j < y->own[1][1] && plane >= 0; j += y->threads)
    dvi__yee_update_faces(&worker, j, plane);
  for (int k = y->own[2][0] + member; k < y->own[2][1] && row >= 0; k += y->threads)
    if (k != plane) dvi__yee_update_faces(&worker, row, k);
}

static void await_tile(const dvi__yee *y, int tile, int front)
{
  for (int waited = 0; atomic_load_explicit(&y->progress[tile], memory_order_acquire) <= front;
       waited++)
    dvi__team_pause(waited);
}

/* Take the rows of a tile in one of the steps, at a plane that may be outside of the step's. */
static void take_plane(const sweep *s, const dvi__yee_worker *worker, int tile, int step, int k)
{
  const dvi__yee *y = s->yee;
  const int left = s->steps - 1 - step, skew = !y->axis[1].is_trivial,
            low = first_of(y, 1, s->steps) + tile * y->tile - skew * step, high = low + y->tile;
  int across[2], planes[2];
  dvi__yee_reach(y, 1, 1, left, across);
  dvi__yee_reach(y, 2, 1, left, planes);
  if (k < planes[0] || k >= planes[1]) return;
  const row_range r = {.first = low > across[0] ? low : across[0],
                       .last = high < across[1] ? high : across[1],
                       .k = k,
                       .is_bare = y->ghosts[2][0] > 0 && k == planes[0],
                       .bare_row = y->ghosts[1][0] > 0 ? across[0] : INT_MIN};
  take_rows(worker, &r);
}

static void take_tile(const sweep *s, int member, int tile)
{
  const dvi__yee *y = s->yee;
  const int below = first_of(y, 2, s->steps), fronts = y->own[2][1] - below + s->steps - 1;
  for (int front = 0; front < fronts; front++) {
    if (tile > 0) await_tile(y, tile - 1, front);
    for (int step = 0; step < s->steps; step++) {
      const dvi__yee_worker worker = worker_of(y, member, step);
      take_plane(s, &worker, tile, step, below + front - step);
    }
    atomic_store_explicit(&y->progress[tile], front + 1, memory_order_release);
  }
}

static void take_tiles(void *user, int member)
{
  const sweep *s = user;
  for (int tile = member; tile < s->tiles; tile += s->yee->threads) take_tile(s, member, tile);
}

static void run(const dvi__yee *y, void (*work)(void *user, int member), sweep *s)
{
  if (y->team != NULL)
    dvi__team_run(y->team, y->threads, work, s);
  else
    work(s, 0);
}

/* Take a step after the early faces, which other processes need, and give them E. */
static void run_divided(const dvi__yee *y, sweep *s)
{
  if (y->axis[2].wraps || y->planes != NULL) run(y, take_early_faces, s);
  dvi__yee_pass_faces(y);
  run(y, take_tiles, s);
  dvi__yee_pass_edges(y);
}

void dvi__yee_sweep(dvi__yee *y, int steps)
{
  sweep s = {y, steps, tiles_of(y, steps)};
  y->lanes = dvi__yee_lanes_in_use();
  for (int tile = 0; tile < s.tiles; tile++) atomic_store(&y->progress[tile], 0);
  if (!has_ghosts(y)) {
    run_divided(y, &s);
    return;
  }
  dvi__yee_fill_ghosts(y, steps);
  run(y, take_tiles, &s);
  dvi__yee_spoil_ghosts(y);
}

/* ---- tiles ---- */

/* Give the most steps that can go together. On an axis that repeats itself E and B go around after
 * each step, unless other processes have them: then ghosts do, but for phases, whose roundings
 * depend on where they are multiplied with. A process has the ghosts of its neighbours only, and on
 * both sides other ones. */
static int most_together(const dvi__yee *y)
{
  int most = DVI__YEE_MOST_TOGETHER;
  for (int l = 1; l < 3; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    const int parts = y->parts[l] == 2 && a->wraps ? 4 : y->parts[l];
    if (a->wraps && (parts == 1 || y->copies > 1)) return 1;
    if (parts > 1 && a->cells / parts < most) most = a->cells / parts;
  }
  return most;
}

/* Give how many planes a process has. Of a grid that is divided along two axes these are as many as
 * slabs would have to have the same surface. */
static int64_t planes_of(const dvi__yee *y)
{
  int64_t planes = 0;
  for (int l = 1; l < 3; l++) {
    const int64_t here = y->axis[l].cells / y->parts[l];
    if (dvi__yee_is_divided(y, l)) planes = planes > 0 ? planes * here / (planes + here) : here;
  }
  return planes;
}

/* Choose how many steps go together if nothing is asked for: one where all of a process fits into
 * a cache. A process that takes s together updates up to s planes of others in a step, and goes
 * through its own ones in memory 1/s times. The square root of a quarter of these balances it. */
static int default_together(const dvi__yee *y, size_t bytes)
{
  const int64_t planes = planes_of(y);
  int steps = DEFAULT_TOGETHER;
  if (bytes <= CACHE) return 1;
  while (planes > 0 && steps > 1 && 4 * steps * steps > planes) steps--;
  return steps;
}

static size_t bytes_of_row(const dvi__yee *y)
{
  return (size_t)(y->copies * y->components) * y->width * sizeof(double);
}

dvi_status dvi__yee_choose_together(dvi__yee *y, const dvi_yee_terms *terms)
{
  if (terms->threads < 0 || terms->threads > 1024 || terms->together < 0 ||
      terms->together > DVI__YEE_MOST_TOGETHER)
    return dvi__fail(DVI_BAD_SIZE,
                     "yee: %d threads and %d steps together are asked for; up to 1024 and %d are "
                     "possible",
                     terms->threads, terms->together, DVI__YEE_MOST_TOGETHER);
  size_t all = bytes_of_row(y) / (size_t)(y->parts[1] * y->parts[2]);
  for (int l = 1; l < 3; l++)
    if (!y->axis[l].is_trivial) all *= (size_t)y->axis[l].cells + 2;
  const int most = most_together(y);
  y->together = terms->together > 0 ? terms->together : default_together(y, all);
  if (y->together > most) y->together = most;
  return DVI_OK;
}

/* Choose tiles whose planes of all steps stay in a cache. */
static void choose_tiles(dvi__yee *y)
{
  const size_t planes = y->axis[2].is_trivial ? 1 : (size_t)y->together + 2,
               fitting = CACHE / (bytes_of_row(y) * planes);
  const int rows = rows_of(y), share = (rows + y->threads - 1) / y->threads;
  y->tile = fitting > LEAST_TILE ? (fitting < (size_t)rows ? (int)fitting : rows) : LEAST_TILE;
  if (y->threads > 1 && y->tile > share) y->tile = share;
}

dvi_status dvi__yee_make_sweeps(dvi__yee *y, const dvi_yee_terms *terms)
{
  y->threads = terms->threads > 0 ? terms->threads : 1;
  choose_tiles(y);
  y->progress = DVI_NEW(atomic_int, tiles_of(y, y->together));
  y->scratch = DVI_NEW(double, (size_t)y->threads *DVI__YEE_SCRATCH * y->width);
  if (y->progress == NULL || y->scratch == NULL)
    return dvi__fail(DVI_NO_MEMORY, "yee: no memory for %d threads", y->threads);
  return y->threads > 1 ? dvi__team_create(y->threads, &y->team) : DVI_OK;
}
