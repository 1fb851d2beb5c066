/** Meshes: cell complexes of dimension 1 to 4 with orientation, incidence, named parts, and files.
 *
 *  A mesh of dimension n has k-cells of every degree k from 0 (vertices) to n. A k-cell of a mesh
 *  of simplices is an ascending tuple of k + 1 vertices, oriented by that order. A k-cell of a mesh
 *  of boxes has 2^k corners. Bit a of a corner's number tells whether the corner is at the far end
 *  of the cell's axis a, and the axes in their order orient the cell. Cells of degree 1 to n - 1
 *  are numbered by their smallest vertex, then by the others. The incidence d_k has a row for each
 *  (k+1)-cell and a column for each k-cell, and d_{k+1} d_k = 0 (Hirani 2003, ch. 2-3).
 *
 *  A mesh never changes after its creation. Any number of threads may use it. */
#ifndef DVI_MESH_H
#define DVI_MESH_H
#include <dvi/matrix.h>
#include <stddef.h>

enum {
  DVI_MESH_DIMENSION_MAX = 4, /**< largest dimension of cells */
  DVI_MESH_SPACE_MAX = 8      /**< largest number of coordinates of a point */
};

/** A mesh. */
typedef struct dvi_mesh dvi_mesh;

/** Kinds of cells. */
typedef enum dvi_cell_kind {
  DVI_SIMPLICES, /**< points, edges, triangles, tetrahedra, 4-simplices */
  DVI_BOXES      /**< points, edges, rectangles, boxes, 4-boxes */
} dvi_cell_kind;

/** A part of a mesh that has a name: some cells of one degree, with all their faces. */
typedef struct dvi_mesh_part {
  const char *name; /**< copied. Not empty, and neither "all" nor "boundary" */
  int degree;       /**< of the cells, 0 to the mesh's dimension */
  int64_t count;    /**< number of cells */
  /** [count*(degree+1)], for boxes [count*2^degree]: the vertices of each cell in any order.
   *  Copied. NULL if `cell` is given. */
  const int *vertex;
  const int *cell; /**< [count] the cells' numbers. Only for degree 0 and the mesh's dimension */
} dvi_mesh_part;

/** What a mesh consists of. Zero means the default. All arrays are copied. */
typedef struct dvi_mesh_terms {
  size_t size;               /**< sizeof(dvi_mesh_terms) */
  dvi_cell_kind kind;        /**< default DVI_SIMPLICES */
  int dimension;             /**< of the cells, n from 1 to 4 */
  int space;                 /**< coordinates of a point, from n to 8. Default: n */
  int64_t points;            /**< number of points. Each belongs to a cell */
  const double *point;       /**< [points*space], point by point */
  int64_t cells;             /**< number of cells of degree n */
  const int *vertex;         /**< [cells*(n+1)], for boxes [cells*2^n] */
  const dvi_mesh_part *part; /**< [parts] */
  int parts;
  /** [space] +1 or -1 for each axis: the metric, for stars (dvi/forms.h). Default: all +1 */
  const double *metric;
  /** [space] lengths after which space repeats itself, and 0 for axes that do not. Each edge is
   *  shorter than half of them along their axis. Default: none repeats itself */
  const double *period;
} dvi_mesh_terms;

/** Sizes of a generated mesh. Zero means the generator's default (docs/fields/meshes.md). */
typedef struct dvi_generator_options {
  size_t size;       /**< sizeof(dvi_generator_options) */
  int dimension;     /**< of box, kuhn, kuhn-torus. Default: the number of `cells` that are not 0 */
  int cells[4];      /**< cells along each axis, or the rings, layers and so on of a shape */
  double extent[4];  /**< length of each axis, or the radii and so on of a shape */
  double origin[4];  /**< the lower corner of a grid, the place of a shape's own origin */
  double grading[4]; /**< node i of m along an axis is at (i/m)^grading of its length. Default 1 */
  int periodic[4];   /**< not 0 for the axes along which a box or a Kuhn mesh repeats itself */
} dvi_generator_options;

/** How to read a mesh from a file. Zero means the default. */
typedef struct dvi_mesh_read_options {
  size_t size;        /**< sizeof(dvi_mesh_read_options) */
  const char *format; /**< "msh", "off" or "ply". Default: what the file begins with */
  /** Coordinates of a point. Those that a file lacks are 0. Default: what a file of
   *  dvi_mesh_write tells, else as few as hold all points, but not fewer than the dimension */
  int space;
  const double *metric; /**< [space] as in dvi_mesh_terms. Default: the file's, or all +1 */
  const double *period; /**< [space] as in dvi_mesh_terms. Default: the file's, or none */
} dvi_mesh_read_options;

