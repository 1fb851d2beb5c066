/** Curvature of meshes of simplices: deficit angles, connections and their holonomy, and fields of
 *  directions on surfaces.
 *
 *  An n-simplex is flat inside, n from 2 to 4. All curvature of a mesh is at its hinges, the cells
 *  of degree n-2: vertices of a surface, edges of tetrahedra, triangles of 4-simplices. There the
 *  dihedral angles of the cells sum to 2 pi less the deficit (Regge 1961).
 *
 *  A connection has an orthonormal frame in each n-simplex, and for each facet between two of them,
 *  s and t, a rotation R_ts that takes components of vectors in the frame of s to those in the
 *  frame of t. The holonomy of a loop of cells is the product of these rotations in the loop's
 *  order. Levi and Civita's connection unfolds the two cells at their facet. Its holonomy around a
 *  hinge fixes the hinge, and turns the plane normal to it by the deficit (Stern 2009, sec. 4.3).
 *
 *  The metric is that of the mesh's points in Euclidean space, or that of given edge lengths.
 *  A connection never changes after its creation. Any number of threads may use it. */
#ifndef DVI_CURVATURE_H
#define DVI_CURVATURE_H
#include <dvi/mesh.h>

/** A connection. */
typedef struct dvi_connection dvi_connection;

/** Both sides of Gauss and Bonnet's theorem on a surface. */
typedef struct dvi_gauss_bonnet {
  double deficits;    /**< sum of the deficits of the inner vertices */
  double turning;     /**< sum of pi less the angles at the vertices of the boundary */
  int64_t euler;      /**< Euler's characteristic chi, vertices - edges + triangles */
  double difference;  /**< deficits + turning - 2 pi chi, a rounding error */
  double least, most; /**< smallest and largest deficit of an inner vertex, 0 without any */
  int64_t at_least;   /**< vertex of the smallest deficit, or -1 */
  int64_t at_most;    /**< vertex of the largest deficit, or -1 */
} dvi_gauss_bonnet;

/** Options of a connection. Zero means the default. */
typedef struct dvi_connection_options {
  size_t size;          /**< sizeof(dvi_connection_options) */
  const double *length; /**< [edges] lengths of the edges. Copied. Default: those of the points */
  /** [facets*n*n] own rotations R_ts, row by row, from the first to the second of the facet's cells
   *  by their numbers. Those of facets of the boundary are not read. Copied. Default: Levi and
   *  Civita's */
  const double *rotation;
  /** not 0 to lift the rotations to Spin(n). The signs are chosen so that the holonomy around each
   *  hinge is lifted to the turn by its deficit modulo 4 pi, that of own rotations to the shorter
   *  of both turns, and to any where both are half turns */
  int spin;
} dvi_connection_options;

/** A vertex around which directions turn. */
typedef struct dvi_singularity {
  int64_t vertex;
  double index; /**< turns of the direction along a small loop around the vertex, of size 1e4 at
                     most */
} dvi_singularity;

/** Options of dvi_connection_adjust. Zero means the default. */
typedef struct dvi_adjust_options {
  size_t size; /**< sizeof(dvi_adjust_options) */
  /** [singularities] the indices. Those of other vertices are 0. A vertex of the boundary stands
   *  for its whole boundary component, and its index counts turns against the boundary's tangent.
   *  All indices sum to Euler's characteristic */
  const dvi_singularity *singularity;
  int singularities;
  int symmetry; /**< N for fields of N directions in each cell. Indices are multiples of 1/N.
                     Default 1 */
  /** [dvi_connection_loops] finite turns in radians along the loops, modulo 2 pi/N. Default: 0 */
  const double *turn;
  int is_least; /**< not 0 to leave the turns along loops as the least adjustment has them */
} dvi_adjust_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Give the deficits of all hinges, 2 pi less the dihedral angles at inner ones, and pi less the
 *  angles at those of the boundary.
 *
 *  Edges have twice the digits, and each angle comes from atan2, so that the angles of flat and of
 *  thin cells are right to a few roundings of their inputs.
 *
 *  @param      length   [edges], or NULL for the mesh's points
 *  @param[out] deficit  [(n-2)-cells] radians
 *  @retval DVI_UNSUPPORTED   the cells are no simplices of dimension 2 to 4, or an axis of the
 *                            mesh's metric is timelike and no lengths are given
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, a length is not positive, no simplex has such
 *                            lengths, or a facet has more than two cells. dvi_last_error() names
 *                            the cell */
