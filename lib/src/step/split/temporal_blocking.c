#include "step/split/temporal_blocking.h"

#include <stdatomic.h>
#include <stddef.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "num/team.h"
#include "step/split/window.h"

/* Lags are multiples of a cache line, so that vectors stay aligned. With blocks of 512 coordinates,
 * and the lags of 17 substeps between nearest neighbours, the window has five arrays of 800
 * numbers, which fits into the first cache. Windows up to WINDOW fit into the second. */
enum { LINE = 8, BLOCK = 512, WINDOW = 24 * 1024 };

enum { ARRAYS = DVI__WINDOW_ARRAYS };

/* Chains of so many coordinates leave no cache large enough for the states before and after a step.
 * The operations then work in a window of their own, from which the new state goes to memory past
 * the caches. Lines that a plain store writes would be read first. While a block is computed no
 * memory is read, unless the processor looks ahead to the next block. Blocks are therefore short
 * where a pass computes little, SHORT_BLOCK coordinates for each substep, unless more are in work
 * behind them. A window has ROOM for some of them, so that it moves more seldom. */
enum { LONG_CHAIN = 400 * 1000, SHORT_BLOCK = 64, ROOM = 192 };

struct dvi__blocking {
  const dvi_system *system;
  int threads;
  ptrdiff_t block, lag; /* coordinates of one turn; lag of one operation behind the other */
  dvi__division by;
  double scalar;
  /* [threads*block] one potential's gradient, before it is added to the others; NULL for a single
   * potential */
  double *term;
  double *windows; /* [threads][ARRAYS][length], or NULL */
  ptrdiff_t length;
  dvi__team *team;
  atomic_int *begun; /* [threads] not 0 if the left neighbour may cross the cut */
};

static atomic_int chosen_block, least_long_chain = LONG_CHAIN;

void dvi__blocking_choose_block(int block)
{
  atomic_store(&chosen_block, block);
}

void dvi__blocking_choose_long_chain(int coordinates)
{
  atomic_store(&least_long_chain, coordinates > 0 ? coordinates : LONG_CHAIN);
}

/* ---- create, destroy ---- */

const char *dvi__blocking_obstacle(const dvi_system *system)
{
  if (system->mass_diagonal == NULL) return "the mass is not diagonal";
  if (system->potential_count == 0) return "there is no potential";
  if (system->force_count > 0) return "there are forces without a potential";
  if (system->damping > 0) return "the system is damped";
  for (int k = 0; k < system->potential_count; k++)
    if (system->potentials[k].callbacks.gradient_range == NULL)
      return "a potential has no gradient_range";
  return NULL;
}

/* Return how many coordinates a pass of so many substeps has in work behind its block. */
static ptrdiff_t in_work(const dvi__blocking *w, int count)
{
  return 2 * count * w->lag;
}

static ptrdiff_t block_of_window(const dvi__blocking *w, int count)
{
  const ptrdiff_t work = in_work(w, count),
                  least = work > SHORT_BLOCK * count ? work : SHORT_BLOCK * count;
  return w->block < least ? w->block : least;
}

/* Return the length of the window of such a pass. It holds a block, what is in work, and as much of
 * the right neighbour's. What moves with the window is less than the room in front of it. */
static ptrdiff_t length_of_window(const dvi__blocking *w, int count)
{
  const ptrdiff_t work = in_work(w, count), kept = work > w->block ? 4 * work : 2 * work;
  return (block_of_window(w, count) + kept + w->lag + ROOM + LINE - 1) / LINE * LINE;
}

/* Allocate windows for the passes whose windows fit into a cache. */
static int allocate_windows(dvi__blocking *w)
{
  int count = dvi__blocking_depth(w);
  while (count > 0 && length_of_window(w, count) > WINDOW) count--;
  if (count == 0 || w->system->n < atomic_load(&least_long_chain)) return 1;
  w->length = length_of_window(w, count);
  w->windows = DVI_NEW(double, (size_t)w->threads *ARRAYS *(size_t)w->length);
  return w->windows != NULL;
}

static int has_windows(const dvi__blocking *w, int count)
{
  return w->windows != NULL && length_of_window(w, count) <= w->length;
}

