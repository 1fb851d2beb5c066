#include "bench/scale.h"

#include <dvi/study.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "load/axis.h"
#include "cli/command.h"
#include "csv/events.h"
#include "bench/machine.h"
#include "load/open.h"
#include "plot/plot.h"
#include "cli/progress.h"
#include "study/samples.h"
#include "study/clock.h"
#include "csv/table.h"

enum { STEPS_DEFAULT = 32, TITLE_SIZE = 160 };

/* One method at one value. */
typedef struct scale_result {
  int n;
  double h;
  double step[DVI_STUDY_ROUNDS_MAX];   /* seconds of one step, in each round */
  dvi_study_spread seconds;            /* seconds over all rounds, set at their end */
  double create[DVI_STUDY_ROUNDS_MAX]; /* seconds of creation and start, in each round */
  double first
      [DVI_STUDY_ROUNDS_MAX]; /* seconds of the first step with its preparations, in each round */
  dvi_study_spread creation, first_step;
  double bytes;         /* NaN if not known */
  dvi_counters counted; /* counters of the steps of one run */
  double traffic;       /* bytes that a step moves, 0 if not known */
  /* bytes a second of an axpy beside the steps, in each round, where the traffic is known */
  double axpy[DVI_STUDY_ROUNDS_MAX];
  dvi_study_spread bandwidth; /* spread of axpy */
} scale_result;

typedef struct scaling {
  const scale_request *request;
  scale_axis axis;
  long steps;         /* steps of one run */
  scale_result *cell; /* [methods][values] */
  dvi_study_spread calibration;
  progress_line progress;
} scaling;

static const table_column columns[] = {
    {"method", NULL},
    {"problem", NULL},
    {"parameter", NULL},
    {"value", "%.6g"},
    {"n", "%.0f"},
    {"h", "%.6g"},
    {"step_seconds", "%.3e"},
    {"step_lower", "%.3e"},
    {"step_upper", "%.3e"},
    {"bytes", "%.0f"},
    {"create_seconds", "%.3e"},
    {"first_seconds", "%.3e"},
    {"step_evaluations", "%.2f"},
    {"step_residuals", "%.2f"},
    {"step_factorizations", "%.2f"},
    {"calibration_seconds", ""},
    {"calibration_least", ""},
    {NULL, NULL},
};

static scale_result *scale_cell(const scaling *s, int method, int k)
{
  return &s->cell[method * s->axis.values.count + k];
}

/* Read the clock. With several threads, process time would be the sum of theirs. */
static double scale_clock(const scaling *s)
{
  return s->axis.parallel ? elapsed_now() : dvi_study_clock();
}

/* Time the first steps from the start, and count their work. */
static dvi_status scale_run_steps(const scaling *s, dvi_integrator *integrator,
                                  const problem *scene, scale_result *c, double *spent)
{
  dvi_counters before;
  dvi_status status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  dvi_integrator_counters(integrator, &before);
  const double began = scale_clock(s);
  for (long i = 0; i < s->steps && status == DVI_OK; i++)
    status = dvi_integrator_step(integrator, c->h);
  *spent = scale_clock(s) - began;
  dvi_integrator_counters(integrator, &c->counted);
  c->counted.gradients -= before.gradients;
  c->counted.residuals -= before.residuals;
  c->counted.factorizations -= before.factorizations;
  return status;
}

/* Create the integrator, and measure its first step. A step analyses, factors and allocates what it
 * needs first, so that the first step of all is measured apart. */
static dvi_status scale_create_and_step(const scaling *s, const char *method, const problem *scene,
                                        scale_result *c, int round, dvi_integrator **integrator)
{
  const double began = scale_clock(s);
  dvi_status status = dvi_integrator_create(scene->system, method, integrator);
  if (status == DVI_OK) status = dvi_integrator_start(*integrator, 0.0, scene->q, scene->p);
  const double created = scale_clock(s);
  if (status == DVI_OK) status = dvi_integrator_step(*integrator, c->h);
  c->create[round] = created - began;
  c->first[round] = scale_clock(s) - created;
  return status;
}

