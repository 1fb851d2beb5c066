/* One step for a degenerate Lagrangian alpha(q).v - H(q) with half of the components of the
 * one-form constant.
 *
 * Let y be the coordinates of the constant components, x the others, and theta(x,y) = alpha_x. Up
 * to a total derivative L = theta(x,y).dx/dt - H(x,y). Hence (x, p = theta) are canonical (Darboux)
 * coordinates, y takes the place of p, and the step varies
 *     sum_i b_i [ theta(X_i,Y_i).W_i - h H(X_i,Y_i) ],   X_i = x0 + sum_j a_ij W_j,   W_i = h V_i.
 * With b_i abar_ij + b_j a_ji = b_i b_j the equations of the stages are
 *     theta(X_i,Y_i) = p0 + h sum_j abar_ij F_j,    F = (d theta/dx)^T V - H_x,
 *     G_i = (d theta/dy)^T W_i - h H_y = 0.
 * The end is one more stage, with the weights as its row in both tableaux. Its W is h times the
 * velocity there.
 *
 * Source: Ellison, Finn, Burby, Kraus, Qin and Tang 2018; Kraus 2017, arXiv:1708.07356. The end as
 * a stage, and the increments, are ours.
 *
 * Unknowns and rows are stored component by component. Number k of component i is x[i*m + k], with
 * m stages and the end as the last. The unknowns are W for x and the increments Y_k - y0 for y. */
#ifndef DVI_STEP_DEGENERATE_DARBOUX_H
#define DVI_STEP_DEGENERATE_DARBOUX_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__darboux dvi__darboux;

/* Rule A is at (x0, p1), B at (x1, p0). The trapezoidal rule is Lobatto IIIA for x and IIIB for
 * p. */
typedef enum dvi__darboux_rule {
  DVI__EULER_A,
  DVI__EULER_B,
  DVI__TRAPEZOIDAL_PAIR,
  DVI__GAUSS_STAGES
} dvi__darboux_rule;

/* `stages` [1,6] is for Gauss alone. DVI_UNSUPPORTED if too few components of the one-form are
 * constant (dvi__form_constant_components). */
dvi_status dvi__darboux_create(const dvi_system *system, dvi__darboux_rule rule, int stages,
                               dvi_counters *counters, dvi__darboux **darboux);
void dvi__darboux_destroy(dvi__darboux **darboux);

const dvi__pattern *dvi__darboux_pattern(const dvi__darboux *darboux);
dvi__evaluator *dvi__darboux_evaluator(const dvi__darboux *darboux);

/* Returns 1 if coordinate i belongs to x. */
int dvi__darboux_is_x(const dvi__darboux *darboux, int i);

/* Put the step at (t0, q0, p0). The caller keeps the arrays unchanged. */
void dvi__darboux_place(dvi__darboux *darboux, double t0, double h, const double *q0,
                        const double *p0);

/* DVI_UNSUPPORTED if a component that should be constant varies. */
dvi_status dvi__darboux_residual(dvi__darboux *darboux, const double *x, double *R);
dvi_status dvi__darboux_jacobian(dvi__darboux *darboux, const double *x, double *values);

/* Write the size of the rows per unit of an unknown. */
dvi_status dvi__darboux_scale(dvi__darboux *darboux, double *scale);

/* Write the increments dq [n] of a solution. */
void dvi__darboux_end(const dvi__darboux *darboux, const double *x, double *dq);

/* Write x for a straight line along v [n]. dvi__darboux_continue continues the x of the last step,
 * with ratio = h_next / h_last. */
void dvi__darboux_straight(const dvi__darboux *darboux, const double *v, double *x);
void dvi__darboux_continue(dvi__darboux *darboux, double ratio, const double *last, double *x);

#endif
