/** Elastic solids on meshes of triangles in a plane and of tetrahedra in space.
 *
 *  The displacement u is linear in each cell K, and a node at X stands at x = X + u. With the
 *  deformation gradient F = I + grad u the Lagrangian is
 *
 *      L = sum_a m_a |u_a'|^2/2 - sum_K V_K W(F_K) + sum_K int_K f.u + sum_s int_s T.u
 *
 *  where W is the energy that a material stores in a unit of volume of reference, m_a the lumped
 *  mass, an (n+1)-th part of that of each cell of the node, f a force per volume, and T one per
 *  area of a facet s of the boundary, both of reference. In a plane the strain is plane (F_33 = 1).
 *
 *  A solid is a mechanical system, to which all methods of the library apply, and it has marches in
 *  which each cell has its own step (Lew, Marsden, Ortiz and West 2003; docs/fields/elastic.md). */
#ifndef DVI_ELASTIC_H
#define DVI_ELASTIC_H
#include <dvi/march.h>

/** A solid. It never changes after its creation. */
typedef struct dvi_elastic dvi_elastic;

enum { DVI_ELASTIC_DIMENSION_MAX = 3 /**< dimensions of a solid */ };

/** Laws of materials. lambda and mu are Lame's constants of small strains. */
typedef enum dvi_elastic_law {
  /** W = lambda (tr e)^2/2 + mu e:e with e = (F + F^T)/2 - I */
  DVI_ELASTIC_LINEAR,
  /** St. Venant and Kirchhoff: the same with E = (F^T F - I)/2 in place of e */
  DVI_ELASTIC_SVK,
  /** W = mu/2 (tr F^T F - n) - mu ln J + lambda/2 (ln J)^2 with J = det F */
  DVI_ELASTIC_NEO_HOOKEAN,
  /** With C = F^T F, I_1 = tr C and I_2 = (I_1^2 - tr C^2)/2 in space,
   *  W = (mu - mooney)/2 (I_1 - 3) + mooney/2 (I_2 - 3) - (mu + mooney) ln J
   *      + (lambda - 2 mooney)/2 (ln J)^2 */
  DVI_ELASTIC_MOONEY_RIVLIN,
  DVI_ELASTIC_ENERGY /**< W is given */
} dvi_elastic_law;

/** The material of a part. */
typedef struct dvi_elastic_material {
  const char *part; /**< a part of n-cells. Copied. "all" is one. The last one of a cell counts */
  dvi_elastic_law law;
  double lambda, mu; /**< mu > 0, lambda > -2 mu/n */
  double mooney;     /**< 0 to mu, and 0 with other laws */
  double rho;        /**< density of reference, above 0 */
  /** Rayleigh's damping, forces -alpha m u' - beta K u' with the stiffness K at rest. At least 0.
   *  Default: none */
  double alpha, beta;
  /** W, its gradient P_ij = dW/dF_ij [n*n*count] and the lower triangle, row by row, of its Hessian
   *  [n*n*(n*n+1)/2*count] at F [n*n*count], entry by entry. Each may be NULL. Returns 0, a
   *  positive number where W is not defined, such as for J <= 0, or a negative one for a failure.
   *  Required for a W that is given, with P = 0 at F = I */
  int (*energy)(int64_t count, const double *F, double *W, double *P, double *Hessian, void *user);
  void *user;
} dvi_elastic_material;

/** A displacement that is given on a part. */
typedef struct dvi_elastic_condition {
  const char *part; /**< a part of the mesh. Copied */
  /** not 0 for the components of u that are given. Default: all of them */
  int component[DVI_ELASTIC_DIMENSION_MAX];
  /** u and its rate u' [n] at a node X. Return 0, or another number for a failure. Default: 0 */
  int (*displacement)(double t, const double *X, double *u, double *rate, void *user);
  int is_steady; /**< not 0 if the displacement does not depend on time */
  void *user;
} dvi_elastic_condition;

