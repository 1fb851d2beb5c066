/** Function spaces for fields on intervals, boxes, tori and meshes, with a quadrature each.
 *
 *  A field is u(x) = sum_i U_i phi_i(x). A box is the product of axes, with a space of one
 *  dimension on each. Integrals over the domain are sums over quadrature points. The kinds are
 *
 *    fem:degree=k,cells=N              continuous, polynomials of degree k (1 to 8) on N cells,
 *                                      with k+1 Gauss points each
 *    fem:degree=k,cells=N,lumped=yes   the same functions by their values at Gauss-Lobatto nodes,
 *                                      which are the quadrature points: the mass is diagonal
 *    spline:degree=p,cells=N           B-splines with p-1 continuous derivatives (p from 1 to 8)
 *    fourier:modes=K                   1, cos x, sin x, .., cos K x, sin K x with x from 0 to 2 pi
 *                                      along the axis, orthonormal. Periodic alone
 *    legendre:degree=N                 one polynomial by its values at Gauss-Lobatto nodes, which
 *                                      are the quadrature points (N up to 256)
 *    chebyshev:degree=N                one polynomial by its values at Chebyshev's nodes, with N+1
 *                                      Gauss points: the mass is exact
 *    msfem:cells=N,fine=F              functions that solve (a phi')' = 0 in each cell, found on F
 *                                      equal parts of it (1 to 512, default 16) with 8 Gauss points
 *                                      each (docs/fields/multiscale.md)
 *    msfem:..,edges=E                  on two axes, div (a grad phi) = 0 by F x F bilinear elements
 *                                      in each cell, with the coefficient of their centres and
 *                                      2 x 2 Gauss points. On edges of cells functions solve the
 *                                      equation of the edge (E = solved, the default), are linear,
 *                                      or come from a larger cell (oversampled), which has
 *                                      overlap=P more elements on each side (default F/2). With
 *                                      threads=T, T threads share the cells, and bits do not depend
 *                                      on T. Both axes are msfem
 *
 *  Every kind has the option points=R: quadrature points a cell (fourier: of the whole axis, msfem:
 *  of a part, along each axis), for those whose nodes are not their points. On a mesh of triangles
 *  or tetrahedra the kind is fem with degree=1 or 2, without cells.
 *
 *  Functions are numbered with the first axis running slowest, and the points, too. Periodic ends
 *  are one. Sources: Leok 2004, secs. 5.1, 5.7 and 5.8; Karniadakis and Sherwin 2005, chs. 2-4. */
#ifndef DVI_SPACE_H
#define DVI_SPACE_H
#include <dvi/mesh.h>

/** A function space. It never changes after its creation, and threads may share it. */
typedef struct dvi_space dvi_space;

enum { DVI_AXES_MAX = 3 /**< axes of a box */ };

/** An axis of a box. */
typedef struct dvi_axis {
  const char *name; /**< copied. Default: x, y, z */
  double from, to;  /**< finite, from < to */
  int periodic;     /**< not 0 if its ends are one point */
  const char *kind; /**< of this axis. Default: that of the space */
  /** [nodes] ends of the cells, ascending, the first and last those of the axis, for fem, spline
   *  and msfem. Default: equal cells */
  const double *node;
  int nodes;
} dvi_axis;

/** Options of a space. Zero means the default. */
typedef struct dvi_space_options {
  size_t size;          /**< sizeof(dvi_space_options) */
  const char *kind;     /**< as above */
  const dvi_axis *axis; /**< [axes] of a box */
  int axes;             /**< 1 to DVI_AXES_MAX. 0 with a mesh */
  const dvi_mesh *mesh; /**< of triangles or tetrahedra, shared, instead of axes */
  /** the coefficient a(x) > 0 [count] of msfem, x axis by axis [axes*count]. Returns 0, or another
   *  number for a failure */
  int (*coefficient)(int64_t count, const double *x, double *a, void *user);
  void *user;
} dvi_space_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a space.
 *
 *  @retval DVI_BAD_OPTION       there is no such kind, it has no such option, or a value is out of
 *                               its range
 *  @retval DVI_BAD_ARGUMENT     an axis, a node or another argument is not as described
 *  @retval DVI_UNSUPPORTED      the kinds of the axes do not go together, or the mesh has other
 *                               cells
 *  @retval DVI_BAD_SIZE         there are too many functions or points
 *  @retval DVI_CALLBACK_FAILED  the coefficient failed
 *  @retval DVI_NOT_FINITE       the coefficient is not positive and finite
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_space_create(const dvi_space_options *options, dvi_space **space);

