/** An ensemble: many members, each a state of its own, advanced by one method in one call. */
#ifndef DVI_ENSEMBLE_H
#define DVI_ENSEMBLE_H
#include <dvi/integrator.h>
#include <dvi/shapes.h>

/** Members differ in their initial states, or in the parameters of their systems. Each has the
 *  digits of a dvi_integrator that runs it alone, bit for bit, on every processor, for every number
 *  of threads and however the members are grouped.
 *
 *  Members side by side are the lanes of vectors, and one batch callback evaluates all their
 *  points, where the mass is constant and scalar or diagonal and the potentials give their
 *  gradients: for verlet, for fixed point iteration of the implicit methods, and for compositions
 *  of both. Everything else goes member by member, as an integrator does. One ensemble, one caller
 *  at a time. */
typedef struct dvi_ensemble dvi_ensemble;

/** Options of an ensemble; zero means default. */
typedef struct dvi_ensemble_options {
  int members; /**< how many, at least 1 */
  /** Threads that share the members, the caller's among them; 0: 1. With more than one, callbacks
   *  run at the same time on several threads: what their `user` points to must bear that. A
   *  method's own threads (verlet's key) are made for each of these. */
  int threads;
  /** members that are worked on together, side by side; 1: none are; 0: chosen by the system's
   * size. It changes speed alone */
  int block;
  /** [members] the system of each member, for sweeps of parameters; the array is copied, the
   *  systems must outlive the ensemble. NULL: all have the system that dvi_ensemble_create is
   *  given. They must declare the same terms, masses, patterns, names, derivatives and reaches, and
   *  differ in what their callbacks compute. Only neighbours with the same system are worked on
   *  side by side. Methods that take the fast potentials apart (imex, respa, mollified, trig,
   *  multiscale that finds what is fast, compositions of imex) keep parts, modes or factors of a
   *  system: an integrator is made for each such group of neighbours then, so put members of one
   *  system next to each other. */
  const dvi_system *const *systems;
  /** Functions of your own for `shaped-galerkin`, as dvi_integrator_options has them; copied. With
   *  more threads than one their callbacks run at the same time, too. NULL: none. */
  const dvi_shapes *shapes;
} dvi_ensemble_options;

#ifdef __cplusplus
extern "C" {
#endif

/** Make an ensemble.
 *
 *  A batch callback must give each point the bits that it gives that point alone, wherever it
 *  stands in a batch of whatever count; plain loops over the points do, unless they are compiled
 *  with -ffast-math.
 *  @param      system    of all members, must outlive the ensemble; NULL if options->systems names
 *                        them
 *  @param      method    a specification, see dvi/method.h
 *  @param[out] ensemble  owned by the caller; NULL on failure
 *  @retval DVI_BAD_SIZE      members, threads or block is out of range (members 1 or more, threads
 *                            up to 1024)
 *  @retval DVI_BAD_ARGUMENT  an argument is NULL, system and systems are both given, or a system
 *                            differs from the first one
 *  @retval DVI_UNSUPPORTED   the method chooses its steps, so that members would part in time
 *  @retval DVI_NO_MEMORY     also if the system gives no more threads
 *  @retval (others)          as dvi_integrator_create */
dvi_status dvi_ensemble_create(const dvi_system *system, const char *method,
                               const dvi_ensemble_options *options, dvi_ensemble **ensemble);

/** Free an ensemble, end its threads, and set the pointer to NULL; NULL is allowed. */
void dvi_ensemble_destroy(dvi_ensemble **ensemble);

/** Put all members at time t in states q [nq*members], p [nv*members]: coordinate i of member k is
 * q[i*members + k].
 *
 *  On any failure all old states stay; the error sentence names the first member that cannot start.
 *  Allocates.
 *  @retval DVI_NO_MEMORY
 *  @retval (others)  as dvi_integrator_start */
dvi_status dvi_ensemble_start(dvi_ensemble *ensemble, double t, const double *q, const double *p);

/** The same in states q [nq*members], v [nv*members], with p = L_v(t,q,v).
 *
 *  @retval (others)  as dvi_integrator_start_velocity */
dvi_status dvi_ensemble_start_velocity(dvi_ensemble *ensemble, double t, const double *q,
                                       const double *v);

/** Take one step of length h with every member: dvi_ensemble_advance with one step. */
dvi_status dvi_ensemble_step(dvi_ensemble *ensemble, double h);

/** Take so many steps of length h (negative: backward) with every member.
 *
 *  A block of members takes all of them before the next block begins, so that it stays in the
 *  processor's cache: few calls with many steps are faster than many calls.
 *
 *  A member whose step fails stays where it was before that step, and takes no more steps in this
 *  call; all others go on. The next call tries it again, from its own time. The status is a fatal
 *  one if a member has one, else a positive one if a member has one, of the first such member; the
 *  error sentence names that member, its time and what failed, and says how many failed.
 *  @retval DVI_BAD_ARGUMENT  h is zero, not finite or so small that 1/h = Inf, or steps is
 *                            negative: no member moves
 *  @retval DVI_BAD_STATE     before dvi_ensemble_start
 *  @retval (others)          as dvi_integrator_step, for the member named */
dvi_status dvi_ensemble_advance(dvi_ensemble *ensemble, double h, long steps);

/** Copy out the states: times t [members], coordinates q [nq*members], momenta p [nv*members], as
 * dvi_ensemble_start has them; any may be NULL.
 *
 *  @retval DVI_BAD_STATE  before dvi_ensemble_start */
dvi_status dvi_ensemble_state(const dvi_ensemble *ensemble, double *t, double *q, double *p);

/** How the last dvi_ensemble_advance or dvi_ensemble_step went for this member; DVI_OK before the
 *  first one, DVI_BAD_ARGUMENT if there is no such member. */
dvi_status dvi_ensemble_status(const dvi_ensemble *ensemble, int member);

/** How many steps this member has taken since dvi_ensemble_start; 0 if there is no such member. */
long dvi_ensemble_steps(const dvi_ensemble *ensemble, int member);

/** All invariants of one member at its state, as dvi_integrator_invariants gives them.
 *
 *  @param[out] value  [dvi_system_invariant_count]
 *  @retval DVI_BAD_ARGUMENT  there is no such member
 *  @retval (others)          as dvi_integrator_invariants */
dvi_status dvi_ensemble_invariants(dvi_ensemble *ensemble, int member, double *value);

/** Number of members; 0 for NULL. */
int dvi_ensemble_members(const dvi_ensemble *ensemble);

/** The method's full specification, every key spelled out, as member 0 has it (a frequency that
 *  multiscale finds may differ from system to system); owned by the ensemble; NULL for NULL. */
const char *dvi_ensemble_method(const dvi_ensemble *ensemble);

/** The sum of what the members' own integrators would count, however they are grouped: members side
 *  by side are counted as if each were alone. Only of `jacobians`, `hessians` and `factorizations`
 *  there may be more: an integrator keeps the Jacobian that simplified Newton's method has frozen,
 *  a thread of an ensemble that of one member at a time. `allocations`, `preparations` and
 *  `symbolic` are those of this ensemble, whose threads prepare a solver once for all members; a
 *  step allocates only then. All 0 for NULL. */
void dvi_ensemble_counters(const dvi_ensemble *ensemble, dvi_counters *counters);

/** Say in words how the members are grouped, and what dvi_integrator_explain says of the method.
 *
 *  @return the length of the whole text (without the 0 at its end); text holds as much of it as
 *          fits, always ended by 0. */
size_t dvi_ensemble_explain(const dvi_ensemble *ensemble, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
