/* Small systems of equations for the solvers, whose callbacks count and fail on demand. */
#ifndef SUPPORT_EQUATIONS_H
#define SUPPORT_EQUATIONS_H
#include "solve/nonlinear.h"

enum { SIZE = 5 };

/* What a callback does from its `at`-th call on (0: never): it answers, and leaves a NaN if
 * `nan`. */
typedef struct fault {
  long at;
  dvi_status answer;
  int nan;
} fault;

/* R_i = (2 + i) (x_i - s_i) + strength (sin of both neighbours, at x less at s): the solution is s.
 * The chord inverts the diagonal, so the fixed point iteration contracts by about `strength`. */
typedef struct chain {
  dvi__pattern pattern;
  double strength, solution[SIZE];
  long residuals, jacobians, chords; /* calls */
  fault residual_fault, jacobian_fault;
} chain;

/* One unknown, R(x) = f(x). */
typedef struct single {
  double (*f)(double x), (*slope)(double x);
  double chord;
  double least; /* below this x the residual answers DVI_CALLBACK_RETRY */
  long residuals;
} single;

/* A solver with what belongs to it. */
typedef struct bench {
  dvi__solver *solver;
  dvi_counters counters;
  dvi__solve_report report;
} bench;

void make_chain(double strength, chain *c);
void for_chain(chain *c, bench *b);
void for_single(single *s, bench *b);

/* The same for a row in which numbers of size 1 are summed. */
void for_sum(single *s, bench *b);

/* One rung, neither wary nor patient. */
dvi_status run_rung(bench *b, dvi__rung rung, double *x);

/* Frees the solver and the chain's pattern; c may be NULL. */
void free_bench(bench *b, chain *c);

/* The status is as expected, and the error sentence says more than it does. */
void failed_with(dvi_status status, dvi_status expected);

/* Some functions: atan, whose zero Newton's method overshoots from |x| > 1.39; x^2 - 1; x^2 + 1,
 * which has no zero. */
double arctangent(double x);
double arctangent_slope(double x);
double parabola(double x);
double parabola_slope(double x);
double never_zero(double x);
double flat_slope(double x); /* 0 */

/* A millionth of x^2 - 1, rounded as a sum of numbers of size 1 is, at random. */
double faint(double x);
double faint_slope(double x);

/* Every rung, cheap to robust. */
extern const dvi__rung rungs[3];

#endif
