/* The Lagrangian of an optimal control problem, on coordinates (q,w) with the multipliers w.
 *
 *     G(t,(q,w),(v,w')) = min over u of C(t,q,v,u)/unit + w.(L_q + F(t,q,v) + F(t,q,v,u)) + w'.L_v
 *
 * Its discrete action by any element is the Lagrange function of the discrete problem with the same
 * element, because the rows of the element are h sum_j b_j (chi_a (L_q + F) + chi_a'/h L_v)_j, and
 * w = sum_a chi_a w_a (Ober-Bloebaum, Junge and Marsden 2011, sec. 4). The minimum over u is taken
 * at each point alone. By the envelope theorem the derivatives of G are those at fixed u. Bounds
 * least < u < most add the barrier -mu (log(u - least) + log(most - u)) to C/unit. */
#ifndef DVI_BOUNDARY_DOUBLED_H
#define DVI_BOUNDARY_DOUBLED_H
#include <dvi/control.h>

#include "system/evaluate/evaluator.h"

enum { DVI__CONTROLS_MOST = 16, DVI__TROUBLE_SIZE = 256 };

typedef struct dvi__doubled {
  const dvi_system *of;
  dvi_system *system; /* that of G */
  dvi_controls controls;
  double least[DVI__CONTROLS_MOST], most[DVI__CONTROLS_MOST];
  double unit, mu; /* unit of the cost, and factor of the barrier in that unit */
  dvi__evaluator *evaluator;
  dvi_counters counters;
  double *numbers;                    /* storage of the arrays below */
  double *L_q, *L_v, *F, *C_q, *C_v;  /* [n] */
  double *F_q, *F_v, *F_u;            /* [n*n], [n*n], [n*count] of the controls */
  double *qq, *qv, *vv, *by_q, *by_v; /* Hessians of L and derivatives of F, by their patterns */
  double C_u[DVI__CONTROLS_MOST];
  char trouble[DVI__TROUBLE_SIZE]; /* why u was not found, or "" */
} dvi__doubled;

dvi_status dvi__doubled_create(const dvi_system *system, const dvi_controls *controls,
                               dvi__doubled **doubled);
void dvi__doubled_destroy(dvi__doubled **doubled);

/* Return 1 if a control has a bound. */
int dvi__doubled_is_bounded(const dvi__doubled *doubled);

/* Find the minimum over u [count] at a point, where w [n] are the multipliers. DVI_NOT_CONVERGED
 * with the reason in `trouble`, or the failure of a callback. */
dvi_status dvi__doubled_minimise(dvi__doubled *doubled, double t, const double *q, const double *v,
                                 const double *w, double *u);

/* Evaluate the cost C, which is not in the unit, after dvi__doubled_minimise has found u. */
dvi_status dvi__doubled_cost(dvi__doubled *doubled, double t, const double *q, const double *v,
                             const double *u, double *C);

/* Choose the unit of the cost, so that its second derivative by the multipliers is of the size of
 * the kinetic part over the span, and eigenvalues can be compared with each other. Give the size of
 * the cost over the bounds' width, in that unit. */
dvi_status dvi__doubled_choose_unit(dvi__doubled *doubled, double t, double span, const double *q,
                                    double *size);

#endif
