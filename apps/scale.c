#include "scale.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "machine.h"
#include "numbers.h"
#include "open.h"
#include "plot.h"
#include "progress.h"
#include "samples.h"
#include "study.h"
#include "table.h"

enum { STEPS = 32, SETTING_SIZE = 128, TITLE_SIZE = 160, METHOD_SIZE = 320 };

/* The one axis that is a key of the methods, not a parameter of the problem. */
static const char threads_key[] = "threads";

/* One method at one size. */
typedef struct cell {
  int n;
  double h;
  double cpu[ROUNDS_MAX];  /* seconds of a step, in each round */
  spread seconds;          /* of all rounds; set when they are over */
  double bytes;            /* NaN: not known */
  double evaluations;      /* of a step */
  double traffic;          /* bytes that a step moves; 0: not known */
  double axpy[ROUNDS_MAX]; /* bytes a second that one moves beside it, in each round; only where the traffic is known */
} cell;

typedef struct scaling {
  const scale_request *request;
  char parameter[SETTING_SIZE];
  numbers sizes;
  cell *cell; /* [methods][sizes] */
  spread calibration;
  bool threads; /* the axis is threads_key */
  long steps;
  progress_line progress;
} scaling;

static const table_column columns[] = {
    {"method", NULL},       {"problem", NULL}, {"parameter", NULL},          {"value", "%.6g"},
    {"n", "%.0f"},          {"h", "%.6g"},     {"step_seconds", "%.3e"},     {"step_lower", "%.3e"},
    {"step_upper", "%.3e"}, {"bytes", "%.0f"}, {"step_evaluations", "%.2f"}, {NULL, NULL},
};

static cell *cell_at(const scaling *s, int method, int size)
{
  return &s->cell[method * s->sizes.count + size];
}

/* Make the problem at one of the sizes. */
static int open_size(const scaling *s, int size, problem **scene)
{
  char setting[2 * SETTING_SIZE];
  words settings = *s->request->settings; /* of which scale_run left one free */
  if (s->threads) return open_problem(s->request->problem, &settings, scene);
  (void)snprintf(setting, sizeof setting, "%s=%s", s->parameter, s->sizes.text[size]);
  settings.word[settings.count++] = setting;
  return open_problem(s->request->problem, &settings, scene);
}

/* The specification of a method at one place of the axis; `text` [METHOD_SIZE] holds it if it is not the method's own. */
static const char *method_at(const scaling *s, int method, int size, char *text)
{
  const char *word = s->request->methods->word[method];
  if (!s->threads) return word;
  (void)snprintf(text, METHOD_SIZE, "%s%c%s=%s", word, strchr(word, ':') != NULL ? ',' : ':', s->parameter, s->sizes.text[size]);
  return text;
}

static double now(const scaling *s)
{
  return s->threads ? elapsed_now() : cpu_now();
}

static long evaluations_of(const dvi_integrator *integrator)
{
  dvi_counters counters;
  dvi_integrator_counters(integrator, &counters);
  return counters.gradients;
}

/* The first steps from the start: their time, and the points at which they evaluated the gradient. */
static dvi_status run_steps(const scaling *s, dvi_integrator *integrator, const problem *scene, double h, double *spent,
                            long *evaluations)
{
  dvi_status status = dvi_integrator_start(integrator, 0.0, scene->q, scene->p);
  const long before = evaluations_of(integrator);
  const double began = now(s);
  for (long i = 0; i < s->steps && status == DVI_OK; i++) status = dvi_integrator_step(integrator, h);
  *spent = now(s) - began;
  *evaluations = evaluations_of(integrator) - before;
  return status;
}

static dvi_status measure_cell(const scaling *s, const char *method, const problem *scene, cell *c, int round)
{
  dvi_integrator *integrator = NULL;
  double spent = 0.0;
  double total = 0.0;
  long evaluations = 0;
  const double heap = machine_heap();
  dvi_status status = dvi_integrator_create(scene->system, method, &integrator);
  /* The first run finds memory and the machine's caches as they will be: it is not timed. */
  for (int i = 0; i < 2 && status == DVI_OK; i++) status = run_steps(s, integrator, scene, c->h, &spent, &evaluations);
  const double grown = machine_heap() - heap;
  if (round == 0) c->bytes = grown > 0.0 ? grown : (double)NAN; /* another malloc does not show there */
  const long repeats = study_repeats(spent);
  for (long i = 0; i < repeats && status == DVI_OK; i++) {
    status = run_steps(s, integrator, scene, c->h, &spent, &evaluations);
    total += spent;
  }
  c->evaluations = (double)evaluations / (double)s->steps;
  c->cpu[round] = total / ((double)s->steps * (double)repeats);
  c->traffic = dvi_integrator_traffic(integrator);
  dvi_integrator_destroy(&integrator);
  return status;
}

