/** Maxwell's equations on boxes without a mesh, by Yee's method.
 *
 *  A grid of boxes along one to three axes has voltages E on its edges, and fluxes B through its
 *  faces. With d_1 the incidence of the grid, M_1 the star of eps and M_2 that of 1/mu,
 *
 *      B^{n+1} = B^n - dt d_1 E^{n+1/2},   M_1 (E^{n+1/2} - E^{n-1/2}) = dt (d_1^T M_2 B^n - J^n),
 *
 *  which is the leapfrog of dvi/march.h on a mesh of boxes, without the memory of a mesh (Yee 1966;
 *  Bossavit and Kettunen 1999). Conductors and absorbing ends add the current S E, with the mean of
 *  E^{n-1/2} and E^{n+1/2}. It starts with
 *  E^{1/2} = E^0 + dt/2 M_1^-1 (d_1^T M_2 B^0 - J^0 - S E^{1/2}). Units have c = 1 where
 *  eps = mu = 1.
 *
 *  The components are all six in space, on two axes (Ex, Ey, Bz) or (Ez, Bx, By), and on one axis
 *  (Ey, Bz). Values of a march's forms are integrals over cells: E times the length of its edge (of
 *  1 where the edge points out of the grid), and B times the area of its face, both positive along
 *  their axes. Components follow each other, each with x fastest, then y, then z. A component has
 *  as many places along an axis as there are boxes where its cell reaches along the axis, and nodes
 *  where it does not. There is one node more than boxes, or as many where the axis repeats itself.
 *  dvi_yee_place counts so. On two axes with (Ez, Bx, By), and on one, the field is a scalar wave
 *  of degree 0, and B is the curl of A, not its gradient. */
#ifndef DVI_YEE_H
#define DVI_YEE_H
#include <dvi/march.h>

/** What is at an end of an axis. */
typedef enum dvi_yee_boundary {
  DVI_YEE_PEC,       /**< a perfect electric conductor: no tangential E */
  DVI_YEE_PMC,       /**< a perfect magnetic conductor: natural, no tangential H */
  DVI_YEE_PERIODIC,  /**< the axis repeats itself. At both of its ends */
  DVI_YEE_BLOCH,     /**< it repeats itself but for a phase. At both of its ends */
  DVI_YEE_ABSORBING, /**< absorbs waves that come along the axis (Mur 1981, first order), by the
                          same current as walls of a mesh. Energy only falls */
  DVI_YEE_CPML       /**< absorbs waves in layers before a conductor (Roden and Gedney 2000) */
} dvi_yee_boundary;

/** An end of an axis. The numbers are those of absorbing layers, where zero means the default.
 *
 *  At the depth rho, from 0 at the inner end of the layers to 1 at the outer one, they have the
 *  conductivity s = rho^3 s_max with s_max = -2 ln(reflection)/depth, kappa grows from 1 as
 *  rho^3, and alpha falls as 1 - rho. In layers, materials should not change along the axis: fields
 *  may grow then. */
typedef struct dvi_yee_end {
  dvi_yee_boundary kind;
  int layers;        /**< boxes that absorb. Default: 10 */
  double reflection; /**< amplitude that comes back in a continuum. Default: 1e-8 */
  double alpha;      /**< shift of the pole, for waves that vanish. Default: 0 */
  double kappa;      /**< stretch at the outer end, at least 1. Default: 1 */
} dvi_yee_end;

/** An axis of the grid. */
typedef struct dvi_yee_axis {
  int cells;           /**< number of boxes along the axis */
  double lower, upper; /**< the ends of the axis, if there are no nodes. Default: 0 and 1 */
  const double *node;  /**< [cells+1] ascending, for boxes of unequal lengths. Copied */
  dvi_yee_end end[2];  /**< lower and upper end */
  double phase;        /**< with DVI_YEE_BLOCH: E(x + length) = exp(i phase) E(x) */
} dvi_yee_axis;

/** A function of time. Return 0, or another number for a failure. */
typedef int dvi_yee_signal(double t, double *value, void *user);

/** A material quantity: a number in each box, or a function of the place x [axes], or neither for
 *  the default. A function is averaged over the pieces of boxes at each edge or face, so that
 *  surfaces of a material may lie between the nodes:
 *
 *      M_1(e) = int over *e of [ int over e of dl/eps ]^-1,
 *      M_2(f) = int over *f of dl [ int over f of mu dA ]^-1,
 *
 *  and sigma by the losses of the field that M_1 supposes, int over *e of int over e of
 *  sigma/eps^2 dl / [ int over e of dl/eps ]^2.
 *
 *  Functions are looked at in the eighths of each box along each axis. A film through a box, across
 *  an axis, is seen if it is thicker than an eighth of the box. A thinner one is seen only if one
 *  of the places is in it, and counts as if it were not there otherwise. */
