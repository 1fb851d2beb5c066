/** What order studies found: as tables, verdicts and a plot. */
#ifndef ORDER_REPORT_H
#define ORDER_REPORT_H
#include <stdio.h>

#include "plot/axes.h"
#include "study/order.h"

/** Each subject's levels, aligned; `problem` stands above them. */
void order_print_tables(const char *problem, const result_table *rows, int results,
                        const order_result *result);

/** Who judged a subject, and whether it has its order. */
void order_print_verdict(FILE *stream, const order_result *result);

/** Columns of the table against each other, the error against the length with the claimed slopes,
 * as an SVG file. False, with a complaint, if it cannot be written. */
bool order_plot(const char *problem, const result_table *rows, const plot_axes *axes, int results,
                const order_result *result, const char *path);
#endif
