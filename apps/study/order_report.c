#include "study/order_report.h"

#include <dvi/study.h>
#include <math.h>

enum { PHRASE_SIZE = 192 };

/* Return a phrase of the subject, or "" if it has none. */
static const char *order_phrase(const order_result *result, study_phrase phrase, char *text)
{
  const char *said = study_say(result->words, phrase, result->extent, text, PHRASE_SIZE);
  return said != NULL ? said : "";
}

/* ---- tables ---- */

static bool has_closer(const order_result *result)
{
  return result->closer.asked && result->closer.missing == NULL;
}

static void print_closer(const order_result *result)
{
  const closer_look *c = &result->closer;
  (void)printf("\n%s, %s\n", result->name, c->title);
  (void)printf("  %10s  %9s  order\n", result->words->length, "error");
  for (int k = 0; k < c->levels; k++) {
    (void)printf("  %10.6g  %9.3e", c->length[k], c->error[k]);
    if (k > 0)
      (void)printf("  %5.2f",
                   log(c->error[k - 1] / c->error[k]) / log(c->length[k - 1] / c->length[k]) -
                       c->excess);
    (void)putchar('\n');
  }
}

void order_print_tables(const char *problem, const result_table *rows, int results,
                        const order_result *result)
{
  char reach[PHRASE_SIZE];
  (void)printf("Order on %s\n", problem);
  int first = 0;
  for (int i = 0; i < results; i++) {
    const char *to = order_phrase(&result[i], STUDY_REACH, reach);
    (void)printf("\n%s%s%s\n", result[i].name, to[0] != '\0' ? ", " : "", to);
    table_print(rows, stdout, 2, first, first + result[i].levels);
    first += result[i].levels;
    if (has_closer(&result[i])) print_closer(&result[i]);
  }
  (void)putchar('\n');
}

/* ---- verdicts ---- */

/* Beyond SLOW_ORDER a slope may look settled too early, beyond HIDDEN_ORDER hardly any levels show
 * it. */
enum { SLOW_ORDER = 8, HIDDEN_ORDER = 12 };

static int count_above(const order_result *result, double bound)
{
  int count = 0;
  for (int k = 0; k < result->levels; k++) count += !(result->error[k] < bound);
  return count;
}

/* Return the cause that hides small errors. */
static const char *floor_cause(const order_result *result, char *text)
{
  const bool of_judge = result->floor <= 1.01 * DVI_STUDY_FLOOR_MARGIN * result->judge_error;
  const char *said = order_phrase(result, STUDY_ROUNDOFF, text);
  return of_judge ? "the judge's own error" : said[0] != '\0' ? said : "roundoff";
}

/* End the line with advice, if there is any. */
static void print_advice(FILE *stream, const order_result *result, study_phrase phrase)
{
  char text[PHRASE_SIZE];
  const char *advice = order_phrase(result, phrase, text);
  (void)fprintf(stream, "%s%s\n", advice[0] != '\0' ? "; " : "", advice);
}

/* Print a line of advice. */
static void print_line(FILE *stream, const order_result *result, study_phrase phrase)
{
  char text[PHRASE_SIZE];
  const char *advice = order_phrase(result, phrase, text);
  if (advice[0] != '\0') (void)fprintf(stream, "  %s\n", advice);
}

/* Report too few levels between the floor and the ceiling. */
static void print_missing(FILE *stream, const order_result *result)
{
  char text[PHRASE_SIZE];
  const int above = count_above(result, result->ceiling),
            below = result->levels - count_above(result, result->floor);
  (void)fprintf(stream, "not decided: ");
  if (result->levels < DVI_STUDY_FIT_LEAST) {
    (void)fprintf(stream, "%d levels are too few, %d are needed", result->levels,
                  (int)DVI_STUDY_FIT_LEAST);
    print_advice(stream, result, STUDY_MORE);
  } else if (above > below) {
    (void)fprintf(stream,
                  "%s are too large: %d of %d levels have errors above 1 %% of the solution (%.1e)",
                  result->words->parts, above, result->levels, result->ceiling);
    print_advice(stream, result, STUDY_FINER);
  } else {
    (void)fprintf(stream, "%d of %d levels have errors below %.1e, ten times %s", below,
                  result->levels, result->floor, floor_cause(result, text));
    print_advice(stream, result, STUDY_COARSER);
  }
}

static void slopes_between(const order_result *result, double *least, double *most)
{
  *least = (double)INFINITY;
  *most = (double)-INFINITY;
  for (int k = result->fit.first + 1; k <= result->fit.last; k++) {
    *least = fmin(*least, order_local_slope(result, k));
    *most = fmax(*most, order_local_slope(result, k));
  }
}

