#include "support/solid/throws.h"

#include <stdlib.h>

thrown throw_block(const solid_case *of, const dvi_obstacle *obstacle, double turn, double span)
{
  thrown c = {.obstacle = *obstacle, .span = span};
  c.s = make_judged(of, &c.obstacle, 1);
  const int size = c.s.judge.size;
  c.end = calloc((size_t)size, sizeof *c.end), c.speed = calloc((size_t)size, sizeof *c.speed);
  start_judged(&c.s, turn, c.end, c.speed);
  for (int k = 0; k < size; k++)
    c.speed[k] = (double)(c.speed[k] + (k % of->n == 1 ? -0.5 : -0.125));
  c.u = rounded(size, c.end), c.rate = rounded(size, c.speed);
  quad_solid_advance_among(&c.s.judge, &c.obstacle, 1, c.span, 20, c.end, c.speed, &c.hits);
  return c;
}

void end_throw(thrown *c)
{
  free(c->u), free(c->rate), free(c->end), free(c->speed);
  end_judged_solid(&c->s);
}
