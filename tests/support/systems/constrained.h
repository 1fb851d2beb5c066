/* Systems with holonomic constraints. */
#ifndef SUPPORT_CONSTRAINED_H
#define SUPPORT_CONSTRAINED_H
#include <dvi/dvi.h>

enum { CONSTRAINED_N = 7, CONSTRAINED_ROWS = 6 };

typedef enum constrained_kind {
  SPHERICAL_PENDULUM, /* m = l = 1, g = 9.81, in Cartesian coordinates */
  DAMPED_PENDULUM,    /* the same with the force -v/5 */
  SWUNG_PENDULUM,     /* in a plane, its pivot moves as (0.3 sin 2t, 0) */
  CURVED_PENDULUM,    /* on the unit circle, L = (1 + x^2) |v|^2/2 - y */
  SLIDER_CRANK,       /* seven coordinates, six rows */
  CONSTRAINED_KINDS
} constrained_kind;

/* A system with a start at t = 0 and the span of an order study. */
typedef struct constrained {
  const char *name;
  dvi_system *system;
  int n, rows;
  double q[CONSTRAINED_N], v[CONSTRAINED_N], span;
} constrained;

/* `differenced` leaves out the Hessians of the constraints. */
void make_constrained(constrained_kind kind, int differenced, constrained *made);
void destroy_constrained(constrained *made);

/* Gives some coordinates at the end of the span, to 14 digits. The others are NaN. Returns 0 if
 * none is known. */
int constrained_digits(constrained_kind kind, double *q);

dvi_integrator *constrained_integrator(const constrained *model, const char *method);

#endif
