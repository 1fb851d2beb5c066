#include "study/asked.h"

#include <math.h>

#include "study/frontier.h"
#include "mechanics/order_study.h"

enum { FIRST_SHOWN = 3 };

static const table_column columns[] = {
    {"asked_error", "%.3e"},     {"problem", NULL},         {"judged", NULL},
    {"integrator", NULL},        {"cpu_seconds", "%.3e"},   {"ratio", "%.2f"},
    {"evaluations", "%.0f"},     {"answer", NULL},          {"create_seconds", "%.3e"},
    {"calibration_seconds", ""}, {"calibration_least", ""}, {NULL, NULL},
};

static const char *const answers[] = {[FRONTIER_NOT_REACHED] = "not reached",
                                      [FRONTIER_BETWEEN] = "interpolated",
                                      [FRONTIER_AT_MOST] = "at most"};

typedef struct price {
  double seconds, creation, evaluations;
  frontier_answer answer;
} price;

/* Time and evaluations have a frontier each: what a method evaluates shall not depend on the clock.
 * Its creation takes as long for any step. */
static price price_at(const bench_results *results, int first, double asked)
{
  enum { SETTINGS_MAX = 64 }; /* no integrator has as many */
  double error[SETTINGS_MAX];
  double seconds[SETTINGS_MAX];
  double evaluations[SETTINGS_MAX];
  double creation[SETTINGS_MAX];
  price found;
  int count = 0;
  for (int i = first; i < bench_group_end(results, first) && count < SETTINGS_MAX; i++, count++) {
    const bench_job *job = &results->job[i];
    error[count] = fmax(job->error,
                        results->judge->error); /* more than the judge knows is not credited */
    seconds[count] = job->seconds.median;
    evaluations[count] = (double)job->evaluations;
    creation[count] = job->creation_seconds;
  }
  found.answer = frontier_cost(count, error, seconds, asked, &found.seconds);
  (void)frontier_cost(count, error, evaluations, asked, &found.evaluations);
  found.creation = found.answer == FRONTIER_NOT_REACHED ? (double)NAN
                                                        : samples_spread(count, creation).median;
  return found;
}

/* Within a decade of the judge's own error the errors mean little. */
static bool can_be_judged(const bench_results *results, double asked)
{
  return asked >= STUDY_FLOOR_MARGIN * results->judge->error;
}

static double fastest(const bench_results *results, double asked)
{
  double least = (double)NAN;
  for (int first = 0; first < results->jobs; first = bench_group_end(results, first))
    least = fmin(least,
                 price_at(results, first, asked).seconds); /* of a number and a NaN the number */
  return least;
}

static void add_rows(result_table *rows, const bench_results *results, double asked)
{
  const double least = fastest(results, asked);
  for (int first = 0; first < results->jobs; first = bench_group_end(results, first)) {
    const price found = price_at(results, first, asked);
    table_number(rows, asked);
    table_text(rows, results->scene->name);
    table_text(rows, can_be_judged(results, asked) ? "yes" : "no");
    table_text(rows, results->job[first].integrator);
    table_number(rows, found.seconds);
    table_number(rows, found.seconds / least);
    table_number(rows, found.evaluations);
    table_text(rows, answers[found.answer]);
    table_number(rows, found.creation);
    table_number(rows, results->calibration.median);
    table_number(rows, results->calibration.least);
  }
}

result_table *asked_table(const bench_results *results, const numbers *asked)
{
  result_table *rows = table_create(columns);
  for (int k = 0; k < asked->count; k++) add_rows(rows, results, asked->number[k]);
  return rows;
}

void asked_print(const bench_results *results, const numbers *asked, const result_table *rows,
                 FILE *stream)
{
  const int integrators = table_rows(rows) / asked->count;
  for (int k = 0; k < asked->count; k++) {
    (void)fprintf(stream, "At an error of %s%s\n", asked->text[k],
                  can_be_judged(results, asked->number[k])
                      ? ""
                      : ": less than ten times the judge's own error, not to be trusted");
    table_print(rows, stream, FIRST_SHOWN, k * integrators, (k + 1) * integrators);
    (void)fputc('\n', stream);
  }
}
