/** One setting of a bench: a whole job, from creation to the last step, that can be repeated. */
#ifndef BENCH_JOB_H
#define BENCH_JOB_H
#include "judge.h"
#include "problem.h"

enum { ROUNDS_MAX = 99, SETTING_SIZE = 32 };

/** A method at a step, or a SUNDIALS code at a tolerance. */
typedef struct bench_job {
  const char *integrator;     /**< its name in the table */
  char setting[SETTING_SIZE]; /**< "h=0.05" or "tol=1e-08" */
  long steps;                 /**< of a method; 0: it is a code */
  dvi_reference_code code;
  double tolerance;
  double error, energy_error;
  long evaluations;
  long repeats;           /**< jobs in one measurement */
  double cpu[ROUNDS_MAX]; /**< seconds of one job, in each round */
} bench_job;

/** Run the job once: fills error, evaluations, for codes energy_error, and repeats. */
dvi_status bench_job_try(bench_job *job, const problem *scene, const judgement *judge, double t_end);

/** Measure the job in one round. */
dvi_status bench_job_time(bench_job *job, const problem *scene, double t_end, int round);

/** Median over the rounds. Sorts the measurements. */
double bench_job_median(bench_job *job, int rounds);
#endif
