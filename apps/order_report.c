#include "order_report.h"

#include <math.h>
#include <stdlib.h>

#include "window.h"

static const double order_tolerance = 0.2;

#define COLUMNS                                                                                                \
  {"method", NULL}, {"problem", NULL}, {"h", "%.6g"}, {"steps", "%.0f"}, {"error", "%.3e"}, {"slope", "%.2f"}, \
      {"energy_error", "%.3e"}, {"cpu_seconds", "%.3e"}, {"residuals", "%.0f"}, {"jacobians", "%.0f"},         \
  {                                                                                                            \
    "factorizations", "%.0f"                                                                                   \
  }

const table_column *order_columns(const problem *scene)
{
  static const table_column plain[] = {COLUMNS, {NULL, NULL}}, with_distance[] = {COLUMNS, {"distance", "%.1e"}, {NULL, NULL}};
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

/* Whether single steps have the last word. */
static bool decided_by_steps(const order_result *result)
{
  return result->single.asked && result->single.missing == NULL && result->single.settled;
}

bool order_holds(const order_result *result)
{
  if (decided_by_steps(result)) return is_claimed(result, result->single.fit.slope);
  return result->settled && is_claimed(result, result->fit.slope);
}

static void print_steps(FILE *stream, const order_result *result)
{
  const single_steps *s = &result->single;
  (void)fprintf(stream, "  single steps in quadruple precision, each from %d points of the motion\n", (int)SINGLE_POINTS);
  for (int k = 0; k < SINGLE_LEVELS; k++) {
    (void)fprintf(stream, "  h = %-10.4g error %.3e", s->h[k], s->error[k]);
    if (k > 0) (void)fprintf(stream, "  order %.2f", log(s->error[k - 1] / s->error[k]) / log(s->h[k - 1] / s->h[k]) - 1.0);
    (void)fputc('\n', stream);
  }
  (void)fprintf(stream, "  judge %.1e apart %.1e fit %.3f settled %d\n", s->judge_error, s->apart, s->fit.slope, s->settled);
}

void order_print_tables(const char *name, const result_table *rows, int results, const order_result *result)
{
  (void)printf("Order on %s\n", name);
  int first = 0;
  for (int i = 0; i < results; i++) {
    (void)printf("\n%s, to t = %g\n", result[i].method, result[i].t_end);
    table_print(rows, stdout, 2, first, first + result[i].levels);
    first += result[i].levels;
  }
  (void)putchar('\n');
}

static void print_missing(FILE *stream, const order_result *result)
{
  (void)fprintf(stream, "not decided: %d of %d levels have errors between %.1e and %.1e, and %d are needed; ",
                fitted_levels(result), result->levels, result->floor, result->ceiling, (int)WINDOW_LEVELS);
  (void)fprintf(stream, "set a first step by --h, a longer --t-end, or more --levels\n");
}

static void print_unsettled(FILE *stream, const order_result *result)
{
  double least = (double)INFINITY;
  double most = (double)-INFINITY;
  for (int k = result->fit.first + 1; k <= result->fit.last; k++) {
    least = fmin(least, order_local_slope(result, k));
    most = fmax(most, order_local_slope(result, k));
  }
  (void)fprintf(stream, "not decided: the slope does not settle (%.2f over levels %d to %d, %.2f to %.2f between neighbours); ",
                result->fit.slope, result->fit.first + 1, result->fit.last + 1, least, most);
  (void)fprintf(stream, "between steps that are too large and roundoff there is no range that shows an order\n");
}

void order_print_verdict(FILE *stream, const order_result *result)
{
  (void)fprintf(stream, "%s: claimed order %d, ", result->method, result->claimed);
  if (fitted_levels(result) < WINDOW_LEVELS)
    print_missing(stream, result);
  else if (!result->settled)
    print_unsettled(stream, result);
  else
    (void)fprintf(stream, "fitted %.2f to levels %d to %d: %s\n", result->fit.slope, result->fit.first + 1, result->fit.last + 1,
                  order_holds(result) ? "ok" : "MISSED");
  if (result->single.asked && result->single.missing == NULL) print_steps(stream, result);
  if (result->single.asked && result->single.missing != NULL) (void)fprintf(stream, "no single steps: %s\n", result->single.missing);
  (void)fprintf(stream, "  judge at t = %g: %s, error %.1e; errors up to %.1e are not fitted\n", result->t_end, result->judge,
                result->judge_error, result->floor);
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

bool order_plot(const char *name, const result_table *rows, const plot_axes *axes, int results, const order_result *result,
                const char *path)
{
  plot_curve curve[WORDS_MAX];
  double x[WORDS_MAX][2];
  double y[WORDS_MAX][2];
  for (int i = 0; i < results; i++) {
    const int count = guide(&result[i], x[i], y[i]);
    curve[i] = (plot_curve){
        .label = i == 0 ? "slopes of the claimed orders" : NULL, .count = count, .x = x[i], .y = y[i], .guide = true};
  }
  return axes_plot(rows, axes, name, results, curve, path);
}