static dvi_status blocking_initialise(dvi__blocking *w)
{
  const int potentials = w->system->potential_count, block = atomic_load(&chosen_block);
  int reach = 0;
  for (int k = 0; k < potentials; k++)
    reach = w->system->potentials[k].callbacks.reach > reach
                ? w->system->potentials[k].callbacks.reach
                : reach;
  w->block = block > 0 ? block : BLOCK;
  w->lag = block > 0 ? reach : ((ptrdiff_t)reach + LINE - 1) / LINE * LINE;
  w->by = w->system->mass_scalar != 0 ? dvi__division_by(w->system->mass_scalar, &w->scalar)
                                      : DVI__BY_ARRAY;
  w->begun = DVI_NEW(atomic_int, w->threads);
  if (potentials > 1) w->term = DVI_NEW(double, w->threads * w->block);
  if (w->begun == NULL || (potentials > 1 && w->term == NULL) || !allocate_windows(w))
    return dvi__fail(DVI_NO_MEMORY, "temporal blocking: no memory for %d threads", w->threads);
  return w->threads > 1 ? dvi__team_create(w->threads, &w->team) : DVI_OK;
}

dvi_status dvi__blocking_create(const dvi_system *system, int threads, dvi__blocking **blocking)
{
  *blocking = NULL;
  dvi__blocking *made = DVI_NEW(dvi__blocking, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "temporal blocking: no memory");
  made->system = system;
  made->threads = threads;
  const dvi_status status = blocking_initialise(made);
  if (status != DVI_OK) dvi__blocking_destroy(&made);
  *blocking = made;
  return status;
}

void dvi__blocking_destroy(dvi__blocking **blocking)
{
  dvi__blocking *w = *blocking;
  if (w == NULL) return;
  dvi__team_destroy(&w->team);
  dvi__release(w->begun);
  dvi__release(w->term);
  dvi__release(w->windows);
  dvi__release(w);
  *blocking = NULL;
}

/* ---- the operations ---- */

/* A pass of some threads over all coordinates. */
typedef struct pass {
  const dvi__blocking *blocking;
  dvi__blocking_step step;
  int members;
  atomic_int failed;
} pass;

/* The part of one thread has coordinates begin to end-1. It is cut obliquely on both sides, except
 * at the ends of the chain. */
typedef struct part {
  pass *pass;
  ptrdiff_t begin, end, block;
  double *term;
  dvi__window window;
} part;

typedef struct range {
  ptrdiff_t first, last;
} range;

static dvi__phase phase_at(const dvi__phase *whole, ptrdiff_t i)
{
  return (dvi__phase){.q = whole->q + i,
                      .p = whole->p + i,
                      .q_compensation = whole->q_compensation + i,
                      .p_compensation = whole->p_compensation + i};
}

/* Take the operation A_k, k = 0 .. count-1. The second kick of the substep before and the first
 * kick of this one have the same gradient. */
static int blocking_kick_drift(const part *own, int k, range r)
{
  const dvi__blocking *w = own->pass->blocking;
  const dvi__blocking_step *s = &own->pass->step;
  const double *gradient = k == 0 && s->gradient != NULL ? s->gradient : own->window.gradient;
  const dvi__kick_drift kick_drift = {
      .count = (size_t)(r.last - r.first),
      .kicks = k == 0 ? 1 : 2,
      .kick = {k == 0 ? -0.5 * s->h[0] : -0.5 * s->h[k - 1], -0.5 * s->h[k]},
      .drift = s->h[k],
      .by = w->by,
      .scalar = w->scalar,
      .mass = w->by == DVI__BY_ARRAY ? w->system->mass_diagonal + r.first : NULL,
      .force = gradient + r.first,
      .from = phase_at(k == 0 ? &s->from : &own->window.at, r.first),
      .to = phase_at(&own->window.at, r.first),
      .far = k > 0                       ? DVI__NEAR
             : own->window.in[0] != NULL ? DVI__FAR_FROM
                                         : DVI__FAR_BOTH};
  return dvi__lanes_kick_drift(&kick_drift);
}

WIDE static void add_term(size_t count, const double *restrict term, double *restrict sum)
{
  for (size_t i = 0; i < count; i++) sum[i] += term[i];
}

/* Add the potentials' gradients at q, in the order of the plain operations. Numbers that are not
 * finite are found in the kick that follows, before a callback gets any that come of them. */
static int blocking_gradient(const part *own, double t, const double *q, range r)
{
  const dvi_system *system = own->pass->blocking->system;
  double *sum = own->window.gradient + r.first;
  const size_t count = (size_t)(r.last - r.first);
  for (int k = 0; k < system->potential_count; k++) {
    const dvi_potential *asked = &system->potentials[k].callbacks;
    if (asked->gradient_range(t, q, (int)r.first, (int)r.last, k == 0 ? sum : own->term,
                              asked->user) != 0)
      return 0;
    if (k > 0) add_term(count, own->term, sum);
  }
  return 1;
}

