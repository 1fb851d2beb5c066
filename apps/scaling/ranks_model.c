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
                        .cuts = b->cuts - 1,
                        .latency = isnan(r->latency) ? b->latency : r->latency,
                        .bandwidth = isnan(r->bandwidth) ? b->bandwidth : r->bandwidth,
                        .agreements = b->run[0].agreements};
  for (int i = 1; i < b->cuts; i++) b->cost.cut[i - 1] = b->cut[i].cut;
  if (!fit_compute(b)) {
    complain("bench: the measured times are no times");
    return false;
  }
  fit_shared(b);
  if (step_cost_makes_sense(&b->cost)) return true;
  complain("bench: the measured times give no model");
  return false;
}

bool ranks_model_predict(const ranks_bench *b, double ranks, bool is_weak, step_prediction *p,
                         double *efficiency)
{
  const double cells = b->whole.cells * (is_weak ? ranks : 1);
  step_prediction one;
  if (!is_weak && ranks > b->most_ranks) return false;
  if (!step_cost_predict(&b->cost, 1, b->whole.cells, &one) ||
      !step_cost_predict(&b->cost, ranks, cells, p))
    return false;
  *efficiency = one.seconds / p->seconds / (is_weak ? 1 : ranks);
  return true;
}
