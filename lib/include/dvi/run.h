/** The run driver: many steps, with observers, events, stop conditions and checkpoints. */
#ifndef DVI_RUN_H
#define DVI_RUN_H
#include <dvi/integrator.h>

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

#ifdef __cplusplus
}
#endif
#endif
