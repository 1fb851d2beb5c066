/** The cost of requested errors, for each subject. */
#ifndef ASKED_H
#define ASKED_H
#include <stdio.h>

#include "csv/table.h"
#include "study/work.h"

/** Fill in the columns of the table, which end with one without a title. The first quantity that
 * the subjects count is a cost beside the time. */
enum { ASKED_COLUMNS_MAX = 12 };
void asked_columns(const study_words *words, table_column *columns);

/** Create the table, with a row for each subject at each requested error. Without memory it is
 * NULL, or table_good returns false. */
result_table *asked_table(const work *w, const table_column *columns);

/** Print the table, one requested error after the other. */
void asked_print(const work *w, const result_table *rows, FILE *stream);
#endif
