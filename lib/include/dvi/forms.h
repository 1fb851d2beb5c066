/** Discrete exterior calculus: Hodge stars of a mesh, integrals and values of differential forms.
 *
 *  A k-form is a cochain, an array [k-cells] of its integrals over the oriented k-cells. The mesh's
 *  incidence d_k is its derivative, exactly (dvi/mesh.h). The star M_k has all of the metric and of
 *  the materials: a.M_k b is the scalar product of two k-forms. With the two,
 *
 *      delta_{k+1} = M_k^-1 d_k^T M_{k+1},     L_k = delta_{k+1} d_k + d_{k-1} delta_k,
 *
 *  are the codifferential and the Laplacian of Laplace and de Rham. On functions L_0 is minus the
 *  Laplacian (Hirani 2003, ch. 4-6, with the signs of docs/fields/forms.md). */
#ifndef DVI_FORMS_H
#define DVI_FORMS_H
#include <dvi/mesh.h>

/** A star. */
typedef struct dvi_star dvi_star;

/** Kinds of stars. */
typedef enum dvi_star_kind {
  /** diagonal, M_k = kappa |*s|/|s| with the volume of the circumcentric dual cell, cut off at the
   *  boundary. Duals have signs: where circumcentres lie outside of their cells, entries may be
   *  zero or negative. kappa is 1, and -1 for cells that are timelike */
  DVI_CIRCUMCENTRIC,
  /** diagonal and positive for functions and for n-forms: each vertex gets its share of the cells
   *  around it, which lumps the mass of linear finite elements. As whitney for other degrees */
  DVI_BARYCENTRIC,
  /** the mass matrices of Whitney's forms: linear finite elements for functions, edge and face
   *  elements (Nedelec 1980) for other forms. Symmetric, definite, not diagonal */
  DVI_WHITNEY,
  /** of equal boxes that repeat themselves along all axes: full matrices for which the waves of the
   *  grid have their own wave numbers, without an error. For up to some thousand boxes */
  DVI_SPECTRAL
} dvi_star_kind;

/** Options of a star. Zero means the default. */
typedef struct dvi_star_options {
  size_t size;        /**< sizeof(dvi_star_options) */
  dvi_star_kind kind; /**< default DVI_CIRCUMCENTRIC */
  /** [n+1] for each degree the factor [cells] of M_k in each n-cell, or NULL for 1. Copied. A
   *  piece of a dual cell in an n-cell counts with its factor */
  const double *const *factor;
} dvi_star_options;

/** A differential k-form at a point x [space]. Its components are in the order of their axes, those
 *  of a 2-form in space at dx^dy, dx^dz, dy^dz. So a magnetic field (Bx, By, Bz) has the components
 *  Bz, -By, Bx. Return 0, or another number for a failure. */
typedef int dvi_form_function(const double *x, double *value, void *user);

