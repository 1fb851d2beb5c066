/** One method on one problem at one step size after another, up to the same time. */
#ifndef STUDY_H
#define STUDY_H
#include "mechanics/judge.h"
#include "load/open.h"
#include "problem.h"
#include "cli/progress.h"

/** An error must exceed what blurs it by this factor to count. */
#define STUDY_FLOOR_MARGIN 10.0

/** What is studied. */
typedef struct order_study {
  const problem *scene;
  const judgement *judge;
  const char *method; /**< its name in tables */
  double t_end;
  double span; /**< the sum of the steps: t_end, or what it is in the time of the steps */
  dvi_integrator *integrator; /**< owned */
  progress_line *progress;    /**< shown while it runs; NULL: none */
  int order;                  /**< that the method claims */
  double first_error; /**< where the first level's error should lie, relative to study_size; 0:
                         chosen by the order */
  double ceiling;     /**< errors above this are too large to tell an order */
  double floor;       /**< errors up to this belong to roundoff or to the judge */
} order_study;

/** What came out at one step size. */
typedef struct level_trial {
  long steps;
  long taken;          /**< the same, but where steps are chosen */
  double h;            /**< span / steps; of methods that choose their steps the first one */
  double error;        /**< of q at t_end, in the maximum norm */
  double energy_error; /**< largest |energy - energy at the start| over the run */
  double distance;     /**< largest distance of q from its manifold over the run */
  double cpu_seconds;  /**< of one run without diagnostics */
  dvi_counters spent;  /**< by one run without diagnostics */
} level_trial;

/** Begin a study of a method, whose steps may follow a monitor. Returns DONE, or complains and
 * returns the exit code. */
int study_init(order_study *study, const problem *scene, const judgement *judge, const char *method,
               const pacing *how, double t_end);

/** Complain that the monitor leads nowhere, and return FAILED. */
int study_refuse(const order_study *study);

void study_clear(order_study *study);

/** Run once with so many equal steps: fills steps, h, error and spent. */
dvi_status study_run(order_study *study, long steps, level_trial *trial);

/** Run again, to watch the energy and the manifold: fills energy_error and distance. */
dvi_status study_watch(order_study *study, level_trial *trial);

/** Run as often as a clock needs: fills cpu_seconds. */
dvi_status study_time(order_study *study, level_trial *trial);

/** Integrate from q [n] and the problem's momenta with so many equal steps; `start` may be NULL. */
dvi_status study_integrate(order_study *study, const double *q, const dvi_start_options *start,
                           long steps);

/** Size of the solution at the end, in the maximum norm; 1 if it is 0. */
double study_size(const order_study *study);

/** How often something that takes so many seconds is to be run in one measurement, so that the
 * clock can tell. */
long study_repeats(double seconds);

/** Process time in seconds. */
double cpu_now(void);

/** Elapsed time in seconds, from some moment on: for work on several threads. */
double elapsed_now(void);
#endif