/** A force on a part, per volume of reference of n-cells or per area of facets of the boundary. */
typedef struct dvi_elastic_load {
  const char *part; /**< a part of n-cells or of facets of the boundary. Copied */
  /** The force [n] at X, the centre of a cell or facet. `normal` [n] is the outer unit normal of a
   *  facet in the reference, and NULL for cells. Return 0, or another number for a failure */
  int (*force)(double t, const double *X, const double *normal, double *force, void *user);
  int is_steady; /**< not 0 if the force does not depend on time */
  void *user;
} dvi_elastic_load;

/** Kinds of rigid obstacles. */
typedef enum dvi_obstacle_kind {
  DVI_OBSTACLE_PLANE, /**< nodes stay where (x - point).normal >= 0 */
  DVI_OBSTACLE_BALL,  /**< nodes stay outside of a ball */
  DVI_OBSTACLE_HOLLOW /**< nodes stay inside of a ball */
} dvi_obstacle_kind;

/** A rigid obstacle, which a node hits at the time when it reaches it. A hit changes the node's
 *  velocity v along the outer normal from -v_n to e v_n, and friction takes at most mu (1 + e) v_n
 *  from its velocity along the surface (Fetecau, Marsden, Ortiz and West 2003). A node that a
 *  condition moves into an obstacle ends the run with DVI_CALLBACK_FAILED. */
typedef struct dvi_obstacle {
  const char *name; /**< copied. Used in messages */
  dvi_obstacle_kind kind;
  double point[DVI_ELASTIC_DIMENSION_MAX];  /**< a point of the plane, or the centre */
  double normal[DVI_ELASTIC_DIMENSION_MAX]; /**< of a plane, of any length */
  double radius;                            /**< of a ball */
  double restitution;                       /**< e, 0 to 1 */
  double friction;                          /**< mu, 0 or more */
} dvi_obstacle;

/** What a solid consists of. Zero means the default. */
typedef struct dvi_elastic_terms {
  size_t size;          /**< sizeof(dvi_elastic_terms) */
  const dvi_mesh *mesh; /**< simplices in a space of their own dimension, 2 or 3. Shared */
  const dvi_elastic_material *material; /**< [materials] Each n-cell has one */
  int materials;
  const dvi_elastic_condition
      *condition; /**< [conditions] Of two on a component the first counts */
  int conditions;
  const dvi_elastic_load *load; /**< [loads] */
  int loads;
  const dvi_obstacle *obstacle; /**< [obstacles] for the nodes of the boundary */
  int obstacles;
  /** not 0 to give the mechanical system the energy in two parts, that of the stiffness at rest,
   *  which is quadratic and fast, and the other. Methods such as imex need it */
  int split;
} dvi_elastic_terms;

/** Energies of a solid. Their sum is the energy. */
typedef struct dvi_elastic_energies {
  double kinetic;
  double stored; /**< V_K W */
  double load;   /**< minus the work of the loads, f.u and T.u */
} dvi_elastic_energies;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a solid.
 *
 *  @retval DVI_BAD_ARGUMENT     a cell has no material, a constant is out of its range, a part is
 *                               missing, all is held, all of a load on facets acts on what is held,
 *                               or an argument is not as described.
 *                               dvi_last_error() names the material, the part or the cell
 *  @retval DVI_UNSUPPORTED      the mesh has no triangles in a plane or tetrahedra in space, or
 *                               repeats itself
 *  @retval DVI_CALLBACK_FAILED  a stored energy, a displacement or a load failed
 *  @retval DVI_NOT_FINITE       one of them is not finite
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_elastic_create(const dvi_elastic_terms *terms, dvi_elastic **elastic);

/** Release the solid, and set the pointer to NULL. NULL is allowed. Its systems and marches are
 *  released before. */
void dvi_elastic_destroy(dvi_elastic **elastic);

/** Return the mesh, owned by the solid. */
const dvi_mesh *dvi_elastic_mesh(const dvi_elastic *elastic);

/** Return the coordinate of each component of each vertex [vertices*n], vertex by vertex, or -1
 *  where it is given, and the number of coordinates. Owned by the solid. */
