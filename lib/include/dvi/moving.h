/** Fields of one or two dimensions on a mesh whose nodes move.
 *
 *  A field u(t,x) of some components is linear in each cell, between values u_a at nodes x_a. Cells
 *  are parts of an interval, or triangles. The nodes may be coordinates beside the values, so that
 *  the mesh follows from the action, too, and translations in space are a symmetry of it. With a
 *  density l per length or area the Lagrangian is
 *
 *      L = sum over cells of int l(t, x, u, u_t, grad u) dx
 *          + mu/2 sum |x_a'|^2 - kappa sum V_e B(F_e) - eps^2/2 int u_xx^2 dx
 *
 *  where u_t = u' - grad u . x' with u' and x' along a node's path. mu is a mass of the nodes. F_e
 *  maps a cell of reference, of volume V_e, to what it is now. With J = det F the barrier
 *
 *      B = (J - 1)^2 / J,    and for triangles    B = (J - 1)^2 / J + |F|^2 / (2 J) - 1,
 *
 *  keeps volumes, and the shapes of triangles, near those of reference, and nodes apart. In one
 *  dimension V B = (h - H)^2/h with the length h and that of reference H (Leok 2004, sec. 5.6;
 *  docs/fields/moving.md). eps is for one dimension alone. */
#ifndef DVI_MOVING_H
#define DVI_MOVING_H
#include <dvi/density.h>

/** A field on a moving mesh. It never changes after its creation. */
typedef struct dvi_moving dvi_moving;

enum {
  DVI_MOVING_AXES_MAX = 2,       /**< dimensions */
  DVI_MOVING_COMPONENTS_MAX = 4, /**< components of a field */
  DVI_MOVING_POINTS_MAX = 16     /**< quadrature points a cell */
};

/** How the nodes move. */
typedef enum dvi_moving_motion {
  DVI_MOVING_FREE,       /**< by the action. Nodes of a boundary rest, unless they slide */
  DVI_MOVING_PRESCRIBED, /**< by a path, or not at all without one */
  /** by constraints, all arcs sqrt(h^2 + (stretch Du)^2) of one length. On an axis of 3 cells or
   *  more */
  DVI_MOVING_EQUAL
} dvi_moving_motion;

/** What is known of u at an end of the interval. */
typedef struct dvi_moving_end {
  dvi_condition_kind kind;
  const double *value; /**< [components] of fixed ends, copied. Default: 0 */
} dvi_moving_end;

/** A function of u alone that is added to the density, by its mean over a cell of an axis. It makes
 *  that part's integral exact. -V(u) = cos u - 1 has the mean cos(a) sinc(d/2) - 1 between values
 *  with middle a and difference d. */
typedef struct dvi_moving_mean {
  /** The mean over the straight line from `left` to `right` [components*count], its first
   *  derivatives [2*components*count] by the left and then the right values, and the lower triangle
   *  of the second ones, row by row. Each may be NULL. Returns as the callbacks of dvi/system.h do.
   *  Required */
  int (*mean)(int count, const double *left, const double *right, double *mean, double *first,
              double *second, void *user);
  void *user;
} dvi_moving_mean;

/** A field on a moving mesh. Zero means the default. Numbers of points are axis by axis, such as
 *  x [dimension*count]. */
typedef struct dvi_moving_terms {
  size_t size;   /**< sizeof(dvi_moving_terms) */
  dvi_axis axis; /**< its nodes, if it has any, are those of reference. Without a kind */
  int cells;     /**< of the axis, at least 2. 0 with the axis's nodes, which determine it */
  /** Triangles of reference in a plane, shared, instead of an axis. Their period, if any, is that
   *  of the field. With a mesh there are no mean, monitor, ends, viscosity, and dispersion */
  const dvi_mesh *mesh;
  int components; /**< 1 to DVI_MOVING_COMPONENTS_MAX. Default: 1 */
  /** The density, with variables u, u_t, u_x, and u_y of the components. Its kind and its
   *  derivative in time are not read. Required */
  const dvi_density_part *part;
  const dvi_moving_mean *mean; /**< a part of the density that is integrated exactly */
  int translations;            /**< not 0 if l does not depend on x */
  /** l_x [dimension*count], l_xz [dimension*variables*count] and the lower triangle of l_xx, row by
   *  row, at fixed z. Each may be NULL. Required for nodes that are unknowns, unless l does not
   *  depend on x */
  int (*space_derivative)(int count, double t, const double *x, const double *z, double *l_x,
                          double *l_xz, double *l_xx, void *user);
  /** Gauss points a cell, 1 to DVI_MOVING_POINTS_MAX. In triangles 1, 3 or 6, exact for degrees 1,
   *  2 and 4. Default: 3 */
  int points;
  dvi_moving_motion motion;
  /** The path x of nodes with reference positions X, and its rate x'. At t = 0 it need not be X.
   *  Periodic paths move the end as the start. Default: nodes rest */
  int (*path)(int count, double t, const double *X, double *x, double *rate, void *user);
  /** Nodes move straight from the path's positions at multiples of this time to the next ones. A
   *  method that takes u straight over a step, midpoint, then keeps fields u = b t + c x exactly,
   *  if the steps are these. Default: 0, nodes are on the path at all times */
  double path_step;
  double stretch; /**< of DVI_MOVING_EQUAL, at least 0 */
  double mu;      /**< mass of a node, at least 0. Needed where u is straight */
  double kappa;   /**< stiffness of the cells, at least 0 */
  /** A monitor m(x) > 0 [count], whose integral is the same in all cells of reference. It is
   *  sampled at 16384 points or more, until its integral settles. Default: equal cells */
  int (*monitor)(int64_t count, const double *x, double *m, void *user);
  dvi_moving_end left, right; /**< without periodic ends */
  /** [dimension*components] change of u over a period, axis by axis. Default: 0 */
  const double *jump;
  /** [conditions] values on parts of a mesh, at time 0 and the places of reference. Without robin,
   *  fluxes, and rates. Default: all free */
  const dvi_density_condition *condition;
  int conditions;
  /** not 0 if free nodes of a mesh's boundary move along edges that are parallel to an axis, and
   *  have no other. Fixed values move with them */
  int slide;
  /** nu >= 0 of a force nu u_txx, which is -dR/dv with R = nu/2 int u_tx^2 */
  double viscosity;
  double dispersion; /**< eps >= 0 of a density -eps^2 u_xx^2/2 */
  void *user;        /**< of the callbacks here */
} dvi_moving_terms;

