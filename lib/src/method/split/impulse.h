/* Methods that split the potentials. The slow potentials kick. Between the kicks stands the motion
 * with the fast potentials alone.
 *
 *     p <- p - h/2 V_slow'(t0, q),   (q, p) <- fast motion over h,   p <- p - h/2 V_slow'(t1, q)
 * The discrete Lagrangian is that of the fast motion with the trapezoid for the slow potentials.
 * The forces of the last kick are those of the next first kick. */
#ifndef DVI_METHOD_SPLIT_IMPULSE_H
#define DVI_METHOD_SPLIT_IMPULSE_H
#include "method/method.h"
#include "num/simd/lanes.h"

/* The own struct of a stepper begins with this struct. The memory holds the gradient [n] of the
 * kicks, the length of step for which it was computed (0 if not known), and the memory of
 * `inner`. */
typedef struct dvi__impulse {
  dvi_system *slow, *fast; /* the parts of the system; slow is NULL if all potentials kick */
  dvi__evaluator *forces;  /* evaluator of the potentials that kick */
  /* the method that moves the fast part, or NULL if `move` does this alone */
  dvi__stepper *inner;
  /* The gradient V_q [n] of the kicks at the state, for steps of length h. NULL selects the plain
   * gradient, which does not depend on h. */
  dvi_status (*gradient)(dvi__stepper *self, const dvi__state *state, double h, double *V_q);
  /* the fast motion, which leaves the clock as it is */
  dvi_status (*move)(dvi__stepper *self, dvi__state *state, double h);
} dvi__impulse;

/* Make self->own, of `size` bytes. Set the parts, the forces, the size of the memory, order 2, and
 * symmetric. All potentials kick if `all` is not 0, else the slow ones. */
dvi_status dvi__impulse_create(dvi__stepper *self, size_t size, int all);
void dvi__impulse_destroy(dvi__stepper *self);

/* Let another method, given by its specification, move the fast part in `count` steps of length
 * h/count. */
dvi_status dvi__impulse_take_inner(dvi__stepper *self, const char *specification);
dvi_status dvi__impulse_inner_steps(dvi__stepper *self, dvi__state *state, double h, int count);

/* Operations of dvi__method. */
void dvi__impulse_start(dvi__stepper *self, const double *v);
dvi_status dvi__impulse_step(dvi__stepper *self, dvi__state *state, double h);

dvi__phase dvi__impulse_phase(const dvi__state *state);

/* Entries that all such methods have in their initialisers. */
#define DVI__IMPULSE_OPERATIONS                                                         \
  .needs = DVI__CONSTANT_MASS | DVI__FAST, .uses = DVI__CONSTANT_MASS | DVI__POTENTIAL, \
  .start = dvi__impulse_start, .step = dvi__impulse_step

#endif