static dvi_status measure_cell(const scaling *s, const char *method, const problem *scene,
                               scale_result *c, int round)
{
  dvi_integrator *integrator = NULL;
  double spent = 0.0;
  double total = 0.0;
  const double heap = machine_heap();
  dvi_status status = scale_create_and_step(s, method, scene, c, round, &integrator);
  /* The first run fills memory and the machine's caches, and is not timed. */
  for (int i = 0; i < 2 && status == DVI_OK; i++)
    status = scale_run_steps(s, integrator, scene, c, &spent);
  const double grown = machine_heap() - heap;
  if (round == 0)
    c->bytes = grown > 0.0 ? grown : (double)NAN; /* another malloc does not show there */
  const long repeats = dvi_study_repeats(spent);
  for (long i = 0; i < repeats && status == DVI_OK; i++) {
    status = scale_run_steps(s, integrator, scene, c, &spent);
    total += spent;
  }
  c->step[round] = total / ((double)s->steps * (double)repeats);
  c->traffic = dvi_integrator_traffic(integrator);
  dvi_integrator_destroy(&integrator);
  return status;
}

static int measure_methods(scaling *s, const problem *scene, int k, int round)
{
  char method[SPECIFICATION_SIZE];
  int code = DONE;
  for (int i = 0; i < s->request->methods->count && code == DONE; i++) {
    scale_result *c = scale_cell(s, i, k);
    c->n = scene->nq;
    c->h = isnan(s->request->h) ? scene->h : s->request->h;
    progress_show(&s->progress, -1.0, s->request->methods->word[i]);
    code = axis_method(&s->axis, k, s->request->methods->word[i], method);
    if (code != DONE) break;
    const dvi_status status = measure_cell(s, method, scene, c, round);
    if (status != DVI_OK) code = library_error(status);
    if (c->traffic > 0.0) c->axpy[round] = machine_axpy(c->n);
  }
  return code;
}

static int measure_value(scaling *s, int k, int round)
{
  problem *scene;
  int code = axis_problem(&s->axis, k, s->request->problem, s->request->settings,
                          s->request->one_point, &scene);
  if (code != DONE) return code;
  code = measure_methods(s, scene, k, round);
  problem_destroy(&scene);
  return code;
}

/* Measure everything once in every round, so that whatever slows the machine for a while slows all
 * of it. */
static int scale_measure(scaling *s)
{
  double calibration[DVI_STUDY_ROUNDS_MAX];
  const int rounds = (int)s->request->rounds;
  int code = DONE;
  progress_start(&s->progress, true);
  for (int round = 0; round < rounds && code == DONE; round++) {
    calibration[round] = machine_multiplications();
    for (int k = 0; k < s->axis.values.count && code == DONE; k++)
      code = measure_value(s, k, round);
  }
  progress_end(&s->progress);
  if (code != DONE) return code;
  s->calibration = dvi_study_spread_of(rounds, calibration);
  for (int i = 0; i < s->request->methods->count * s->axis.values.count; i++) {
    s->cell[i].seconds = dvi_study_spread_of(rounds, s->cell[i].step);
    s->cell[i].creation = dvi_study_spread_of(rounds, s->cell[i].create);
    s->cell[i].first_step = dvi_study_spread_of(rounds, s->cell[i].first);
    s->cell[i].bandwidth = dvi_study_spread_of(rounds, s->cell[i].axpy);
  }
  return DONE;
}

static result_table *scale_table(const scaling *s)
{
  result_table *rows = table_create(columns);
  for (int i = 0; i < s->request->methods->count; i++)
    for (int k = 0; k < s->axis.values.count; k++) {
      const scale_result *c = scale_cell(s, i, k);
      table_text(rows, s->request->methods->word[i]);
      table_text(rows, s->request->problem);
      table_text(rows, s->axis.name);
      table_number(rows, s->axis.values.number[k]);
      table_number(rows, c->n);
      table_number(rows, c->h);
      table_number(rows, c->seconds.median);
      table_number(rows, c->seconds.lower);
      table_number(rows, c->seconds.upper);
      table_number(rows, c->bytes);
      table_number(rows, c->creation.median);
      table_number(rows, c->first_step.median);
      table_number(rows, (double)c->counted.gradients / (double)s->steps);
      table_number(rows, (double)c->counted.residuals / (double)s->steps);
      table_number(rows, (double)c->counted.factorizations / (double)s->steps);
      table_number(rows, s->calibration.median);
      table_number(rows, s->calibration.least);
    }
  return rows;
}

