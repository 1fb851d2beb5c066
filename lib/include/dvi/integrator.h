/** An integrator: one method on one system, with the state that it advances. */
#ifndef DVI_INTEGRATOR_H
#define DVI_INTEGRATOR_H
#include <stddef.h>
#include <dvi/status.h>
#include <dvi/system.h>

typedef struct dvi_integrator dvi_integrator;

/** What an integrator has done since its creation. Counters, unlike clocks, say the same on every machine. */
typedef struct dvi_counters {
  long steps;          /**< accepted steps */
  long failed_steps;   /**< steps that failed */
  long values;         /**< points at which values, or rates, were evaluated, those of differences included */
  long gradients;      /**< points at which gradients were evaluated, those of differences included */
  long hessians;       /**< points at which Hessians were evaluated */
  long residuals;      /**< residuals of the step's equations (fixed-point iterations count as one each) */
  long jacobians;      /**< Jacobians of the step's equations */
  long factorizations; /**< numeric factorisations */
  long symbolic;       /**< symbolic analyses */
  long solves;         /**< triangular solves */
  long fixed_points;   /**< solves by fixed point iteration: steps, and parts of steps that build a starting path */
  long newtons;        /**< the same by Newton's method */
  long kinsols;        /**< solves handed to KINSOL */
  long followed;       /**< solutions that were followed from those of shorter steps */
  long allocations;    /**< blocks of memory that its creation and its steps took; a step takes none */
  long simplified;     /**< solves by simplified Newton's method: the Jacobian of one point, decoupled into systems of n unknowns */
  long jump_alarms;    /**< steps that ended in a jump large against the motion (dg, dg-phase with alarm=warn) */
  long certified;      /**< solutions of other iterations that KINSOL's own test of the residual accepted (solver=certified) */
  long energy_fallbacks; /**< steps of sem whose energy equation has no solution: least-squares steps */
  long
      products; /**< products of a sparse matrix with a vector, for functions of that matrix by polynomials (trig, mollified, respa) */
} dvi_counters;

/** The energy of a run by a method whose discrete energy is conserved (sem): E+ of each step is E- of the next, but for jumps.
 *
 *      energy = first + work + jumps,   up to roundoff
 *
 *  Leok 2004, sec. 5.2; E+ = sum_j b_j ( L_v v - L - c_j h L_t )_j and E- = E+ + h sum_j b_j L_t are -dLd/dt1 and dLd/dt0. All in the unit of L. */
typedef struct dvi_energy_balance {
  double first;        /**< E- of the first step after dvi_integrator_start */
  double energy;       /**< E+ of the last step, evaluated on its path */
  double work;         /**< sum over the steps of E+ - E-, what the time dependence did: 0 for autonomous systems */
  double jumps;        /**< sum over the steps of E- less the E+ before, for steps that do not solve the energy equation */
  long fallbacks;      /**< how many of these are least-squares steps, because the energy equation has no solution in the bounds */
  double last_jump;    /**< the jump of the last of those; 0: there was none */
  double largest_jump; /**< the largest of theirs, with its sign */
  long given_steps;    /**< how many others: ordinary steps of a given length, each of which begins a new sequence */
  double given_jumps;  /**< the sum of the jumps of those */
} dvi_energy_balance;

/** Options of a start; zero means default. */
typedef struct dvi_start_options {
  /** What becomes of a start off the constraint. 0: it is refused. Else it is projected. With a one-form by the simplest way onto p = alpha(q) that there
   *  is: q stays, and p becomes alpha(q); the motion is that of q then, whatever p was. With constraints phi(q,p) = 0 q and p move along the constraints'
   *  own fields (phi_p, -phi_q), by Newton's method with the bracket matrix, which needs no measure of distance. Of other systems each p is a state, and
   *  nothing changes. */
  int project;
} dvi_start_options;