/* Take the last kick, which leaves the new state. */
static int blocking_last_kick(const part *own, range r)
{
  const dvi__blocking_step *s = &own->pass->step;
  return dvi__lanes_last_kick(&(dvi__last_kick){.count = (size_t)(r.last - r.first),
                                                .kick = -0.5 * s->h[s->count - 1],
                                                .force = own->window.gradient + r.first,
                                                .from = phase_at(&own->window.at, r.first),
                                                .to = phase_at(&s->to, r.first),
                                                .force_to = s->gradient_to + r.first,
                                                .past = own->window.in[0] != NULL});
}

/* ---- one thread ---- */

/* Return the range of an operation that is `lag` behind, when the first operation works from x
 * on. */
static range range_at(const part *own, ptrdiff_t x, ptrdiff_t lag)
{
  const ptrdiff_t n = own->pass->blocking->system->n, block = own->block;
  const ptrdiff_t least = own->begin == 0 ? 0 : own->begin + lag,
                  most = own->end == n ? n : own->end + lag;
  const range r = {x - lag > least ? x - lag : least,
                   x - lag + block < most ? x - lag + block : most};
  return r;
}

/* Fetch share k of the next block from memory, while this one is computed. A pass of one substep
 * computes too little for that. GCC drops calls of functions that do nothing else. */
INLINE void fetch_share(const part *own, ptrdiff_t x, int k)
{
  const dvi__blocking_step *s = &own->pass->step;
  const range next = range_at(own, x + own->block, 0);
  const ptrdiff_t lines = (next.last - next.first + LINE - 1) / LINE;
  const double *const read[] = {s->from.q, s->from.p, s->from.q_compensation,
                                s->from.p_compensation, s->gradient};
  if (own->window.in[0] == NULL || s->count == 1) return;
  for (ptrdiff_t i = lines * k / s->count; i < lines * (k + 1) / s->count; i++)
    for (int a = 0; a < ARRAYS - (s->gradient == NULL); a++)
      __builtin_prefetch(read[a] + next.first + LINE * i, 0, 2);
}

/* Take all operations, each in its range when the first one is at x. */
static int work_at(const part *own, ptrdiff_t x)
{
  const dvi__blocking_step *s = &own->pass->step;
  const ptrdiff_t lag = own->pass->blocking->lag;
  range r = range_at(own, x, 0);
  if (s->gradient == NULL && r.first < r.last && !blocking_gradient(own, s->t0, s->from.q, r))
    return 0;
  for (int k = 0; k < s->count; k++) {
    fetch_share(own, x, k);
    r = range_at(own, x, 2 * k * lag);
    if (r.first < r.last && !blocking_kick_drift(own, k, r)) return 0;
    r = range_at(own, x, (2 * k + 1) * lag);
    if (r.first < r.last && !blocking_gradient(own, s->t[k], own->window.at.q, r)) return 0;
  }
  return r.first >= r.last || blocking_last_kick(own, r);
}

static int blocking_await_neighbour(const part *own, int neighbour)
{
  for (int waited = 0; atomic_load(&own->pass->blocking->begun[neighbour]) == 0; waited++) {
    if (atomic_load(&own->pass->failed)) return 0;
    dvi__team_pause(waited);
  }
  return 1;
}

/* Let the left neighbour cross the cut, once all that it needs is in memory. */
static void let_neighbour_begin(part *own, int member)
{
  dvi__lanes_await_stores();
  atomic_store(&own->pass->blocking->begun[member], 1);
}

/* Run the part of one thread. Behind `clear` the thread touches no coordinate of the left
 * neighbour, which writes `behind` coordinates beyond the cut and reads one reach more. Before
 * `clear` no thread waits for another, so that all threads get there. */
