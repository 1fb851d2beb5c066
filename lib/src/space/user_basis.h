/* A user's function space (dvi/shapes.h) as shapes: polynomials of a degree, then the user's
 * functions, made orthonormal.
 *
 * The inner product is the quadrature's, sum_j b_j psi_k' psi_l', with |b_j| between functions;
 * psi_0 = tau. What the points do not tell apart cannot be solved for: a function of which less
 * than 1e-8 of itself is left is not present, as in space/oscillating.h. */
#ifndef DVI_SPACE_GIVEN_H
#define DVI_SPACE_GIVEN_H
#include <dvi/quadrature.h>
#include <dvi/shapes.h>

#include "space/shapes.h"

typedef struct dvi__user_basis dvi__user_basis;

/* A sum over the points, the functions' values and derivatives there and their values at the
 * end, and over their sizes: two spaces of one name are told apart by it. */
typedef struct dvi__user_basis_fingerprint {
  double sum, size;
  size_t count; /* of numbers */
} dvi__user_basis_fingerprint;

/* A copy of the user's struct, with its name and its coordinates, in one block of memory. NULL:
 * there is none left. */
dvi_shapes *dvi__shapes_copy(const dvi_shapes *shapes);

/* What can be said before there is a system: pointers, counts, the name. */
dvi_status dvi__shapes_check(const dvi_shapes *shapes);

/* The shapes must outlive the space; `rule` and `nodes` are used if they have no points. Checks all
 * that the user supplies, at shapes->h. */
dvi_status dvi__user_basis_create(const dvi_shapes *shapes, int degree, dvi_rule rule, int nodes,
                                  dvi__user_basis **given);
void dvi__user_basis_destroy(dvi__user_basis **given);

/* The same as shapes; they live as long as the space. */
dvi__shapes dvi__user_basis_shapes(dvi__user_basis *given);

/* Make the tables of steps of length h, for `set` to find. On failure those of the last length
 * stay. */
dvi_status dvi__user_basis_prepare(dvi__user_basis *given, double h);

/* Whether steps are symmetric; the quadrature's order, as far as the polynomials ask for it. Found
 * at creation. */
int dvi__user_basis_symmetric(const dvi__user_basis *given);
int dvi__user_basis_quadrature_order(const dvi__user_basis *given);

/* Of the length prepared. */
dvi__user_basis_fingerprint dvi__user_basis_fingerprint_of(const dvi__user_basis *given);

#endif