#ifdef __cplusplus
extern "C" {
#endif

/** What the steps of an integrator are. */
typedef enum dvi_pacing {
  DVI_STEPS_OF_TIME,  /**< steps of time, of length h, or as long as the method chooses */
  DVI_TIME_TRANSFORM, /**< equal steps in the fictitious time of a monitor (dvi/transform.h) */
  DVI_STEP_CONTROL    /**< steps of time that follow a monitor by reversible control */
} dvi_pacing;

/** How an integrator is made; zero means default. */
typedef struct dvi_integrator_options {
  size_t size;        /**< sizeof(dvi_integrator_options), so that programs of older headers go on */
  const char *method; /**< a specification, see dvi/method.h; needed */
  /** Functions of your own, for the method `shaped-galerkin` (dvi/shapes.h); copied, but for what `user`
   *  points to. Default: none */
  const struct dvi_shapes *shapes;
  dvi_pacing pacing; /**< default: steps of time */
  /** The monitor of another pacing (dvi/transform.h); copied, but for what `user` points to */
  const struct dvi_monitor *monitor;
} dvi_integrator_options;

/** Make an integrator.
 *
 *  @param      system      must outlive the integrator
 *  @param      options     read during the call only
 *  @param[out] integrator  owned by the caller; NULL on failure
 *  @retval DVI_BAD_OPTION   unknown method, key or value, or values that do not go together (nodes < degree, say); the error
 *                           sentence gives the reason
 *  @retval DVI_UNSUPPORTED  the method cannot use a term of the system (verlet with a general Lagrangian, say), or, of dvrk and its kin, not this
 *                           one-form
 *  @retval DVI_BAD_SIZE     the Jacobian has more entries than an int can count: a pattern was left out, or the degree is too high; or the fast
 *                           potentials couple more coordinates than a method with normal modes can take
 *  @retval DVI_SINGULAR     a method with normal modes (trig, mollified, respa:substeps=exact, multiscale that finds omega) wants a positive definite mass
 *  @retval DVI_NOT_FINITE, DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED  the same methods and imex ask for the Hessian of quadratic fast potentials at
 *                           t = 0 and q = 0, and that is not finite, or the callback failed
 *  @retval DVI_BAD_ARGUMENT a pointer or the method is NULL, the size is none of this struct, a monitor is given without
 *                           its pacing or a pacing without a monitor, or the shapes or the monitor are not well declared
 *  @retval DVI_NO_MEMORY
 *
 *  dvi/shapes.h and dvi/transform.h say what else these options ask of the system and the method. */
dvi_status dvi_integrator_create_with(const dvi_system *system, const dvi_integrator_options *options, dvi_integrator **integrator);

/** Make an integrator of a method, all other options being default. */
dvi_status dvi_integrator_create(const dvi_system *system, const char *method, dvi_integrator **integrator);

/** Make another one of the same system, method and monitor (dvi/transform.h), without a state.
 *
 *  If the given one is started, and its steps are in a fictitious time, the new one keeps its E0 in all its starts: those near each other belong to
 *  one map, whose derivatives can be differenced. Time-transformed, only a start of the energy E0 follows the motion then; one of another energy E
 *  succeeds and follows that of g (E - E0), which is another. For starts of their own energies make an integrator by
 *  dvi_integrator_create_with.
 *  @param[out] integrator  owned by the caller; NULL on failure
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL
 *  @retval (others)          as when the given one was made */
dvi_status dvi_integrator_create_like(const dvi_integrator *like, dvi_integrator **integrator);

/** Free an integrator and set the pointer to NULL; NULL is allowed. */
void dvi_integrator_destroy(dvi_integrator **integrator);

/** Put the integrator at time t in state q [nq], p [nv]. May be called again for a new run.
 *
 *  A general Lagrangian's velocity is sought by Newton's method from v = 0 and from velocities along p. Where several velocities have one
 *  momentum, say which one is meant: dvi_integrator_start_velocity.
 *  With a one-form p must be alpha(q) up to rounding, and with constraints phi(q,p) must be 0; dvi_integrator_start_with can project another start.
 *  On any failure the old state stays.
 *  @retval DVI_BAD_ARGUMENT   a pointer is NULL; or the state is off the constraint, p = alpha(q) of a one-form or phi(q,p) = 0 of a Hamiltonian
 *  @retval DVI_NOT_FINITE     an argument, the energy or the forces are not finite there
 *  @retval DVI_SINGULAR       the velocity Hessian is singular wherever it was tried: a degenerate Lagrangian; or the two-form of a one-form
 *                             is, or the bracket matrix of a Hamiltonian's constraints
 *  @retval DVI_NOT_CONVERGED  no velocity was found for p
 *  @retval DVI_CALLBACK_RETRY, DVI_CALLBACK_FAILED  a callback failed there
 *  @retval DVI_NO_MEMORY      KLU's own */
dvi_status dvi_integrator_start(dvi_integrator *integrator, double t, const double *q, const double *p);

/** The same by options; NULL: the default ones.
 *
 *  @retval DVI_BAD_ARGUMENT   the start is off the constraint, and not to be projected; the error sentence says how far it is off
 *  @retval DVI_NOT_CONVERGED  no point with phi(q,p) = 0 was found from there
 *  @retval (others)           as dvi_integrator_start */
dvi_status dvi_integrator_start_with(dvi_integrator *integrator, double t, const double *q, const double *p,
                                     const dvi_start_options *options);

/** The same in state q [nq], v [nv], with p = L_v(t,q,v).
 *
 *  @retval DVI_SINGULAR     the velocity Hessian is singular at this velocity
 *  @retval DVI_UNSUPPORTED  the system declares a Hamiltonian, whose p is not known by v
 *  @retval (others)         as dvi_integrator_start */
dvi_status dvi_integrator_start_velocity(dvi_integrator *integrator, double t, const double *q, const double *v);

/** Take one step of length h (negative: backward); h is time, or the fictitious time of dvi/transform.h.
 *
 *  Methods that choose their steps (dvi_integrator_chooses_steps) take an ordinary step of h at first, and lengths of their own as long as h stays the
 *  same; another h begins anew.
 *
 *  On any failure the state, and all that the next step depends on, is as before the call.
 *  @retval DVI_BAD_ARGUMENT    h is zero or not finite, or so small that t + h = t or 1/h = Inf
 *  @retval DVI_BAD_OPTION      sem: a first step h outside of hmin and hmax
 *  @retval DVI_BAD_STATE       before dvi_integrator_start
 *  @retval DVI_STEP_TOO_LARGE  the equations have no solution that continues those of shorter steps down
 *                              to h = 0 (docs/theory.md); the error sentence names step, time, the h up to
 *                              which there is one, and iterations. A rotation beyond its chart
 *  @retval DVI_NOT_CONVERGED   not even a short step could be solved; the error sentence names step, time
 *                              and iterations. Of a one-form in up to 16 dimensions, and of up to 16 constraints, also:
 *                              the step leads over a point where the two-form, or the bracket matrix, is singular, beyond which no
 *                              trajectory goes on
 *  @retval DVI_NOT_FINITE      NaN or Inf came out of a callback or the step
 *  @retval DVI_JUMP            a method with jumps ends the run because they have grown (its key `alarm`)
 *  @retval DVI_CALLBACK_RETRY  a callback returned a positive number
 *  @retval DVI_CALLBACK_FAILED a callback returned a negative number
 *  @retval DVI_SINGULAR        dg, dg-phase: the two-form is singular at the step's end
 *  @retval DVI_UNSUPPORTED     dvrk and its kin: a component of the one-form that seemed constant at create is not
 *  @retval DVI_NO_MEMORY       KLU's own
 *  @retval DVI_SOLVER_FAILED   KINSOL refuses the equations */
dvi_status dvi_integrator_step(dvi_integrator *integrator, double h);

/** Current time; NaN for NULL. The queries up to dvi_integrator_method give NULL or 0 for NULL. */
double dvi_integrator_time(const dvi_integrator *integrator);

/** Current coordinates [nq], owned by the integrator, valid until its next call. */
const double *dvi_integrator_q(const dvi_integrator *integrator);

/** Current momenta [nv], owned by the integrator, valid until its next call. */
const double *dvi_integrator_p(const dvi_integrator *integrator);

/** The system that it integrates. */
const dvi_system *dvi_integrator_system(const dvi_integrator *integrator);

/** The order that theory claims for this method with its options. */
int dvi_integrator_order(const dvi_integrator *integrator);

/** Length of the last step in time, as it was taken; 0 before the first one, and for NULL. */
double dvi_integrator_last_step(const dvi_integrator *integrator);

/** Whether steps have other lengths than they are asked for: the method chooses them, or they are steps in another time (dvi/transform.h). 1 or 0. */
int dvi_integrator_chooses_steps(const dvi_integrator *integrator);

/** What became of the discrete energy since the start.
 *
 *  @param[out] balance  see dvi_energy_balance
 *  @retval DVI_UNSUPPORTED  the method conserves no discrete energy
 *  @retval DVI_BAD_STATE    no step was taken yet */
dvi_status dvi_integrator_energy_balance(const dvi_integrator *integrator, dvi_energy_balance *balance);

/** The jump q+ - q- at the current time, of a method whose trajectories jump between two elements (dg, dg-phase).
 *
 *  With constraints phi(q,p) that of p follows from the multiplier: [q] = h phi_p^T lambda and [p] = -h phi_q^T lambda at the state, with
 *  h = dvi_integrator_last_step and lambda = dvi_integrator_multiplier.
 *  @param[out] jump  [nq]; NULL if it is not wanted. Not written if the method has none
 *  @return the largest magnitude of its components; NaN if the method has none, before the start, or for NULL */
double dvi_integrator_jump(const dvi_integrator *integrator, double *jump);

/** Bytes that a step moves between memory and processor if the state fits in no cache: what it reads, what it writes, and the lines that are
 *  fetched to be written. 0 if the method does not know: it does if it goes through memory in whole passes (verlet with potentials that
 *  declare gradient_range, and its compositions). */
double dvi_integrator_traffic(const dvi_integrator *integrator);

/** The method's full specification, every key spelled out; owned by the integrator. */
const char *dvi_integrator_method(const dvi_integrator *integrator);

/** All invariants at the current state, as dvi_system_invariants, without an allocation.
 *
 *  @param[out] value  [dvi_system_invariant_count] */
dvi_status dvi_integrator_invariants(dvi_integrator *integrator, double *value);

/** Invariant i at the current state, without an allocation: no other one is evaluated. 0 is the energy; dvi_system_invariant_name names them.
 *
 *  @param[out] value  one number
 *  @retval DVI_BAD_ARGUMENT  there is no such invariant, or an argument is NULL
 *  @retval DVI_BAD_STATE     before dvi_integrator_start
 *  @retval DVI_NOT_FINITE    it is not finite at the state
 *  @retval (others)          as its callback fails, or the inverse Legendre map, which the energy needs */
dvi_status dvi_integrator_invariant(dvi_integrator *integrator, int i, double *value);

/** How far the state is from the constraint of a system with a one-form, the largest |p_i - alpha_i(q)|, or of a Hamiltonian, the largest |phi_a(q,p)|,
 *  without an allocation.
 *
 *  @param[out] distance  not written on failure
 *  @retval DVI_UNSUPPORTED  the system has neither a one-form nor a Hamiltonian
 *  @retval DVI_BAD_STATE    before dvi_integrator_start
 *  @retval (others)         as the callback of the one-form or the constraint fails */
dvi_status dvi_integrator_constraint(dvi_integrator *integrator, double *distance);

/** The multiplier [nv], or [dvi_system_constraint_count], of the last step's constraint, owned by the integrator, valid until its next call; NULL if the method has none, or before the first
 *  step.
 *
 *  That of `vprk` is lambda in the units of q: the kick by which a projection moves q after the step (docs/methods/vprk.md). It measures by how much the
 *  step without a projection leaves p = alpha(q); where its sign alternates from step to step and it grows, a parasitic mode does. That of `dg-phase` with a Hamiltonian is the lambda of the node at
 *  the step's end (docs/methods/dg_phase.md). */
const double *dvi_integrator_multiplier(const dvi_integrator *integrator);

/** Dense output: the trajectory inside the last step.
 *
 *  Galerkin methods (midpoint and trapezoidal among them) evaluate the step's polynomial of degree s; the others use Hermite's
 *  cubic through the ends. Inside a step from a point of the solution, q has an error of
 *    - O(h^(s+1)), if the quadrature is of order 2s-1 or more: Gauss, Radau, Lobatto with s+1 points, midpoint, trapezoidal,
 *    - O(h^(u-s+2)), if it is of a lower order u: O(h^s) for Lobatto with s points,
 *    - O(h^4) for compositions, O(h^3) for verlet, whose step itself is no better,
 *
 *  and v is one order less accurate. After many steps the error of the state at the ends, O(h^order), is added to both.
 *  @param      t  a time in the last step, ends included
 *  @param[out] q  [nq], or NULL
 *  @param[out] v  [nv], or NULL
 *  @retval DVI_BAD_STATE     no step was taken yet
 *  @retval DVI_BAD_ARGUMENT  t is outside of the last step
 *  @retval DVI_NOT_FINITE    functions of your own (dvi/shapes.h) cannot be evaluated there */
dvi_status dvi_integrator_interpolate(dvi_integrator *integrator, double t, double *q, double *v);

/** What was done so far; all 0 for NULL. */
void dvi_integrator_counters(const dvi_integrator *integrator, dvi_counters *counters);

/** Say in words which kernel, solver and sparsity the integrator chose, and why: several lines, each ended by a newline.
 *
 *  @return the length of the whole text (without the 0 at its end); text holds as much of it as fits, always ended by 0. */
size_t dvi_integrator_explain(const dvi_integrator *integrator, char *text, size_t size);

/** Write the state to a file: the file is whole or, on failure, as before, and nothing else is
 *  left in its folder. It is on the disk, under its name, when the call returns.
 *
 *  @retval DVI_IO_ERROR  the file cannot be written (disk full, no permission), or the folder
 *                        cannot be flushed; the error sentence has the system's reason */
dvi_status dvi_integrator_save(const dvi_integrator *integrator, const char *path);

/** Write the same state to memory.
 *
 *  @param[out] bytes     [capacity] the state; NULL: only its size is wanted
 *  @param      capacity  bytes of room
 *  @param[out] size      bytes that the state takes, also where the room is too small
 *  @retval DVI_BAD_SIZE  the room is too small; nothing is written */
dvi_status dvi_integrator_save_memory(const dvi_integrator *integrator, void *bytes, size_t capacity, size_t *size);

/** Read a state that dvi_integrator_save wrote; a run then continues bit for bit.
 *
 *  On any failure the state stays. The method must have the same keys, but for those that do
 *  not change the steps (an alarm, the path of a tableau, whose coefficients must be the same),
 *  and the same function space and monitor. Callbacks are not in the file; the system is known
 *  again by what it declares and by the Lagrangian's value and forces, the distance from
 *  phi(q,p) = 0 or p = alpha(q), and the monitor and its gradient, at the saved state, which
 *  must agree to nine digits; functions of the program's own (dvi/shapes.h) by their values at
 *  the quadrature points. Other parameters that show in none of these (a drive's frequency at
 *  t = 0) are not noticed.
 *  @retval DVI_IO_ERROR  the file cannot be read
 *  @retval DVI_BAD_FILE  it is cut short, damaged, or from another method or system; the error
 *                        sentence says what differs */
dvi_status dvi_integrator_restore(dvi_integrator *integrator, const char *path);

/** Read a state that dvi_integrator_save_memory wrote, or the bytes of a file of dvi_integrator_save; the
 *  rest is as of dvi_integrator_restore. */
dvi_status dvi_integrator_restore_memory(dvi_integrator *integrator, const void *bytes, size_t size);

#ifdef __cplusplus
}
#endif
#endif