dvi_status dvi_hinge_deficits(const dvi_mesh *mesh, const double *length, double *deficit);

/** Give both sides of Gauss and Bonnet's theorem, sum deficits + sum turning = 2 pi chi, of a mesh
 *  of triangles, which need not be orientable.
 *
 *  @param length  [edges], or NULL for the mesh's points
 *  @retval DVI_UNSUPPORTED  the cells are no triangles
 *  @retval (others)         as dvi_hinge_deficits */
dvi_status dvi_gauss_bonnet_of(const dvi_mesh *mesh, const double *length,
                               dvi_gauss_bonnet *report);

/** Create a connection on a mesh, which it shares.
 *
 *  The frames have the orientation of dvi_mesh_orientation, and the rotations are in SO(n). A mesh
 *  that is not orientable has frames oriented by the order of the vertices, and rotations in O(n).
 *
 *  @param      options     NULL for the defaults
 *  @param[out] connection  for dvi_connection_destroy. NULL after a failure
 *  @retval DVI_BAD_ARGUMENT  an own rotation is none up to 1e-8, or the cells around a hinge do not
 *                            hang together
 *  @retval DVI_UNSUPPORTED   there is no lift: the mesh is not orientable, or has no spin
 *                            structure, as the complex projective plane, or an own rotation turns
 *                            right into left, or no signs suit the shorter turns of own rotations
 *  @retval DVI_NO_MEMORY     there is no memory
 *  @retval (others)          as dvi_hinge_deficits */
dvi_status dvi_connection_create(const dvi_mesh *mesh, const dvi_connection_options *options,
                                 dvi_connection **connection);

/** Release the connection, and set the pointer to NULL. NULL is allowed. */
void dvi_connection_destroy(dvi_connection **connection);

/** Return the connection's mesh, owned by the connection. */
const dvi_mesh *dvi_connection_mesh(const dvi_connection *connection);

/** Return the frame [n*space] of an n-cell, vector by vector, owned by the connection. NULL if the
 *  metric is that of lengths, or the cell is out of range. */
const double *dvi_connection_frame(const dvi_connection *connection, int64_t cell);

/** Give vectors in space from their components in the cells' frames.
 *
 *  @param      component  [cells*n] of size 1e300 at most
 *  @param[out] vector     [cells*space]
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, a component is too large or no number, or the
 *                            metric is that of lengths */
dvi_status dvi_connection_vectors(const dvi_connection *connection, const double *component,
                                  double *vector);

/** Return the cells around a hinge in their order, and their number. Owned by the connection.
 *
 *  The cells of an inner hinge are a ring, whose last cell is a neighbour of the first one, and
 *  those of a hinge of the boundary a fan. With the hinge's vertices in their order, the ring turns
 *  in the sense of the mesh's orientation, on surfaces to the left. NULL with a count of 0 if the
 *  hinge is out of range. */
const int *dvi_connection_ring(const dvi_connection *connection, int64_t hinge, int64_t *count);

/** Multiply the rotations along a path of n-cells, each of which shares a facet with the next.
 *
 *  A loop ends with the cell with which it begins.
 *
 *  @param      cell      [count] numbers of n-cells, 1 or more
 *  @param[out] rotation  [n*n] from the frame of the first cell to that of the last. May be NULL
 *  @param[out] lifted    its lift: [2] cos and sin of half the angle for n = 2, [4] the unit
 *                        quaternion q of v -> q v q^-1 for n = 3, real part first, [8] the unit
 *                        quaternions p and q of v -> p v q^-1 for n = 4. May be NULL
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, a cell is out of range, or shares no facet
 *                            with the next one
 *  @retval DVI_BAD_STATE     a lift is asked for, and the connection was created without */
dvi_status dvi_connection_along(const dvi_connection *connection, int64_t count, const int *cell,
                                double *rotation, double *lifted);

/** Transport a vector along a path of n-cells in parallel.
 *
 *  @param      vector  [n] components in the frame of the first cell, of size 1e300 at most
 *  @param[out] moved   [count*n] components in the frame of each cell of the path
 *  @retval DVI_BAD_ARGUMENT  as dvi_connection_along, or a component is too large or no number */
