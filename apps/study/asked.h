/** What errors that were asked for cost, subject by subject. */
#ifndef ASKED_H
#define ASKED_H
#include <stdio.h>

#include "csv/table.h"
#include "study/work.h"

/** Fill in the columns of the table, ended by one without a title. Of what the subjects count the
 *  first is a cost beside the time. */
enum { ASKED_COLUMNS_MAX = 12 };
void asked_columns(const study_words *words, table_column *columns);

/** The table: for each asked error a row for each subject. NULL, or not table_good, without
 *  memory. */
result_table *asked_table(const work *w, const table_column *columns);

/** Print it, an asked error after the other. */
void asked_print(const work *w, const result_table *rows, FILE *stream);
#endif
