/** An integrator: one method on one system, with the state that it advances. */
#ifndef DVI_INTEGRATOR_H
#define DVI_INTEGRATOR_H
#include <stddef.h>
#include <dvi/status.h>
#include <dvi/system.h>

typedef struct dvi_integrator dvi_integrator;

/** Work of an integrator since its creation. Counters, unlike clocks, say the same on every
 *  machine. */
typedef struct dvi_counters {
  long steps;        /**< accepted steps */
  long failed_steps; /**< steps that failed */
  /** points at which values, or rates, were evaluated, those of differences included */
  long values;
  /** points at which gradients were evaluated, those of differences included */
  long gradients;
  long hessians; /**< points at which Hessians were evaluated */
  /** residuals of the step's equations (fixed-point iterations count as one each) */
  long residuals;
  long jacobians;      /**< Jacobians of the step's equations */
  long factorizations; /**< numeric factorisations */
  long symbolic;       /**< symbolic analyses */
  long solves;         /**< triangular solves */
  /** solves by fixed-point iteration, of steps and of parts of steps that build a starting path */
  long fixed_points;
  long newtons;  /**< solves by Newton's method, counted as fixed_points */
  long kinsols;  /**< solves handed to KINSOL */
  long followed; /**< solutions that were followed from those of shorter steps */
  /** blocks of memory that the creation and the steps took. A step takes some only where it
   *  prepares a solver */
  long allocations;
  /** solves by simplified Newton's method, with the Jacobian of one point: decoupled into systems
   *  of n unknowns, in charts by blocks, in dg-phase in small matrices */
  long simplified;
  /** steps that ended in a jump large against the motion (dg, dg-phase with alarm=warn) */
  long jump_alarms;
  /** solutions of other iterations that KINSOL's own test of the residual accepted
   *  (solver=certified) */
  long certified;
  /** least-squares steps of sem, taken where the energy equation has no solution */
  long energy_fallbacks;
  /** products of a matrix with a vector: for functions of the matrix by polynomials (trig,
   *  mollified, respa), and of a large Jacobian in GMRES */
  long products;
  /** solvers that were made ready: the memory of a factor, of KINSOL, of the room to follow a
   *  branch. Each is made ready when it is first needed, and never again. If memory is lacking
   *  then, the step fails with DVI_NO_MEMORY, the state stays, and the next step tries again */
  long preparations;
  long hits; /**< hits of contacts, where each is met at its time */
  /** sweeps of projected Gauss-Seidel iteration for the impulses of contacts (moreau-jean) */
  long sweeps;
} dvi_counters;

/** The energy of a run by a method whose discrete energy is conserved (sem). But for jumps E+
 *  of each step is E- of the next.
 *
 *      energy = first + work + jumps,   up to roundoff
 *
 *  Leok 2004, sec. 5.2. E+ = sum_j b_j ( L_v v - L - c_j h L_t )_j and E- = E+ + h sum_j b_j L_t
 *  are -dLd/dt1 and dLd/dt0. All energies are in the unit of L. */
typedef struct dvi_energy_balance {
  double first;  /**< E- of the first step after dvi_integrator_start */
  double energy; /**< E+ of the last step, evaluated on its path */
  /** sum over the steps of E+ - E-, the effect of the time dependence. 0 for autonomous systems */
  double work;
  /** sum of E- less the E+ before, over the steps that do not solve the energy equation */
  double jumps;
  /** number of least-squares steps, taken because the energy equation has no solution in the
   *  bounds */
  long fallbacks;
  double last_jump;    /**< jump of the last least-squares step. 0 if there was none */
  double largest_jump; /**< jump of largest magnitude at a least-squares step, with its sign */
  /** number of ordinary steps of a given length, each of which begins a new sequence */
  long given_steps;
  double given_jumps; /**< sum of the jumps of the ordinary steps */
} dvi_energy_balance;

