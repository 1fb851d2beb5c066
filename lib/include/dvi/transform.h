/** Steps that adapt to the motion without losing what fixed steps keep: a fixed step h in a fictitious time tau,
 *
 *      dt/dtau = g(q),      g a positive function, the monitor, small where steps must be short.
 *
 *  Time transform: the stationary action is that of a new system,
 *
 *      integral of  Lg(q,q') = g(q) [ L(q, q'/g(q)) + E0 ]  dtau,      E0 the energy of the start.
 *
 *  Its momenta are those of L, p = Lg_q' = L_v; its energy is g (E - E0), which is 0 along the run, and there its motion is that of L in the time t.
 *  A fixed step in tau is therefore a symplectic map, with all that follows for long runs (Hairer 1997; Reich 1999). The new system is a general
 *  Lagrangian with the mass M/g, so explicit methods cannot take it. Physical time is a quadrature of the same step, by the method's own nodes,
 *  t1 = t0 + h sum_j b_j g(Q_j), and has the method's own order.
 *
 *  Step control: the step stays one of the system itself, of length h/z, where z follows 1/g reversibly (Hairer and Soederlind 2005):
 *
 *      z_half = z_n - h/2 g_q.v/g (at n),    step of h/z_half,    z_n+1 = z_half - h/2 g_q.v/g (at n+1),    z_0 = 1/g(q_0).
 *
 *  Cheaper: explicit methods stay explicit. A symmetric method stays symmetric, which keeps the energy of reversible systems from drifting, but the map is
 *  not symplectic.
 *
 *  Either is a `pacing` of dvi_integrator_options, with its `monitor`. What it asks for, else creation fails:
 *
 *  - DVI_TIME_TRANSFORM: an autonomous system, and a method that takes a general Lagrangian: galerkin, midpoint,
 *    trapezoidal, or a composition of one of them (DVI_UNSUPPORTED). The start chooses E0. Lg_qq is full, whatever the
 *    system's patterns are. The Hessian of an arclength or acceleration monitor is differenced.
 *  - DVI_STEP_CONTROL: a symmetric method; for an arclength monitor an autonomous system (DVI_UNSUPPORTED). The
 *    monitor's Hessian is not used. A step also fails, with DVI_NOT_CONVERGED, if z would not be positive: h is too large
 *    for how fast the monitor changes.
 *  - Both: coordinates of R^n, and a constant mass where the monitor needs it (DVI_UNSUPPORTED); a monitor that is well
 *    declared: a value, a positive power, bodies that are the coordinates (DVI_BAD_ARGUMENT). Where the monitor is not
 *    a positive finite number, dvi_integrator_start and dvi_integrator_step fail with DVI_NOT_FINITE.
 *
 *  Such an integrator takes h in units of tau: dvi_integrator_step, dvi_run_options.h, and the functions of dvi/diagnostics.h. All else is
 *  in physical time: dvi_integrator_time, observers, events, dense output, t_end. dvi_run ends at t_end: a step that would
 *  pass it is taken back, and the shorter one that ends there to roundoff is sought. Choosing steps by estimates of their errors is not offered: a step that
 *  depends on where it is taken in such a way makes any of the methods neither symplectic nor symmetric, and their energies drift. */
#ifndef DVI_TRANSFORM_H
#define DVI_TRANSFORM_H
#include <dvi/integrator.h>

/** What a monitor is. */
typedef enum dvi_monitor_kind {
  DVI_MONITOR_FUNCTION, /**< g is the user's */
  /** 1/g = sum of |x_a - x_b|^-power over all pairs of points a < b; of one point alone: its distance from the origin */
  DVI_MONITOR_DISTANCE,
  /** 1/g^2 = 2 (E0 - V) + V_q.M^-1 V_q: equal lengths, in mass-weighted units, of the orbit in phase space (Huang and Leimkuhler 1997) */
  DVI_MONITOR_ARCLENGTH,
  /** g = (V_q.M^-1 V_q)^(-power/2): the size of the mass-weighted acceleration, which must vanish nowhere on the way */
  DVI_MONITOR_ACCELERATION
} dvi_monitor_kind;

/** A monitor g(q) > 0; all zero but the kind means defaults. */
typedef struct dvi_monitor {
  dvi_monitor_kind kind;
  /** DVI_MONITOR_FUNCTION: g in the place of V, with its name and `user`, in either shape; t is without meaning. Value needed; a gradient or Hessian that is
   *  left out is differenced. No pattern: the Hessian is full, for the transformed system's is. */
  dvi_potential function;
  /** Distance: positive, 0: 1.5, by which fast passages of bodies under gravity take a fixed number of steps. Acceleration: positive, 0: 0.75,
   *  which is the same for two such bodies. */
  double power;
  /** Distance: q is `bodies` points of `dimension` coordinates each, one after the other; 0: one point, of all coordinates. */
  int bodies, dimension;
} dvi_monitor;

#ifdef __cplusplus
extern "C" {
#endif

/** Read a built-in monitor's specification: "distance", "arclength" or "acceleration", with keys as a method has them: "distance:power=1.5".
 *
 *  Keys: power (distance, acceleration), bodies and dimension (distance).
 *  @param[out] monitor  the monitor; unchanged on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval DVI_BAD_OPTION    an unknown name, key or value */
dvi_status dvi_monitor_read(const char *specification, dvi_monitor *monitor);

/** Compare the gradient and the Hessian of a user's monitor with differences at one point, as dvi_system_check does. A wrong gradient shows in no
 *  status: the steps then belong to no action, and the energy drifts.
 *
 *  @param      q          [nq] a point in general position
 *  @param      tolerance  largest relative difference to accept; 0: 1e-6
 *  @param[out] check      the findings, with g in the place of V; may be NULL
 *  @retval DVI_OK            everything agrees
 *  @retval DVI_BAD_ARGUMENT  something does not, which the error sentence names; or a pointer is NULL, or the monitor is built in
 *  @retval DVI_NOT_FINITE    the monitor is not finite at q, or not positive */
dvi_status dvi_monitor_check(const dvi_system *system, const dvi_monitor *monitor, const double *q, double tolerance,
                             dvi_derivative_check *check);

/** The monitor's name, "distance:power=1.5" or that of the user's function; owned by the integrator. NULL if its steps are steps of time. */
const char *dvi_integrator_monitor(const dvi_integrator *integrator);

#ifdef __cplusplus
}
#endif
#endif
