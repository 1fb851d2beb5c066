#include "study/order.h"

#include <dvi/study.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double order_tolerance = 0.2;

/* Part of the claimed order by which a slope on its way to it may still be off. */
static const double on_its_way = 0.25;

/* Largest process time of a run, in seconds, to which levels are added. */
static const double cheap_seconds = 1.0;

enum { FURTHER_LEVELS = 6 };

/* --- The table. --- */

void order_columns(const study_words *words, table_column *columns)
{
  const table_column head[] = {{words->subject, NULL},  {words->problem, NULL},
                               {words->length, "%.6g"}, {words->parts, "%.0f"},
                               {"error", "%.3e"},       {"slope", "%.2f"}};
  const int further = study_count(words->further), counted = study_count(words->counted);
  int count = (int)(sizeof head / sizeof *head);
  memcpy(columns, head, sizeof head);
  for (int i = 0; i < further; i++) columns[count++] = words->further[i];
  columns[count++] = (table_column){"cpu_seconds", "%.3e"};
  for (int i = 0; i < counted; i++) columns[count++] = words->counted[i];
  columns[count] = (table_column){NULL, NULL};
}

static void order_add_row(result_table *rows, const study_subject *subject, double slope,
                          const study_level *level)
{
  table_text(rows, subject->name);
  table_text(rows, subject->problem);
  table_number(rows, level->length);
  table_number(rows, level->parts);
  table_number(rows, level->error);
  table_number(rows, slope);
  for (int i = 0; i < study_count(subject->words->further); i++)
    table_number(rows, level->further[i]);
  table_number(rows, level->seconds);
  for (int i = 0; i < study_count(subject->words->counted); i++)
    table_number(rows, level->counted[i]);
}

/* --- Levels. --- */

static dvi_status order_run_level(const study_subject *subject, double parts, study_level *level)
{
  dvi_status status = study_run(subject, parts, level);
  if (status == DVI_OK) status = study_watch(subject, parts, level);
  if (status == DVI_OK) status = study_time(subject, parts, level);
  return status;
}

/* Run a level, and add its row. */
static dvi_status add_level(const study_subject *subject, double parts, result_table *rows,
                            order_result *result)
{
  study_level level = {.number = NULL};
  const int k = result->levels;
  const dvi_status status = order_run_level(subject, parts, &level);
  if (status != DVI_OK) return status;
  result->length[k] = fabs(level.length);
  result->error[k] = level.error;
  result->seconds = level.seconds;
  result->levels = k + 1;
  order_add_row(rows, subject, order_local_slope(result, k), &level);
  return DVI_OK;
}

static void fit_levels(order_result *result)
{
  result->settled = dvi_study_fit(result->levels, result->length, result->error, result->floor,
                                  result->ceiling, &result->fit);
}

dvi_status order_measure(const study_subject *subject, const dvi_study_levels *choice, int levels,
                         result_table *rows, order_result *result)
{
  (void)snprintf(result->name, sizeof result->name, "%s", subject->name);
  (void)snprintf(result->judge, sizeof result->judge, "%s",
                 subject->judge != NULL ? subject->judge : "");
  result->words = subject->words;
  result->claimed = subject->order;
  result->chooses = subject->chooses;
  result->extent = subject->extent;
  result->judge_error = subject->judge_error;
  result->floor = choice->floor;
  result->ceiling = choice->ceiling;
  result->levels = 0;
  for (int k = 0; k < levels; k++) {
    const dvi_status status = add_level(subject, (double)choice->parts[k], rows, result);
    if (status != DVI_OK) return status;
  }
  fit_levels(result);
  return DVI_OK;
}

/* Return the ratio of the last two levels, which is above 1. */
static double last_ratio(const order_result *result)
{
  const double *length = result->length + result->levels;
  return length[-2] / length[-1];
}

dvi_status order_extend(const study_subject *subject, result_table *rows, order_result *result)
{
  for (int i = 0; i < FURTHER_LEVELS && order_may_settle(result) &&
                  last_ratio(result) * result->seconds <= cheap_seconds;
       i++) {
    const double last = fabs(subject->span) / result->length[result->levels - 1];
    const double parts = fmax(round(last) + 1.0, round(last * last_ratio(result)));
    const dvi_status status = add_level(subject, parts, rows, result);
    if (status != DVI_OK) return status;
    fit_levels(result);
  }
  return DVI_OK;
}

/* --- Decisions. --- */

int order_fitted(const order_result *result)
{
  return result->fit.first < 0 ? 0 : result->fit.last - result->fit.first + 1;
}

double order_local_slope(const order_result *result, int k)
{
  if (k == 0 || !(result->error[k - 1] > 0.0) || !(result->error[k] > 0.0)) return (double)NAN;
  return log(result->error[k - 1] / result->error[k]) /
         log(result->length[k - 1] / result->length[k]);
}

static bool is_claimed(const order_result *result, double slope)
{
  return fabs(slope - result->claimed) <= order_tolerance;
}

bool order_may_settle(const order_result *result)
{
  const int last = result->levels - 1;
  if (result->settled || result->chooses || last < 1 || result->levels >= DVI_STUDY_LEVELS_MAX)
    return false;
  const double off = fabs(order_local_slope(result, last) - result->claimed);
  const double next = result->error[last] * pow(last_ratio(result), -result->claimed);
  return off <= on_its_way * result->claimed && next > result->floor &&
         result->error[last] < result->ceiling;
}

bool order_closer_settled(const order_result *result)
{
  return result->closer.asked && result->closer.missing == NULL && result->closer.settled;
}

/* Return whether errors of the levels fall about as the closer look predicts. If they fall far
 * slower, as behind a kink that it did not meet, they are not on their way to that order. */
static bool levels_agree(const order_result *result)
{
  static const double unsettled = 0.7, settled = 0.9; /* fraction of the order */
  if (order_fitted(result) < 2) return true;
  return result->fit.slope >= (result->settled ? settled : unsettled) * result->closer.fit.slope;
}

bool order_closer_decides(const order_result *result)
{
  return order_closer_settled(result) && levels_agree(result);
}

bool order_holds(const order_result *result)
{
  if (order_closer_decides(result)) return is_claimed(result, result->closer.fit.slope);
  return result->settled && is_claimed(result, result->fit.slope);
}
