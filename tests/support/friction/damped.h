/* Systems with uniform friction -gamma p. */
#ifndef SUPPORT_DAMPED_H
#define SUPPORT_DAMPED_H
#include <dvi/dvi.h>

enum { DAMPED_NQ = 13, DAMPED_NV = 7 };

typedef enum damped_kind {
  DAMPED_OSCILLATOR, /* x'' = -x - gamma x', with an exact solution */
  DAMPED_PLANE,      /* in a plane, V = r^2/2 + r^4/4, two equal masses; angular momentum */
  DAMPED_DRIVE,      /* L = (1 + x^2) v^2/2 - x^2/2 with F = sin(2t)/5 - v/10 beside it */
  DAMPED_TOP,        /* a rotation with a weight, a direction with a weight, an angle */
  DAMPED_FREE_TOP,   /* the same without weights; invariant 1 is the momentum of turns */
  DAMPED_KINDS
} damped_kind;

/* A system with a start at t = 0, and the rate of its friction. */
typedef struct damped {
  const char *name;
  dvi_system *system;
  int nq, nv;
  double q[DAMPED_NQ], v[DAMPED_NV], gamma;
} damped;

void make_damped(damped_kind kind, double gamma, damped *made);
void destroy_damped(damped *made);

/* Creates an integrator that keeps balances, and starts it. */
dvi_integrator *damped_integrator(const damped *model, const char *method);

#endif
