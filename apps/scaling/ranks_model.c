#include "scaling/ranks_model.h"

#include <math.h>

#include "cli/command.h"

/* Fit the seconds of a step without others, on the whole mesh and on the largest share of each cut:
 * the least of the rounds, which other work of the machine disturbs least. The scene's own step on
 * the whole mesh takes longer, by a factor that is that of its shares, too. */
static bool fit_compute(ranks_bench *b)
{
  double bytes[CUTS_MAX] = {0}, seconds[CUTS_MAX] = {0};
  for (int i = 0; i < b->cuts; i++) {
    bytes[i] = b->cost.traffic * b->cut[i].cut.share;
    seconds[i] = b->cut[i].seconds.least;
  }
  if (!step_cost_fit(b->cuts, bytes, seconds, &b->cost.per_step, &b->cost.per_byte, b->deviation))
    return false;
  b->own = b->whole.kind == TIMED_FIELD ? b->whole.seconds.least / seconds[0] : 1;
  b->cost.per_step *= b->own;
  b->cost.per_byte *= b->own;
  return true;
}

/* Means over the runs that had a core for each rank: by which factor a step without messages took
 * longer than alone, and what a byte took beside the network. */
static void fit_shared(ranks_bench *b)
{
  double factors = 0, packings = 0;
  int runs = 0;
  for (int i = 0; i < b->shared; i++) {
    const shared_run *r = b->run + i;
    if (r->is_oversubscribed) continue;
    const double compute = b->cost.per_step + b->cost.per_byte * b->cost.traffic * r->cut.share,
                 network = r->cut.messages * b->refresh + r->cut.bytes / b->bandwidth,
                 agreements = r->agreements * ceil(log2(r->ranks)) * b->refresh;
    factors += (r->seconds.median - r->exchange - agreements) / compute;
    packings += (r->exchange - network) / fmax(1, r->cut.bytes);
    runs++;
  }
  b->has_sharing = runs > 0 && factors > 0;
  b->cost.sharing = b->has_sharing ? factors / runs : 1;
  b->cost.overhead = fmax(0, b->refresh - b->latency);
  b->cost.packing = runs > 0 ? fmax(0, packings / runs) : 0;
}

bool ranks_model_fit(ranks_bench *b)
{
  const ranks_request *r = b->request;
  b->cost = (step_cost){.dimension = b->whole.dimension,
                        .cells = b->whole.cells,
                        .traffic = b->whole.bytes / b->whole.cells,
                        .cuts = b->whole.kind == TIMED_GRID ? 0 : b->cuts - 1,
                        .latency = isnan(r->latency) ? b->latency : r->latency,
                        .bandwidth = isnan(r->bandwidth) ? b->bandwidth : r->bandwidth,
                        .agreements = b->run[0].agreements};
  for (int i = 1; i <= b->cost.cuts; i++) b->cost.cut[i - 1] = b->cut[i].cut;
  if (!fit_compute(b)) {
    complain("bench: the measured times are no times");
    return false;
  }
  fit_shared(b);
  if (step_cost_makes_sense(&b->cost)) return true;
  complain("bench: the measured times give no model");
  return false;
}

/* Blocks of a grid are foreseen for each number of ranks. A grid that is longer has slabs, each
 * with a neighbour on both sides. */
static bool predict_grid(const ranks_bench *b, double ranks, bool is_weak, step_prediction *p)
{
  const double whole = b->whole.cells, sides = fmin(2, ranks - 1),
               beside = fmax(0, b->beside.share - whole / 2);
  *p = (step_prediction){.cells = is_weak ? whole : whole / ranks, .share = whole};
  if (is_weak) {
    p->share += sides * beside;
    p->bytes = sides * b->beside.bytes;
    p->messages = sides * b->beside.messages;
  } else if (ranks > 1) {
    int i = 0;
    while (i < b->asked.count && b->foreseen[i].parts < ranks) i++;
    if (i == b->asked.count || b->foreseen[i].parts > ranks) return false;
    p->share = b->foreseen[i].share;
    p->bytes = b->foreseen[i].bytes;
    p->messages = b->foreseen[i].messages;
  }
  step_cost_charge(&b->cost, ranks, p);
  return true;
}

static bool predict(const ranks_bench *b, double ranks, bool is_weak, step_prediction *p)
{
  if (b->whole.kind == TIMED_GRID) return predict_grid(b, ranks, is_weak, p);
  return step_cost_predict(&b->cost, ranks, b->whole.cells * (is_weak ? ranks : 1), p);
}

bool ranks_model_predict(const ranks_bench *b, double ranks, bool is_weak, step_prediction *p,
                         double *efficiency)
{
  step_prediction one;
  if (!predict(b, 1, false, &one) || !predict(b, ranks, is_weak, p)) return false;
  *efficiency = one.seconds / p->seconds / (is_weak ? 1 : ranks);
  return true;
}

void ranks_model_run(const ranks_bench *b, const shared_run *run, step_prediction *p)
{
  *p = (step_prediction){.seconds = (double)NAN};
  if (b->whole.kind != TIMED_GRID) {
    (void)step_cost_predict(&b->cost, run->ranks, run->cells, p);
    return;
  }
  *p = (step_prediction){.cells = run->cells / run->ranks,
                         .share = run->cut.share,
                         .messages = run->cut.messages,
                         .bytes = run->cut.bytes};
  step_cost_charge(&b->cost, run->ranks, p);
}
