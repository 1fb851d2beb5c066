/** One setting of a bench: a whole job, from creation to the last step, that can be repeated. */
#ifndef BENCH_JOB_H
#define BENCH_JOB_H
#include "mechanics/judge.h"
#include "load/pacing.h"
#include "problem.h"
#include "study/samples.h"

enum { SETTING_SIZE = 32 };

/** A method at a step, or a peer at a tolerance. */
typedef struct bench_job {
  const char *integrator;     /**< its name in the table */
  char setting[SETTING_SIZE]; /**< "h=0.05" or "tol=1e-08" */
  int peer;                   /**< a peer's number; -1: a method */
  const char *method;         /**< of a method: its specification */
  pacing how;                 /**< what its steps follow */
  double h;                   /**< its step */
  long steps;                 /**< as asked, in equal parts of the span */
  long taken; /**< as they were taken: those that a peer chose, a method that chooses, or another
                 time */
  double tolerance; /**< of a peer */
  double error, energy_error;
  long evaluations;
  double tried;                /**< seconds of the first run */
  long repeats;                /**< jobs in one measurement */
  double cpu[ROUNDS_MAX];      /**< seconds of one job, in each round */
  spread seconds;              /**< of all rounds; set when they are over */
  double creation[ROUNDS_MAX]; /**< the part of them that the integrator's creation took; NaN for
                                  peers */
  double creation_seconds;     /**< median of all rounds; set when they are over */
} bench_job;

/** The times at which the energy of a peer's run is looked at: so many, evenly spaced, the last one
 * the end. */
enum { ENERGY_TIMES = 8 };

/** Run the job once: fills error, evaluations, tried, for peers energy_error and steps, and
 * repeats. A peer is run from the start to each of the ENERGY_TIMES, because it shows its state at
 * the end only. */
dvi_status bench_job_try(bench_job *job, const problem *scene, const judgement *judge,
                         double t_end);

/** Measure the job in one round. */
dvi_status bench_job_time(bench_job *job, const problem *scene, double t_end, int round);
/** Set what the rounds have in common. Sorts them. */
void bench_job_finish(bench_job *job, int rounds);
#endif
