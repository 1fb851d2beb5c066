/* Small systems with sparse patterns. Their callbacks count calls, fail and give wrong numbers on
 * demand. */
#ifndef TESTS_SUPPORT_SYSTEMS_H
#define TESTS_SUPPORT_SYSTEMS_H
#include <dvi/system.h>

enum { SITES = 6 };

typedef enum callback_shape { ONE_POINT, BATCH } callback_shape;

/* The `user` of a term's callbacks: the calls so far, and the errors that they shall make. A lie is
 * added to a result, in a gradient or Hessian to entry `at`. For the rotors `block` selects one of
 * two gradients, or of three Hessian blocks. */
typedef struct behaviour {
  long values, gradients, hessians; /* calls */
  int answer;                       /* what the callbacks return */
  double value_lie, gradient_lie, hessian_lie, rate_lie;
  int at, block;
} behaviour;

/* V = sum over neighbours of d^2/2 + d^4/4, d = q_(i+1) - q_i, with a tridiagonal Hessian. */
dvi_potential springs(behaviour *user, callback_shape shape);

/* V = sum of (1 + i) q_i^4/4 + t q_i, with a diagonal Hessian. */
dvi_potential wells(behaviour *user, callback_shape shape);

/* L = sum of (2 + cos q_i) v_i^2/2 - (1 + t) q_i^2/2, and over neighbours v_i v_(i+1)/4 +
 * sin(q_i) v_(i+1). The mass depends on q, and the last term is magnetic. qq is diagonal, qv upper
 * bidiagonal, vv tridiagonal. */
dvi_lagrangian rotors(behaviour *user, callback_shape shape);

/* The tridiagonal pattern of SITES columns, and a regular symmetric matrix on it with 2 + i on the
 * diagonal and -1/2 beside it. */
extern const dvi_pattern tridiagonal;
extern const double tridiagonal_mass[3 * SITES - 2];

/* A point in general position. */
extern const double generic_q[SITES], generic_v[SITES];

/* Creates a system, or fails the test. */
dvi_system *make_system(const dvi_system_terms *terms);

/* Creates the system q'' = 1 + q^2, which runs to infinity. From rest at 0 the midpoint rule solves
 * x = h^2/2 (1 + x^2/4), which has no real solution for h > sqrt(2). */
dvi_system *runaway(int fast);

#endif