/* Advise on errors of a high order that do not follow a power of the length. */
static void print_remedy(FILE *stream, const order_result *result)
{
  const closer_look *c = &result->closer;
  if (c->asked && c->missing != NULL)
    (void)fprintf(stream, "  no %s %s: %s\n", c->of, c->digits, c->missing);
  if (order_closer_settled(result)) {
    char whole[PHRASE_SIZE];
    (void)fprintf(stream, "  %s have the order %.2f, but over %s errors fall far slower: %s\n",
                  c->of, c->fit.slope, order_phrase(result, STUDY_WHOLE, whole), c->unlike);
  } else if (result->chooses) {
    print_line(stream, result, STUDY_EQUAL);
  } else {
    print_line(stream, result, result->claimed < HIDDEN_ORDER ? STUDY_NEARER : STUDY_LOWER);
  }
}

static void print_unsettled(FILE *stream, const order_result *result)
{
  double least, most;
  char text[PHRASE_SIZE];
  slopes_between(result, &least, &most);
  (void)fprintf(stream,
                "not decided: the slope does not settle (%.2f over levels %d to %d, %.2f to %.2f "
                "between neighbours): ",
                result->fit.slope, result->fit.first + 1, result->fit.last + 1, least, most);
  if (order_may_settle(result)) {
    (void)fprintf(stream, "it comes near the claimed order at the last levels alone\n");
    print_line(stream, result, STUDY_FURTHER);
    return;
  }
  (void)fprintf(stream,
                "between %s that are too large and %s there is no range that shows an order\n",
                result->words->parts, floor_cause(result, text));
  print_remedy(stream, result);
}

static void print_levels(FILE *stream, const order_result *result)
{
  if (order_fitted(result) < DVI_STUDY_FIT_LEAST) {
    print_missing(stream, result);
  } else if (!result->settled) {
    print_unsettled(stream, result);
  } else {
    (void)fprintf(stream, "fitted %.2f to levels %d to %d: %s\n", result->fit.slope,
                  result->fit.first + 1, result->fit.last + 1,
                  order_holds(result) ? "ok" : "MISSED");
    if (!order_holds(result) && (result->claimed >= SLOW_ORDER || order_closer_settled(result)))
      print_remedy(stream, result);
  }
}

/* Explain why the levels were not enough. */
static void print_hidden(FILE *stream, const order_result *result)
{
  double least, most;
  char whole[PHRASE_SIZE], reach[PHRASE_SIZE];
  slopes_between(result, &least, &most);
  (void)fprintf(stream, "  %s %s does not show it: %d of %d levels lie between floor and ceiling",
                order_phrase(result, STUDY_WHOLE, whole), order_phrase(result, STUDY_REACH, reach),
                order_fitted(result), result->levels);
  if (order_fitted(result) > 1)
    (void)fprintf(stream, ", slope %.2f, %.2f to %.2f between neighbours", result->fit.slope, least,
                  most);
  (void)fputc('\n', stream);
}

static void print_of_closer(FILE *stream, const order_result *result)
{
  const closer_look *c = &result->closer;
  (void)fprintf(stream, "fitted %.2f to %s %d to %d: %s\n", c->fit.slope, c->of, c->fit.first + 1,
                c->fit.last + 1, order_holds(result) ? "ok" : "MISSED");
  print_hidden(stream, result);
  (void)fprintf(stream, "  %s\n", c->judge);
}

void order_print_verdict(FILE *stream, const order_result *result)
{
  char place[PHRASE_SIZE];
  (void)fprintf(stream, "%s: claimed order %d, ", result->name, result->claimed);
  if (order_closer_decides(result))
    print_of_closer(stream, result);
  else
    print_levels(stream, result);
  const char *at = order_phrase(result, STUDY_PLACE, place);
  (void)fprintf(stream, "  judge%s%s: %s%serror %.1e; errors up to %.1e are not fitted\n",
                at[0] != '\0' ? " " : "", at, result->judge, result->judge[0] != '\0' ? ", " : "",
                result->judge_error, result->floor);
}

/* ---- plot ---- */

/* Make a line of the claimed order's slope, a little below the subject's errors, over its
 * window. */
static int slope_guide(const order_result *result, double *x, double *y)
{
  if (order_fitted(result) < 2) return 0;
  const int ends[2] = {result->fit.first, result->fit.last};
  for (int i = 0; i < 2; i++) {
    x[i] = result->length[ends[i]];
    y[i] = 0.4 * result->error[ends[0]] * pow(x[i] / result->length[ends[0]], result->claimed);
  }
  return 2;
}

bool order_plot(const char *problem, const result_table *rows, const plot_axes *axes, int results,
                const order_result *result, const char *path)
{
  plot_curve curve[WORDS_MAX];
  double x[WORDS_MAX][2];
  double y[WORDS_MAX][2];
  for (int i = 0; i < results; i++) {
    const int count = slope_guide(&result[i], x[i], y[i]);
    curve[i] = (plot_curve){.label = i == 0 ? "slopes of the claimed orders" : NULL,
                            .count = count,
                            .x = x[i],
                            .y = y[i],
                            .guide = true};
  }
  return axes_plot(rows, axes, problem, results, curve, path);
}