/** Values on a mesh, to be seen with it. */
typedef struct dvi_view {
  const char *name;     /**< not empty, and not that of another view on cells of this degree */
  const double *values; /**< [cells*components], cell by cell */
  int components;       /**< numbers for each cell, 1 or more */
  int degree;           /**< of the cells: 0 for vertices, or the mesh's dimension */
} dvi_view;

/** Processes that hold a mesh together, each of them a share of it, and how they speak with each
 *  other. All of them call each function in the same order. A function returns 0, or another number
 *  on all processes if it failed on one of them. */
typedef struct dvi_ranks {
  size_t size; /**< sizeof(dvi_ranks) */
  int rank;    /**< the number of this process, from 0 */
  int count;   /**< the number of processes, 1 or more */
  /** Set the values [cells] of this share's cells of a degree, of which other processes are the
   *  owners, to those that the owners have. */
  int (*refresh)(int degree, double *values, void *user);
  /** Set numbers [count] to their sums over all processes. They do not overflow. */
  int (*sum)(int count, int64_t *number, void *user);
  /** Set numbers [count] to the largest ones of all processes. */
  int (*largest)(int count, double *number, void *user);
  void *user;
  /** Send numbers [count] to another process, without waiting until it takes them. NULL with
   *  `receive` if nothing is used that needs them, as free steps of solids do. These two are called
   *  by single processes. */
  int (*send)(int to, int count, const double *number, void *user);
  /** Take the numbers that another process has sent by its first call of `send` that has not been
   *  taken, at most `most` of them, and wait for them. */
  int (*receive)(int from, int most, double *number, int *count, void *user);
  /** What solves equations on all processes together, as that of dvi_mesh_divide (<dvi/petsc.h>).
   *  What needs it is refused without it. May be NULL */
  const struct dvi_ranks_solver *solver;
} dvi_ranks;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a mesh from arrays.
 *
 *  The signs of dvi_mesh_orientation orient the cells of a mesh in R^n as R^n is, and others as the
 *  first cell of their component is given. Simplices may be given in any order.
 *
 *  @param[in]  terms  the mesh's points and cells
 *  @param[out] mesh   the mesh, for dvi_mesh_destroy. NULL after a failure
 *  @retval DVI_BAD_ARGUMENT  an array is missing, a number is not finite, an index is out of range,
 *                            a cell is degenerate, given twice or folded over its neighbour, a
 *                            point belongs to no cell, or a part has a cell that the mesh has not.
 *                            dvi_last_error() names the place
 *  @retval DVI_BAD_SIZE      a count is out of range, or an int cannot number the cells
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_mesh_create(const dvi_mesh_terms *terms, dvi_mesh **mesh);

/** Create one of the meshes that docs/fields/meshes.md lists, such as "box", "kuhn" or "disk".
 *
 *  @param name     the generator's name
 *  @param options  sizes. NULL for the generator's defaults
 *  @retval DVI_BAD_OPTION  there is no such generator, or it cannot take an option
 *  @retval (others)        as dvi_mesh_create */
dvi_status dvi_mesh_generate(const char *name, const dvi_generator_options *options,
                             dvi_mesh **mesh);

/** Return the name of generator i, counted from 0, or NULL beyond the last one. */
const char *dvi_mesh_generator_name(int i);

/** Triangulate points in two to four dimensions: the simplices whose circumscribed spheres have no
 *  point inside (Delaunay 1934).
 *
 *  The simplices fill the points' hull, and each point is a vertex. Points on one sphere are
 *  divided as a regular triangulation divides them, cubes of a grid along the axes as by Kuhn.
 *  Where points lie on one sphere up to rounding, as those of a rotated grid, spheres may be empty
 *  up to 1e-9 only, and those of flat simplices at the hull less. The hull then misses simplices
 *  that are flat up to 1e-12, or up to 2.4e-7 where this does not suffice.
 *
 *  @param point  [points*dimension], point by point. Copied
 *  @retval DVI_BAD_ARGUMENT  a coordinate is not finite, or all points lie in a plane, or two
 *                            points are equal up to 2e-18 of the longest edge of the points' box
 *  @retval DVI_BAD_SIZE      the dimension is not 2 to 4, or there are too few points
 *  @retval (others)          as dvi_mesh_create, which refuses flat simplices that could not be
 *                            avoided */
dvi_status dvi_mesh_delaunay(int dimension, int64_t points, const double *point, dvi_mesh **mesh);

