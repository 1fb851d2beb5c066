/* Methods that split: kicks by the slow potentials, and between them the motion of the fast ones
 * alone.
 *
 *     p <- p - h/2 V_slow'(t0, q),      (q, p) <- fast motion over h,      p <- p - h/2 V_slow'(t1, q)
 * The discrete Lagrangian is that of the fast motion with the trapezoid on the slow potentials. The
 * last kick's forces are the next first kick's. */
#ifndef DVI_METHOD_IMPULSE_H
#define DVI_METHOD_IMPULSE_H
#include "method/method.h"
#include "num/simd/lanes.h"

/* A stepper's own struct begins with it. The memory: the gradient [n] of the kicks, the length for
 * which it was made (0: not known), then that of `inner`. */
typedef struct dvi__impulse {
  dvi_system *slow, *fast; /* the parts of the system; slow: NULL if all potentials kick */
  dvi__evaluator *forces;  /* of those that kick */
  /* another method, which moves the fast part; NULL: `move` does without */
  dvi__stepper *inner;
  /* The gradient V_q [n] of what kicks at the state, as steps of length h want it; NULL: as it is,
   * whatever h. */
  dvi_status (*gradient)(dvi__stepper *self, const dvi__state *state, double h, double *V_q);
  /* the fast motion; the clock is not its own */
  dvi_status (*move)(dvi__stepper *self, dvi__state *state, double h);
} dvi__impulse;

/* Make self->own, `size` bytes: parts, forces, the memory's size; order 2, symmetric. Slow
 * potentials kick, or all of them. */
dvi_status dvi__impulse_create(dvi__stepper *self, size_t size, int all);
void dvi__impulse_destroy(dvi__stepper *self);

/* Let another method, by its specification, move the fast part: `count` steps of length h/count. */
dvi_status dvi__impulse_take_inner(dvi__stepper *self, const char *specification);
dvi_status dvi__impulse_inner_steps(dvi__stepper *self, dvi__state *state, double h, int count);

/* Operations of dvi__method. */
void dvi__impulse_start(dvi__stepper *self, const double *v);
dvi_status dvi__impulse_step(dvi__stepper *self, dvi__state *state, double h);

dvi__phase dvi__impulse_phase(const dvi__state *state);

/* What all such methods have in their initialisers. */
#define DVI__IMPULSE_OPERATIONS                                                         \
  .needs = DVI__CONSTANT_MASS | DVI__FAST, .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL, \
  .start = dvi__impulse_start, .step = dvi__impulse_step

#endif
