/** The results of jobs as a table. */
#ifndef WORK_TABLE_H
#define WORK_TABLE_H
#include <stdio.h>

#include "csv/table.h"
#include "study/work.h"

/** Fill in the columns of the table, which end with one without a title. */
enum { WORK_COLUMNS_MAX = 12 + STUDY_FURTHER_MAX + STUDY_COUNTS_MAX };
void work_columns(const study_words *words, table_column *columns);

/** Create the table of all jobs. Without memory it is NULL, or table_good returns false. */
result_table *work_table(const work *w, const table_column *columns);

/** Print the table, one subject after the other. */
void work_print(const work *w, const result_table *rows, FILE *stream);
#endif
