/** The run driver: many steps, with observers, events, stop conditions and checkpoints, and
 *  recordings, which are the numbers of a run in arrays.
 *
 *  dvi_record advances an integrator as dvi_run does, and keeps what is asked for: row by row at
 *  the start, after every `every` steps and at the end, or at given times inside the steps. Each
 *  part of a row has an array of its own, row after row, without gaps. */
#ifndef DVI_RUN_H
#define DVI_RUN_H
#include <dvi/integrator.h>
#include <stddef.h>
#include <stdint.h>

/** A function g(t,q,v) whose zeros along the trajectory are wanted. */
typedef struct dvi_event {
  const char *name;
  int (*value)(double t, const double *q, const double *v, double *g, void *user);
  /** +1: g rises through zero, -1: g falls, 0: both. The sense is that of the run */
  int direction;
  /** not 0 if the run ends at the event. The step is taken again, up to the event */
  int terminal;
  /** Called at each event, at the time where the step's polynomial has g = 0, right to 1e-12 of
   *  the step and a few roundings of t. May be NULL.
   *  Return 0 to go on, >0 to end the run, <0 to fail. */
  int (*occurred)(double t, const double *q, const double *v, void *user);
  void *user;
} dvi_event;

/** Options of a run. Zero means default. */
typedef struct dvi_run_options {
  /** the step, or the first step of methods that choose their steps. Its sign must lead from the
   *  current time to t_end */
  double h;
  /** end of the run. A last, shorter step ends there if h does not divide the interval, or if the
   *  method chooses its steps */
  double t_end;
  long every; /**< observer interval in steps (default 1) */
  /** Called at the start, after every `every` steps, and at the end. Return 0 to go on, >0 to end
   *  the run, <0 to fail. The observer may query the integrator, but not step, start or restore
   *  it. */
  int (*observe)(dvi_integrator *integrator, void *user);
  void *user;
  const dvi_event *events;
  int event_count;
  /** path of the checkpoint that is written when the run ends, for any reason. Default none */
  const char *checkpoint;
  long checkpoint_every; /**< checkpoint interval in steps (default: only at the end) */
  /** the run ends after the step in which this becomes not 0, or at most 32 steps later where
   *  verlet takes steps together. May be NULL */
  const volatile int *cancel;
} dvi_run_options;

/** Why a run ended. */
typedef enum dvi_run_end {
  DVI_RUN_COMPLETE,  /**< t_end was reached */
  DVI_RUN_STOPPED,   /**< the observer or an event's callback returned a positive number */
  DVI_RUN_EVENT,     /**< a terminal event */
  DVI_RUN_CANCELLED, /**< `cancel` was set */
  DVI_RUN_FAILED     /**< a step failed, as the status says */
} dvi_run_end;

/** Results of a run. */
typedef struct dvi_run_report {
  dvi_run_end end;
  long steps;        /**< accepted steps of this run */
  long events;       /**< events found */
  double event_time; /**< time of the last event found. NaN if there was none */
  int event;         /**< index of the last event found. -1 if there was none */
} dvi_run_report;

/** A recording. */
typedef struct dvi_recording dvi_recording;

/** A part of a row. Options combine parts by |. */
typedef enum dvi_record_part {
  DVI_RECORD_T = 1,           /**< [1] the time. It is always kept */
  DVI_RECORD_Q = 2,           /**< [nq] coordinates */
  DVI_RECORD_P = 4,           /**< [nv] momenta */
  DVI_RECORD_V = 8,           /**< [nv] velocities */
  DVI_RECORD_INVARIANTS = 16, /**< [dvi_system_invariant_count] energy, momenta, declared ones */
  DVI_RECORD_STEP = 32,       /**< [1] length of the last step. 0 before the first */
  DVI_RECORD_CONSTRAINT = 64, /**< [1] distance from the constraint, dvi_integrator_constraint */
  /** [dvi_system_constraint_count] multipliers, dvi_integrator_reactions */
  DVI_RECORD_REACTIONS = 128,
  DVI_RECORD_A = 256,           /**< [cells] the form A of a march, dvi_march_record alone */
  DVI_RECORD_E = 512,           /**< [cells] its form E */
  DVI_RECORD_B = 1024,          /**< [cells] its form B */
  DVI_RECORD_OBSERVABLES = 2048 /**< [observables] its energy and so on */
} dvi_record_part;

