/** The report of a bench, with tables for people, CSV files and a plot. */
#ifndef BENCH_REPORT_H
#define BENCH_REPORT_H
#include <stdbool.h>

#include "bench/whole_job.h"
#include "cli/numbers.h"
#include "plot/axes.h"
#include "study/asked.h"
#include "study/work.h"
#include "study/work_table.h"

/** The destinations of the results. NULL for none, "-" for standard output, in which case all words
 * go to standard error. */
typedef struct bench_outputs {
  const char *csv, *plot, *at_csv;
  table_column columns[WORK_COLUMNS_MAX]; /**< columns of the table */
  plot_axes axes;                         /**< axes of the plot */
  numbers asked;                          /**< errors at which the integrators are compared */
} bench_outputs;

/** All measurements of whole jobs. */
typedef struct bench_results {
  const judged_motion *motion;
  bool one_point; /**< callbacks have the one-point shape */
  const work *work;
} bench_results;

/** Print and write everything. Returns DONE, or complains and returns FAILED. */
int bench_report(const bench_results *results, const bench_outputs *outputs);
#endif