/** Read a mesh from a file of the formats MSH 2.2 or 4.1 (Gmsh), OFF or PLY, as text or as
 *  little-endian binary numbers. OFF is read as text only.
 *
 *  Lines, triangles or tetrahedra make a mesh of simplices, quadrangles or hexahedra one of boxes.
 *  The cells are those of the highest dimension, in the order of their numbers in the file. Points
 *  without such a cell are left out, the others stand in the order of their numbers. Physical
 *  groups become parts with their names, or with the name "group N" (docs/fields/meshes.md,
 *  "Files").
 *
 *  @param path     the file's name
 *  @param options  NULL for the defaults
 *  @param[out] mesh  the mesh, for dvi_mesh_destroy. NULL after a failure
 *  @retval DVI_IO_ERROR    the file could not be read
 *  @retval DVI_BAD_FILE    the file is cut short, or is not what it claims to be. dvi_last_error()
 *                          names the line, or the byte of a binary file
 *  @retval DVI_BAD_OPTION  there is no such format, or `space` does not fit
 *  @retval (others)        as dvi_mesh_create */
dvi_status dvi_mesh_read(const char *path, const dvi_mesh_read_options *options, dvi_mesh **mesh);

/** Write a mesh to a file whose format the end of its name chooses.
 *
 *  `.msh` is MSH 4.1 as text, with the parts as physical groups; dvi_mesh_read reads the same mesh
 *  from it. `.off` and `.ply` have the points and faces of a surface, as text. `.vtu` is an
 *  unstructured grid of VTK, with views, for ParaView. All of them have at most three coordinates.
 *
 *  An old file is replaced as a whole, or stays if the new one cannot be written.
 *
 *  Of a share, a .vtu file has the whole mesh, byte for byte, and the views' values at the cells
 *  that each process owns. All processes call the function, and the first one writes. No process
 *  holds the whole mesh.
 *
 *  @param views  number of views. Only a .vtu file has them
 *  @param view   [views]
 *  @retval DVI_BAD_OPTION    the name's end is none of these
 *  @retval DVI_BAD_ARGUMENT  a view is not as described
 *  @retval DVI_UNSUPPORTED   the format cannot hold such a mesh, or views, or a share
 *  @retval DVI_IO_ERROR      the file could not be written
 *  @retval DVI_NO_MEMORY     there is no memory for the file
 *  @retval DVI_CALLBACK_FAILED  the processes of a share cannot speak with each other */
dvi_status dvi_mesh_write(const dvi_mesh *mesh, const char *path, int views, const dvi_view *view);

/** Write a mesh as dvi_mesh_write, with its vertices at other points [vertices*space], of a share
 *  those of all of its vertices. The cells have the orientation of the mesh.
 *
 *  @retval DVI_BAD_ARGUMENT  a coordinate is not finite
 *  @retval (others)          as dvi_mesh_write */
dvi_status dvi_mesh_write_moved(const dvi_mesh *mesh, const double *point, const char *path,
                                int views, const dvi_view *view);

/** Write a list of files at their times, a .pvd file, which ParaView opens as one series.
 *
 *  @param path   the name of the list
 *  @param count  number of files
 *  @param time   [count]
 *  @param file   [count] names, relative to the folder of the list
 *  @retval DVI_BAD_OPTION    the name of the list does not end with .pvd
 *  @retval DVI_BAD_ARGUMENT  a time is not finite, or a name is missing
 *  @retval (others)          as dvi_mesh_write */
dvi_status dvi_series_write(const char *path, int64_t count, const double *time,
                            const char *const *file);

/** Cut the share of one process out of a mesh.
 *
 *  A share has the n-cells that its process owns and all others with which these have a vertex in
 *  common. A k-cell belongs to the owner of the first n-cell around it. Cells keep their order, and
 *  parts are those of the whole mesh, "boundary" as well. Fields and leapfrog take a share as they
 *  take a mesh. All processes make the same calls then, and have the digits of one process. What
 *  cannot be done with shares is refused with DVI_UNSUPPORTED (docs/fields/shares.md). A failure of
 *  one process is one of all, with the same status.
 *
 *  @param owner  [n-cells] the process to which each of them belongs. Each process owns a cell
 *  @param ranks  the processes. Copied
 *  @retval DVI_BAD_ARGUMENT  an owner is out of range, a process has no cell, or an argument is not
 *                            as described. The arguments are those of all processes
 *  @retval DVI_NO_MEMORY     there is no memory
 *  @retval DVI_CALLBACK_FAILED  the processes cannot speak with each other */
dvi_status dvi_mesh_cut(const dvi_mesh *mesh, const int *owner, const dvi_ranks *ranks,
                        dvi_mesh **share);

