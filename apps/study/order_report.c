#include "study/order_report.h"

#include <math.h>
#include <stdlib.h>

#include "mechanics/order_study.h"
#include "study/window.h"

static const double order_tolerance = 0.2;

#define COLUMNS                                                                                    \
  {"method", NULL}, {"problem", NULL}, {"h", "%.6g"}, {"steps", "%.0f"}, {"error", "%.3e"},        \
      {"slope", "%.2f"}, {"energy_error", "%.3e"}, {"cpu_seconds", "%.3e"}, {"residuals", "%.0f"}, \
      {"jacobians", "%.0f"},                                                                       \
  {                                                                                                \
    "factorizations", "%.0f"                                                                       \
  }

const table_column *order_columns(const problem *scene)
{
  static const table_column plain[] = {COLUMNS, {NULL, NULL}},
                            with_distance[] = {COLUMNS, {"distance", "%.1e"}, {NULL, NULL}};
  return scene->velocity != NULL ? with_distance : plain;
}

static int fitted_levels(const order_result *result)
{
  return result->fit.first < 0 ? 0 : result->fit.last - result->fit.first + 1;
}

double order_local_slope(const order_result *result, int k)
{
  if (k == 0 || !(result->error[k - 1] > 0.0) || !(result->error[k] > 0.0)) return (double)NAN;
  return log(result->error[k - 1] / result->error[k]) / log(result->h[k - 1] / result->h[k]);
}

static bool is_claimed(const order_result *result, double slope)
{
  return fabs(slope - result->claimed) <= order_tolerance;
}

static bool steps_settled(const order_result *result)
{
  return result->single.asked && result->single.missing == NULL && result->single.settled;
}

/* Whether the span's errors fall about as single steps foretell. Those that fall far slower, as
 * behind a kink of the forces which no single step met, are not on their way to that order. */
static bool span_agrees(const order_result *result)
{
  static const double unsettled = 0.7, settled = 0.9; /* of the order */
  if (fitted_levels(result) < 2) return true;
  return result->fit.slope >= (result->settled ? settled : unsettled) * result->single.fit.slope;
}

/* Whether single steps have the last word. */
static bool decided_by_steps(const order_result *result)
{
  return steps_settled(result) && span_agrees(result);
}

bool order_holds(const order_result *result)
{
  if (decided_by_steps(result)) return is_claimed(result, result->single.fit.slope);
  return result->settled && is_claimed(result, result->fit.slope);
}

static void print_single_steps(const order_result *result)
{
  const single_steps *s = &result->single;
  (void)printf("\n%s, single steps from %d points to t = %g, in quadruple precision\n",
               result->method, (int)SINGLE_POINTS, result->t_end);
  (void)printf("  %10s  %9s  order\n", "h", "error");
  for (int k = 0; k < SINGLE_LEVELS; k++) {
    (void)printf("  %10.6g  %9.3e", s->h[k], s->error[k]);
    if (k > 0)
      (void)printf("  %5.2f",
                   log(s->error[k - 1] / s->error[k]) / log(s->h[k - 1] / s->h[k]) - 1.0);
    (void)putchar('\n');
  }
}

void order_print_tables(const char *name, const result_table *rows, int results,
                        const order_result *result)
{
  (void)printf("Order on %s\n", name);
  int first = 0;
  for (int i = 0; i < results; i++) {
    (void)printf("\n%s, to t = %g\n", result[i].method, result[i].t_end);
    table_print(rows, stdout, 2, first, first + result[i].levels);
    first += result[i].levels;
    if (result[i].single.asked && result[i].single.missing == NULL) print_single_steps(&result[i]);
  }
  (void)putchar('\n');
}

/* ---- verdicts ---- */

/* From the first on a slope may look settled before it is, from the other on hardly a span shows
 * it. */
enum { SLOW_ORDER = 8, HIDDEN_ORDER = 12 };

static const double shorter =
    0.25; /* of the span, for which the errors of high orders fall into line */

static int count_above(const order_result *result, double bound)
{
  int count = 0;
  for (int k = 0; k < result->levels; k++) count += !(result->error[k] < bound);
  return count;
}

/* What hides small errors. */
static const char *floor_cause(const order_result *result)
{
  const bool of_judge = result->floor <= 1.01 * STUDY_FLOOR_MARGIN * result->judge_error;
  return of_judge ? "the judge's own error"
                  : "roundoff (what a change of the start in its last digit does to the end)";
}

