/* A user's function space (dvi/shapes.h) as shapes. It has polynomials up to a degree, then the
 * user's functions, made orthonormal.
 *
 * The inner product is the quadrature's, sum_j b_j psi_k' psi_l', with |b_j| between functions, and
 * psi_0 = tau. Functions that the points do not tell apart cannot be solved for. So a function of
 * which less than 1e-8 of itself is left is not present, as in space/oscillating.h. */
#ifndef DVI_SPACE_USER_BASIS_H
#define DVI_SPACE_USER_BASIS_H
#include <dvi/quadrature.h>
#include <dvi/shapes.h>

#include "space/shapes.h"

typedef struct dvi__user_basis dvi__user_basis;

/* Sums over the points, over the functions' values and derivatives there and their values at the
 * end, and over the sizes of all. Different spaces of one name differ in them. */
typedef struct dvi__user_basis_fingerprint {
  double sum, size;
  size_t count; /* count of the summed numbers */
} dvi__user_basis_fingerprint;

/* Copy the user's struct, with its name and its coordinates, into one block of memory. Return NULL
 * if there is no memory. */
dvi_shapes *dvi__shapes_copy(const dvi_shapes *shapes);

/* Check pointers, counts and the name, which need no system. */
dvi_status dvi__shapes_check(const dvi_shapes *shapes);

/* Create a space and check all that the user supplies, at shapes->h. The shapes must outlive the
 * space. `rule` and `nodes` are used if the shapes have no points. */
dvi_status dvi__user_basis_create(const dvi_shapes *shapes, int degree, dvi_rule rule, int nodes,
                                  dvi__user_basis **basis);
void dvi__user_basis_destroy(dvi__user_basis **basis);

/* Return the space as shapes, which live as long as the space. */
dvi__shapes dvi__user_basis_shapes(dvi__user_basis *basis);

/* Compute the tables of steps of length h for a later `set`. On failure the tables of the last
 * length stay. */
dvi_status dvi__user_basis_prepare(dvi__user_basis *basis, double h);

/* Return 1 if steps are symmetric, and the quadrature's order, as far as the polynomials need it.
 * Both are found at creation. */
int dvi__user_basis_symmetric(const dvi__user_basis *basis);
int dvi__user_basis_quadrature_order(const dvi__user_basis *basis);

/* Return the fingerprint of the prepared length. */
dvi__user_basis_fingerprint dvi__user_basis_fingerprint_of(const dvi__user_basis *basis);

#endif