static void print_power(FILE *stream, const scaling *s, const char *name, const double *x,
                        const double *y)
{
  const double exponent = samples_power(s->axis.values.count, x, y);
  if (isnan(exponent))
    (void)fprintf(stream, "  %s: not known", name);
  else
    (void)fprintf(stream, "  %s ~ %s^%.2f", name, axis_symbol(&s->axis), exponent);
}

static void print_powers(FILE *stream, const scaling *s, int method)
{
  double x[NUMBERS_MAX];
  double seconds[NUMBERS_MAX];
  double bytes[NUMBERS_MAX];
  double create[NUMBERS_MAX];
  double first[NUMBERS_MAX];
  double evaluations[NUMBERS_MAX];
  for (int k = 0; k < s->axis.values.count; k++) {
    const scale_result *c = scale_cell(s, method, k);
    x[k] = axis_abscissa(&s->axis, k, c->n);
    seconds[k] = c->seconds.median;
    bytes[k] = c->bytes;
    create[k] = c->creation.median;
    first[k] = c->first_step.median;
    evaluations[k] = (double)c->counted.gradients;
  }
  print_power(stream, s, "step_seconds", x, seconds);
  print_power(stream, s, "bytes", x, bytes);
  print_power(stream, s, "create_seconds", x, create);
  print_power(stream, s, "first_seconds", x, first);
  print_power(stream, s, "step_evaluations", x, evaluations);
  (void)fputc('\n', stream);
}

static void print_speed_up(FILE *stream, const scaling *s, int method)
{
  (void)fprintf(stream, "  speed-up against %s=%s:", s->axis.name, s->axis.values.text[0]);
  for (int k = 1; k < s->axis.values.count; k++)
    (void)fprintf(stream, "  %.2f",
                  scale_cell(s, method, 0)->seconds.median /
                      scale_cell(s, method, k)->seconds.median);
  (void)fputc('\n', stream);
}

/* Print the fraction of the machine's memory bandwidth that the steps use. */
static void print_traffic(FILE *stream, const scaling *s, int method)
{
  for (int k = 0; k < s->axis.values.count; k++) {
    const scale_result *c = scale_cell(s, method, k);
    const double moved = c->traffic / c->seconds.median;
    const double axpy = c->bandwidth.median;
    if (c->traffic > 0.0)
      (void)fprintf(stream,
                    "  %s=%s: a step moves %.4g bytes, %.1f GB/s: %.2f of the %.1f GB/s of an "
                    "in-place axpy\n",
                    s->axis.name, s->axis.values.text[k], c->traffic, 1e-9 * moved, moved / axpy,
                    1e-9 * axpy);
  }
}

static void print_meaning(FILE *stream, const scaling *s)
{
  (void)fprintf(stream,
                "\nstep_seconds: %s time of a step, mean of the first %ld from the start, "
                "repeated; median of %ld interleaved\n",
                s->axis.parallel ? "elapsed" : "process", s->steps, s->request->rounds);
  (void)fprintf(stream, "rounds; step_lower, step_upper: quartiles%s\n",
                s->axis.parallel ? "" : "; the fitted exponents are least squares over all rows");
  (void)fprintf(stream, "bytes: what the integrator holds of the heap after its first steps, by "
                        "mallinfo2; the problem's own is not counted\n"
                        "create_seconds, first_seconds: creation and start, and the first step "
                        "after it with all that it\n"
                        "prepares; medians of the rounds\n");
}

static void scale_print(FILE *stream, const scaling *s, const result_table *rows)
{
  (void)fprintf(stream, "Cost of a step on %s\n", s->request->problem);
  machine_print(stream);
  machine_print_calibration(stream, &s->calibration);
  if (s->request->one_point) (void)fprintf(stream, "callbacks: one point a call\n");
  for (int i = 0; i < s->request->methods->count; i++) {
    (void)fprintf(stream, "\n%s\n", s->request->methods->word[i]);
    table_print(rows, stream, 2, i * s->axis.values.count, (i + 1) * s->axis.values.count);
    if (s->axis.parallel)
      print_speed_up(stream, s, i);
    else
      print_powers(stream, s, i);
    print_traffic(stream, s, i);
  }
  print_meaning(stream, s);
}

