/** What jobs found, as a table, and as a plot. */
#ifndef WORK_TABLE_H
#define WORK_TABLE_H
#include <stdio.h>

#include "csv/table.h"
#include "study/work.h"

/** Fill in the columns of the table, ended by one without a title. */
enum { WORK_COLUMNS_MAX = 12 + STUDY_FURTHER_MAX + STUDY_COUNTS_MAX };
void work_columns(const study_words *words, table_column *columns);

/** The table of all jobs. NULL, or not table_good, without memory. */
result_table *work_table(const work *w, const table_column *columns);

/** Print it, a subject after the other. */
void work_print(const work *w, const result_table *rows, FILE *stream);
#endif
