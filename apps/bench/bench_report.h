/** What a bench found, as tables for people, CSV files and a plot. */
#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H
#include <stdbool.h>

#include "bench/whole_job.h"
#include "cli/numbers.h"
#include "plot/axes.h"
#include "study/asked.h"
#include "study/work.h"
#include "study/work_table.h"

/** Where the results go; NULL: nowhere, "-": standard output, and all words to standard error. */
typedef struct bench_outputs {
  const char *csv, *plot, *at_csv;
  table_column columns[WORK_COLUMNS_MAX]; /**< of the table */
  plot_axes axes;                         /**< of the plot */
  numbers asked;                          /**< errors at which the integrators are compared */
} bench_outputs;

/** All that was measured, of whole jobs. */
typedef struct bench_results {
  const judged_motion *motion;
  bool one_point; /**< callbacks of the one-point shape */
  const work *work;
} bench_results;

/** Print and write everything. Returns DONE, or complains and returns FAILED. */
int bench_report(const bench_results *results, const bench_outputs *outputs);
#endif
