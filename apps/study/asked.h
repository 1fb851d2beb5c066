/** What errors that were asked for cost, integrator by integrator: the --at of dvi bench. */
#ifndef ASKED_H
#define ASKED_H
#include "study/work_report.h"
#include "csv/table.h"

/** The table: for each asked error a row for each integrator. NULL, or not table_good, without
 * memory. */
result_table *asked_table(const bench_results *results, const numbers *asked);

/** Print it, an asked error after the other. */
void asked_print(const bench_results *results, const numbers *asked, const result_table *rows,
                 FILE *stream);
#endif
