#include "method/split/verlet_alone.h"

#include "method/split/impulse.h"
#include "num/compensated.h"
#include "system/evaluate/untested.h"

/* So few coordinates cost less than a call of the loops in lanes, whose bits are the same. */
enum { FEW = 8 };

/* Kicks by the force [n], and a drift. */
typedef struct move {
  int kicks;
  double kick[2], drift;
  const double *force;
} move;

static inline int kick_drift_few(const dvi__verlet_alone *own, const move *by,
                                 const dvi__state *from, const dvi__state *to)
{
  const double *mass = own->system->mass_diagonal, first = by->kick[0], second = by->kick[1],
               drift = by->drift, scalar = own->scalar;
  double doubt = 0;
  for (int i = 0; i < own->system->n; i++) {
    double p = from->p[i], p_compensation = from->p_compensation[i], q = from->q[i],
           q_compensation = from->q_compensation[i];
    dvi__add_compensated(&p, &p_compensation, first * by->force[i]);
    if (by->kicks == 2) dvi__add_compensated(&p, &p_compensation, second * by->force[i]);
    const double v = own->by == DVI__TIMES_SCALAR ? p * scalar
                     : own->by == DVI__BY_SCALAR  ? p / scalar
                                                  : p / mass[i];
    dvi__add_compensated(&q, &q_compensation, v * drift);
    doubt += 0 * p;
    to->p[i] = p;
    to->p_compensation[i] = p_compensation;
    to->q[i] = q;
    to->q_compensation[i] = q_compensation;
  }
  return doubt == 0;
}

static int kick_drift_many(const dvi__verlet_alone *own, const move *by, const dvi__state *from,
                           const dvi__state *to)
{
  return dvi__lanes_kick_drift(&(dvi__kick_drift){.count = (size_t)own->system->n,
                                                  .kicks = by->kicks,
                                                  .kick = {by->kick[0], by->kick[1]},
                                                  .drift = by->drift,
                                                  .by = own->by,
                                                  .scalar = own->scalar,
                                                  .mass = own->system->mass_diagonal,
                                                  .force = by->force,
                                                  .from = dvi__impulse_phase(from),
                                                  .to = dvi__impulse_phase(to)});
}

static inline int last_kick_few(int n, double kick, const double *force, const dvi__state *at)
{
  double doubt = 0;
  for (int i = 0; i < n; i++) {
    dvi__add_compensated(&at->p[i], &at->p_compensation[i], kick * force[i]);
    doubt += 0 * at->p[i] + 0 * at->q[i];
  }
  return doubt == 0;
}

static int last_kick_many(int n, double kick, const double *force, const dvi__state *at)
{
  return dvi__lanes_last_kick(&(dvi__last_kick){.count = (size_t)n,
                                                .kick = kick,
                                                .force = force,
                                                .from = dvi__impulse_phase(at),
                                                .to = dvi__impulse_phase(at)});
}

/* The kicks at the end of one step and at the start of the next stay apart, because a step is the
 * same whatever comes before it. */
int dvi__verlet_alone_steps(const dvi__verlet_alone *own, const dvi__state *now,
                            const double *before, dvi__state *next, double *gradient,
                            const double *h, int count)
{
  const int n = own->system->n, few = n <= FEW;
  const dvi__state *from = now;
  move by = {.kicks = 1, .force = before};
  next->t = now->t;
  next->t_compensation = now->t_compensation;
  for (int i = 0; i < count; i++, from = next) {
    by.kick[by.kicks - 1] = -0.5 * h[i];
    by.drift = h[i];
    if (!(few ? kick_drift_few(own, &by, from, next) : kick_drift_many(own, &by, from, next)))
      return 0;
    dvi__add_compensated(&next->t, &next->t_compensation, h[i]);
    if (dvi__potentials_gradient_untested(own->evaluator, 1, &next->t, next->q, gradient) != DVI_OK)
      return 0;
    by = (move){.kicks = 2, .kick = {-0.5 * h[i]}, .force = gradient};
  }
  return few ? last_kick_few(n, by.kick[0], gradient, next)
             : last_kick_many(n, by.kick[0], gradient, next);
}