static int measure_size(scaling *s, int size, int round)
{
  problem *scene;
  int code = open_size(s, size, &scene);
  if (code != DONE) return code;
  for (int i = 0; i < s->request->methods->count && code == DONE; i++) {
    cell *c = cell_at(s, i, size);
    c->n = scene->n;
    c->h = isnan(s->request->h) ? scene->h : s->request->h;
    char text[METHOD_SIZE];
    progress_show(&s->progress, -1.0, s->request->methods->word[i]);
    const dvi_status status = measure_cell(s, method_at(s, i, size, text), scene, c, round);
    if (status != DVI_OK) code = library_error(status);
    if (c->traffic > 0.0) c->axpy[round] = machine_axpy(c->n);
  }
  problem_destroy(&scene);
  return code;
}

/* Every round measures everything once, so that whatever slows the machine for a while slows all of it. */
static int measure(scaling *s)
{
  double calibration[ROUNDS_MAX];
  const int rounds = (int)s->request->rounds;
  int code = DONE;
  progress_start(&s->progress, true);
  for (int round = 0; round < rounds && code == DONE; round++) {
    calibration[round] = machine_multiplications();
    for (int size = 0; size < s->sizes.count && code == DONE; size++) code = measure_size(s, size, round);
  }
  progress_end(&s->progress);
  if (code != DONE) return code;
  s->calibration = samples_spread(rounds, calibration);
  for (int i = 0; i < s->request->methods->count * s->sizes.count; i++) s->cell[i].seconds = samples_spread(rounds, s->cell[i].cpu);
  return DONE;
}

static result_table *make_table(const scaling *s)
{
  result_table *rows = table_create(columns);
  for (int i = 0; i < s->request->methods->count; i++)
    for (int k = 0; k < s->sizes.count; k++) {
      const cell *c = cell_at(s, i, k);
      table_text(rows, s->request->methods->word[i]);
      table_text(rows, s->request->problem);
      table_text(rows, s->parameter);
      table_number(rows, s->sizes.number[k]);
      table_number(rows, c->n);
      table_number(rows, c->h);
      table_number(rows, c->seconds.median);
      table_number(rows, c->seconds.lower);
      table_number(rows, c->seconds.upper);
      table_number(rows, c->bytes);
      table_number(rows, c->evaluations);
    }
  return rows;
}

static void print_power(FILE *stream, const char *name, int count, const double *n, const double *y)
{
  const double exponent = samples_power(count, n, y);
  if (isnan(exponent))
    (void)fprintf(stream, "  %s: not known", name);
  else
    (void)fprintf(stream, "  %s ~ n^%.2f", name, exponent);
}

static void print_speed_up(FILE *stream, const scaling *s, int method)
{
  (void)fprintf(stream, "  speed-up against %s=%s:", s->parameter, s->sizes.text[0]);
  for (int k = 1; k < s->sizes.count; k++)
    (void)fprintf(stream, "  %.2f", cell_at(s, method, 0)->seconds.median / cell_at(s, method, k)->seconds.median);
  (void)fputc('\n', stream);
}

/* How much of the machine's memory bandwidth the steps use. Sorts the rounds of the axpy. */
static void print_traffic(FILE *stream, const scaling *s, int method)
{
  for (int k = 0; k < s->sizes.count; k++) {
    cell *c = cell_at(s, method, k);
    if (!(c->traffic > 0.0)) continue;
    const double axpy = samples_spread((int)s->request->rounds, c->axpy).median, moved = c->traffic / c->seconds.median;
    (void)fprintf(stream, "  %s=%s: a step moves %.4g bytes, %.1f GB/s: %.2f of the %.1f GB/s of an in-place axpy\n", s->parameter,
                  s->sizes.text[k], c->traffic, 1e-9 * moved, moved / axpy, 1e-9 * axpy);
  }
}

static void print_powers(FILE *stream, const scaling *s, int method)
{
  double n[NUMBERS_MAX];
  double seconds[NUMBERS_MAX];
  double bytes[NUMBERS_MAX];
  double evaluations[NUMBERS_MAX];
  const int count = s->sizes.count;
  for (int k = 0; k < count; k++) {
    const cell *c = cell_at(s, method, k);
    n[k] = c->n;
    seconds[k] = c->seconds.median;
    bytes[k] = c->bytes;
    evaluations[k] = c->evaluations;
  }
  print_power(stream, "step_seconds", count, n, seconds);
  print_power(stream, "bytes", count, n, bytes);
  print_power(stream, "step_evaluations", count, n, evaluations);
  (void)fputc('\n', stream);
}

static void print_all(FILE *stream, const scaling *s, const result_table *rows)
{
  (void)fprintf(stream, "Cost of a step on %s\n", s->request->problem);
  machine_print(stream);
  machine_print_calibration(stream, &s->calibration);
  for (int i = 0; i < s->request->methods->count; i++) {
    (void)fprintf(stream, "\n%s\n", s->request->methods->word[i]);
    table_print(rows, stream, 2, i * s->sizes.count, (i + 1) * s->sizes.count);
    s->threads ? print_speed_up(stream, s, i) : print_powers(stream, s, i);
    print_traffic(stream, s, i);
  }
  (void)fprintf(stream,
                "\nstep_seconds: %s time of a step, mean of the first %ld from the start, repeated; median of %ld interleaved\n",
                s->threads ? "elapsed" : "process", s->steps, s->request->rounds);
  (void)fprintf(stream, "rounds; step_lower, step_upper: quartiles%s\n",
                s->threads ? "" : "; the fitted exponents are least squares over all rows");
  (void)fprintf(
      stream,
      "bytes: what the integrator holds of the heap after its first steps, by mallinfo2; the problem's own is not counted\n");
}