/** Options of a start. Zero means default. */
typedef struct dvi_start_options {
  /** not 0 to project a start off the constraint. By default such a start is refused.
   *
   *  With a one-form q stays and p becomes alpha(q), the simplest projection onto p = alpha(q). The
   *  motion is then that of q, whatever p was. With constraints phi(q,p) = 0 the state moves along
   *  the constraints' own Hamiltonian vector fields (phi_p, -phi_q), by Newton's method with the
   *  bracket matrix, which needs no measure of distance. With holonomic constraints phi(t,q) = 0 q
   *  moves along M^-1 G^T, and then p along G^T. In other systems each p is a state, and nothing
   *  changes. */
  int project;
} dvi_start_options;

#ifdef __cplusplus
extern "C" {
#endif

/** The unit of an integrator's steps. */
typedef enum dvi_pacing {
  DVI_STEPS_OF_TIME,  /**< steps of time, of length h or of lengths that the method chooses */
  DVI_TIME_TRANSFORM, /**< equal steps in the fictitious time of a monitor (dvi/transform.h) */
  DVI_STEP_CONTROL    /**< steps of time that follow a monitor by reversible control */
} dvi_pacing;

/** Options of an integrator. Zero means default. */
typedef struct dvi_integrator_options {
  /** sizeof(dvi_integrator_options). Programs built with older headers then still work */
  size_t size;
  const char *method; /**< a specification, see dvi/method.h. Required */
  /** Functions of your own, for the method `shaped-galerkin` (dvi/shapes.h). Copied, but for the
   *  data at `user`. Default none */
  const struct dvi_shapes *shapes;
  dvi_pacing pacing; /**< default: steps of time */
  /** The monitor of another pacing (dvi/transform.h). Copied, but for the data at `user` */
  const struct dvi_monitor *monitor;
  /** not 0 to add up what forces supply (dvi_integrator_supplied), which costs an evaluation of the
   *  forces a step */
  int balances;
} dvi_integrator_options;

/** Make an integrator.
 *
 *  @param      system      must outlive the integrator
 *  @param      options     read during the call only
 *  @param[out] integrator  owned by the caller. NULL on failure
 *  @retval DVI_BAD_OPTION   unknown method, key or value, or values that contradict each other
 *                           (nodes < degree, say). The error sentence gives the reason
 *  @retval DVI_UNSUPPORTED  the method cannot use a term of the system (verlet with a general
 *                           Lagrangian, say). Or dvrk and its kin cannot take this one-form
 *  @retval DVI_BAD_SIZE     the Jacobian has more entries than an int can count, because a pattern
 *                           was left out or the degree is too high. Or the fast potentials couple
 *                           more coordinates than a method with normal modes can take
 *  @retval DVI_SINGULAR     a method with normal modes (trig, mollified, respa:substeps=exact,
 *                           multiscale that finds omega) needs a positive definite mass
 *  @retval DVI_NOT_FINITE, DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED  the same methods and imex ask
 *                           for the Hessian of quadratic fast potentials at t = 0 and q = 0. The
 *                           Hessian is not finite, or the callback failed
 *  @retval DVI_BAD_ARGUMENT a pointer or the method is NULL, the size is none of this struct, a
 *                           monitor is given without its pacing or a pacing without a monitor, or
 *                           the shapes or the monitor are not well declared
 *  @retval DVI_NO_MEMORY    memory could not be allocated
 *
 *  dvi/shapes.h and dvi/transform.h list further requirements of these options. */
dvi_status dvi_integrator_create_with(const dvi_system *system,
                                      const dvi_integrator_options *options,
                                      dvi_integrator **integrator);

/** Make an integrator of a method, with default values of all other options. */
dvi_status dvi_integrator_create(const dvi_system *system, const char *method,
                                 dvi_integrator **integrator);

/** Make an integrator of the same system, method and monitor (dvi/transform.h) as `like`, without a
 *  state.
 *
 *  If `like` is started, and its steps are in a fictitious time, the new integrator keeps its E0 in
 *  all starts. Starts near each other then belong to one map, whose derivatives can be differenced.
 *  With a time transform only a start of the energy E0 follows the motion of the system. A start
 *  of another energy E succeeds and follows the motion of g (E - E0), which is different. For
 *  starts of their own energies make an integrator by dvi_integrator_create_with.
 *  @param[out] integrator  owned by the caller. NULL on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval (others)          as at the creation of `like` */
dvi_status dvi_integrator_create_like(const dvi_integrator *like, dvi_integrator **integrator);

/** Free an integrator and set the pointer to NULL. NULL is allowed. */
void dvi_integrator_destroy(dvi_integrator **integrator);

/** Put the integrator at time t in state q [nq], p [nv]. May be called again for a new run.
 *
 *  A general Lagrangian's velocity is found by Newton's method from v = 0 and from velocities along
 *  p. Where several velocities have one momentum, choose one by dvi_integrator_start_velocity. With
 *  a one-form p must be alpha(q) up to rounding, and with constraints phi(q,p) must be 0.
 *  dvi_integrator_start_with can project another start. On any failure the old state stays.
 *  @retval DVI_BAD_ARGUMENT   a pointer is NULL, or the state is off the constraint, p = alpha(q)
 *                             of a one-form or phi(q,p) = 0 of a Hamiltonian, phi(t,q) = 0 or A v +
 *                             a = 0 with their velocities, or nonholonomic constraints are
 *                             integrable (of systems with up to 64 coordinates, at the first start)
 *  @retval DVI_NOT_FINITE     an argument, the energy or the forces are not finite there
 *  @retval DVI_SINGULAR       the velocity Hessian is singular at every guess (a degenerate
 *                             Lagrangian), or the two-form of a one-form or the bracket matrix of a
 *                             Hamiltonian's constraints is singular, or a nonholonomic constraint
 *                             depends on the others
 *  @retval DVI_NOT_CONVERGED  no velocity was found for p
 *  @retval DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED  a callback failed there
 *  @retval DVI_NO_MEMORY      KLU could not allocate memory */
dvi_status dvi_integrator_start(dvi_integrator *integrator, double t, const double *q,
                                const double *p);

/** Start with options. NULL means the default ones. Otherwise this is dvi_integrator_start.
 *
 *  @retval DVI_BAD_ARGUMENT   the start is off the constraint, and not to be projected. The error
 *                             sentence gives the distance
 *  @retval DVI_NOT_CONVERGED  no point with phi(q,p) = 0 was found from there
 *  @retval (others)           as dvi_integrator_start */
dvi_status dvi_integrator_start_with(dvi_integrator *integrator, double t, const double *q,
                                     const double *p, const dvi_start_options *options);

/** Start in state q [nq], v [nv], with p = L_v(t,q,v). Otherwise this is dvi_integrator_start.
 *
 *  @retval DVI_SINGULAR     the velocity Hessian is singular at this velocity
 *  @retval DVI_UNSUPPORTED  the system declares a Hamiltonian, where v does not determine p
 *  @retval (others)         as dvi_integrator_start */
dvi_status dvi_integrator_start_velocity(dvi_integrator *integrator, double t, const double *q,
                                         const double *v);

/** Take one step of length h (negative: backward). h is time, or the fictitious time of
 *  dvi/transform.h.
 *
 *  Methods that choose their steps (dvi_integrator_chooses_steps) take an ordinary step of h at
 *  first, and lengths of their own as long as h stays the same. Another h begins anew.
 *
 *  After any failure the state, and all data for the next step, are as before the call.
 *  @retval DVI_BAD_ARGUMENT    h is zero or not finite, or so small that t + h = t or 1/h = Inf
 *  @retval DVI_BAD_OPTION      sem: a first step h outside of hmin and hmax
 *  @retval DVI_BAD_STATE       before dvi_integrator_start
 *  @retval DVI_STEP_TOO_LARGE  the equations have no solution that continues those of shorter steps
 *                              down to h = 0 (docs/theory.md), or a rotation goes beyond its chart.
 *                              The error sentence names step, time, the largest h with a solution,
 *                              and iterations
 *  @retval DVI_NOT_CONVERGED   not even a short step could be solved, or the iterative solver of
 *                              a large system does not find a correction. The error sentence names
 *                              step, time and iterations. Also, for a one-form in up to 16
 *                              dimensions or up to 16 constraints, the step leads over a point
 *                              where the two-form, or the bracket matrix, is singular. No
 *                              trajectory goes on beyond such a point
 *  @retval DVI_NOT_FINITE      NaN or Inf came out of a callback or the step
 *  @retval DVI_JUMP            a method with jumps ends the run because they have grown (its key
 *                              `alarm`)
 *  @retval DVI_CALLBACK_RETRY  a callback returned a positive number
 *  @retval DVI_CALLBACK_FAILED a callback returned a negative number
 *  @retval DVI_SINGULAR        dg, dg-phase: the two-form is singular at the step's end; or the
 *                              rank of holonomic constraints drops within the step
 *  @retval DVI_UNSUPPORTED     dvrk and its kin: a component of the one-form that seemed constant
 *                              at create is not
 *  @retval DVI_UNSUPPORTED     hits of a contact accumulate, or a contact stays closed, without
 *                              `hold`; or two contacts close at one time and push against each
 *                              other (docs/mechanics/contacts.md). The sentence names them and the
 *                              time
 *  @retval DVI_NO_MEMORY       KLU could not allocate memory
 *  @retval DVI_SOLVER_FAILED   KINSOL refuses the equations */
dvi_status dvi_integrator_step(dvi_integrator *integrator, double h);

/** Return the current time. NaN for NULL. The queries from here to dvi_integrator_method return
 *  NULL or 0 for NULL. */
double dvi_integrator_time(const dvi_integrator *integrator);

/** Return the current coordinates [nq]. Owned by the integrator, valid until its next call. */
const double *dvi_integrator_q(const dvi_integrator *integrator);

/** Return the current momenta [nv]. Owned by the integrator, valid until its next call. */
const double *dvi_integrator_p(const dvi_integrator *integrator);

/** Return the system of the integrator. */
const dvi_system *dvi_integrator_system(const dvi_integrator *integrator);

/** Return the order that theory claims for this method with its options. */
int dvi_integrator_order(const dvi_integrator *integrator);

/** Return the length of the last step in time, as it was taken. 0 before the first step, and for
 *  NULL. */
double dvi_integrator_last_step(const dvi_integrator *integrator);

/** Return 1 if the steps have other lengths than asked for, else 0. This is so if the method
 *  chooses them, or if they are steps in another time (dvi/transform.h). */
int dvi_integrator_chooses_steps(const dvi_integrator *integrator);

/** Return what the forces without a potential and a heat bath have supplied to an invariant since
 *  the start. With the option `balances` they are 0, the energy, and the momenta of the symmetries.
 *
 *  The supplies of a step are those of the discrete principle of Lagrange and d'Alembert, by the
 *  quadrature of the method: h sum_j b_j F_j.v_j to the energy, and h sum_j b_j F_j.xi(q_j) to a
 *  momentum (Marsden and West 2001, sec. 3.1.4). A heat bath supplies the change of the kinetic
 *  energy and of the momenta by its noise and friction, the heat. NaN without the option, before
 *  the start, and for other invariants. */
double dvi_integrator_supplied(const dvi_integrator *integrator, int invariant);

/** Compute the defect of a balance, the change of an invariant since the start less what forces
 *  have supplied.
 *
 *  It is rounding for momenta of symmetries that are affine in q, and for the energy with Gauss
 *  quadrature if the energy is quadratic. Other energies have a defect of the method's order, which
 *  grows in proportion to time at most.
 *  @retval DVI_BAD_STATE     the integrator keeps no balances, or has no state yet
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, or the invariant has no balance
 *  @retval (others)          as dvi_integrator_invariant */
dvi_status dvi_integrator_balance(dvi_integrator *integrator, int invariant, double *defect);

/** Report the discrete energy since the start.
 *
 *  @param[out] balance  see dvi_energy_balance
 *  @retval DVI_UNSUPPORTED  the method conserves no discrete energy
 *  @retval DVI_BAD_STATE    no step was taken yet */
dvi_status dvi_integrator_energy_balance(const dvi_integrator *integrator,
                                         dvi_energy_balance *balance);

/** Measure the jump q+ - q- at the current time, for a method whose trajectories jump between two
 *  elements (dg, dg-phase).
 *
 *  With constraints phi(q,p) the jump of p follows from the multiplier. At the state
 *  [q] = h phi_p^T lambda and [p] = -h phi_q^T lambda, with h = dvi_integrator_last_step and
 *  lambda = dvi_integrator_multiplier.
 *  @param[out] jump  [nq]. NULL if not wanted. Not written if the method has no jump
 *  @return the largest magnitude of its components. NaN if the method has none, before the start,
 *          or for NULL */
double dvi_integrator_jump(const dvi_integrator *integrator, double *jump);

/** Return the bytes that a step moves between memory and processor if the state fits in no cache.
 *
 *  They count reads, writes, and the lines that are fetched to be written. 0 if the method does not
 *  know. Methods that go through memory in whole passes know (verlet with potentials that declare
 *  gradient_range, and its compositions). */
double dvi_integrator_traffic(const dvi_integrator *integrator);

/** Return the method's full specification, every key spelled out. Owned by the integrator. */
const char *dvi_integrator_method(const dvi_integrator *integrator);

/** Evaluate all invariants at the current state, as dvi_system_invariants. The first call may
 *  allocate room for a velocity at each end of the last step, which the dense output shares, and
 *  for a symmetry. Later calls allocate nothing.
 *
 *  @param[out] value  [dvi_system_invariant_count]
 *  @retval DVI_NO_MEMORY  there is no memory for these
 *  @retval (others)       as dvi_integrator_invariant */
dvi_status dvi_integrator_invariants(dvi_integrator *integrator, double *value);

/** Evaluate invariant i alone at the current state. Allocations are those of
 *  dvi_integrator_invariants. Invariant 0 is the energy. dvi_system_invariant_name returns the
 *  names.
 *
 *  @param[out] value  one number
 *  @retval DVI_BAD_ARGUMENT  there is no such invariant, or an argument is NULL
 *  @retval DVI_BAD_STATE     before dvi_integrator_start
 *  @retval DVI_NOT_FINITE    the invariant is not finite at the state
 *  @retval DVI_NO_MEMORY     there is no memory for a velocity or a symmetry
 *  @retval (others)          as its callback fails, or the inverse Legendre map, which the energy
 *                            needs */
dvi_status dvi_integrator_invariant(dvi_integrator *integrator, int i, double *value);

/** Measure how far the state is from the constraint, without an allocation. With a one-form this is
 *  the largest |p_i - alpha_i(q)|, with a Hamiltonian the largest |phi_a(q,p)|, with holonomic
 *  constraints the largest |phi_a(t,q)|, and with nonholonomic ones the largest |A v + a|.
 *
 *  @param[out] distance  the distance. Not written on failure
 *  @retval DVI_UNSUPPORTED  the system has no one-form, no Hamiltonian and no holonomic or
 *                           nonholonomic constraint
 *  @retval DVI_BAD_STATE    before dvi_integrator_start
 *  @retval (others)         as the callback of the one-form or the constraint fails */
dvi_status dvi_integrator_constraint(dvi_integrator *integrator, double *distance);

/** Compute the multipliers lambda [dvi_system_constraint_count] of the holonomic constraints at the
 *  present state, of the forces -G^T lambda, and behind them those of the nonholonomic ones, of the
 *  forces -A^T lambda, from the equations of motion there. They have the order of the method.
 *
 *  @retval DVI_UNSUPPORTED  the system has neither holonomic nor nonholonomic constraints
 *  @retval DVI_BAD_STATE    before dvi_integrator_start
 *  @retval DVI_SINGULAR     the constraints are dependent there, and were not so at the start
 *  @retval (others)         as the callbacks fail */
dvi_status dvi_integrator_reactions(dvi_integrator *integrator, double *lambda);

/** Return the multiplier [nv], or [dvi_system_constraint_count], of the last step's constraint.
 *  Owned by the integrator, valid until its next call. NULL if the method has none, or before the
 *  first step.
 *
 *  The multiplier of `vprk` is lambda in the units of q, the kick by which a projection moves q
 *  after the step (docs/methods/vprk.md). It measures by how much the step without a projection
 *  leaves p = alpha(q). Where its sign alternates from step to step and it grows, a parasitic mode
 *  grows. The multiplier of `dg-phase` with a Hamiltonian is the lambda of the node at the step's
 *  end (docs/methods/dg_phase.md). */
const double *dvi_integrator_multiplier(const dvi_integrator *integrator);

/** Evaluate the trajectory inside the last step (dense output).
 *
 *  Galerkin methods (midpoint and trapezoidal among them) evaluate the step's polynomial of degree
 *  s. The others use Hermite's cubic through the ends. Inside a step from a point of the solution,
 *  q has an error of
 *    - O(h^(s+1)), if the quadrature is of order 2s-1 or more (Gauss, Radau, Lobatto with s+1
 *      points, midpoint, trapezoidal),
 *    - O(h^(u-s+2)), if the quadrature is of a lower order u, which is O(h^s) for Lobatto with s
 *      points,
 *    - O(h^4) for compositions, O(h^3) for verlet, whose step itself is no better,
 *
 *  and v is one order less accurate. After many steps the error of the state at the ends,
 *  O(h^order), is added to both. The first call may allocate room for the velocities at both ends.
 *  @param      t  a time in the last step, ends included
 *  @param[out] q  [nq], or NULL
 *  @param[out] v  [nv], or NULL
 *  @retval DVI_BAD_STATE     no step was taken yet
 *  @retval DVI_BAD_ARGUMENT  t is outside of the last step
 *  @retval DVI_NO_MEMORY     there is no memory for the velocities
 *  @retval DVI_NOT_FINITE    functions of your own (dvi/shapes.h) cannot be evaluated there */
dvi_status dvi_integrator_interpolate(dvi_integrator *integrator, double t, double *q, double *v);

/** Copy the counters. All are 0 for NULL. */
void dvi_integrator_counters(const dvi_integrator *integrator, dvi_counters *counters);

/** Say in words which kernel, solver and sparsity the integrator chose, and why. The text has
 *  several lines, each ended by a newline.
 *
 *  @return the length of the whole text (without the 0 at its end). text holds as much of it as
 *          fits, always ended by 0. */
size_t dvi_integrator_explain(const dvi_integrator *integrator, char *text, size_t size);

/** Write the state to a file. The file is on the disk, under its name, when the call returns. On
 *  failure the old file stays, and nothing else is left in its folder.
 *
 *  @retval DVI_IO_ERROR  the file cannot be written (disk full, no permission), or the folder
 *                        cannot be flushed. The error sentence has the system's reason */
dvi_status dvi_integrator_save(const dvi_integrator *integrator, const char *path);

/** Write the state to memory, with the bytes of dvi_integrator_save.
 *
 *  @param[out] bytes     [capacity] the state. NULL if only its size is wanted
 *  @param      capacity  size of the array in bytes
 *  @param[out] size      bytes that the state takes, also where the capacity is too small
 *  @retval DVI_BAD_SIZE  the capacity is too small. Nothing is written */
dvi_status dvi_integrator_save_memory(const dvi_integrator *integrator, void *bytes,
                                      size_t capacity, size_t *size);

/** Read a state that dvi_integrator_save wrote. A run then continues bit for bit.
 *
 *  On any failure the state stays. The method must have the same keys, but for those that do not
 *  change the steps (an alarm, the path of a tableau, whose coefficients must be the same), and the
 *  same function space and monitor. The file holds no callbacks. The system is recognised by its
 *  declared terms and by numbers at the saved state, which must agree to nine digits: the
 *  Lagrangian's value and forces, the distance from phi(q,p) = 0 or p = alpha(q), and the monitor
 *  and its gradient. Functions of the program's own (dvi/shapes.h) are recognised by their values
 *  at the quadrature points. Other parameters that show in none of these (a drive's frequency at
 *  t = 0) are not noticed.
 *  @retval DVI_IO_ERROR  the file cannot be read
 *  @retval DVI_BAD_FILE  the file is cut short, damaged, or from another method or system. The
 *                        error sentence says what differs */
dvi_status dvi_integrator_restore(dvi_integrator *integrator, const char *path);

/** Read a state that dvi_integrator_save_memory wrote, or the bytes of a file of
 *  dvi_integrator_save. Otherwise this is dvi_integrator_restore. */
dvi_status dvi_integrator_restore_memory(dvi_integrator *integrator, const void *bytes,
                                         size_t size);

#ifdef __cplusplus
}
#endif
#endif
