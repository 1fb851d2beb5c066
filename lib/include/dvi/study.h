/** Studies: the order that the errors of a method show, the time of methods against their error,
 *  and runs at all points of a grid of parameters. They are in a library of their own, dvi-study
 *  (dvi::study, pkg-config dvi-study).
 *
 *  Other studies are calls of libdvi itself: paths between two ends in dvi/path.h, modes in
 *  dvi/field.h, spectra in dvi/spectrum.h, and many members side by side in dvi/ensemble.h. */
#ifndef DVI_STUDY_H
#define DVI_STUDY_H
#include <dvi/diagnostics.h>
#include <dvi/integrator.h>
#include <dvi/run.h>
#include <stddef.h>
#include <stdint.h>

/** Limits. */
enum {
  DVI_STUDY_LEVELS_MAX = 40,     /**< largest number of levels */
  DVI_STUDY_FIT_LEAST = 4,       /**< fewer levels than this decide nothing */
  DVI_STUDY_ROUNDS_MAX = 99,     /**< largest number of rounds */
  DVI_STUDY_STEPS_MAX = 1 << 28, /**< largest number of steps that a run of a given step may have */
  DVI_STUDY_FIRST_PARTS_MAX = 1 << 24, /**< largest number of parts of a given first level */
  DVI_STUDY_FLOOR_MARGIN = 10, /**< factor by which an error must exceed disturbances to count */
  DVI_STUDY_AXES_MAX = 64,     /**< largest number of axes of a grid */
  DVI_STUDY_THREADS_MAX = 1024 /**< largest number of threads */
};

/** The runs of a study: their start, their end, and what q is at their end. */
typedef struct dvi_study_runs {
  size_t size;     /**< sizeof(dvi_study_runs) */
  double t;        /**< time of the start */
  double t_end;    /**< end of the runs, another time */
  const double *q; /**< [nq] start */
  const double *p; /**< [nv] start. Exactly one of p and v is given */
  const double *v; /**< [nv] start. NULL with p */
  /** [nq] q at t_end. At most one of `end`, `exact` and `reference` is given */
  const double *end;
  /** Write the exact q [nq] at t. Return 0, or another number on failure */
  int (*exact)(double t, double *q, void *user);
  void *user;
  int reference; /**< not 0 to compare with IDA (dvi_reference_judge at its defaults) */
  /** The study ends when this becomes not 0, within a step as in dvi_run_options, but for the run
   *  of IDA. May be NULL */
  const volatile int *cancel;
} dvi_study_runs;

/** Options of an order study. Zero means default. */
typedef struct dvi_study_order_options {
  size_t size; /**< sizeof(dvi_study_order_options) */
  /** step of the first level, without sign. Default: the levels are searched for
   *  (dvi_study_search_levels), which needs one of `end`, `exact` and `reference` */
  double h;
  double ratio; /**< ratio of neighbouring steps, above 1 (default 2, or that of the search) */
  int levels;   /**< number of levels, from 2 to DVI_STUDY_LEVELS_MAX (default 6) */
  int once;     /**< not 0 to leave short runs as they are, without repeats for the clock */
} dvi_study_order_options;

/** The result at a level. */
typedef struct dvi_study_level {
  /** step without sign. It divides the span. The first one of methods that choose their steps */
  double h;
  long steps;   /**< steps that were taken */
  double error; /**< largest difference of a coordinate at t_end */
  double slope; /**< order from the level before to this one. 0 where two errors do not tell one */
  double energy_error;   /**< largest change of the energy since the start, over all steps */
  double seconds;        /**< process time of a run */
  dvi_counters counters; /**< work of a run */
} dvi_study_level;

/** The order that the levels show. */
typedef struct dvi_study_order_result {
  int levels;  /**< levels that were measured */
  int claimed; /**< order of the method by its theory */
  /** order fitted to levels `first` to `last`. 0 and first = -1 if fewer than two levels count */
  double order;
  int first, last;
  int settled; /**< not 0 if the order is the same all over these levels (dvi_study_fit) */
  /** not 0 if the fit is settled, and within 0.2 of the claimed order. 0 for methods that choose
   *  their steps, where an error is no power of the first step */
  int holds;
  double judge_error; /**< error of the reference. 0 where none is known */
  /** Errors up to the floor, ten times the judge's error or a rounding of q, and from the ceiling
   *  on, 1 % of the largest coordinate, are not fitted */
  double floor, ceiling;
  /** not 0 if `cancel` ended the study. The levels before are there, without a fit */
  int cancelled;
} dvi_study_order_result;

