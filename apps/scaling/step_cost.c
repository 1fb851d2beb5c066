#include "scaling/step_cost.h"

#include <math.h>

/* ---- the fit ---- */

static bool is_positive(double number)
{
  return isfinite(number) && number > 0;
}

static bool are_positive(int count, const double *number)
{
  for (int i = 0; i < count; i++)
    if (!is_positive(number[i])) return false;
  return count > 0;
}

/* The least squares of a/t + b w/t = 1 over all samples, of which a or b may be held at 0. */
typedef struct normal_equations {
  double aa, ab, bb, a, b;
} normal_equations;

static normal_equations sum_up(int count, const double *bytes, const double *seconds)
{
  normal_equations n = {0};
  for (int i = 0; i < count; i++) {
    const double one = 1 / seconds[i], work = bytes[i] / seconds[i];
    n.aa += one * one;
    n.ab += one * work;
    n.bb += work * work;
    n.a += one;
    n.b += work;
  }
  return n;
}

bool step_cost_fit(int count, const double *bytes, const double *seconds, double *per_step,
                   double *per_byte, double *deviation)
{
  static const double singular = 1e-12; /* of the determinant beside its terms */
  if (!are_positive(count, bytes) || !are_positive(count, seconds)) return false;
  const normal_equations n = sum_up(count, bytes, seconds);
  const double determinant = n.aa * n.bb - n.ab * n.ab;
  double constant = 0, slope = n.b / n.bb;
  if (determinant > singular * n.aa * n.bb) {
    const double free_constant = (n.a * n.bb - n.b * n.ab) / determinant,
                 free_slope = (n.aa * n.b - n.ab * n.a) / determinant;
    if (free_slope < 0) {
      constant = n.a / n.aa;
      slope = 0;
    } else if (free_constant >= 0) {
      constant = free_constant;
      slope = free_slope;
    }
  }
  for (int i = 0; i < count; i++)
    deviation[i] = (constant + slope * bytes[i] - seconds[i]) / seconds[i];
  *per_step = constant;
  *per_byte = slope;
  return true;
}

/* ---- the prediction ---- */

static bool is_not_negative(double number)
{
  return isfinite(number) && number >= 0;
}

static bool cuts_make_sense(const step_cost *cost)
{
  if (cost->cuts < 0 || cost->cuts > CUTS_MAX) return false;
  for (int i = 0; i < cost->cuts; i++) {
    const mesh_cut *c = cost->cut + i;
    const double before = i > 0 ? c[-1].parts : 1;
    if (!isfinite(c->parts) || c->parts <= before || c->parts > cost->cells) return false;
    if (!is_positive(c->share) || c->share < floor(cost->cells / c->parts)) return false;
    if (!is_not_negative(c->bytes) || !is_not_negative(c->messages)) return false;
  }
  return true;
}

bool step_cost_makes_sense(const step_cost *cost)
{
  return cost->dimension >= 1 && cost->dimension <= 3 && is_positive(cost->cells) &&
         is_positive(cost->traffic) && cuts_make_sense(cost) && is_not_negative(cost->per_step) &&
         is_not_negative(cost->per_byte) && cost->per_step + cost->per_byte > 0 &&
         is_positive(cost->sharing) && is_not_negative(cost->latency) &&
         is_positive(cost->bandwidth) && is_not_negative(cost->overhead) &&
         is_not_negative(cost->packing) && is_not_negative(cost->agreements);
}

/* What a part has around it: the thickness of its shell, its bytes for a unit of surface, and its
 * messages. */
typedef struct surroundings {
  double thickness, surface, messages;
} surroundings;

static surroundings surroundings_of(const step_cost *cost, const mesh_cut *cut)
{
  const double n = cost->dimension, side = pow(cost->cells / cut->parts, 1 / n);
  return (surroundings){fmax(0, pow(cut->share, 1 / n) - side), cut->bytes / pow(side, n - 1),
                        cut->messages};
}

/* Those of as many ranks: of cuts with fewer parts the most, and in between along the logarithm. */
static surroundings find_surroundings(const step_cost *cost, double ranks)
{
  surroundings most = {0};
  double parts = 1;
  for (int i = 0; i < cost->cuts && parts < ranks; i++) {
    const surroundings at = surroundings_of(cost, cost->cut + i);
    const double part = fmin(1, log(ranks / parts) / log(cost->cut[i].parts / parts));
    most.thickness += part * fmax(0, at.thickness - most.thickness);
    most.surface += part * fmax(0, at.surface - most.surface);
    most.messages += part * fmax(0, at.messages - most.messages);
    parts = cost->cut[i].parts;
  }
  most.messages = fmin(most.messages, ranks - 1);
  return most;
}

void step_cost_charge(const step_cost *cost, double ranks, step_prediction *p)
{
  const double message = cost->latency + cost->overhead;
  p->compute = cost->per_step + cost->per_byte * cost->traffic * p->share;
  if (ranks > 1) p->compute *= cost->sharing;
  p->exchange = p->messages * message + p->bytes * (1 / cost->bandwidth + cost->packing) +
                cost->agreements * ceil(log2(ranks)) * message;
  p->seconds = p->compute + p->exchange;
}

bool step_cost_predict(const step_cost *cost, double ranks, double cells,
                       step_prediction *prediction)
{
  if (!step_cost_makes_sense(cost) || !isfinite(ranks) || !isfinite(cells) || ranks < 1 ||
      cells < ranks)
    return false;
  const double n = cost->dimension, side = pow(cells / ranks, 1 / n);
  const surroundings around = find_surroundings(cost, ranks);
  step_prediction p = {.cells = cells / ranks,
                       .share = fmin(cells, pow(side + around.thickness, n)),
                       .messages = around.messages,
                       .bytes = around.surface * pow(side, n - 1)};
  if (ranks <= 1) p.share = cells;
  step_cost_charge(cost, ranks, &p);
  *prediction = p;
  return true;
}