static bool plot_cells(const scaling *s)
{
  plot_curve curve[WORDS_MAX];
  char title[TITLE_SIZE];
  const int methods = s->request->methods->count;
  const int sizes = s->sizes.count;
  double *x = calloc(2 * (size_t)methods * (size_t)sizes, sizeof *x);
  if (x == NULL) {
    complain("out of memory for the plot");
    return false;
  }
  double *y = x + methods * sizes;
  for (int i = 0; i < methods * sizes; i++) {
    x[i] = s->threads ? s->sizes.number[i % sizes] : s->cell[i].n;
    y[i] = s->cell[i].seconds.median;
  }
  for (int i = 0; i < methods; i++)
    curve[i] = (plot_curve){.label = s->request->methods->word[i], .count = sizes, .x = x + i * sizes, .y = y + i * sizes};
  (void)snprintf(title, sizeof title, s->threads ? "time of a step against threads: %s" : "CPU time of a step against size: %s",
                 s->request->problem);
  const plot_panel panel = {.title = title,
                            .x_label = s->threads ? "threads" : "coordinates",
                            .y_label = s->threads ? "seconds of a step" : "CPU seconds of a step",
                            .logarithmic = true,
                            .curves = methods,
                            .curve = curve};
  const bool good = plot_write(s->request->plot, 1, &panel);
  free(x);
  return good;
}

static int report(const scaling *s)
{
  const scale_request *request = s->request;
  const bool csv_only = request->csv != NULL && strcmp(request->csv, "-") == 0;
  result_table *rows = make_table(s);
  bool good = table_good(rows);
  if (good) print_all(csv_only ? stderr : stdout, s, rows);
  if (good && request->csv != NULL) good = table_write(rows, request->csv);
  if (good && request->plot != NULL) good = plot_cells(s);
  table_destroy(&rows);
  return good ? DONE : FAILED;
}

/* Split "ell=100,1000" into the parameter and its values. */
static int read_sizes(scaling *s)
{
  const char *text = s->request->sizes;
  const size_t length = strcspn(text, "=");
  if (text[length] == '\0' || length == 0 || length >= SETTING_SIZE)
    return usage_error("bench: --scale wants a parameter of the problem and its values, NAME=V1,V2,..., not '%s'", text);
  (void)snprintf(s->parameter, sizeof s->parameter, "%.*s", (int)length, text);
  s->threads = strcmp(s->parameter, threads_key) == 0;
  const int code = numbers_read("bench: --scale", text + length + 1, &s->sizes);
  if (code == DONE && s->sizes.count < 2)
    return usage_error("bench: --scale needs two values at least: with %s there is nothing to compare", text);
  return code;
}

/* Before anything is measured: every size can be made, is another one, and every method can run on the first. */
static int check_sizes(const scaling *s)
{
  int n[NUMBERS_MAX];
  int code = DONE;
  for (int k = 0; k < s->sizes.count && code == DONE; k++) {
    problem *scene;
    code = open_size(s, k, &scene);
    if (code != DONE) return code;
    n[k] = scene->n;
    for (int i = 0; i < s->request->methods->count && (k == 0 || s->threads) && code == DONE; i++) {
      char text[METHOD_SIZE];
      dvi_integrator *integrator = NULL;
      code = open_integrator(scene, method_at(s, i, k, text), &integrator);
      dvi_integrator_destroy(&integrator);
    }
    problem_destroy(&scene);
    for (int j = 0; j < k && !s->threads && code == DONE; j++)
      if (n[j] == n[k])
        code = usage_error(
            "bench: --scale: %s has %d coordinates at %s=%s and at %s=%s alike; scale a parameter that makes it grow",
            s->request->problem, n[k], s->parameter, s->sizes.text[j], s->parameter, s->sizes.text[k]);
  }
  return code;
}

int scale_run(const scale_request *request)
{
  scaling s = {.request = request, .steps = request->steps > 0 ? request->steps : STEPS};
  if (request->methods->count == 0) return usage_error("bench: --scale needs a method: --method SPEC");
  if (request->settings->count == WORDS_MAX) return usage_error("bench: --set is given too often for --scale");
  int code = read_sizes(&s);
  if (code == DONE) code = check_sizes(&s);
  if (code != DONE) return code;
  const int cells = request->methods->count * s.sizes.count;
  s.cell = cells > 0 ? calloc((size_t)cells, sizeof *s.cell) : NULL;
  if (s.cell == NULL) {
    complain("out of memory");
    return FAILED;
  }
  code = measure(&s);
  if (code == DONE) code = report(&s);
  free(s.cell);
  return code;
}