/** Return the numbers [cells], ascending, that the k-cells of a share have in the whole mesh. Owned
 *  by the share. NULL if the mesh is none, or k is not from 0 to n. */
const int64_t *dvi_mesh_share_numbers(const dvi_mesh *share, int k);

/** Return the processes [cells] to which the k-cells of a share belong. Owned by the share. NULL if
 *  the mesh is none, or k is not from 0 to n. */
const int *dvi_mesh_share_owners(const dvi_mesh *share, int k);

/** Let one more owner share the mesh. Each owner calls dvi_mesh_destroy. Returns the mesh. */
dvi_mesh *dvi_mesh_share(const dvi_mesh *mesh);

/** Release the mesh, which disappears with its last owner, and set the pointer to NULL. NULL is
 *  allowed. */
void dvi_mesh_destroy(dvi_mesh **mesh);

/** Return the dimension n of the mesh's cells. 0 for NULL. */
int dvi_mesh_dimension(const dvi_mesh *mesh);

/** Return the number of coordinates of a point. 0 for NULL. */
int dvi_mesh_space(const dvi_mesh *mesh);

/** Return the kind of the cells. */
dvi_cell_kind dvi_mesh_kind(const dvi_mesh *mesh);

/** Return the number of k-cells. 0 if k is not from 0 to n. */
int64_t dvi_mesh_count(const dvi_mesh *mesh, int k);

/** Return the points [vertices*space], point by point. Owned by the mesh. */
const double *dvi_mesh_points(const dvi_mesh *mesh);

/** Return the vertices of the k-cells [count*width], and their number in a cell, `width`. Owned by
 *  the mesh. NULL if k is not from 1 to n. */
const int *dvi_mesh_vertices(const dvi_mesh *mesh, int k, int *width);

/** Give the centres [count*space] of the k-cells, the means of their vertices. In a space that
 *  repeats itself a cell is placed at its first vertex.
 *
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or k is out of range */
dvi_status dvi_mesh_centres(const dvi_mesh *mesh, int k, double *centre);

/** Find the n-cells that contain points, in a mesh that fills its space.
 *
 *  Of several cells that share a point, the one with the lowest number is taken. Where space
 *  repeats itself, points may lie in any period.
 *
 *  @param[in]  point   [points*n], point by point
 *  @param[out] cell    [points] the cell of each point, or -1 outside
 *  @param[out] weight  [points*(n+1)], for boxes [points*n]: the place in the cell, as
 *                      dvi_form_evaluate takes it (dvi/forms.h)
 *  @retval DVI_UNSUPPORTED   the space has more dimensions than the cells
 *  @retval DVI_BAD_ARGUMENT  a coordinate is not finite, or an argument is missing
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_mesh_locate(const dvi_mesh *mesh, int64_t points, const double *point, int *cell,
                           double *weight);

/** Give the incidence d_k, whose entries are signs, for k from 0 to n - 1. Its arrays are the
 *  mesh's.
 *
 *  @retval DVI_BAD_ARGUMENT  k is out of range */
dvi_status dvi_mesh_incidence(const dvi_mesh *mesh, int k, dvi_matrix *incidence);

/** Return the orientations [cells], +1 or -1, that make the n-cells coherent. Owned by the mesh.
 *  NULL if the mesh is not orientable. */
const int8_t *dvi_mesh_orientation(const dvi_mesh *mesh);

/** Return the numbers of the k-cells of a part, ascending, and their count. Owned by the mesh.
 *
 *  Every mesh has the parts "all" and "boundary". NULL, with a count of -1, if the mesh has no such
 *  part. A count of 0 if the part's cells have a lower degree than k. */
const int *dvi_mesh_part_cells(const dvi_mesh *mesh, const char *name, int k, int64_t *count);

/** Return the name of part i, counted from 0 ("all"), 1 ("boundary"), or NULL beyond the last
 *  one. Owned by the mesh. */
const char *dvi_mesh_part_name(const dvi_mesh *mesh, int i);

/** Return the degree of part i, or -1. */
int dvi_mesh_part_degree(const dvi_mesh *mesh, int i);

/** Return the Betti numbers b_0 .. b_n, which count components, tunnels, voids and so on.
 *
 *  b_k = N_k - rank d_k - rank d_{k-1} with ranks modulo a prime of 31 bits.
 *
 *  @param[out] betti  [n+1]
 *  @retval DVI_NO_MEMORY  there is no memory for the elimination */
dvi_status dvi_mesh_betti(const dvi_mesh *mesh, int64_t *betti);

#ifdef __cplusplus
}
#endif
#endif
