/** What an order study found: as tables, verdicts and a plot. */
#ifndef ORDER_REPORT_H
#define ORDER_REPORT_H
#include <stdbool.h>
#include <stdio.h>

#include "plot/axes.h"
#include "mechanics/judge.h"
#include "load/pacing.h"
#include "problem.h"
#include "mechanics/single_steps.h"
#include "csv/table.h"

enum { LEVELS_MAX = 40 };

/** What was found for one method. */
typedef struct order_result {
  char method[PACED_NAME]; /**< with what its steps follow */
  int claimed;             /**< its order */
  bool chooses_steps;      /**< so that h is that of the first one alone */
  double t_end;            /**< where it was judged */
  char judge[JUDGE_WORDS]; /**< by whom, in words */
  double judge_error;
  int levels;
  double h[LEVELS_MAX]; /**< step sizes without sign */
  double error[LEVELS_MAX];
  double floor, ceiling; /**< errors outside are not fitted */
  dvi_order_fit fit;
  bool settled;        /**< the slope is the same all over the fitted levels */
  single_steps single; /**< asked where the span does not show the claimed order */
} order_result;

/** The order that level k and the one before it show; NaN if there is none. */
double order_local_slope(const order_result *result, int k);

/** The columns of the table; of problems with factors there is one more, the distance from their
 * manifold. */
const table_column *order_columns(const problem *scene);

/** Whether a settled slope is the claimed order. */
bool order_holds(const order_result *result);

/** Each method's levels, aligned. */
void order_print_tables(const char *name, const result_table *rows, int results,
                        const order_result *result);

/** Who judged a method, and whether it has its order. */
void order_print_verdict(FILE *stream, const order_result *result);

/** Columns of the table against each other, the error against the step with the claimed slopes, as
 * an SVG file. False, with a complaint, if it cannot be written. */
bool order_plot(const char *name, const result_table *rows, const plot_axes *axes, int results,
                const order_result *result, const char *path);
#endif
