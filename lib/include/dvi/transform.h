/** Steps that adapt to the motion and keep the conservation laws of fixed steps. The step h is
 *  fixed in a fictitious time tau,
 *
 *      dt/dtau = g(q),      g a positive function, the monitor, small where steps must be short.
 *
 *  DVI_TIME_TRANSFORM makes the action of a new system stationary,
 *
 *      integral of  Lg(q,q') = g(q) [ L(q, q'/g(q)) + E0 ]  dtau,      E0 the energy of the start.
 *
 *  Its momenta are those of L, p = Lg_q' = L_v. Its energy is g (E - E0), which is 0 along the run,
 *  and there its motion is that of L in the time t. A fixed step in tau is therefore a symplectic
 *  map, with the long-time behaviour of such maps (Hairer 1997, Reich 1999). The new system is a
 *  general Lagrangian with the mass M/g, so explicit methods cannot take it. Physical time is a
 *  quadrature of the same step, by the method's own nodes, t1 = t0 + h sum_j b_j g(Q_j), and has
 *  the method's own order.
 *
 *  DVI_STEP_CONTROL takes steps of the system itself, of length h/z, where z follows 1/g reversibly
 *  (Hairer and Soederlind 2005):
 *
 *      z_0 = 1/g(q_0),
 *      z_half = z_n - h/2 g_q.v/g (at n),    step of h/z_half,
 *      z_n+1 = z_half - h/2 g_q.v/g (at n+1).
 *
 *  Step control is cheaper, and explicit methods stay explicit. A symmetric method stays symmetric,
 *  which keeps the energy of reversible systems from drifting, but the map is not symplectic.
 *
 *  Both are a `pacing` of dvi_integrator_options, with its `monitor`. Creation fails, by the status
 *  in parentheses, unless these requirements hold:
 *
 *  - DVI_TIME_TRANSFORM requires an autonomous system, and a method that takes a general Lagrangian
 *    (galerkin, midpoint, trapezoidal, or a composition of one of them) (DVI_UNSUPPORTED). The
 *    start chooses E0. Lg_qq is full, whatever the system's patterns are. The Hessian of an
 *    arclength or acceleration monitor is differenced.
 *  - DVI_STEP_CONTROL requires a symmetric method, and for an arclength monitor an autonomous
 *    system (DVI_UNSUPPORTED). The monitor's Hessian is not used. A step also fails, with
 *    DVI_NOT_CONVERGED, if z would not be positive. The monitor then changes too fast for h.
 *  - Both require coordinates of R^n, and a constant mass where the monitor needs the mass
 *    (DVI_UNSUPPORTED). The monitor must be well declared, with a value, a positive power, and
 *    bodies that are the coordinates (DVI_BAD_ARGUMENT). Where the monitor is not a positive finite
 *    number, dvi_integrator_start and dvi_integrator_step fail with DVI_NOT_FINITE.
 *
 *  Such an integrator takes h in units of tau in dvi_integrator_step, dvi_run_options.h, and the
 *  functions of dvi/diagnostics.h. All other times are physical: dvi_integrator_time, observers,
 *  events, dense output, t_end. dvi_run ends at t_end. A step that would pass t_end is taken back,
 *  and replaced by the shorter step that ends there to roundoff. The library does not choose steps
 *  by estimates of their errors. Such a step depends on the state in a way that makes any of the
 *  methods neither symplectic nor symmetric, and its energy drifts. */
#ifndef DVI_TRANSFORM_H
#define DVI_TRANSFORM_H
#include <dvi/integrator.h>

/** Kinds of monitors. */
typedef enum dvi_monitor_kind {
  DVI_MONITOR_FUNCTION, /**< g is the user's */
  /** 1/g = sum of |x_a - x_b|^-power over all pairs of points a < b. For one point alone the
   *  distance is that from the origin */
  DVI_MONITOR_DISTANCE,
  /** 1/g^2 = 2 (E0 - V) + V_q.M^-1 V_q. Steps have equal lengths, in mass-weighted units, of the
   *  orbit in phase space (Huang and Leimkuhler 1997) */
  DVI_MONITOR_ARCLENGTH,
  /** g = (V_q.M^-1 V_q)^(-power/2), a power of the mass-weighted acceleration, which must vanish
   *  nowhere on the trajectory */
  DVI_MONITOR_ACCELERATION
} dvi_monitor_kind;

/** A monitor g(q) > 0. Zero means default. */
typedef struct dvi_monitor {
  dvi_monitor_kind kind;
  /** DVI_MONITOR_FUNCTION: g in the place of V, with its name and `user`, in either shape. t has no
   *  meaning. The value is required, and a missing gradient or Hessian is differenced. The Hessian
   *  has no pattern, because that of the transformed system is full. */
  dvi_potential function;
  /** Power of the distance (default 1.5) or of the acceleration (default 0.75), positive. With 1.5
   *  fast passages of bodies under gravity take a fixed number of steps. For two such bodies 0.75
   *  has the same effect. */
  double power;
  /** Distance: q is `bodies` points of `dimension` coordinates each, one after the other. Default:
   *  one point, of all coordinates. */
  int bodies, dimension;
} dvi_monitor;

#ifdef __cplusplus
extern "C" {
#endif

/** Read a built-in monitor's specification, "distance", "arclength" or "acceleration", with keys as
 *  in a method's, for example "distance:power=1.5".
 *
 *  The keys are power (distance, acceleration), bodies and dimension (distance).
 *  @param[out] monitor  the monitor. Unchanged on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_BAD_OPTION    an unknown name, key or value */
dvi_status dvi_monitor_read(const char *specification, dvi_monitor *monitor);

/** Compare the gradient and the Hessian of a user's monitor with differences at one point, as
 *  dvi_system_check does. A wrong gradient shows in no status. The steps then belong to no action,
 *  and the energy drifts.
 *
 *  @param      q          [nq] a point in general position
 *  @param      tolerance  largest relative difference to accept (default 1e-6)
 *  @param[out] check      the findings, with g in the place of V. May be NULL
 *  @retval DVI_OK            all derivatives agree
 *  @retval DVI_BAD_ARGUMENT  a derivative does not agree, and the error sentence names it. Or a
 *                            pointer is NULL, or the monitor is built in
 *  @retval DVI_NOT_FINITE    the monitor is not finite at q, or not positive */
dvi_status dvi_monitor_check(const dvi_system *system, const dvi_monitor *monitor, const double *q,
                             double tolerance, dvi_derivative_check *check);

/** Return the monitor's name, "distance:power=1.5" or that of the user's function. Owned by the
 *  integrator. NULL if its steps are steps of time. */
const char *dvi_integrator_monitor(const dvi_integrator *integrator);

#ifdef __cplusplus
}
#endif
#endif