/* Too few levels between the floor and the ceiling. */
static void print_missing(FILE *stream, const order_result *result)
{
  const int above = count_above(result, result->ceiling),
            below = result->levels - count_above(result, result->floor);
  if (result->levels < WINDOW_LEVELS)
    (void)fprintf(stream, "not decided: %d levels are too few, %d are needed; ask for --levels 6\n",
                  result->levels, (int)WINDOW_LEVELS);
  else if (above > below)
    (void)fprintf(stream,
                  "not decided: steps are too large: %d of %d levels have errors above 1 %% of the "
                  "solution (%.1e); leave --h to "
                  "the search, or shorten the span, --t-end %g\n",
                  above, result->levels, result->ceiling, shorter * result->t_end);
  else
    (void)fprintf(stream,
                  "not decided: %d of %d levels have errors below %.1e, ten times %s; leave --h "
                  "and --judge to the search, or "
                  "lengthen the span, --t-end %g\n",
                  below, result->levels, result->floor, floor_cause(result),
                  result->t_end / shorter);
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

/* What else can be done where errors of a high order are not in line with a power of the step. */
static void print_remedy(FILE *stream, const order_result *result)
{
  if (result->single.asked && result->single.missing != NULL)
    (void)fprintf(stream, "  no single steps in quadruple precision: %s\n", result->single.missing);
  if (steps_settled(result))
    (void)fprintf(stream,
                  "  single steps have the order %.2f, but over the span errors fall far slower: "
                  "is the Lagrangian smooth "
                  "all along the motion? (abs and roots of 0 are not)\n",
                  result->single.fit.slope);
  else if (result->chooses_steps)
    (void)fprintf(stream, "  the method chooses its steps, and an error is no power of the first "
                          "one; galerkin of this degree has "
                          "steps of one length\n");
  else if (result->claimed < HIDDEN_ORDER)
    (void)fprintf(stream, "  try a shorter span, --t-end %g\n", shorter * result->t_end);
  else
    (void)fprintf(stream,
                  "  spans show orders up to about 10 in doubles: try a method of a lower one\n");
}

static void print_unsettled(FILE *stream, const order_result *result)
{
  double least, most;
  slopes_between(result, &least, &most);
  (void)fprintf(stream,
                "not decided: the slope does not settle (%.2f over levels %d to %d, %.2f to %.2f "
                "between neighbours): ",
                result->fit.slope, result->fit.first + 1, result->fit.last + 1, least, most);
  (void)fprintf(stream,
                "between steps that are too large and %s there is no range that shows an order\n",
                floor_cause(result));
  print_remedy(stream, result);
}

static void print_span(FILE *stream, const order_result *result)
{
  if (fitted_levels(result) < WINDOW_LEVELS) {
    print_missing(stream, result);
  } else if (!result->settled) {
    print_unsettled(stream, result);
  } else {
    (void)fprintf(stream, "fitted %.2f to levels %d to %d: %s\n", result->fit.slope,
                  result->fit.first + 1, result->fit.last + 1,
                  order_holds(result) ? "ok" : "MISSED");
    if (!order_holds(result) && (result->claimed >= SLOW_ORDER || steps_settled(result)))
      print_remedy(stream, result);
  }
}

/* Why the span was not enough. */
static void print_hidden(FILE *stream, const order_result *result)
{
  double least, most;
  slopes_between(result, &least, &most);
  (void)fprintf(
      stream,
      "  the span to t = %g does not show it: %d of %d levels lie between floor and ceiling",
      result->t_end, fitted_levels(result), result->levels);
  if (fitted_levels(result) > 1)
    (void)fprintf(stream, ", slope %.2f, %.2f to %.2f between neighbours", result->fit.slope, least,
                  most);
  (void)fputc('\n', stream);
}

static void print_of_steps(FILE *stream, const order_result *result)
{
  const single_steps *s = &result->single;
  (void)fprintf(stream, "fitted %.2f to single steps %d to %d: %s\n", s->fit.slope,
                s->fit.first + 1, s->fit.last + 1, order_holds(result) ? "ok" : "MISSED");
  print_hidden(stream, result);
  (void)fprintf(stream,
                "  judge of the steps: extrapolation, error %.1e; with h = %.3g and an error of "
                "%.1e the library's own "
                "steps are %.1e from these\n",
                s->judge_error, s->common_h, s->common_error, s->apart);
}

void order_print_verdict(FILE *stream, const order_result *result)
{
  (void)fprintf(stream, "%s: claimed order %d, ", result->method, result->claimed);
  if (decided_by_steps(result))
    print_of_steps(stream, result);
  else
    print_span(stream, result);
  (void)fprintf(stream, "  judge at t = %g: %s, error %.1e; errors up to %.1e are not fitted\n",
                result->t_end, result->judge, result->judge_error, result->floor);
}

/* A line of the fitted order's slope, a little below the method's errors, over its window. */
static int guide(const order_result *result, double *x, double *y)
{
  if (fitted_levels(result) < 2) return 0;
  const int ends[2] = {result->fit.first, result->fit.last};
  for (int i = 0; i < 2; i++) {
    x[i] = result->h[ends[i]];
    y[i] = 0.4 * result->error[ends[0]] * pow(x[i] / result->h[ends[0]], result->claimed);
  }
  return 2;
}

bool order_plot(const char *name, const result_table *rows, const plot_axes *axes, int results,
                const order_result *result, const char *path)
{
  plot_curve curve[WORDS_MAX];
  double x[WORDS_MAX][2];
  double y[WORDS_MAX][2];
  for (int i = 0; i < results; i++) {
    const int count = guide(&result[i], x[i], y[i]);
    curve[i] = (plot_curve){.label = i == 0 ? "slopes of the claimed orders" : NULL,
                            .count = count,
                            .x = x[i],
                            .y = y[i],
                            .guide = true};
  }
  return axes_plot(rows, axes, name, results, curve, path);
}