const int *dvi_elastic_unknowns(const dvi_elastic *elastic, int64_t *unknowns);

/** Return the lumped masses [vertices]. Owned by the solid. */
const double *dvi_elastic_masses(const dvi_elastic *elastic);

/** Give displacements and rates [vertices*n], with the given ones at time t, of coordinates and
 *  momenta [unknowns].
 *
 *  @param q, p     may be NULL for 0
 *  @param u, rate  may each be NULL
 *  @retval DVI_BAD_ARGUMENT     the solid is missing
 *  @retval DVI_CALLBACK_FAILED  a displacement failed
 *  @retval DVI_NOT_FINITE       a displacement is not finite */
dvi_status dvi_elastic_lift(const dvi_elastic *elastic, double t, const double *q, const double *p,
                            double *u, double *rate);

/** Give coordinates, velocities and momenta [unknowns] of displacements and rates [vertices*n],
 *  which may be NULL for 0. Each of the results may be NULL. */
void dvi_elastic_project(const dvi_elastic *elastic, const double *u, const double *rate, double *q,
                         double *v, double *p);

/** Give the energies of displacements u and rates [vertices*n] at time t, in a part of n-cells.
 *
 *  @param rate  may be NULL for 0
 *  @param part  the part. NULL for all of the solid
 *  @retval DVI_BAD_ARGUMENT     the mesh has no such part of n-cells
 *  @retval DVI_SINGULAR         a cell is inverted, where its law is not defined.
 *                               dvi_last_error() names it
 *  @retval DVI_CALLBACK_FAILED  a stored energy or a load failed
 *  @retval DVI_NOT_FINITE       displacements, rates or energies are not finite */
dvi_status dvi_elastic_energy(const dvi_elastic *elastic, double t, const double *u,
                              const double *rate, const char *part, dvi_elastic_energies *energies);

/** Give Cauchy's stress P F^T/J of n-cells. That of the linear law is P.
 *
 *  @param      count   number of cells, if `cell` is given
 *  @param      cell    [count] n-cells. NULL for all
 *  @param[out] stress  [count*n*n] or [cells*n*n], row by row
 *  @retval DVI_BAD_ARGUMENT  there is no such cell, or an argument is missing
 *  @retval (others)          as dvi_elastic_energy */
dvi_status dvi_elastic_stress(const dvi_elastic *elastic, int64_t count, const int *cell,
                              const double *u, double *stress);

/** Give von Mises' stress sqrt(3/2 s:s) of n-cells, with the deviator s of Cauchy's stress. In a
 *  plane the stress across it, by which the strain is plane, is one of them.
 *
 *  @param[out] stress  [count] or [cells]
 *  @retval DVI_UNSUPPORTED  in a plane a stored energy that is given does not tell that stress
 *  @retval (others)         as dvi_elastic_stress */
dvi_status dvi_elastic_von_mises(const dvi_elastic *elastic, int64_t count, const int *cell,
                                 const double *u, double *stress);

/** Bound the largest angular frequency at rest from above, within 0.1 percent. verlet is stable
 *  with steps below 2/omega near rest.
 *
 *  @retval (others)  as dvi_matrix_modes */
dvi_status dvi_elastic_fastest(const dvi_elastic *elastic, double *omega);

/** Compute modes of small vibrations about rest, as dvi_field_modes does.
 *
 *  @param[out] mode  [count][vertices*n]. May be NULL */
dvi_status dvi_elastic_modes(const dvi_elastic *elastic, const dvi_modes_options *options,
                             double *eigenvalue, double *mode, int64_t *zeros);

/** Create the mechanical system, whose coordinates are the components of u that are not given.
 *
 *  It has the diagonal mass, the potential "stored", or those of a split energy, "stiffness" and
 *  "rest", a potential "load", Rayleigh's damping as a force, and the obstacles as contacts of the
 *  nodes of the boundary. Its symmetries are the translations "momentum_x" and so on, and turns
 *  "angular_x" and so on (in a plane "angular"), that conditions, loads and obstacles allow. A cell
 *  that is inverted, where its law is not defined, asks for a smaller step.
 *
 *  @param[out] system  owned by the caller, for dvi_system_destroy before the solid's end
 *  @retval (others)    as dvi_system_create */
