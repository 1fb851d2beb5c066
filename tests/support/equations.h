/* Small systems of equations for the solvers, whose callbacks count and fail on demand. */
#ifndef SUPPORT_EQUATIONS_H
#define SUPPORT_EQUATIONS_H
#include "solve/nonlinear.h"

enum { CHAIN_SIZE = 5 };

/* A fault of a callback. */
typedef struct callback_fault {
  long at;           /* first call with the fault (default 0, none) */
  dvi_status answer; /* returned by these calls */
  int nan;           /* these calls leave a NaN in the result */
} callback_fault;

/* R_i = (2 + i) (x_i - s_i) + strength (sin x_(i-1) + sin x_(i+1) - sin s_(i-1) - sin s_(i+1)),
 * with the solution s. The chord inverts the diagonal, so the fixed-point iteration contracts by
 * about `strength`. */
typedef struct equation_chain {
  dvi__pattern pattern;
  double strength, solution[CHAIN_SIZE];
  long residuals, jacobians, chords; /* calls */
  callback_fault residual_fault, jacobian_fault;
} equation_chain;

/* One unknown, R(x) = f(x). */
typedef struct single_equation {
  double (*f)(double x), (*slope)(double x);
  double chord;
  double least; /* the residual returns DVI_CALLBACK_RETRY below this x */
  long residuals;
} single_equation;

/* A solver with its counters and its last report. */
typedef struct solver_bench {
  dvi__solver *solver;
  dvi_counters counters;
  dvi__solve_report report;
} solver_bench;

/* Makes the equations of a chain. */
void make_chain(double strength, equation_chain *chain);

/* Create a solver for these equations. The one for a sum knows that numbers of size 1 are summed in
 * the row. */
void create_chain_solver(equation_chain *chain, solver_bench *bench);
void create_single_solver(single_equation *equation, solver_bench *bench);
void create_sum_solver(single_equation *equation, solver_bench *bench);

/* Solves by one rung of the ladder, without the flags `wary` and `patient`. */
dvi_status solve_by_rung(solver_bench *bench, dvi__rung rung, double *x);

/* Frees the solver and the chain's pattern. The chain may be NULL. */
void destroy_solver_bench(solver_bench *bench, equation_chain *chain);

/* Requires the expected status, and an error sentence longer than its name. */
void check_failure(dvi_status status, dvi_status expected);

/* Functions with their slopes: atan, whose zero Newton's method overshoots from |x| > 1.39, x^2 -
 * 1, and x^2 + 1, which has no zero. */
double arctangent(double x);
double arctangent_slope(double x);
double parabola(double x);
double parabola_slope(double x);
double never_zero(double x);
double flat_slope(double x); /* 0 */

/* (x^2 - 1)/10^6 with a random error as large as the rounding of a sum of numbers of size 1. */
double faint(double x);
double faint_slope(double x);

/* All rungs of the ladder, from cheap to robust. */
extern const dvi__rung rungs[3];

#endif
