/* dvi order: does a method have the order that it claims? */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "file.h"
#include "open.h"
#include "options.h"
#include "plot.h"
#include "progress.h"
#include "study.h"
#include "table.h"

enum { LEVELS_DEFAULT = 6, LEVELS_MAX = 40, FIT_LEVELS = 4, LABEL_SIZE = 160 };
static const double order_tolerance = 0.2;

/* What the command line asks for. */
typedef struct order_request {
  const char *csv, *plot;
  double h, t_end, ratio;
  long levels;
  words methods, settings;
} order_request;

/* What was found for one method. */
typedef struct order_result {
  const char *method;
  int claimed;
  int levels;
  double h[LEVELS_MAX], error[LEVELS_MAX]; /* step sizes without sign */
  double floor, ceiling;
  dvi_order_fit fit;
  char label[LABEL_SIZE];
} order_result;

static const table_column columns[] = {
    {"method", NULL},         {"problem", NULL},          {"h", "%.6g"},
    {"steps", "%.0f"},        {"error", "%.3e"},          {"slope", "%.2f"},
    {"energy_error", "%.3e"}, {"cpu_seconds", "%.3e"},    {"residuals", "%.0f"},
    {"jacobians", "%.0f"},    {"factorizations", "%.0f"}, {NULL, NULL},
};

/* The order that two neighbouring levels show; NaN if there is none. */
static double local_slope(const order_result *result, int k)
{
  if (k == 0 || !(result->error[k - 1] > 0.0) || !(result->error[k] > 0.0)) return (double)NAN;
  return log(result->error[k - 1] / result->error[k]) / log(result->h[k - 1] / result->h[k]);
}

static void add_row(result_table *rows, const order_study *study, const order_result *result, int k, const level_trial *trial)
{
  table_text(rows, study->method);
  table_text(rows, study->scene->name);
  table_number(rows, trial->h);
  table_number(rows, (double)trial->steps);
  table_number(rows, trial->error);
  table_number(rows, local_slope(result, k));
  table_number(rows, trial->energy_error);
  table_number(rows, trial->cpu_seconds);
  table_number(rows, (double)trial->spent.residuals);
  table_number(rows, (double)trial->spent.jacobians);
  table_number(rows, (double)trial->spent.factorizations);
}

static dvi_status run_level(order_study *study, long steps, level_trial *trial)
{
  dvi_status status = study_run(study, steps, trial);
  if (status == DVI_OK) status = study_watch_energy(study, trial);
  if (status == DVI_OK) status = study_time(study, trial);
  return status;
}

/* Run all levels of one method and fit its order. */
static dvi_status measure(order_study *study, const order_request *request, progress_line *progress, result_table *rows,
                          order_result *result)
{
  long steps[LEVELS_MAX];
  dvi_status status = study_levels(study, isnan(request->h) ? 0.0 : request->h, isnan(request->ratio) ? 0.0 : request->ratio,
                                   (int)request->levels, steps);
  result->method = study->method;
  result->claimed = study->order;
  result->floor = study->floor;
  result->ceiling = study->ceiling;
  for (int k = 0; k < request->levels && status == DVI_OK; k++) {
    level_trial trial;
    progress_show(progress, -1.0, study->method);
    status = run_level(study, steps[k], &trial);
    if (status != DVI_OK) break;
    result->h[k] = fabs(trial.h);
    result->error[k] = trial.error;
    result->levels = k + 1;
    add_row(rows, study, result, k, &trial);
  }
  if (status == DVI_OK) (void)dvi_order(result->levels, result->h, result->error, result->floor, result->ceiling, &result->fit);
  return status;
}

static int fitted_levels(const order_result *result)
{
  return result->fit.first < 0 ? 0 : result->fit.last - result->fit.first + 1;
}

static bool holds(const order_result *result)
{
  return fitted_levels(result) >= FIT_LEVELS && fabs(result->fit.slope - result->claimed) <= order_tolerance;
}

static void print_verdict(FILE *stream, const order_result *result)
{
  const int levels = fitted_levels(result);
  if (levels < FIT_LEVELS)
    (void)fprintf(stream,
                  "%s: NOT DECIDED, claimed order %d: only %d of %d levels have errors between %.1e and %.1e, %d are needed; "
                  "change --h, --ratio or --t-end, or ask for more --levels\n",
                  result->method, result->claimed, levels, result->levels, result->floor, result->ceiling, (int)FIT_LEVELS);
  else
    (void)fprintf(stream, "%s: order %.2f fitted to levels %d to %d, claimed %d: %s (errors up to %.1e are not fitted)\n",
                  result->method, result->fit.slope, result->fit.first + 1, result->fit.last + 1, result->claimed,
                  holds(result) ? "ok" : "MISSED", result->floor);
}

