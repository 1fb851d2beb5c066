#include "study/asked.h"

#include <dvi/study.h>
#include <math.h>
#include <string.h>

#include "study/frontier.h"

enum { FIRST_SHOWN = 3 };

static const char *const answers[] = {[FRONTIER_NOT_REACHED] = "not reached",
                                      [FRONTIER_BETWEEN] = "interpolated",
                                      [FRONTIER_AT_MOST] = "at most"};

void asked_columns(const study_words *words, table_column *columns)
{
  const table_column all[ASKED_COLUMNS_MAX] = {
      {"asked_error", "%.3e"},
      {words->problem, NULL},
      {"judged", NULL},
      {words->subject, NULL},
      {"cpu_seconds", "%.3e"},
      {"ratio", "%.2f"},
      {words->counted[0].title, "%.0f"},
      {"answer", NULL},
      {words->preparation, "%.3e"},
      {"calibration_seconds", ""},
      {"calibration_least", ""},
      {NULL, NULL},
  };
  memcpy(columns, all, sizeof all);
}

typedef struct price {
  double seconds, preparation, counted;
  frontier_answer answer;
} price;

/* Interpolate the cost of an error. Time and counts have separate frontiers, because counts must
 * not depend on the clock. The preparation takes as long for any level. */
static price price_at(const work *w, int first, double asked)
{
  enum { SETTINGS_MAX = 64 }; /* no subject has as many settings */
  double error[SETTINGS_MAX];
  double seconds[SETTINGS_MAX];
  double counted[SETTINGS_MAX];
  double preparation[SETTINGS_MAX];
  price found;
  int count = 0;
  for (int i = first; i < work_group_end(w, first) && count < SETTINGS_MAX; i++, count++) {
    const work_job *job = &w->job[i];
    /* no error below the judge's own one is credited */
    error[count] = fmax(job->level.error, w->judge_error);
    seconds[count] = job->seconds.median;
    counted[count] = job->level.counted[0];
    preparation[count] = job->preparation_seconds;
  }
  found.answer = frontier_cost(count, error, seconds, asked, &found.seconds);
  (void)frontier_cost(count, error, counted, asked, &found.counted);
  found.preparation = found.answer == FRONTIER_NOT_REACHED
                          ? (double)NAN
                          : dvi_study_spread_of(count, preparation).median;
  return found;
}

/* Return whether an error can be judged. Errors within a decade of the judge's own error mean
 * little. */
static bool can_be_judged(const work *w, double asked)
{
  return asked >= DVI_STUDY_FLOOR_MARGIN * w->judge_error;
}

static double fastest_seconds(const work *w, double asked)
{
  double least = (double)NAN;
  for (int first = 0; first < w->jobs; first = work_group_end(w, first))
    /* fmin of a number and a NaN is the number */
    least = fmin(least, price_at(w, first, asked).seconds);
  return least;
}

static void asked_add_rows(result_table *rows, const work *w, double asked)
{
  const double least = fastest_seconds(w, asked);
  for (int first = 0; first < w->jobs; first = work_group_end(w, first)) {
    const price found = price_at(w, first, asked);
    table_number(rows, asked);
    table_text(rows, w->job[first].subject->problem);
    table_text(rows, can_be_judged(w, asked) ? "yes" : "no");
    table_text(rows, w->job[first].subject->name);
    table_number(rows, found.seconds);
    table_number(rows, found.seconds / least);
    table_number(rows, found.counted);
    table_text(rows, answers[found.answer]);
    table_number(rows, found.preparation);
    table_number(rows, w->calibration.median);
    table_number(rows, w->calibration.least);
  }
}

result_table *asked_table(const work *w, const table_column *columns)
{
  result_table *rows = table_create(columns);
  for (int k = 0; k < w->asked->count; k++) asked_add_rows(rows, w, w->asked->number[k]);
  return rows;
}

void asked_print(const work *w, const result_table *rows, FILE *stream)
{
  const int subjects = table_rows(rows) / w->asked->count;
  for (int k = 0; k < w->asked->count; k++) {
    const bool judged = can_be_judged(w, w->asked->number[k]);
    (void)fprintf(stream, "At an error of %s%s\n", w->asked->text[k],
                  judged ? "" : ": less than ten times the judge's own error, not to be trusted");
    table_print(rows, stream, FIRST_SHOWN, k * subjects, (k + 1) * subjects);
    (void)fputc('\n', stream);
  }
}