dvi_status dvi_connection_transport(const dvi_connection *connection, int64_t count,
                                    const int *cell, const double *vector, double *moved);

/** Give the holonomy around an inner hinge, from the first cell of its ring back to it.
 *
 *  @param[out] rotation, lifted  as dvi_connection_along. Each may be NULL
 *  @retval DVI_BAD_ARGUMENT  the hinge is out of range, or on the boundary
 *  @retval DVI_BAD_STATE     as dvi_connection_along */
dvi_status dvi_connection_holonomy(const dvi_connection *connection, int64_t hinge,
                                   double *rotation, double *lifted);

/** Give the angle by which the holonomy around an inner hinge turns the plane normal to it, in the
 *  sense of the ring. Of Levi and Civita's connection it is the deficit.
 *
 *  @param[out] angle  modulo 2 pi in [-pi, pi], and of a lift modulo 4 pi in [-2 pi, 2 pi]
 *  @param[out] rest   size of the largest entry by which the holonomy, and its lift, differ from
 *                     such a turn. May be NULL
 *  @retval (others)   as dvi_connection_holonomy */
dvi_status dvi_connection_turn(const dvi_connection *connection, int64_t hinge, double *angle,
                               double *rest);

/** Change the frame of each cell s by a rotation g_s, R_ts -> g_t R_ts g_s^-1.
 *
 *  Holonomies become g H g^-1 with the rotation of their first cell, so that their angles stay.
 *  A lift is changed by lifts of g.
 *
 *  @param      gauge    [cells*n*n] rotations, row by row
 *  @param[out] changed  another connection, for dvi_connection_destroy
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or an entry is no rotation up to 1e-8
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_connection_gauge(const dvi_connection *connection, const double *gauge,
                                dvi_connection **changed);

/** Return the number of independent loops of an orientable connected surface that are not around
 *  its vertices and boundaries: twice its genus. 0 on other meshes. */
int64_t dvi_connection_loops(const dvi_connection *connection);

/** Return the cells of such a loop, closed by its first cell, and their number. Owned by the
 *  connection. NULL if there is no such loop. */
const int *dvi_connection_loop(const dvi_connection *connection, int64_t loop, int64_t *count);

/** Adjust a connection of a surface by the least angles phi, so that its holonomy around vertices
 *  is 2 pi times given indices, and along loops trivial (Crane, Desbrun and Schroeder 2010).
 *
 *  The least sum of phi^2/w over the facets, with the weights w = (cot a + cot b)/2 of the angles
 *  opposite to an edge, is attained by
 *
 *      phi = w (d u + h),     d^T w d u = 2 pi index - deficit,     d h = 0,  d^T w h = 0,
 *
 *  with one sparse factor. On each component of the boundary u is constant.
 *
 *  @param      options   NULL for the defaults, which only surfaces with chi = 0 have
 *  @param[out] adjusted  the adjusted connection, for dvi_connection_destroy. It has no lift
 *  @retval DVI_UNSUPPORTED   the mesh is no orientable connected surface of triangles
 *  @retval DVI_BAD_ARGUMENT  a vertex is out of range, or two have one boundary or are equal, an
 *                            index is no multiple of 1/N or too large, the indices do not sum to
 *                            Euler's characteristic, or a turn is not finite. dvi_last_error()
 *                            names the vertex, the sum, or the loop
 *  @retval DVI_SINGULAR      the matrix is not definite
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_connection_adjust(const dvi_connection *connection,
                                 const dvi_adjust_options *options, dvi_connection **adjusted);

/** Transport a direction from one triangle to all others of a connected surface.
 *
 *  @param      root       the triangle
 *  @param      angle      of its direction against the first vector of its frame, radians
 *  @param      symmetry   N for fields of N directions. 0 stands for 1
 *  @param[out] direction  [cells*2] unit vectors, components in the frames
 *  @param[out] mismatch   largest angle at a facet between the direction there and that which comes
 *                         through the facet, modulo 2 pi/N. A rounding error if the holonomy of all
 *                         loops is trivial. May be NULL
 *  @retval DVI_UNSUPPORTED   the mesh is no orientable connected surface of triangles
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or the cell is out of range
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_connection_directions(const dvi_connection *connection, int64_t root, double angle,
                                     int symmetry, double *direction, double *mismatch);

#ifdef __cplusplus
}
#endif
#endif