static bool scale_plot(const scaling *s)
{
  plot_curve curve[WORDS_MAX];
  char title[TITLE_SIZE];
  const char *y_label = s->axis.parallel ? "elapsed seconds of a step" : "CPU seconds of a step";
  const int methods = s->request->methods->count;
  const int values = s->axis.values.count;
  double *x = calloc(2 * (size_t)methods * (size_t)values, sizeof *x);
  if (x == NULL) {
    complain("out of memory for the plot");
    return false;
  }
  double *y = x + methods * values;
  for (int i = 0; i < methods * values; i++) {
    x[i] = axis_abscissa(&s->axis, i % values, s->cell[i].n);
    y[i] = s->cell[i].seconds.median;
  }
  for (int i = 0; i < methods; i++)
    curve[i] = (plot_curve){.label = s->request->methods->word[i],
                            .count = values,
                            .x = x + i * values,
                            .y = y + i * values};
  (void)snprintf(title, sizeof title, "%s time of a step against %s: %s",
                 s->axis.parallel ? "elapsed" : "CPU", axis_title(&s->axis), s->request->problem);
  const plot_panel panel = {.title = title,
                            .x_label = axis_title(&s->axis),
                            .y_label = y_label,
                            .logarithmic = true,
                            .curves = methods,
                            .curve = curve};
  const bool good = plot_write(s->request->plot, 1, &panel);
  free(x);
  return good;
}

static int scale_report(const scaling *s)
{
  const scale_request *request = s->request;
  const bool csv_only = request->csv != NULL && strcmp(request->csv, "-") == 0;
  result_table *rows = scale_table(s);
  bool good = table_good(rows);
  if (good) scale_print(csv_only ? stderr : stdout, s, rows);
  if (good && request->csv != NULL) good = table_write(rows, request->csv);
  if (good && request->plot != NULL) good = scale_plot(s);
  table_destroy(&rows);
  return good ? DONE : FAILED;
}

static int scale_check_methods(const scaling *s, const problem *scene, int k)
{
  char method[SPECIFICATION_SIZE];
  int code = DONE;
  for (int i = 0; i < s->request->methods->count && code == DONE; i++) {
    dvi_integrator *integrator = NULL;
    code = axis_method(&s->axis, k, s->request->methods->word[i], method);
    if (code == DONE) code = open_integrator(scene, method, &integrator);
    dvi_integrator_destroy(&integrator);
  }
  return code;
}

/* Check that value k makes a problem of another size than the values before it, n [k]. */
static int check_growth(const scaling *s, const int *n, int k)
{
  const char(*value)[NUMBER_SIZE] = s->axis.values.text;
  for (int j = 0; j < k && s->axis.kind == AXIS_PARAMETER; j++)
    if (n[j] == n[k])
      return usage_error("bench: --scale: %s has %d coordinates at %s=%s and at %s=%s alike; scale "
                         "a parameter that makes it grow",
                         s->request->problem, n[k], s->axis.name, value[j], s->axis.name, value[k]);
  return DONE;
}

/* Check that each problem and each specification can be created, before anything is measured. A
 * method's answer does not depend on the problem's size, so it is created once. */
static int check_values(const scaling *s)
{
  int n[NUMBERS_MAX];
  int code = DONE;
  for (int k = 0; k < s->axis.values.count && code == DONE; k++) {
    problem *scene;
    code = axis_problem(&s->axis, k, s->request->problem, s->request->settings,
                        s->request->one_point, &scene);
    if (code != DONE) return code;
    n[k] = scene->nq;
    if (k == 0 || s->axis.kind != AXIS_PARAMETER) code = scale_check_methods(s, scene, k);
    if (k == 0 && code == DONE) events_passed("bench", scene);
    problem_destroy(&scene);
    if (code == DONE) code = check_growth(s, n, k);
  }
  return code;
}

int scale_run(const scale_request *request)
{
  scaling s = {.request = request, .steps = request->steps > 0 ? request->steps : STEPS_DEFAULT};
  if (request->methods->count == 0)
    return usage_error("bench: --scale needs a method: --method SPEC");
  if (request->settings->count == WORDS_MAX)
    return usage_error("bench: --set is given too often for --scale");
  int code = axis_read(request->scaled, &s.axis);
  if (code == DONE) code = check_values(&s);
  if (code != DONE) return code;
  const int cells = request->methods->count * s.axis.values.count;
  s.cell = cells > 0 ? calloc((size_t)cells, sizeof *s.cell) : NULL;
  if (s.cell == NULL) {
    complain("out of memory");
    return FAILED;
  }
  code = scale_measure(&s);
  if (code == DONE) code = scale_report(&s);
  free(s.cell);
  return code;
}