static int blocking_run_part(part *own, int member)
{
  const dvi__blocking *w = own->pass->blocking;
  const ptrdiff_t behind = (2 * own->pass->step.count - 1) * w->lag,
                  clear = own->begin + 2 * (behind + w->lag);
  const int is_last = member == own->pass->members - 1;
  const ptrdiff_t last = is_last ? own->end : own->end + behind, end = last + behind;
  dvi__window *window = &own->window;
  int waits = !is_last, tells = 1, good = 1;
  for (ptrdiff_t x = own->begin; x < end && good; x += own->block) {
    const int meets = waits && x + own->block + w->lag > own->end, is_clear = tells && x >= clear;
    if (is_clear || meets || x + own->block > window->first + window->length)
      dvi__window_slide(window, x - behind - w->lag, is_clear && own->begin > 0 ? behind : 0);
    if (is_clear) let_neighbour_begin(own, member);
    tells = tells && !is_clear;
    if (window->last < own->end)
      window->last = x + own->block < own->end ? x + own->block : own->end;
    if (meets) {
      good = blocking_await_neighbour(own, member + 1);
      if (good) dvi__window_take(window, own->end, behind + w->lag);
      waits = 0;
    }
    good = good && !atomic_load_explicit(&own->pass->failed, memory_order_relaxed) &&
           work_at(own, x);
  }
  dvi__lanes_await_stores();
  return good;
}

static ptrdiff_t blocking_cut(const pass *p, int member)
{
  const ptrdiff_t n = p->blocking->system->n;
  return member == p->members ? n : n / p->members * member / LINE * LINE;
}

static void blocking_take_part(void *user, int member)
{
  pass *p = user;
  const dvi__blocking *w = p->blocking;
  part own = {.pass = p,
              .begin = blocking_cut(p, member),
              .end = blocking_cut(p, member + 1),
              .block = w->block,
              .term = w->term != NULL ? w->term + member * w->block : NULL,
              .window = dvi__window_none(&p->step.to, p->step.gradient_to)};
  if (has_windows(w, p->step.count)) {
    own.block = block_of_window(w, p->step.count);
    dvi__window_open(&own.window, w->windows + member * ARRAYS * w->length, w->length,
                     length_of_window(w, p->step.count), own.begin);
  }
  if (!blocking_run_part(&own, member)) atomic_store(&p->failed, 1);
}

/* ---- the whole ---- */

int dvi__blocking_depth(const dvi__blocking *w)
{
  const ptrdiff_t depth = w->lag > 0 ? (WINDOW - w->block) / (2 * w->lag) : DVI__BLOCKING_SUBSTEPS;
  return depth < 1 ? 1 : depth > DVI__BLOCKING_SUBSTEPS ? DVI__BLOCKING_SUBSTEPS : (int)depth;
}

int dvi__blocking_threads(const dvi__blocking *w, int count)
{
  const int substeps = count < dvi__blocking_depth(w) ? count : dvi__blocking_depth(w);
  const ptrdiff_t least = 4 * (substeps + 1) * w->lag + 4 * w->block + LINE,
                  possible = w->system->n / least;
  return possible < 1 ? 1 : possible < w->threads ? (int)possible : w->threads;
}

static int run_pass(dvi__blocking *w, const dvi__blocking_step *step)
{
  pass p = {.blocking = w, .step = *step, .members = dvi__blocking_threads(w, step->count)};
  atomic_init(&p.failed, 0);
  for (int i = 0; i < w->threads; i++) atomic_store(&w->begun[i], 0);
  if (p.members == 1)
    blocking_take_part(&p, 0);
  else
    dvi__team_run(w->team, p.members, blocking_take_part, &p);
  return !atomic_load(&p.failed);
}

int dvi__blocking_run(dvi__blocking *w, const dvi__blocking_step *step)
{
  const int depth = dvi__blocking_depth(w);
  dvi__blocking_step rest = *step;
  while (step->h + step->count > rest.h) {
    const ptrdiff_t left = step->h + step->count - rest.h;
    rest.count = left < depth ? (int)left : depth;
    if (!run_pass(w, &rest)) return 0;
    rest.t0 = rest.t[rest.count - 1];
    rest.h += rest.count;
    rest.t += rest.count;
    rest.from = rest.to;
    rest.gradient = rest.gradient_to;
  }
  return 1;
}

/* The first pass goes from one array to another, whose lines are read first unless a window is
 * written past the caches. Later passes stay there. */
double dvi__blocking_traffic(const dvi__blocking *w, int count)
{
  const int depth = dvi__blocking_depth(w), passes = (count + depth - 1) / depth;
  const int fetched = has_windows(w, count < depth ? count : depth) ? 0 : ARRAYS;
  const int arrays = 2 * ARRAYS * passes + fetched + (w->by == DVI__BY_ARRAY ? passes : 0);
  return (double)arrays * (double)sizeof(double) * w->system->n;
}
