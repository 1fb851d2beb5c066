/** An ensemble: many members, each with its own state, advanced by one method in one call. */
#ifndef DVI_ENSEMBLE_H
#define DVI_ENSEMBLE_H
#include <dvi/integrator.h>
#include <stddef.h>
#include <stdint.h>
#include <dvi/shapes.h>

/** Members differ in their initial states, or in the parameters of their systems. Each member has
 *  the digits of a dvi_integrator that runs it alone, bit for bit, on every processor, for every
 *  number of threads and however the members are grouped.
 *
 *  Members side by side are the lanes of vectors, and one batch callback evaluates all their
 *  points. The section "Ensembles" of docs/guide.md has the methods and systems for which this is
 *  so. Everything else goes member by member, as an integrator does. An ensemble serves one caller
 *  at a time. */
typedef struct dvi_ensemble dvi_ensemble;

/** Options of an ensemble. Zero means default. */
typedef struct dvi_ensemble_options {
  int members; /**< number of members, at least 1 */
  /** Threads that share the members, counting the caller's (default 1). With more than one,
   *  callbacks run at the same time on several threads, and the data at their `user` must allow
   *  this. Each of these threads makes the method's own threads (verlet's key). */
  int threads;
  /** Members that are worked on together, side by side. 1 means member by member. The default
   *  follows from the system's size. The block changes speed alone. */
  int block;
  /** [members] the system of each member, for sweeps of parameters. The array is copied, and the
   *  systems must outlive the ensemble. By default all have that of dvi_ensemble_create.
   *
   *  The systems must declare the same terms, masses, patterns, names, derivatives and reaches, and
   *  differ in what their callbacks compute. Only neighbours with the same system are worked on
   *  side by side. Methods that treat the fast potentials apart (imex, respa, mollified, trig,
   *  multiscale that finds the fast part, compositions of imex) keep parts, modes or factors of a
   *  system. An integrator is then made for each group of neighbours with one system, so put
   *  members of one system next to each other. */
  const dvi_system *const *systems;
  /** Functions of your own for `shaped-galerkin`, as in dvi_integrator_options. Copied. With more
   *  threads than one their callbacks run at the same time, too. May be NULL. */
  const dvi_shapes *shapes;
} dvi_ensemble_options;

/** Arrays of the caller for the states of an ensemble at several times. Each may be NULL. */
typedef struct dvi_ensemble_rows {
  size_t size;   /**< sizeof(dvi_ensemble_rows) */
  double *t;     /**< [rows*members] */
  double *q, *p; /**< [rows*nq*members], [rows*nv*members], each row as dvi_ensemble_state has it */
} dvi_ensemble_rows;

