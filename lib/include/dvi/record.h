/** Recordings: the numbers of a run in arrays.
 *
 *  dvi_record advances an integrator as dvi_run does, and keeps what is asked for: row by row at
 *  the start, after every `every` steps and at the end, or at given times inside the steps. Each
 *  part of a row has an array of its own, row after row, without gaps. */
#ifndef DVI_RECORD_H
#define DVI_RECORD_H
#include <dvi/run.h>
#include <stddef.h>
#include <stdint.h>

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
  DVI_RECORD_REACTIONS = 128
} dvi_record_part;

/** Options of a recording. Zero means default. */
typedef struct dvi_record_options {
  size_t size;    /**< sizeof(dvi_record_options) */
  unsigned parts; /**< parts of a row. Default: DVI_RECORD_Q | DVI_RECORD_P */
  /** [time_count] the times of the rows, in the order of the run, from its start to its end.
   *  Default: rows after steps. The path of a step is that of dvi_integrator_interpolate. Parts
   *  other than T, Q, P, V, INVARIANTS and STEP then have no rows. Owned by the caller */
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

/** Run an integrator to t_end as dvi_run, and record the run.
 *
 *  The run's own observer and events are called, too, after their row or event is kept. With
 *  `times` the observer is called after every `every` steps all the same.
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

/** Return event i of the run, owned by the recording. NULL if i is out of range. */
const dvi_recorded_event *dvi_recording_event(const dvi_recording *recording, int64_t i);

/** Return the report of the run, owned by the recording. NULL for NULL. */
const dvi_run_report *dvi_recording_report(const dvi_recording *recording);

#ifdef __cplusplus
}
#endif
#endif