#ifdef __cplusplus
extern "C" {
#endif

/** Create the star of a mesh, which the star shares.
 *
 *  @param options  NULL for the defaults
 *  @retval DVI_BAD_ARGUMENT  a facet belongs to more than two cells, a cell has no volume in the
 *                            mesh's metric, a factor is not finite, or the mesh is not such a grid
 *                            for the spectral star
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_star_create(const dvi_mesh *mesh, const dvi_star_options *options, dvi_star **star);

/** Let one more owner share the star. Each owner calls dvi_star_destroy. Returns the star. */
dvi_star *dvi_star_share(const dvi_star *star);

/** Release the star, and set the pointer to NULL. NULL is allowed. */
void dvi_star_destroy(dvi_star **star);

/** Return the star's mesh, owned by the star. */
const dvi_mesh *dvi_star_mesh(const dvi_star *star);

/** Give the matrix M_k of the star, [k-cells] in rows and columns. Its arrays are the star's.
 *
 *  The matrix of a star that is not diagonal is made by the first call for its degree.
 *
 *  @retval DVI_BAD_ARGUMENT  k is not from 0 to n
 *  @retval DVI_BAD_SIZE      a matrix of the spectral star would be too large
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_star_matrix(const dvi_star *star, int k, dvi_matrix *matrix);

/** Return the volumes |*s| [k-cells] of the circumcentric dual cells, with their signs. Owned by
 *  the star. NULL for stars of another kind, or if k is out of range. */
const double *dvi_star_duals(const dvi_star *star, int k);

/** Return the number of components of a k-form in a space: the binomial coefficient. 0 if k is not
 *  from 0 to `space`, or `space` not from 1 to 8. */
int dvi_form_components(int space, int k);

/** Integrate a form over the k-cells (de Rham's map), by Gauss's rule with 5 points an axis.
 *
 *  The rule is exact for polynomials of degree 9 - k + 1 on simplices, and of degree 9 in each axis
 *  on boxes. In a space that repeats itself, a cell is placed at its first vertex.
 *
 *  @param[out] form  [k-cells]
 *  @retval DVI_BAD_ARGUMENT     an argument is missing, or k is out of range
 *  @retval DVI_CALLBACK_FAILED  the function returned a number that is not 0
 *  @retval DVI_NOT_FINITE       a value is not finite. dvi_last_error() names the place */
dvi_status dvi_form_integrate(const dvi_mesh *mesh, int k, dvi_form_function *function, void *user,
                              double *form);

/** Give the value of Whitney's interpolation of a form at a place in an n-cell.
 *
 *  Functions are interpolated linearly (on boxes, in each axis), and d of the interpolation is the
 *  interpolation of d (Whitney 1957, sec. IV.27).
 *
 *  @param      form   [k-cells]
 *  @param      place  [n+1] barycentric coordinates in the order of dvi_mesh_vertices, or [n]
 *                     coordinates from 0 to 1 along the axes of a box
 *  @param[out] value  [dvi_form_components(space, k)]
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or k or the cell is out of range, or the cell
 *                            has no volume in the mesh's metric */
dvi_status dvi_form_evaluate(const dvi_mesh *mesh, int k, const double *form, int64_t cell,
                             const double *place, double *value);

/** Give the values of Whitney's interpolation of a form at the centres of all n-cells.
 *
 *  @param      form   [k-cells]
 *  @param[out] value  [cells*dvi_form_components(space, k)], cell by cell
 *  @retval (others)   as dvi_form_evaluate */
dvi_status dvi_form_at_centres(const dvi_mesh *mesh, int k, const double *form, double *value);

/** Solve M_k x = b, by conjugate gradients if M_k is not diagonal.
 *
 *  @param[in,out] b  [k-cells] the right side, then x. Unchanged on failure
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or k is out of range
 *  @retval DVI_SINGULAR      an entry of a diagonal matrix is zero, or another one is not positive
 *                            definite
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_star_solve(const dvi_star *star, int k, double *b);

/** Give the codifferential delta_k = M_{k-1}^-1 d_{k-1}^T M_k of k-forms, k from 1 to n.
 *
 *  @param[out] codifferential  owned by the caller, for dvi_matrix_destroy
 *  @retval DVI_UNSUPPORTED  M_{k-1} is not diagonal, so that the matrix would be full.
 *                           dvi_star_solve does without it
 *  @retval DVI_SINGULAR     an entry of M_{k-1} is zero */
dvi_status dvi_form_codifferential_create(const dvi_star *star, int k, dvi_matrix **codifferential);

/** Give the symmetric matrix of Laplace and de Rham's operator on k-forms,
 *
 *      M_k L_k = d_k^T M_{k+1} d_k + M_k d_{k-1} M_{k-1}^-1 d_{k-1}^T M_k.
 *
 *  With M_k it is the pencil of the operator's eigenvalues. Nothing is prescribed at the boundary,
 *  where forms have natural conditions: no flux for functions.
 *
 *  @retval DVI_UNSUPPORTED  M_{k-1} is not diagonal
 *  @retval DVI_SINGULAR     an entry of M_{k-1} is zero */
dvi_status dvi_form_laplacian_create(const dvi_star *star, int k, dvi_matrix **laplacian);

/** Split a k-form into three parts that are orthogonal in M_k (Hodge's decomposition),
 *
 *      form = d a + delta b + h,     d h = 0, delta h = 0.
 *
 *  All forms vanish on the cells of the part `held` of the mesh, where the form's entries are taken
 *  as 0. Elsewhere on the boundary nothing is prescribed, and conditions are natural. With NULL
 *  nothing is held (absolute conditions), and with "boundary" all of it is (relative conditions).
 *  M_k is positive definite.
 *
 *  @param[out] exact, coexact, harmonic  [k-cells] the parts. Each may be NULL
 *  @retval DVI_BAD_ARGUMENT   an argument is missing, k is out of range, or there is no such part
 *  @retval DVI_NOT_FINITE     the form is not finite, or its square overflows
 *  @retval DVI_SINGULAR       a star is not positive definite. The barycentric and Whitney's stars
 *                             are
 *  @retval DVI_NOT_CONVERGED  an iteration left too much of its right side
 *  @retval DVI_NO_MEMORY      there is no memory */
dvi_status dvi_form_decompose(const dvi_star *star, int k, const char *held, const double *form,
                              double *exact, double *coexact, double *harmonic);

/** Return the number of independent harmonic k-forms: the Betti number b_k, and on an orientable
 *  mesh whose whole boundary is held b_{n-k}.
 *
 *  @param[out] count  the number
 *  @param[out] basis  [count][k-cells] forms that are orthonormal in M_k. NULL to count only
 *  @retval (others)   as dvi_form_decompose */
dvi_status dvi_form_harmonic(const dvi_star *star, int k, const char *held, int64_t *count,
                             double *basis);

/** Solve L_k u = f for a k-form u without a harmonic part, by conjugate gradients.
 *
 *  M_{k-1} and M_{k+1}, where there are such, are positive definite, too.
 *
 *  @param      f  [k-cells]. A harmonic part is an error, since no solution exists then
 *  @param[out] u  [k-cells]
 *  @retval DVI_BAD_ARGUMENT  f has a harmonic part above 1e-8 of f. dvi_last_error() has its size
 *  @retval (others)          as dvi_form_decompose */
dvi_status dvi_form_solve(const dvi_star *star, int k, const char *held, const double *f,
                          double *u);

/** Check the multisymplectic form formula: for two k-forms a and b, and a set K of n-cells, give
 *
 *      sum over the k-cells s on the boundary of K of  a_s (R b)_s - b_s (R a)_s,
 *      R = d_k^T M_{k+1} d_k with what the cells of K alone contribute to the star.
 *
 *  The sum is a rounding error if a and b solve R a = 0 and R b = 0 on all k-cells inside of K, as
 *  waves do in a mesh of spacetime, whose metric has a sign, and harmonic functions and static
 *  fields in one of space, where it is the law of reciprocity. On the way from one part of the
 *  boundary to the others the two-form of the field's phase space is thus conserved (Marsden,
 *  Patrick and Shkoller 1998; Stern 2009, sec. 3.5.1).
 *
 *  @param      k      degree, from 0 to n - 1
 *  @param      cells  number of cells of K
 *  @param      cell   [cells] numbers of n-cells, each once
 *  @param      a, b   [k-cells]
 *  @param[out] sum    the sum
 *  @param[out] size   the sum of the sizes of all products, beside which it is to be seen. May be
 *                     NULL
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, k or a cell is out of range, or a cell is
 *                            given twice
 *  @retval DVI_UNSUPPORTED   the star is spectral, and not a sum over cells
 *  @retval DVI_NOT_FINITE    a form is not finite, or a product overflows
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_form_multisymplectic(const dvi_star *star, int k, int64_t cells, const int *cell,
                                    const double *a, const double *b, double *sum, double *size);

#ifdef __cplusplus
}
#endif
#endif
