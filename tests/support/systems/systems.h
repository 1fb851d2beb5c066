/* Small systems with sparse patterns, whose callbacks count, fail and lie on demand. */
#ifndef TESTS_SUPPORT_SYSTEMS_H
#define TESTS_SUPPORT_SYSTEMS_H
#include <dvi/system.h>

enum { SITES = 6 };

typedef enum callback_shape { ONE_POINT, BATCH } callback_shape;

/* What a term's callbacks did and shall do; its `user`. Gradients and Hessians get `lie` added to
 * their entry `at`; for the rotors' two gradients and three Hessian blocks `block` chooses which.
 * Rates are right but for their lie. */
typedef struct behaviour {
  long values, gradients, hessians; /* calls */
  int answer;                       /* what the callbacks return */
  double value_lie, gradient_lie, hessian_lie, rate_lie;
  int at, block;
} behaviour;

/* V = sum over neighbours of d^2/2 + d^4/4, d = q_(i+1) - q_i; tridiagonal. */
dvi_potential springs(behaviour *user, callback_shape shape);

/* V = sum of (1 + i) q_i^4/4 + t q_i; diagonal. */
dvi_potential wells(behaviour *user, callback_shape shape);

/* L = sum of (2 + cos q_i) v_i^2/2 - (1 + t) q_i^2/2, and over neighbours v_i v_(i+1)/4 + sin(q_i)
 * v_(i+1): a mass that depends on q and a magnetic term. qq is diagonal, qv upper bidiagonal, vv
 * tridiagonal. */
dvi_lagrangian rotors(behaviour *user, callback_shape shape);

/* The tridiagonal pattern of SITES columns, and a regular symmetric matrix on it: 2 + i on the
 * diagonal, -1/2 beside it. */
extern const dvi_pattern tridiagonal;
extern const double tridiagonal_mass[3 * SITES - 2];

/* A point in general position. */
extern const double generic_q[SITES], generic_v[SITES];

/* A system that must be made; fails the test otherwise. */
dvi_system *make_system(const dvi_system_terms *terms);

/* q'' = 1 + q^2 runs to infinity. From rest at 0 the midpoint rule asks for x = h^2/2 (1 + x^2/4),
 * which has no real solution for h > sqrt(2). */
dvi_system *runaway(int fast);

#endif
