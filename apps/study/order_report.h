/** Reports of order studies by tables, verdicts and a plot. */
#ifndef ORDER_REPORT_H
#define ORDER_REPORT_H
#include <stdio.h>

#include "plot/axes.h"
#include "study/order.h"

/** Print each subject's levels, aligned, with `problem` above them. */
void order_print_tables(const char *problem, const result_table *rows, int results,
                        const order_result *result);

/** Print the judge of a subject, and whether the subject has its order. */
void order_print_verdict(FILE *stream, const order_result *result);

/** Draw columns of the table against each other into an SVG file, the error against the length with
 * the claimed slopes. Complains and returns false if it cannot be written. */
bool order_plot(const char *problem, const result_table *rows, const plot_axes *axes, int results,
                const order_result *result, const char *path);
#endif
