/** What a bench found, as tables for people, CSV files and a plot. */
#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H
#include <stdbool.h>

#include "plot/axes.h"
#include "bench/bench_job.h"
#include "cli/numbers.h"

/** All that was measured. */
typedef struct bench_results {
  const problem *scene;
  const judgement *judge;
  double t_end;
  bool one_point; /**< callbacks of the one-point shape */
  long rounds;
  int jobs;
  bench_job *job; /**< [jobs] in the order of the table: all settings of one integrator, then of the
                     next */
  spread calibration; /**< machine_multiplications, once a round */
} bench_results;

/** Where the results go; NULL: nowhere, "-": standard output, and all words to standard error. */
typedef struct bench_outputs {
  const char *csv, *plot, *at_csv;
  plot_axes axes; /**< of the plot */
  numbers asked;  /**< errors at which the integrators are compared */
} bench_outputs;

/** The columns of the table, ended by one without a title. */
extern const table_column bench_columns[];

/** One past the last job of the integrator that job `first` belongs to. */
int bench_group_end(const bench_results *results, int first);

/** Print and write everything. Returns DONE, or complains and returns FAILED. */
int bench_report(const bench_results *results, const bench_outputs *outputs);
#endif
