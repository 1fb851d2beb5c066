/* Systems with a constant mass and a vector potential. */
#ifndef SUPPORT_MAGNETIC_H
#define SUPPORT_MAGNETIC_H
#include <dvi/dvi.h>

enum { MAGNETIC_N = 4 };

typedef enum magnetic_kind {
  BOTTLE,  /* in space, A = (1 + .3 z^2)/2 (-y, x, 0), V = z^2/20, m = 1.3; one-point callbacks */
  WAVE,    /* in a plane, A and V depend on t, two masses; batch callbacks, differenced Hessian */
  COUPLED, /* four coordinates, all of which mass and A couple; no pattern, differenced Hessian */
  MAGNETIC_KINDS
} magnetic_kind;

/* A system with a start at t = 0 and the span of an order study. It must not move in memory. */
typedef struct magnetic {
  const char *name;
  magnetic_kind kind;
  dvi_system_terms terms;
  dvi_vector_potential A;
  dvi_potential V;
  dvi_lagrangian L;
  dvi_system *system;
  int n;
  double q[MAGNETIC_N], v[MAGNETIC_N], span;
} magnetic;

void make_magnetic(magnetic_kind kind, magnetic *made);
void destroy_magnetic(magnetic *made);

/* Makes the same system by a general Lagrangian with a gradient. */
void make_as_lagrangian(magnetic_kind kind, magnetic *made);

/* Gives q and v at the end of the span by the judge in quadruple precision. */
void magnetic_judge(magnetic_kind kind, double *q, double *v);

#endif