/** Repeated measurements in a few numbers. Half of them lie between the quartiles. */
typedef struct dvi_study_spread {
  double least;  /**< least of all */
  double lower;  /**< lower quartile */
  double median; /**< median */
  double upper;  /**< upper quartile */
} dvi_study_spread;

/** A method at a step. */
typedef struct dvi_study_job {
  const char *method; /**< specification, given by the caller */
  double h;           /**< step without sign, given by the caller */
  /** DVI_OK, or the status above 0 with which the run failed. All numbers below are then 0 */
  dvi_status status;
  int cancelled; /**< not 0 if `cancel` ended the study. The other numbers of all jobs are then 0 */
  double error;  /**< largest difference of a coordinate at t_end */
  dvi_counters counters;    /**< work of a run */
  dvi_study_spread seconds; /**< process time of a run, over the rounds */
} dvi_study_job;

/** A search for levels: runs of anything that is divided into parts, such as steps, whose error
 *  falls by an order. Zero means default. */
typedef struct dvi_study_search {
  size_t size;           /**< sizeof(dvi_study_search) */
  int levels;            /**< number of levels, from 1 to DVI_STUDY_LEVELS_MAX */
  int order;             /**< claimed order, at least 1 */
  double span;           /**< interval that is divided into parts, not 0 */
  double first_parts;    /**< parts at which the search begins (default 1) */
  double size_of_result; /**< size of the result, above 0 */
  double judge_error;    /**< error of what the runs are compared with */
  /** length of the first level's parts, at most DVI_STUDY_FIRST_PARTS_MAX of them (default:
   *  searched) */
  double length;
  double ratio; /**< ratio of neighbouring lengths (default: chosen) */
  /** error of a first level that is searched, relative to the size of the result (default: the
   *  larger, the lower the order) */
  double first_error;
  int may_miss; /**< not 0 if runs with any number of parts may end far from the result */
  /** Run once, and measure the error. A status above 0 if this level has no result but another one
   *  may have, below 0 to end the search */
  dvi_status (*run)(double parts, double *error, void *user);
  /** Measure how far roundoff moves the result, with a status as that of `run`. May be NULL */
  dvi_status (*roundoff)(double parts, double *moved, void *user);
  void *user;
} dvi_study_search;

/** The levels that were found. */
typedef struct dvi_study_levels {
  /** [levels] ascending. The first is 0, and nothing else is known, if all levels of a search that
   *  may miss fail or miss the result altogether */
  long parts[DVI_STUDY_LEVELS_MAX];
  double ceiling; /**< errors from this one on are too large to tell an order */
  double floor;   /**< errors up to this one belong to roundoff or to the judge */
  int room; /**< not 0 if the levels fit above the floor. Else so few parts reach it that they do
             *   not */
} dvi_study_levels;

/** A parameter of a grid, and its values. */
typedef struct dvi_study_axis {
  int64_t count; /**< number of values, at least 1 */
  /** [count] NULL if the values are no numbers, and the caller knows them by their index */
  const double *value;
} dvi_study_axis;

/** A point of a grid: one value of each axis. */
typedef struct dvi_study_point {
  int64_t number;       /**< from 0. The last axis changes from one point to the next */
  const int64_t *index; /**< [axes] index of the value of each axis */
  const double *value;  /**< [axes] NaN where the values are no numbers */
} dvi_study_point;

/** The run at a point. */
typedef struct dvi_study_run {
  /** made and started by `open`, on a system that it may have made, too */
  dvi_integrator *integrator;
  /** as for dvi_run. The observer is called after that of the sweep. `cancel` must be NULL */
  dvi_run_options options;
  void *user; /**< for `found` and `close` */
} dvi_study_run;