/** Share a space: the result is released by itself. NULL for NULL. */
dvi_space *dvi_space_share(const dvi_space *space);

/** Release a space, and set the pointer to NULL. NULL is allowed. */
void dvi_space_destroy(dvi_space **space);

/** Return the dimension of the domain, 1 to 3. 0 for NULL. */
int dvi_space_dimension(const dvi_space *space);

/** Return the name of axis d, owned by the space. NULL if there is none. */
const char *dvi_space_axis(const dvi_space *space, int d);

/** Return the number of functions. 0 for NULL. */
int64_t dvi_space_functions(const dvi_space *space);

/** Return the highest derivative along axis d that is square integrable, at most 16. 0 for NULL. */
int dvi_space_smoothness(const dvi_space *space, int d);

/** Return the number of quadrature points. 0 for NULL. The points, axis by axis [dimension*points],
 *  and the weights [points] are the space's. Each pointer may be NULL. Where the nodes are the
 *  points, a node between two cells is two points, because derivatives differ on its sides. */
int64_t dvi_space_points(const dvi_space *space, const double **x, const double **weight);

/** Return the functions that do not vanish on a part of the boundary, ascending, and their number.
 *  Parts of a box are "left" and "right" (x), "bottom" and "top" (y), "back" and "front" (z), as
 *  far as these axes are not periodic, and "boundary", all of them. Those of a mesh are its parts.
 *
 *  @return owned by the space. NULL if there is no such part, or for fourier, which has none */
const int *dvi_space_boundary(const dvi_space *space, const char *part, int64_t *count);

/** Evaluate a derivative of u at the quadrature points.
 *
 *  @param      order   [dimension] derivatives along each axis
 *  @param      U       [functions] coefficients
 *  @param[out] values  [points]
 *  @retval DVI_BAD_ARGUMENT  an argument is missing
 *  @retval DVI_UNSUPPORTED   the space has no such derivatives
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_space_apply(const dvi_space *space, const int *order, const double *U,
                           double *values);

/** Evaluate a derivative of u anywhere in the domain. Periodic axes repeat themselves.
 *
 *  @param      x  [dimension*count] axis by axis
 *  @retval DVI_BAD_ARGUMENT  a point lies outside, or an argument is missing
 *  @retval (others)          as dvi_space_apply */
dvi_status dvi_space_evaluate(const dvi_space *space, const int *order, const double *U,
                              int64_t count, const double *x, double *values);

/** Make a mesh on which functions of the space can be shown, by their values at its vertices
 *  (dvi_space_evaluate).
 *
 *  Of a box it has lines, rectangles or boxes. The cells of an axis are divided into k equal parts
 *  for polynomials of degree k, and into F for msfem, and the axis of fourier into 2 K + 1. An axis
 *  has at most 4096 parts. The vertices stand with the first axis running slowest, and the ends of
 *  a periodic axis are two. The mesh of a space on a mesh is shared.
 *
 *  @param[out] mesh  owned by the caller, for dvi_mesh_destroy. NULL on failure
 *  @retval DVI_BAD_ARGUMENT  an argument is missing
 *  @retval DVI_BAD_SIZE      the mesh would have too many vertices
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_space_mesh(const dvi_space *space, dvi_mesh **mesh);

/** Give coefficients [functions] of a function f: those that interpolate at the nodes of fem,
 *  legendre, chebyshev and msfem, and otherwise those nearest to f at the quadrature points in the
 *  norm of the quadrature. In a box each axis has its own sort.
 *
 *  @param f  gets points x [dimension*count] axis by axis, and gives f [count]. It returns 0, or
 *            another number for a failure
 *  @retval DVI_CALLBACK_FAILED  f failed
 *  @retval DVI_NOT_FINITE       f is not finite. dvi_last_error() names the point
 *  @retval DVI_SINGULAR         there are too few points for the nearest coefficients
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_space_interpolate(const dvi_space *space,
                                 int (*f)(int64_t count, const double *x, double *f, void *user),
                                 void *user, double *U);

/** Write what was built, one fact a line: "fem, degree 2, 100 cells: 201 functions, 3 Gauss points
 *  a cell, exact for polynomials of degree 5". Cut off at size. */
void dvi_space_explain(const dvi_space *space, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
