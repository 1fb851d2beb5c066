/* Linear problems on a space, put together from its operators and points alone:
 *
 *     -div (a grad u) = f,    and    -div (a grad u) = omega^2 u,    u = 0 at the boundary. */
#ifndef SUPPORT_FIELD_GALERKIN_H
#define SUPPORT_FIELD_GALERKIN_H
#include <dvi/space.h>

#include "field/algebra/csr.h"

typedef int function_of_place(int64_t count, const double *x, double *values, void *user);

/* The matrices and the load of the functions inside, in their order. */
typedef struct galerkin {
  dvi__csr stiffness, mass;
  double *load;
  int *number; /* [functions] of a function inside, -1 at the boundary */
  int64_t functions, inside;
} galerkin;

/* A NULL is the function 1. */
galerkin galerkin_of(const dvi_space *space, function_of_place *a, function_of_place *f,
                     void *user);
void galerkin_clear(galerkin *problem);

/* Set U [functions] to the solution. */
void galerkin_solve(const galerkin *problem, double *U);

/* Set omega [inside] to all frequencies, ascending. */
void galerkin_frequencies(const galerkin *problem, double *omega);

#endif
