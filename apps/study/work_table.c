#include "study/work_table.h"

#include <string.h>

void work_columns(const study_words *words, table_column *columns)
{
  const table_column head[] = {
      {words->subject, NULL}, {words->problem, NULL}, {"setting", NULL}, {"error", "%.3e"}};
  const table_column tail[] = {{"cpu_lower", "%.3e"},
                               {"cpu_upper", "%.3e"},
                               {words->parts, "%.0f"},
                               {words->preparation, "%.3e"},
                               {"calibration_seconds", ""},
                               {"calibration_least", ""},
                               {NULL, NULL}};
  int count = (int)(sizeof head / sizeof *head);
  memcpy(columns, head, sizeof head);
  for (int i = 0; i < study_count(words->further); i++) columns[count++] = words->further[i];
  columns[count++] = (table_column){"cpu_seconds", "%.3e"};
  for (int i = 0; i < study_count(words->counted); i++) columns[count++] = words->counted[i];
  memcpy(columns + count, tail, sizeof tail);
}

static void work_add_row(result_table *rows, const work *w, const work_job *job)
{
  const study_words *words = job->subject->words;
  table_text(rows, job->subject->name);
  table_text(rows, job->subject->problem);
  table_text(rows, job->setting);
  table_number(rows, job->level.error);
  for (int i = 0; i < study_count(words->further); i++) table_number(rows, job->level.further[i]);
  table_number(rows, job->seconds.median);
  for (int i = 0; i < study_count(words->counted); i++) table_number(rows, job->level.counted[i]);
  table_number(rows, job->seconds.lower);
  table_number(rows, job->seconds.upper);
  table_number(rows, job->level.parts);
  table_number(rows, job->preparation_seconds);
  table_number(rows, w->calibration.median);
  table_number(rows, w->calibration.least);
}

result_table *work_table(const work *w, const table_column *columns)
{
  result_table *rows = table_create(columns);
  for (int i = 0; i < w->jobs; i++) work_add_row(rows, w, &w->job[i]);
  return rows;
}

void work_print(const work *w, const result_table *rows, FILE *stream)
{
  for (int first = 0; first < w->jobs; first = work_group_end(w, first)) {
    (void)fprintf(stream, "\n%s\n", w->job[first].subject->name);
    table_print(rows, stream, 2, first, work_group_end(w, first));
  }
  (void)fputc('\n', stream);
}
