/** Audit of meshes: what a mesh is like, whether it suits discrete forms, and what helps. */
#ifndef DVI_AUDIT_H
#define DVI_AUDIT_H
#include <dvi/forms.h>

/** What may help a mesh. A report has the sum of those that apply. */
typedef enum dvi_mesh_advice {
  DVI_ADVICE_FLIP = 1, /**< inner edges of triangles have negative duals: dvi_mesh_flip */
  /** as many simplices have one circumcentre as if they were boxes: glue them (dvi_mesh_glue) */
  DVI_ADVICE_GLUE = 2,
  DVI_ADVICE_STAR = 4 /**< dual cells are negative, or vanish: take another star */
} dvi_mesh_advice;

/** What is known of the cells of one degree k. */
typedef struct dvi_degree_report {
  int64_t count;
  int64_t boundary;                /**< cells of the boundary */
  int64_t betti;                   /**< -1 if it was not computed */
  double smallest, largest, total; /**< Euclidean volumes of the cells */
  int64_t negative, zero;          /**< circumcentric dual cells of negative and of no volume */
  double smallest_star;            /**< smallest entry of the circumcentric star M_k */
  int64_t worst;                   /**< a cell that has it */
  /** bound of the frequencies of d_k^T M_{k+1} d_k against M_k. NaN for k = n, and where M_k is not
   *  positive, M_{k+1} has negative entries, or the metric is not that of space */
  double fastest;
  double step; /**< longest stable step of leapfrog, 2/fastest. NaN as fastest */
  /** steps in which a wave of speed 1 goes the length of the mesh, the diagonal of its points */
  double steps;
} dvi_degree_report;

/** What is known of a mesh. */
typedef struct dvi_mesh_report {
  int dimension, space;
  int is_manifold;   /**< facets have two cells at most, and cells around a vertex hang together */
  int64_t branching; /**< a facet of more than two cells, or -1 */
  int64_t pinches;   /**< vertices, and edges of simplices, whose cells do not hang together */
  int64_t pinched;   /**< such a vertex, or -1 */
  int is_orientable;
  /** smallest and mean quality of the n-cells: n times the radius of the inscribed sphere over that
   *  of the circumscribed one, which is 1 for a regular simplex; of boxes the shortest edge over
   *  the longest. Lengths are those of Euclidean space in any metric */
  double quality, mean_quality;
  int64_t worst_cell; /**< an n-cell of the smallest quality */
  double dual_ratio;  /**< smallest |*e|/|e| of the edges with a positive dual */
  double length;      /**< diagonal of the points' bounding box */
  unsigned advice;    /**< a sum of values of dvi_mesh_advice */
  dvi_degree_report degree[DVI_MESH_DIMENSION_MAX + 1];
} dvi_mesh_report;

/** Options of an audit. Zero means the default. */
typedef struct dvi_audit_options {
  size_t size;       /**< sizeof(dvi_audit_options) */
  int64_t holes_max; /**< n-cells up to which Betti numbers are computed. Default 200000 */
  int without_steps; /**< not 0 to leave out the frequencies */
} dvi_audit_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Audit a mesh. Negative and vanishing dual cells are counted as they are.
 *
 *  @param options  NULL for the defaults
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or a cell has no volume in the mesh's metric
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_mesh_audit(const dvi_mesh *mesh, const dvi_audit_options *options,
                          dvi_mesh_report *report);

/** Flip edges of a mesh of triangles until all inner ones have duals that are not negative
 *  (Lawson 1977). Edges of parts, and those between parts, stay, and so do edges whose other
 *  diagonal is an edge already, or is too long for a space that repeats itself.
 *
 *  @param[out] flipped  the new mesh, for dvi_mesh_destroy
 *  @param[out] flips    number of flips. May be NULL
 *  @retval DVI_UNSUPPORTED    the cells are no triangles, or an axis is timelike
 *  @retval DVI_NOT_CONVERGED  flips did not come to an end, as may happen on surfaces
 *  @retval (others)           as dvi_mesh_audit */
dvi_status dvi_mesh_flip(const dvi_mesh *mesh, dvi_mesh **flipped, int64_t *flips);

/** Glue simplices with one circumcentre to rectangular boxes along the axes, as Kuhn's simplices
 *  are. All cells must belong to such boxes.
 *
 *  @param[out] glued  the new mesh of boxes, for dvi_mesh_destroy
 *  @retval DVI_UNSUPPORTED  the cells are no simplices in R^n, they make no boxes, or a part does
 *                           not consist of boxes and their faces. dvi_last_error() names the place
 *  @retval (others)         as dvi_mesh_audit */
dvi_status dvi_mesh_glue(const dvi_mesh *mesh, dvi_mesh **glued);

#ifdef __cplusplus
}
#endif
#endif
