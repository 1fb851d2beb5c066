/* Systems with forces without a potential. */
#ifndef SUPPORT_FORCED_H
#define SUPPORT_FORCED_H
#include <dvi/dvi.h>

enum { FORCED_N = 2 };

/* V = q^2/2 of one coordinate. */
extern const dvi_potential unit_spring;

/* The forms in which the derivatives of the force are declared. */
typedef enum forced_form {
  FORCED_POINT,
  FORCED_BATCH,
  FORCED_DIFFERENCED,
  FORCED_FORMS
} forced_form;

typedef enum forced_kind {
  DRIVEN_OSCILLATOR, /* x'' = -x - x'/5 + sin(2t)/2, with an exact solution */
  DRAGGED_PENDULUM,  /* L = v^2/2 + cos x, F = -.3 v^3 - .1 v cos^2 x + .4 cos 1.3t */
  STIRRED_SPRING,    /* in a plane, V = r^2/2 + r^4/4, F = -c v + k (-y, x), two masses */
  CURVED_LINE,       /* L = (1 + x^2) v^2/2 - x^2/2, F = -v/5 - x^3/10 */
  PUSHED_SPRING,     /* x'' = -x + cos(t) - x^3/2, where all of it but -x is F(t,q) */
  FORCED_KINDS
} forced_kind;

/* A system with a start at t = 0 and the span of an order study. It must not move in memory. */
typedef struct forced {
  const char *name;
  dvi_system *system;
  int n;
  double q[FORCED_N], v[FORCED_N], span;
} forced;

void make_forced(forced_kind kind, forced_form form, forced *made);
void destroy_forced(forced *made);

/* Gives q and v at the end of the span, exactly, or to 14 digits or more. Returns 0 if they are not
 * known. */
int forced_exact(forced_kind kind, double *q, double *v);

/* Creates an integrator that keeps balances, and starts it. */
dvi_integrator *forced_integrator(const forced *model, const char *method);

#endif