dvi_status dvi_elastic_system(dvi_elastic *elastic, dvi_system **system);

/** Give the terms from which dvi_elastic_system makes a system, to add others to them. Their arrays
 *  are the solid's. On the share of a mesh there are only the dimension, which is the number of
 *  unknowns of the share, and the symmetries of the whole solid, without generators.
 *
 *  @retval (others)  as dvi_elastic_fastest */
dvi_status dvi_elastic_system_terms(dvi_elastic *elastic, dvi_system_terms *terms);

/** Agree with the other processes that share the solid (dvi_mesh_cut) whether all have succeeded so
 *  far. If not, all fail with the same status. Called on all of them.
 *
 *  @retval DVI_CALLBACK_FAILED  the processes cannot speak with each other */
dvi_status dvi_elastic_agree(const dvi_elastic *elastic, dvi_status status);

/** Find the cell that contains a point of the reference. Of several that share it, the one with the
 *  lowest number in the whole mesh is taken. Called on all processes that share the solid.
 *
 *  @param[in]  at      [n]
 *  @param[out] cell    its number, or -1 where another process is its owner
 *  @param[out] weight  [n+1] barycentric coordinates of the point, if the cell is here
 *  @retval DVI_BAD_ARGUMENT  the point is outside, or not finite, or an argument is missing
 *  @retval (others)          as dvi_elastic_agree and dvi_mesh_locate */
dvi_status dvi_elastic_locate(const dvi_elastic *elastic, const double *at, int *cell,
                              double *weight);

/** Set numbers to their sums over all processes that share the solid, exact until they are rounded
 *  once. Called on all of them.
 *
 *  @param[in,out] number  [count]
 *  @retval DVI_BAD_ARGUMENT  an argument is missing
 *  @retval (others)          as dvi_elastic_agree */
dvi_status dvi_elastic_sum(const dvi_elastic *elastic, int count, double *number);

/** Create a march of a solid.
 *
 *  The method "avi" gives each cell a step of its own, "verlet" one to all of them; both know
 *  obstacles. DVI_FORM_A is u [vertices*n], vertex by vertex, and DVI_FORM_E is -u'. There is no B.
 *  Observables are "energy", "kinetic", "stored", "load", "momentum_x" .., "angular_x" .. (in a
 *  plane "angular") about the origin, "growth", and with obstacles "hits".
 *
 *  dvi_march_start returns DVI_BAD_ARGUMENT for a node inside of an obstacle, and
 *  dvi_march_advance DVI_SINGULAR at a cell that is inverted, where its law is not defined.
 *  The march stands at the last good time then.
 *
 *  @param options  as for fields (dvi/march.h). NULL for the defaults, and for avi
 *  @retval (others)  as dvi_march_create */
dvi_status dvi_elastic_march_create(const dvi_elastic *elastic, const dvi_march_options *options,
                                    dvi_march **march);

/** Find how fast small vibrations about rest grow under the steps of a march, as
 *  dvi_field_stability does. Obstacles and loads are left out. Free motions of the whole solid are
 *  not counted. */
dvi_status dvi_elastic_stability(const dvi_elastic *elastic, const dvi_march_options *options,
                                 double span, dvi_stability *report);

/** Measure the laws of a solid without conditions, loads, obstacles and damping on a march that
 *  begins at random: "momentum", "angular" and "energy". "angular" is left out if a law has no
 *  turns. Others have the energy alone, if conditions hold at 0, loads are steady, and there are
 *  neither dampings nor obstacles, or nothing.
 *
 *  @param[out] law    [DVI_LAWS_MAX]
 *  @param[out] count  number of laws
 *  @retval (others)   as dvi_elastic_march_create and dvi_march_advance */
dvi_status dvi_elastic_laws(const dvi_elastic *elastic, const dvi_march_options *options, int steps,
                            dvi_law *law, int *count);

#ifdef __cplusplus
}
#endif
#endif