typedef struct dvi_yee_medium {
  const double *cell;    /**< [cells], x fastest. Needed only until the march is made */
  dvi_form_function *at; /**< gives one number */
  void *user;
} dvi_yee_medium;

/** A current: a density of given shape times a signal. */
typedef struct dvi_yee_current {
  /** the density at x [axes], of as many components as E has. Integrated over the dual faces */
  dvi_form_function *density;
  void *density_user;
  dvi_yee_signal *signal;
  void *signal_user;
} dvi_yee_current;

/** A dipole at a point. It is a probe transposed: its current acts on an edge by Whitney's weight,
 *  which is 1/length along the edge, and linear across it. */
typedef struct dvi_yee_dipole {
  double at[3];
  double along[3]; /**< the direction with its strength */
  /** the current, or the moment. The impulse of a moment over a step is its difference */
  dvi_yee_signal *signal;
  int is_moment; /**< not 0 if the signal is the moment */
  void *user;
} dvi_yee_dipole;

/** A plane wave inside of a box, from nowhere: the field is the total one inside and the scattered
 *  one outside. The wave comes from a grid of one axis (Taflove and Hagness 2005, sec. 5.6). Along
 *  an axis nothing leaks out of the box but roundings. Other directions leak O(h^2). */
typedef struct dvi_yee_wave {
  double lower[3], upper[3]; /**< the box, moved to the nearest nodes */
  double direction[3];       /**< where the wave goes to, of any length */
  double polarization[3];    /**< direction of E, of any length, orthogonal to the first one */
  dvi_yee_signal *signal;    /**< E where the wave enters the box */
  void *user;
} dvi_yee_wave;

/** A place where a field is observed. */
typedef struct dvi_yee_probe {
  const char *name;    /**< the name of the observable. Copied */
  dvi_march_form form; /**< DVI_FORM_E or DVI_FORM_B */
  double at[3];
  double along[3]; /**< the direction. The observable is the field's component times its length */
} dvi_yee_probe;

/** A surface through which the flux of energy is observed, E x H: all faces of a box, outwards, or
 *  with lower = upper on one axis a rectangle, along the axis. Moved to the nearest nodes. */
typedef struct dvi_yee_flux {
  const char *name; /**< the name of the observable. Copied */
  double lower[3], upper[3];
} dvi_yee_flux;

/** Processes that hold a grid together. They divide y and z of three axes, and y of two, by
 *  `parts`: the process rank = p[1] + parts[1] p[2] has the boxes from floor(cells p/parts) of an
 *  axis on, and the nodes at their lower ends. The last one of an axis also has its last node. All
 *  of them have the same terms, but for `rank` and `user`, and make the same calls in the same
 *  order. A function returns 0, or another number on all processes if it failed on one of them. */
typedef struct dvi_yee_ranks {
  size_t size; /**< sizeof(dvi_yee_ranks) */
  int rank;    /**< the number of this process, from 0 */
  int count;   /**< the number of processes, 1 or more */
  /** Processes along each axis, of which `count` is the product, 1 along x. 0 along an axis: as
   *  many as pay. Default: slabs of the last axis while they have 12 boxes or more, and otherwise
   *  the division with the least surface */
  int parts[3];
  /** Send numbers [count] to the process `to`, and receive as many of the process `from`, of which
   *  one may be -1: none. */
  int (*pass)(int to, int from, int64_t count, const double *sent, double *received, void *user);
  /** Set numbers [count] to their sums over all processes. They do not overflow. */
  int (*sum)(int count, int64_t *number, void *user);
  /** Set numbers [count] to the largest ones of all processes. */
  int (*largest)(int count, double *number, void *user);
  void *user;
} dvi_yee_ranks;

/** What a march on boxes consists of. Zero means the default. Components of points and directions
 *  beyond the grid's axes do not count, but for those of E. */