static void print_judge(FILE *stream, const judgement *judge, double t_end)
{
  (void)fprintf(stream, "judge at t = %g: %s, error %.1e\n", t_end, judge->kind, judge->error);
}

static void print_for_people(const problem *scene, const judgement *judge, double t_end, const result_table *rows, int results,
                             const order_result *result)
{
  (void)printf("Order on %s\n", scene->name);
  print_judge(stdout, judge, t_end);
  int first = 0;
  for (int i = 0; i < results; i++) {
    (void)printf("\n%s\n", result[i].method);
    table_print(rows, 2, first, first + result[i].levels);
    first += result[i].levels;
  }
  (void)putchar('\n');
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

static bool plot_results(const problem *scene, int results, order_result *result, const char *path)
{
  plot_curve curve[2 * WORDS_MAX];
  double x[WORDS_MAX][2];
  double y[WORDS_MAX][2];
  char title[LABEL_SIZE];
  int curves = 0;
  for (int i = 0; i < results; i++)
    curve[curves++] = (plot_curve){.label = result[i].method, .count = result[i].levels, .x = result[i].h, .y = result[i].error};
  for (int i = 0; i < results; i++) {
    const int count = guide(&result[i], x[i], y[i]);
    (void)snprintf(result[i].label, sizeof result[i].label, "slope %d", result[i].claimed);
    curve[curves++] = (plot_curve){.label = result[i].label, .count = count, .x = x[i], .y = y[i], .guide = true};
  }
  (void)snprintf(title, sizeof title, "Error against step size: %s", scene->name);
  const plot_panel panel = {.title = title,
                            .x_label = "step h",
                            .y_label = "largest error of q at the end",
                            .logarithmic = true,
                            .curves = curves,
                            .curve = curve};
  return plot_write(path, 1, &panel);
}

static bool write_csv(const result_table *rows, const char *path)
{
  whole_file csv;
  if (!file_open(&csv, path)) return false;
  table_csv(rows, csv.stream);
  return file_keep(&csv);
}

/* Tables, verdicts, files; the exit code. */
static int report(const order_request *request, const problem *scene, const judgement *judge, const result_table *rows,
                  order_result *result)
{
  const int results = request->methods.count;
  const bool csv_only = request->csv != NULL && strcmp(request->csv, "-") == 0;
  FILE *words_to = csv_only ? stderr : stdout;
  if (csv_only)
    print_judge(stderr, judge, request->t_end);
  else
    print_for_people(scene, judge, request->t_end, rows, results, result);
  bool all_hold = true;
  for (int i = 0; i < results; i++) {
    print_verdict(words_to, &result[i]);
    all_hold = all_hold && holds(&result[i]);
  }
  if (request->csv != NULL && !write_csv(rows, request->csv)) return FAILED;
  if (request->plot != NULL && !plot_results(scene, results, result, request->plot)) return FAILED;
  return all_hold ? DONE : CHECK_FAILED;
}

/* One method: its own complaint and exit code. */
static int study_method(const order_request *request, const problem *scene, const judgement *judge, const char *method,
                        result_table *rows, order_result *result)
{
  order_study study;
  progress_line progress;
  const int code = study_init(&study, scene, judge, method, request->t_end);
  if (code != DONE) return code;
  progress_start(&progress, true);
  const dvi_status status = measure(&study, request, &progress, rows, result);
  progress_end(&progress);
  study_clear(&study);
  if (status == DVI_OK) return DONE;
  (void)library_error(status);
  complain("order: %s failed on %s; try a smaller --h", method, scene->name);
  return FAILED;
}

static int study_all(const order_request *request, const problem *scene, const judgement *judge)
{
  result_table *rows = table_create(columns);
  order_result *result = calloc((size_t)request->methods.count, sizeof *result);
  int code = table_good(rows) && result != NULL ? DONE : FAILED;
  for (int i = 0; i < request->methods.count && code == DONE; i++)
    code = study_method(request, scene, judge, request->methods.word[i], rows, &result[i]);
  if (code == DONE) code = table_good(rows) ? report(request, scene, judge, rows, result) : FAILED;
  free(result);
  table_destroy(&rows);
  return code;
}

/* Refuse a wrong method before the judge starts to work. */
static int check_methods(const order_request *request, const problem *scene)
{
  int code = DONE;
  for (int i = 0; i < request->methods.count && code == DONE; i++) {
    dvi_integrator *integrator = NULL;
    code = open_integrator(scene, request->methods.word[i], &integrator);
    dvi_integrator_destroy(&integrator);
  }
  return code;
}

static int order(order_request *request, const problem *scene)
{
  if (isnan(request->t_end)) request->t_end = scene->order_t_end;
  int code = check_methods(request, scene);
  if (code != DONE) return code;
  judgement judge;
  const dvi_status status = judge_init(&judge, scene, request->t_end);
  code = status == DVI_OK ? study_all(request, scene, &judge) : library_error(status);
  judge_clear(&judge);
  return code;
}

static int check_request(const order_request *request)
{
  if (request->methods.count == 0)
    return usage_error("order: --method is missing, for example --method galerkin:degree=2; see dvi list methods");
  if (request->levels > LEVELS_MAX)
    return usage_error("order: --levels %ld is too many, %d are possible", request->levels, (int)LEVELS_MAX);
  if (request->t_end == 0.0) return usage_error("order: --t-end 0 leaves nothing to do");
  if (!isnan(request->h) && !(request->h > 0.0))
    return usage_error("order: --h %g is not positive; for a study backward in time set --t-end below 0", request->h);
  if (!isnan(request->ratio) && !(request->ratio >= 1.01 && request->ratio <= 10.0))
    return usage_error("order: --ratio %g is not between 1.01 and 10", request->ratio);
  if (request->csv != NULL && !file_writable(request->csv)) return FAILED;
  return request->plot == NULL || file_writable(request->plot) ? DONE : FAILED;
}

static const char details[] =
    "\n"
    "Columns: method,problem,h,steps,error,slope,energy_error,cpu_seconds,residuals,jacobians,factorizations.\n"
    "  error         largest error of a coordinate at the end, against the judge\n"
    "  slope         log(error ratio) / log(step ratio) from the level before; empty at the first level\n"
    "  energy_error  largest |energy - energy at the start| over the run (an untimed run of its own)\n"
    "  cpu_seconds   process time of one run (short ones are repeated until 0.02 s have passed)\n"
    "  the rest      counted by the library in one run\n"
    "\n"
    "The judge is the problem's exact solution; or its stored quadruple-precision result, if parameters and end are\n"
    "the problem's own; or IDA of SUNDIALS, which shares no code with the methods, run at two tolerances. An error\n"
    "counts if it is above the floor: ten times the judge's own error, and ten times what a change of the start in\n"
    "its last digit does to the end. It must also be below 1 % of the solution. The order is fitted to the longest\n"
    "run of such levels; the exit code is 3 if it misses the claimed order by more than 0.2, or if there are fewer\n"
    "than 4 such levels.\n"
    "\n"
    "Examples:\n"
    "  dvi order kepler --method galerkin:degree=2\n"
    "  dvi order pendulum --method verlet --method composition:order=6,base=verlet --plot order.svg\n"
    "  dvi order toda --method galerkin:degree=3,quadrature=lobatto,nodes=3 --h 0.5 --levels 8 --csv order.csv\n";

int order_command(int argc, char **argv)
{
  order_request r = {.h = (double)NAN, .t_end = (double)NAN, .ratio = (double)NAN, .levels = LEVELS_DEFAULT};
  const option options[] = {
      {.name = "method", .words = &r.methods, .value = "SPEC", .help = "a method: name[:key=value,...]; may be repeated"},
      {.name = "h", .number = &r.h, .value = "H", .help = "first step (T/H is rounded to whole steps); left out: searched"},
      {.name = "levels", .count = &r.levels, .value = "N", .help = "how many step sizes; left out: 6"},
      {.name = "ratio", .number = &r.ratio, .value = "R", .help = "of neighbouring steps; left out: 2, or less for high orders"},
      {.name = "t-end", .number = &r.t_end, .value = "T", .help = "the end; left out: the problem's for order studies"},
      {.name = "set", .words = &r.settings, .value = "NAME=VALUE", .help = "set a parameter of the problem; may be repeated"},
      {.name = "csv", .word = &r.csv, .value = "-|FILE", .help = "write the table as CSV; -: to standard output, words to stderr"},
      {.name = "plot", .word = &r.plot, .value = "FILE.svg", .help = "draw error against step, with the claimed slopes"},
      {.name = NULL},
  };
  const command_line command = {
      .name = "order",
      .synopsis = "PROBLEM --method SPEC [--method SPEC ...] [OPTIONS]",
      .operand = "PROBLEM",
      .summary = "Measure the order of methods: the error at the end for a sequence of steps, and the slope fitted to it.\n",
      .options = options,
      .details = details,
  };
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &name, &code)) return code;
  code = check_request(&r);
  if (code != DONE) return code;
  problem *scene;
  code = open_problem(name, &r.settings, &scene);
  if (code != DONE) return code;
  code = order(&r, scene);
  problem_destroy(&scene);
  return code;
}