/** Options of a recording. Zero means default. */
typedef struct dvi_record_options {
  size_t size;    /**< sizeof(dvi_record_options) */
  unsigned parts; /**< parts of a row. Default: DVI_RECORD_Q | DVI_RECORD_P */
  /** [time_count] the times of the rows, in the order of the run, from its start to its end.
   *  Default: rows after steps. The path of a step is that of dvi_integrator_interpolate. Parts
   *  other than T, Q, P, V, INVARIANTS and STEP then have no rows, nor have P and INVARIANTS of a
   *  Hamiltonian. Owned by the caller */
  const double *times;
  int64_t time_count;
} dvi_record_options;

/** An event that was found in a recorded run. */
typedef struct dvi_recorded_event {
  double t;
  int event;           /**< its index in the options of the run */
  const double *q, *v; /**< [nq], [nv] the point of the path at t */
} dvi_recorded_event;

#ifdef __cplusplus
extern "C" {
#endif

/** Advance the integrator from its current time to t_end.
 *
 *  An event is seen if g has different signs at two neighbouring points of the step (ends and
 *  quarters). An event is also seen if g is zero at the later one of two points and was not at the
 *  earlier one. A touch from above counts as falling, one from below as rising. A g that stays zero
 *  gives no event. Events are reported in the order of the run, up to the first one that ends it.
 *  If an event's function fails in a step, the step is taken back before any of its events is
 *  reported.
 *  @param[out] report  filled on success and on failure. May be NULL
 *  @retval DVI_OK            the run ended as `report->end` says (not DVI_RUN_FAILED)
 *  @retval DVI_BAD_ARGUMENT  h is zero, not finite, leads away from t_end or is less than 2^-53 of
 *                            the interval. Or a count is negative, a direction is not -1, 0 or 1,
 *                            or checkpoint_every has no file
 *  @retval DVI_BAD_STATE     before dvi_integrator_start, or the observer has moved the integrator
 *  @retval (others)          as dvi_integrator_step, for the step that failed. The state is the
 *                            last good one */
dvi_status dvi_run(dvi_integrator *integrator, const dvi_run_options *options,
                   dvi_run_report *report);

/** Run an integrator to t_end as dvi_run, and record the run.
 *
 *  The run's own observer and events are called, too, after their row or event is kept. With
 *  `times` the observer is called after every `every` steps all the same. Without observer, events
 *  and times, steps are taken together as in dvi_run, and `cancel` is looked at every 33 steps.
 *  @param      run        options of the run, with `every` for rows and observer
 *  @param      options    NULL for defaults
 *  @param[out] recording  owned by the caller. It has all rows up to a failure of the run, too.
 *                         NULL if nothing was recorded
 *  @retval DVI_BAD_ARGUMENT  a time is not finite, lies outside of the run or goes back; or a part
 *                            is unknown, or none that a row at a given time may have
 *  @retval DVI_UNSUPPORTED   the system or the integrator has no such part
 *  @retval DVI_NO_MEMORY     there is no memory for the next row
 *  @retval (others)          as dvi_run, and as the parts cannot be evaluated */
dvi_status dvi_record(dvi_integrator *integrator, const dvi_run_options *run,
                      const dvi_record_options *options, dvi_recording **recording);

/** Free a recording and set the pointer to NULL. NULL is allowed. */
void dvi_recording_destroy(dvi_recording **recording);

/** Return the number of rows. 0 for NULL. */
int64_t dvi_recording_rows(const dvi_recording *recording);

/** Return the numbers of a part [rows*width], row by row, owned by the recording.
 *
 *  @param[out] width  numbers of a row. May be NULL
 *  @return NULL if the part was not recorded, and for NULL */
const double *dvi_recording_part(const dvi_recording *recording, dvi_record_part part, int *width);

/** Evaluate DVI_RECORD_V, DVI_RECORD_INVARIANTS, or both, of all rows, from recorded coordinates
 *  and momenta. What was recorded stays. The system must still exist.
 *  @retval DVI_BAD_ARGUMENT  another part, or coordinates or momenta were not recorded
 *  @retval DVI_NO_MEMORY     memory could not be allocated
 *  @retval (others)          as dvi_system_velocity and dvi_system_invariants. Nothing was added */
dvi_status dvi_recording_derive(dvi_recording *recording, unsigned parts);

/** Return event i of the run, owned by the recording. NULL if i is out of range. */
const dvi_recorded_event *dvi_recording_event(const dvi_recording *recording, int64_t i);

/** Return the report of the run, owned by the recording. NULL for NULL. */
const dvi_run_report *dvi_recording_report(const dvi_recording *recording);

#ifdef __cplusplus
}
#endif
#endif