typedef struct dvi_yee_terms {
  size_t size; /**< sizeof(dvi_yee_terms) */
  int axes;    /**< 1 to 3 */
  int degree;  /**< of E: 1 for (Ex, Ey, Ez) and (Ex, Ey), 0 for Ez on two axes, and Ey on one */
  dvi_yee_axis axis[3];
  dvi_yee_medium eps, mu; /**< above 0. Default: 1 */
  dvi_yee_medium sigma;   /**< conductivity, not below 0. Default: 0 */
  const dvi_yee_current *current;
  const dvi_yee_dipole *dipole;
  const dvi_yee_wave *wave;
  const dvi_yee_probe *probe;
  const dvi_yee_flux *flux;
  int currents, dipoles, waves, probes, fluxes;
  double step;     /**< the step, above 0. Default: `fraction` of the largest stable one */
  double fraction; /**< of the largest stable step, below 1. Default: 0.9 */
  /** With a fraction the step is shortened so that a whole number of steps makes this span.
   *  Default: it is not */
  double span;
  int threads; /**< default 1. The bits do not depend on it */
  /** Steps that are taken together while their fields are in a cache. Axes y and z that repeat
   *  themselves allow only 1, but for those without a phase that are divided. A divided grid allows
   *  as many as each process has planes of a divided axis, and planes go to neighbours once for all
   *  of them. The bits do not depend on it. Default: as many as pay */
  int together;
  const dvi_yee_ranks *ranks; /**< copied. Default: one process has the whole grid */
} dvi_yee_terms;

#ifdef __cplusplus
extern "C" {
#endif

/** Create a march on boxes.
 *
 *  Its forms are E and B. With DVI_YEE_BLOCH a form's values are the real parts, and then as many
 *  imaginary ones. Its observables are
 *
 *  - "energy", E.M_1 E/2 + B^n.M_2 B^{n+1}/2 at the half step t_n + dt/2 after the last step. It is
 *    constant but for roundings where there are neither sources nor losses,
 *  - "charge", the sum of -d_0^T M_1 E over the nodes at which charge is conserved, at t_n + dt/2,
 *  - "gauss", the largest change of the charge of a node that the currents do not explain, beside
 *    the largest of its terms,
 *  - "divergence", the largest flux of B out of a box, likewise,
 *  - the probes and then the fluxes, at the march's time.
 *
 *  Nodes and boxes in absorbing layers, on absorbing ends, and on the surface of a wave's box are
 *  left out of charges and divergences.
 *
 *  On a divided grid the values of forms are those of this process, numbered as on a grid of its
 *  own boxes and nodes, and observables are those of the whole grid. All have the bits of one
 *  process. A saved state is that of the whole grid, the same bytes for any division, and each
 *  process takes its part of it. The first process alone writes files, and all read them. After
 *  processes could not speak with each other, a march must be started again, or loaded.
 *
 *  @retval DVI_BAD_ARGUMENT     an argument is not as described: axes, ends, media, places, or a
 *                               step that is not stable. dvi_last_error() has the bound and its
 *                               place
 *  @retval DVI_BAD_SIZE         a count is out of range
 *  @retval DVI_CALLBACK_FAILED  a medium or a density failed
 *  @retval DVI_NOT_FINITE       a medium or a density is not finite
 *  @retval DVI_UNSUPPORTED      a combination that is not there, such as a wave with a phase, or a
 *                               divided grid of one axis
 *  @retval DVI_NO_MEMORY        there is no memory */
dvi_status dvi_yee_create(const dvi_yee_terms *terms, dvi_march **march);

/** Return the number of values of a form, of the real ones, that this process has. 0 if the terms
 *  are not as described. */
int64_t dvi_yee_size(const dvi_yee_terms *terms, dvi_march_form form);

/** Return the number of the cell of a form's component (0 to 2 for x to z) at the place
 *  index [axes] among the places of the whole grid, or -1 if there is none, or if another process
 *  has it. */
int64_t dvi_yee_place(const dvi_yee_terms *terms, dvi_march_form form, int component,
                      const int *index);

/** Integrate a field over the cells of a form, for a start: over edges for E, and faces for B, by
 *  Gauss's rule with 5 points an axis.
 *
 *  @param      function  gives the components that the grid has at x [axes], in order
 *  @param[out] values    [dvi_yee_size]
 *  @retval DVI_BAD_ARGUMENT     an argument is missing or not as described
 *  @retval DVI_CALLBACK_FAILED  the function returned a number that is not 0
 *  @retval DVI_NOT_FINITE       a value is not finite. dvi_last_error() names the place */
dvi_status dvi_yee_integrate(const dvi_yee_terms *terms, dvi_march_form form,
                             dvi_form_function *function, void *user, double *values);

#ifdef __cplusplus
}
#endif
#endif