#ifdef __cplusplus
extern "C" {
#endif

/** Make an ensemble.
 *
 *  A batch callback must give each point the bits that it gives that point alone, at any place in a
 *  batch of any count. Plain loops over the points do, unless they are compiled with -ffast-math.
 *  @param      system    system of all members, must outlive the ensemble. NULL if options->systems
 *                        names the systems
 *  @param      method    a specification, see dvi/method.h
 *  @param[out] ensemble  owned by the caller. NULL on failure
 *  @retval DVI_BAD_SIZE      members, threads or block is out of range (members 1 or more, threads
 *                            up to 1024)
 *  @retval DVI_BAD_ARGUMENT  an argument is NULL, system and systems are both given, or a system
 *                            differs from the first one
 *  @retval DVI_UNSUPPORTED   the method chooses its steps, so that members would part in time
 *  @retval DVI_NO_MEMORY     also if the operating system gives no more threads
 *  @retval (others)          as dvi_integrator_create */
dvi_status dvi_ensemble_create(const dvi_system *system, const char *method,
                               const dvi_ensemble_options *options, dvi_ensemble **ensemble);

/** Free an ensemble, end its threads, and set the pointer to NULL. NULL is allowed. */
void dvi_ensemble_destroy(dvi_ensemble **ensemble);

/** Put all members at time t in states q [nq*members], p [nv*members]. Coordinate i of member k is
 *  q[i*members + k].
 *
 *  On any failure all old states stay, and the error sentence names the first member that cannot
 *  start. The call allocates.
 *  @retval DVI_NO_MEMORY  memory could not be allocated
 *  @retval (others)       as dvi_integrator_start */
dvi_status dvi_ensemble_start(dvi_ensemble *ensemble, double t, const double *q, const double *p);

/** Put all members at time t in states q [nq*members], v [nv*members], with p = L_v(t,q,v).
 *  Otherwise this is dvi_ensemble_start.
 *
 *  @retval (others)  as dvi_integrator_start_velocity */
dvi_status dvi_ensemble_start_velocity(dvi_ensemble *ensemble, double t, const double *q,
                                       const double *v);

/** Take one step of length h with every member, as dvi_ensemble_advance with one step. */
dvi_status dvi_ensemble_step(dvi_ensemble *ensemble, double h);

/** Take `steps` steps of length h (negative: backward) with every member.
 *
 *  A block of members takes all of its steps before the next block begins, so that it stays in the
 *  processor's cache. Few calls with many steps are therefore faster than many calls.
 *
 *  A member whose step fails stays at the state before that step, and takes no more steps in this
 *  call. All others go on. The next call tries the member again, from its own time. The status is a
 *  fatal one if a member has one, else a positive one if a member has one. It is that of the first
 *  such member. The error sentence names that member, its time and the failure, and counts the
 *  members that failed.
 *  @retval DVI_BAD_ARGUMENT  h is zero, not finite or so small that 1/h = Inf, or steps is
 *                            negative. No member moves
 *  @retval DVI_BAD_STATE     before dvi_ensemble_start
 *  @retval (others)          as dvi_integrator_step, for the member named */
dvi_status dvi_ensemble_advance(dvi_ensemble *ensemble, double h, long steps);

/** Copy the states: times t [members], coordinates q [nq*members] and momenta p [nv*members], in
 *  the order of dvi_ensemble_start. Each array may be NULL.
 *
 *  @retval DVI_BAD_STATE  before dvi_ensemble_start */
dvi_status dvi_ensemble_state(const dvi_ensemble *ensemble, double *t, double *q, double *p);

/** Record states: those at present, and then `count` - 1 rows more, each after `every` steps.
 *
 *  @retval DVI_BAD_ARGUMENT  count or every is below 1, or as dvi_ensemble_advance
 *  @retval (others)          as dvi_ensemble_advance. The rows before are filled, and the members
 *                            stand where it left them */
dvi_status dvi_ensemble_record(dvi_ensemble *ensemble, double h, long every, int64_t count,
                               const dvi_ensemble_rows *rows);

/** Return this member's status of the last dvi_ensemble_advance or dvi_ensemble_step. DVI_OK before
 *  the first one, DVI_BAD_ARGUMENT if there is no such member. */
dvi_status dvi_ensemble_status(const dvi_ensemble *ensemble, int member);

/** Return the number of steps of this member since dvi_ensemble_start. 0 if there is no such
 *  member. */
long dvi_ensemble_steps(const dvi_ensemble *ensemble, int member);

/** Evaluate all invariants of one member at its state, as dvi_integrator_invariants.
 *
 *  @param[out] value  [dvi_system_invariant_count]
 *  @retval DVI_BAD_ARGUMENT  there is no such member
 *  @retval (others)          as dvi_integrator_invariants */
dvi_status dvi_ensemble_invariants(dvi_ensemble *ensemble, int member, double *value);

/** Return the number of members. 0 for NULL. */
int dvi_ensemble_members(const dvi_ensemble *ensemble);

/** Return the method's full specification, every key spelled out, as member 0 has it (a frequency
 *  that multiscale finds may differ from system to system). Owned by the ensemble. NULL for
 *  NULL. */
const char *dvi_ensemble_method(const dvi_ensemble *ensemble);

/** Sum the counters that the members' own integrators would have, however the members are grouped.
 *
 *  Members side by side are counted as if each were alone. Only `jacobians`, `hessians` and
 *  `factorizations` may be larger. An integrator keeps the frozen Jacobian of simplified Newton's
 *  method, while a thread of an ensemble keeps that of one member at a time. `allocations`,
 *  `preparations` and `symbolic` are those of this ensemble, whose threads prepare a solver once
 *  for all members. A step allocates only then. All counters are 0 for NULL. */
void dvi_ensemble_counters(const dvi_ensemble *ensemble, dvi_counters *counters);

/** Say in words how the members are grouped, and append the text of dvi_integrator_explain.
 *
 *  @return the length of the whole text (without the 0 at its end). text holds as much of it as
 *          fits, always ended by 0. */
size_t dvi_ensemble_explain(const dvi_ensemble *ensemble, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