/** What a static state took, and what it has. */
typedef struct dvi_moving_report {
  int iterations;  /**< of Newton's method */
  double residual; /**< largest component of the energy's gradient */
  double energy;   /**< -L of the state without rates, kappa's part included */
  double barrier;  /**< kappa's part of the energy */
} dvi_moving_report;

/** A field at points x [dimension*count], axis by axis, by which motion starts: u and u_t
 *  [components*count], the gradients u_x [components*dimension*count] component by component and
 *  axis by axis, and the velocity of the nodes [dimension*count], which is read only if nodes are
 *  unknowns. All are 0 before the call. Returns 0, or another number for a failure. */
typedef int dvi_moving_wave(int64_t count, const double *x, double *u, double *u_x, double *u_t,
                            double *velocity, void *user);

#ifdef __cplusplus
extern "C" {
#endif

/** Create a field on a moving mesh.
 *
 *  @retval DVI_BAD_SIZE         the number of cells, components or points is out of its range
 *  @retval DVI_BAD_ARGUMENT     the axis, a node, an end, a condition, a variable of the density, a
 *                               mass, a stiffness or another argument is not as described
 *  @retval DVI_UNSUPPORTED      the mesh has other cells than triangles in a plane
 *  @retval DVI_CALLBACK_FAILED  the monitor or a datum failed
 *  @retval DVI_NOT_FINITE       the monitor is not positive and finite, or a datum is not finite
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_moving_create(const dvi_moving_terms *terms, dvi_moving **moving);

/** Release the field, and set the pointer to NULL. NULL is allowed. Systems of it are released
 *  before. */
void dvi_moving_destroy(dvi_moving **moving);

/** Return the reference positions of the nodes, owned by the field, and the number of cells. On an
 *  axis these are one more than cells. On a mesh they are its vertices, the positions axis by axis.
 *  `cells` may be NULL. NULL and 0 for NULL. */
const double *dvi_moving_nodes(const dvi_moving *moving, int *cells);

/** Return the coordinate of each number of a node, or -1 for what is no unknown:
 *  [nodes*(dimension+components)], node by node, first the position and then the values. Owned by
 *  the field. `nodes`, which may be NULL, is their number without the periodic last one of an axis.
 *  NULL and 0 for NULL. */
const int *dvi_moving_unknowns(const dvi_moving *moving, int *nodes);

/** Create the mechanical system of the field, a general Lagrangian. Its coordinates are, node by
 *  node, the coordinates of its position that are unknowns, and the components that the boundary
 *  leaves free. Periodic ends have the last node in common with the first one.
 *
 *  Symmetries are "momentum_x" and "momentum_y", translations of all nodes with their values, and
 *  "momentum_u" or "momentum_u1" and so on, if the density allows them and all nodes have the
 *  unknown. A mesh on which a cell has no volume makes the step fail wherever the method evaluates
 *  L, and at its end, and dvi_last_error() names the cell then.
 *
 *  @param[out] system  owned by the caller, for dvi_system_destroy before the field's end
 *  @retval DVI_SINGULAR  a component has no rate in the density
 *  @retval (others)      as dvi_system_create */
dvi_status dvi_moving_system(dvi_moving *moving, dvi_system **system);

/** Give the terms from which dvi_moving_system makes a system, to add others to them. Their arrays
 *  are the field's.
 *
 *  @retval DVI_SINGULAR  a component has no rate in the density */
dvi_status dvi_moving_system_terms(dvi_moving *moving, dvi_system_terms *terms);

/** Give coordinates q, velocities v, and momenta p at time 0 of a wave on the mesh of reference.
 *  Each of q, v and p may be NULL. With DVI_MOVING_EQUAL nodes go from there to arcs of one length,
 *  and the velocity of the first node alone is read, if it is an unknown.
 *
 *  @retval DVI_CALLBACK_FAILED  the wave failed
 *  @retval DVI_NOT_FINITE       the wave is not finite. dvi_last_error() names the node
 *  @retval DVI_SINGULAR         v or p is wanted, and without mu u is straight at a node, or nodes
 *                               of a mesh are free
 *  @retval DVI_NOT_CONVERGED    no arcs of one length were found
 *  @retval DVI_NO_MEMORY        there is no memory
 *  @retval (others)             as the callbacks fail */
dvi_status dvi_moving_start(const dvi_moving *moving, dvi_moving_wave *wave, void *user, double *q,
                            double *v, double *p);

/** Give coordinates q, velocities v, and momenta p at time t of positions x [dimension*nodes] axis
 *  by axis, values u [components*nodes] component by component, and their rates along the paths of
 *  the nodes, x_rate and u_rate, which are 0 if NULL. Nodes are those of dvi_moving_nodes. Numbers
 *  that are no unknowns are not read. Each of q, v and p may be NULL.
 *
 *  @retval DVI_BAD_ARGUMENT  a cell has no volume. dvi_last_error() names it
 *  @retval (others)          as dvi_moving_start */
dvi_status dvi_moving_project(const dvi_moving *moving, double t, const double *x, const double *u,
                              const double *x_rate, const double *u_rate, double *q, double *v,
                              double *p);

/** Give positions x [dimension*nodes] and values u [components*nodes] of coordinates q at time t.
 *  Either may be NULL.
 *
 *  @retval (others)  as the path fails */
dvi_status dvi_moving_lift(const dvi_moving *moving, double t, const double *q, double *x,
                           double *u);

/** Evaluate u [components*count], or its derivatives along an axis, at points x [dimension*count]
 *  of coordinates q and time t. Periodic fields repeat themselves with their jump.
 *
 *  @param slope  1 for u_x, 2 for u_y, 0 for u
 *  @retval DVI_BAD_ARGUMENT  a point lies outside, a cell has no volume, or an edge of a periodic
 *                            mesh has grown to half a period
 *  @retval DVI_NO_MEMORY     there is no memory
 *  @retval (others)          as the path fails */
dvi_status dvi_moving_evaluate(const dvi_moving *moving, double t, const double *q, int slope,
                               int64_t count, const double *x, double *u);

/** Evaluate a function of the field at a point x [dimension], or integrate it over all cells, by 8
 *  Gauss points a cell or 6 points a triangle, if x is NULL. A rate is that at a place, u' - grad u
 *  . x' with the velocities of the nodes.
 *
 *  @param v         velocities, NULL if the function has no rates
 *  @param function  its variables and its density, which is read without derivatives. Nothing else
 *                   is read
 *  @retval DVI_BAD_ARGUMENT     a variable is not as described in dvi_moving_terms, the point lies
 *                               outside, or a cell has no volume
 *  @retval DVI_CALLBACK_FAILED  the function failed
 *  @retval DVI_NO_MEMORY        there is no memory
 *  @retval (others)             as dvi_moving_evaluate */
dvi_status dvi_moving_measure(const dvi_moving *moving, double t, const double *q, const double *v,
                              const dvi_density_part *function, const double *x, double *value);

/** Create the mesh whose points are the nodes of coordinates q at time t, such as to write them
 *  with values. Its cells are those of reference, and its vertices the nodes of dvi_moving_nodes.
 *
 *  @param[out] mesh  owned by the caller, for dvi_mesh_destroy. NULL after a failure
 *  @retval DVI_BAD_ARGUMENT  a cell has no volume
 *  @retval (others)          as dvi_mesh_create */
dvi_status dvi_moving_mesh(const dvi_moving *moving, double t, const double *q, dvi_mesh **mesh);

/** Find a static state of least energy near q, at time 0, with nodes and values free as in motion,
 *  by damped Newton steps. kappa is lowered to its value by factors of ten, from the mean of the
 *  energy's density.
 *
 *  @param[in,out] q       unchanged on failure
 *  @param[out]    report  may be NULL
 *  @retval DVI_UNSUPPORTED    the nodes have constraints
 *  @retval DVI_NOT_CONVERGED  the iteration stopped above its tolerance
 *  @retval DVI_NO_MEMORY      there is no memory
 *  @retval (others)           as the callbacks fail */
dvi_status dvi_moving_solve(const dvi_moving *moving, double *q, dvi_moving_report *report);

#ifdef __cplusplus
}
#endif
#endif