/** What a run came to. */
typedef struct dvi_study_row {
  dvi_status status;     /**< DVI_OK, or the status with which `open` or the run failed */
  const char *sentence;  /**< why it failed. NULL if it did not */
  dvi_run_report report; /**< why the run ended, and the number of its steps and events */
  double t;              /**< time of the end. NaN if there was no run */
  const double *q, *p;   /**< [nq], [nv] the end. NULL if there was no run */
  /** [dvi_system_invariant_count] the invariants where an observer was last called, which is the
   *  end unless the run failed. NULL if it was never called */
  const double *invariant;
  /** [nq] smallest and largest coordinates where an observer was called. NULL if it was never
   *  called, and unless they are asked for */
  const double *least, *most;
  /** largest change of the energy since the start, less what forces supplied if the integrator
   *  keeps balances, where an observer was called. NaN if it was never called */
  double energy_error;
} dvi_study_row;

/** A sweep. Zero means default. The callbacks return DVI_OK or 0 if all is well. */
typedef struct dvi_study_sweep_options {
  size_t size; /**< sizeof(dvi_study_sweep_options) */
  int axes;    /**< number of axes, from 1 to DVI_STUDY_AXES_MAX */
  const dvi_study_axis *axis;
  /** Points `part`, part + parts, .. of the grid alone, with the bits that they have in a sweep of
   *  all of it: 0 <= part < parts (default all of them) */
  int64_t part, parts;
  const char *skip; /**< [points of the grid] not 0 for points to leave out. May be NULL */
  int threads;      /**< runs at a time, up to DVI_STUDY_THREADS_MAX (default 1) */
  int extremes;     /**< not 0 for `least` and `most` of each row */
  /** Make the run of a point, which is all zero before. Called from several threads at once. On
   *  failure the point has a row all the same, without a run */
  dvi_status (*open)(const dvi_study_point *point, dvi_study_run *run, void *user);
  /** Take a row, valid during the call. Called by one thread at a time, in the order in which runs
   *  end. A number other than 0 ends the sweep with DVI_CALLBACK_FAILED */
  int (*found)(const dvi_study_point *point, const dvi_study_run *run, const dvi_study_row *row,
               void *user);
  /** Free what `open` made, also where it failed. Called from several threads at once. May be
   *  NULL, and the integrators are then destroyed */
  void (*close)(dvi_study_run *run, void *user);
  void *user;
  /** The sweep ends when this becomes not 0. Runs under way end as in dvi_run_options, and have no
   *  rows. May be NULL */
  const volatile int *cancel;
} dvi_study_sweep_options;

/** How far a sweep came. */
typedef struct dvi_study_sweep_report {
  int64_t rows;   /**< points that have rows */
  int64_t failed; /**< points whose rows have another status than DVI_OK */
  int cancelled;  /**< not 0 if `cancel` ended the sweep before its last point */
} dvi_study_sweep_report;

