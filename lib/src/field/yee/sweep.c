/* Steps of the whole grid.
 *
 * Rows of B and E at (j, k) are updated one after the other, since E needs only B at smaller j and
 * k, and B needs only E at larger ones that are not yet updated. So one step goes through memory
 * once. Several steps go through it once together: step s follows s planes behind the first one,
 * and in a tile of rows it also lies s rows lower, so that all that it reads is in the tile or in
 * the one before (Wolf and Lam 1991, skewing of loops). Threads take the tiles in turn, each behind
 * the tile before by one plane at least. */
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

static int tiles_of(const dvi__yee *y, int steps)
{
  const int lower = y->axis[1].is_trivial ? 0 : steps - 1;
  return (rows_of(y) + lower + y->tile - 1) / y->tile;
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
  if (axis == y->divided) return dvi__yee_last_boxes(y);
  return y->axis[axis].wraps ? y->axis[axis].cells - 1 : -1;
}

/* Take a step of the rows first to last-1 of a plane. If y is divided, the early ones are done. */
static void take_rows(const dvi__yee_worker *w, int first, int last, int k)
{
  const dvi__yee *y = w->yee;
  const int is_done = k == early(y, 2), early_row = early(y, 1);
  if (early_row >= 0 && y->divided != 1 && first == 0 && !is_done)
    dvi__yee_update_faces(w, early_row, k);
  for (int j = first; j < last; j++) {
    if (!is_done && j != early_row) dvi__yee_update_faces(w, j, k);
    dvi__yee_update_edges(w, j, k);
  }
}

static void take_early_faces(void *user, int member)
{
  const sweep *s = user;
  const dvi__yee *y = s->yee;
  const dvi__yee_worker worker = worker_of(y, member, 0);
  if (y->divided == 1 && member == 0) dvi__yee_update_faces(&worker, early(y, 1), 0);
  for (int j = member; j < rows_of(y) && early(y, 2) >= 0; j += y->threads)
    dvi__yee_update_faces(&worker, j, early(y, 2));
}

static void await_tile(const dvi__yee *y, int tile, int front)
{
  for (int waited = 0; atomic_load_explicit(&y->progress[tile], memory_order_acquire) <= front;
       waited++)
    dvi__team_pause(waited);
}

static void take_tile(const sweep *s, int member, int tile)
{
  const dvi__yee *y = s->yee;
  const int planes = y->own[2][1] - y->own[2][0], rows = rows_of(y), left = y->own[1][0],
            below = y->own[2][0], skew = !y->axis[1].is_trivial;
  for (int front = 0; front < planes + s->steps - 1; front++) {
    if (tile > 0) await_tile(y, tile - 1, front);
    for (int step = 0; step < s->steps; step++) {
      const int k = front - step, low = tile * y->tile - skew * step, high = low + y->tile;
      const dvi__yee_worker worker = worker_of(y, member, step);
      if (k >= 0 && k < planes)
        take_rows(&worker, left + (low > 0 ? low : 0), left + (high < rows ? high : rows),
                  below + k);
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

void dvi__yee_sweep(dvi__yee *y, int steps)
{
  sweep s = {y, steps, tiles_of(y, steps)};
  y->lanes = dvi__yee_lanes_in_use();
  for (int tile = 0; tile < s.tiles; tile++) atomic_store(&y->progress[tile], 0);
  if (y->axis[2].wraps || y->divided >= 0) run(y, take_early_faces, &s);
  dvi__yee_pass_faces(y);
  run(y, take_tiles, &s);
  dvi__yee_pass_edges(y);
}

/* ---- tiles ---- */

static int may_go_together(const dvi__yee *y)
{
  return !y->axis[1].wraps && !y->axis[2].wraps && y->divided < 0;
}

/* Choose how many steps go together, and tiles whose planes of all steps stay in a cache. */
static void choose_tiles(dvi__yee *y, const dvi_yee_terms *terms)
{
  const size_t row = (size_t)(y->copies * y->components) * y->width * sizeof(double),
               all = row * y->rows[0] * y->rows[1];
  y->together = terms->together > 0 ? terms->together : all > CACHE ? DEFAULT_TOGETHER : 1;
  if (!may_go_together(y)) y->together = 1;
  const size_t planes = y->axis[2].is_trivial ? 1 : (size_t)y->together + 2,
               fitting = CACHE / (row * planes);
  const int rows = rows_of(y), share = (rows + y->threads - 1) / y->threads;
  y->tile = fitting > LEAST_TILE ? (fitting < (size_t)rows ? (int)fitting : rows) : LEAST_TILE;
  if (y->threads > 1 && y->tile > share) y->tile = share;
}

dvi_status dvi__yee_make_sweeps(dvi__yee *y, const dvi_yee_terms *terms)
{
  if (terms->threads < 0 || terms->threads > 1024 || terms->together < 0 ||
      terms->together > DVI__YEE_MOST_TOGETHER)
    return dvi__fail(DVI_BAD_SIZE,
                     "yee: %d threads and %d steps together are asked for; up to 1024 and %d are "
                     "possible",
                     terms->threads, terms->together, DVI__YEE_MOST_TOGETHER);
  y->threads = terms->threads > 0 ? terms->threads : 1;
  choose_tiles(y, terms);
  y->progress = DVI_NEW(atomic_int, tiles_of(y, y->together));
  y->scratch = DVI_NEW(double, (size_t)y->threads *DVI__YEE_SCRATCH * y->width);
  if (y->progress == NULL || y->scratch == NULL)
    return dvi__fail(DVI_NO_MEMORY, "yee: no memory for %d threads", y->threads);
  return y->threads > 1 ? dvi__team_create(y->threads, &y->team) : DVI_OK;
}