#ifdef __cplusplus
extern "C" {
#endif

/** Measure the order of a method. Each level is a run from t to t_end in equal steps. The error is
 *  that of q at t_end against `end`, `exact` or the reference. Where none of them is given,
 *  neighbouring levels are compared, for which one more level is run.
 *
 *  The step of each level is the nearest one that divides the span. Runs that take less than 20 ms
 *  are repeated for the clock, unless `once` is set. One further run of each level watches
 *  the energy.
 *  @param[out] level   [options->levels] the levels, as far as they were measured
 *  @param[out] result  the fitted order. Filled on failure, too, as far as it is known
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, a size is none of its struct, a number is out of
 *                            range, or more than one of `end`, `exact` and `reference` is given
 *  @retval DVI_CALLBACK_FAILED  `exact` failed
 *  @retval DVI_NOT_FINITE    a time, `end`, or what `exact` wrote is not finite
 *  @retval DVI_NO_MEMORY     memory could not be allocated
 *  @retval (others)          as dvi_integrator_create, dvi_integrator_start, dvi_run,
 *                            dvi_integrator_invariants and dvi_reference_judge */
dvi_status dvi_study_order(const dvi_system *system, const char *method, const dvi_study_runs *runs,
                           const dvi_study_order_options *options, dvi_study_level *level,
                           dvi_study_order_result *result);

/** Search for levels whose errors lie between what is too large to tell an order and what roundoff
 *  or the judge makes of it. Each level at most halves the length, and less for high orders, of
 *  which a halving would cross the floor at once.
 *
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, the size is not that of the struct, or a number is
 *                            out of range
 *  @retval (others)          of `run` and `roundoff`: those below 0, and those above 0 if even the
 *                            finest level fails */
dvi_status dvi_study_search_levels(const dvi_study_search *wanted, dvi_study_levels *found);

/** Measure the process time of methods against their error. Every round runs every job once, or as
 *  often as the clock needs, so that whatever slows the machine for a while slows all of them.
 *
 *  @param[in,out] job     [count] methods with their steps. A run that fails by a status above 0
 *                         leaves it in its job, and the study goes on
 *  @param         count   number of jobs, at least 1
 *  @param         rounds  from 1 to DVI_STUDY_ROUNDS_MAX
 *  @retval DVI_BAD_ARGUMENT  as dvi_study_order, or none of `end`, `exact` and `reference` is given
 *  @retval (others)          as dvi_study_order */
dvi_status dvi_study_work(const dvi_system *system, const dvi_study_runs *runs, int count,
                          dvi_study_job *job, int rounds);

/** Run a method at each point of a grid, on several threads. A point has the same bits whatever the
 *  threads, the part and the other points are.
 *
 *  @param[out] report  filled on failure, too. May be NULL
 *  @retval DVI_OK            every point has its row, or report->cancelled is set. Runs that fail
 *                            leave their status in their rows
 *  @retval DVI_BAD_ARGUMENT  a pointer is NULL, the size is not that of the struct, or a number is
 *                            out of range
 *  @retval DVI_CALLBACK_FAILED  `found` returned another number than 0
 *  @retval DVI_BAD_STATE     `open` gave no integrator, or set `cancel` of its options
 *  @retval DVI_NO_MEMORY     memory could not be allocated */
dvi_status dvi_study_sweep(const dvi_study_sweep_options *options, dvi_study_sweep_report *report);

/** Count the points of a grid, the product of the numbers of values. -1 if there are no axes, too
 *  many of them, an axis without values, or more points than an int64_t can count. */
int64_t dvi_study_points(int axes, const dvi_study_axis *axis);

/** Write equally spaced values, both ends included: from + (to - from) k/(count - 1), and `to`
 *  itself as the last one.
 *
 *  @param      count  at least 2
 *  @param[out] value  [count]
 *  @retval DVI_BAD_ARGUMENT  count is below 2, a number is not finite, or the range is too wide for
 *                            a double. No value is written */
dvi_status dvi_study_range(double from, double to, int64_t count, double *value);

/** Call work(user) on so many threads at once, the caller's among them. If the operating system
 *  gives no more threads, the work goes on with fewer. Returns when all of them are done.
 *
 *  @param threads  from 1 to DVI_STUDY_THREADS_MAX. Other numbers become the nearest one */
void dvi_study_parallel(int threads, void (*work)(void *user), void *user);

/** Return the number of cores of this machine, at most DVI_STUDY_THREADS_MAX. */
int dvi_study_cores(void);

/** Fit an order to the longest run of levels with a settled slope. The slopes of its coarser and
 *  its finer half agree within 0.1, and the standard error of the fitted slope is at most 0.05. Of
 *  equally long runs the finest is taken. The function does not know which order is claimed.
 *
 *  @param      levels    number of levels
 *  @param      h, error  [levels] h is positive and descending
 *  @param      floor     errors up to this one are left out
 *  @param      ceiling   errors from this one on are left out
 *  @param[out] fit       the fit, that of dvi_order if there is no such run
 *  @return not 0 if there is such a run */
int dvi_study_fit(int levels, const double *h, const double *error, double floor, double ceiling,
                  dvi_order_fit *fit);

/** Return the least value, quartiles and median of sample [count], count >= 1, interpolated
 *  linearly between neighbours (Hyndman and Fan's type 7). Sorts the sample. */
dvi_study_spread dvi_study_spread_of(int count, double *sample);

/** Return the process time in seconds. */
double dvi_study_clock(void);

/** Return how many runs of so many seconds each make one measurement that the clock resolves, which
 *  takes 20 ms. */
long dvi_study_repeats(double seconds);

#ifdef __cplusplus
}
#endif
#endif
