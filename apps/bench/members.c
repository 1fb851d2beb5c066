#include "bench/members.h"

#include <dvi/study.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/events.h"
#include "bench/machine.h"
#include "cli/numbers.h"
#include "load/open.h"
#include "plot/plot.h"
#include "cli/progress.h"
#include "csv/table.h"

enum { STEPS_DEFAULT = 64, MEMBERS_MOST = 1000000, LABEL_SIZE = 300 };

/* Members start within this fraction of the problem's own start, number by number. */
static const double around = 0.01;

static const char axis_word[] = "members=";

/* One method with one number of members. */
typedef struct members_result {
  double together[DVI_STUDY_ROUNDS_MAX]; /* seconds of a member's step, in each round */
  double alone[DVI_STUDY_ROUNDS_MAX];
  dvi_study_spread of_together, of_alone;
  double evaluations; /* evaluations of a step */
} members_result;

typedef struct comparison {
  const scale_request *request;
  numbers counts;
  problem *scene;
  double h;
  long steps;           /* steps of one run */
  double *q, *p;        /* [n*members] starts of the members */
  double *point;        /* [2 n] state of one member */
  members_result *cell; /* [methods][counts] */
  dvi_study_spread calibration;
  progress_line progress;
} comparison;

static const table_column columns[] = {
    {"method", NULL},
    {"problem", NULL},
    {"members", "%.0f"},
    {"n", "%.0f"},
    {"h", "%.6g"},
    {"step_seconds", "%.3e"},
    {"step_lower", "%.3e"},
    {"step_upper", "%.3e"},
    {"alone_seconds", "%.3e"},
    {"alone_lower", "%.3e"},
    {"alone_upper", "%.3e"},
    {"gain", "%.2f"},
    {"step_evaluations", "%.2f"},
    {NULL, NULL},
};

bool members_asked(const char *scaled)
{
  return strncmp(scaled, axis_word, sizeof axis_word - 1) == 0;
}

static members_result *members_cell(const comparison *c, int method, int k)
{
  return &c->cell[method * c->counts.count + k];
}

/* Return a factor near 1, another one for each number. */
static double factor_of(double number)
{
  return 1.0 + around * (fmod(0.618033988749895 * (number + 1.0), 1.0) - 0.5);
}

/* Numbers near a start on a manifold are off it. Members differ in their speeds there. */
static bool starts_on_manifold(const problem *scene)
{
  return scene->velocity != NULL || scene->terms->holonomic_count > 0;
}

/* Place a member. A one-form determines p for any v. */
static dvi_status place_member(const comparison *c, int k)
{
  const int n = c->scene->nq;
  const bool on_manifold = starts_on_manifold(c->scene);
  double *q = c->point, *p = c->point + n;
  for (int i = 0; i < n; i++) {
    const double factor = factor_of(on_manifold ? k : (double)k * n + i);
    q[i] = on_manifold ? c->scene->q[i] : factor * c->scene->q[i];
    if (i < c->scene->nv) p[i] = factor * c->scene->p[i];
  }
  return c->scene->terms->one_form != NULL
             ? dvi_system_momentum(c->scene->system, 0.0, q, c->scene->q, p)
             : DVI_OK;
}

/* Place the members. No two members are alike, and they are the same in every run of this
 * command. */
static dvi_status place_members(comparison *c, int members)
{
  const size_t n = (size_t)c->scene->nq, count = (size_t)members;
  dvi_status status = DVI_OK;
  for (size_t k = 0; k < count && status == DVI_OK; k++) {
    status = place_member(c, (int)k);
    for (size_t i = 0; i < n; i++) {
      c->q[i * count + k] = c->point[i];
      c->p[i * count + k] = c->point[n + i];
    }
  }
  return status;
}

/* ---- runs together and alone ---- */

static dvi_status run_together(const comparison *c, dvi_ensemble *ensemble, double *spent)
{
  const double began = dvi_study_clock();
  dvi_status status = dvi_ensemble_start(ensemble, 0.0, c->q, c->p);
  if (status == DVI_OK) status = dvi_ensemble_advance(ensemble, c->h, c->steps);
  *spent = dvi_study_clock() - began;
  return status;
}

static dvi_status run_one_alone(const comparison *c, dvi_integrator *integrator, size_t members,
                                size_t k)
{
  const size_t n = (size_t)c->scene->nq;
  for (size_t i = 0; i < n; i++) {
    c->point[i] = c->q[i * members + k];
    c->point[n + i] = c->p[i * members + k];
  }
  dvi_status status = dvi_integrator_start(integrator, 0.0, c->point, c->point + n);
  for (long i = 0; i < c->steps && status == DVI_OK; i++)
    status = dvi_integrator_step(integrator, c->h);
  return status;
}

static dvi_status run_alone(const comparison *c, dvi_integrator *integrator, int members,
                            double *spent)
{
  dvi_status status = DVI_OK;
  const double began = dvi_study_clock();
  for (int k = 0; k < members && status == DVI_OK; k++)
    status = run_one_alone(c, integrator, (size_t)members, (size_t)k);
  *spent = dvi_study_clock() - began;
  return status;
}

static dvi_status measure_together(const comparison *c, const char *method, int members,
                                   double *seconds, double *evaluations)
{
  const dvi_ensemble_options options = {.members = members};
  dvi_ensemble *ensemble = NULL;
  dvi_counters before;
  dvi_counters after;
  double spent = 0.0;
  double total = 0.0;
  dvi_status status = dvi_ensemble_create(c->scene->system, method, &options, &ensemble);
  /* The first run fills memory and the machine's caches, and is not timed. */
  if (status == DVI_OK) status = run_together(c, ensemble, &spent);
  dvi_ensemble_counters(ensemble, &before);
  const long repeats = dvi_study_repeats(spent);
  for (long i = 0; i < repeats && status == DVI_OK; i++) {
    status = run_together(c, ensemble, &spent);
    total += spent;
  }
  dvi_ensemble_counters(ensemble, &after);
  dvi_ensemble_destroy(&ensemble);
  *seconds = total / ((double)c->steps * (double)members * (double)repeats);
  *evaluations = (double)(after.gradients - before.gradients) /
                 ((double)c->steps * (double)members * (double)repeats);
  return status;
}

static dvi_status measure_alone(const comparison *c, const char *method, int members,
                                double *seconds)
{
  dvi_integrator *integrator = NULL;
  double spent = 0.0;
  double total = 0.0;
  dvi_status status = dvi_integrator_create(c->scene->system, method, &integrator);
  if (status == DVI_OK) status = run_alone(c, integrator, members, &spent);
  const long repeats = dvi_study_repeats(spent);
  for (long i = 0; i < repeats && status == DVI_OK; i++) {
    status = run_alone(c, integrator, members, &spent);
    total += spent;
  }
  dvi_integrator_destroy(&integrator);
  *seconds = total / ((double)c->steps * (double)members * (double)repeats);
  return status;
}

static int measure_round(comparison *c, int round)
{
  for (int k = 0; k < c->counts.count; k++) {
    const int members = (int)c->counts.number[k];
    dvi_status status = place_members(c, members);
    if (status != DVI_OK) return library_error(status);
    for (int i = 0; i < c->request->methods->count; i++) {
      const char *method = c->request->methods->word[i];
      members_result *at = members_cell(c, i, k);
      progress_show(&c->progress, -1.0, method);
      status = measure_together(c, method, members, &at->together[round], &at->evaluations);
      if (status == DVI_OK) status = measure_alone(c, method, members, &at->alone[round]);
      if (status != DVI_OK) return library_error(status);
    }
  }
  return DONE;
}

static int members_measure(comparison *c)
{
  double calibration[DVI_STUDY_ROUNDS_MAX];
  const int rounds = (int)c->request->rounds;
  int code = DONE;
  progress_start(&c->progress, true);
  for (int round = 0; round < rounds && code == DONE; round++) {
    calibration[round] = machine_multiplications();
    code = measure_round(c, round);
  }
  progress_end(&c->progress);
  if (code != DONE) return code;
  c->calibration = dvi_study_spread_of(rounds, calibration);
  for (int i = 0; i < c->request->methods->count * c->counts.count; i++) {
    c->cell[i].of_together = dvi_study_spread_of(rounds, c->cell[i].together);
    c->cell[i].of_alone = dvi_study_spread_of(rounds, c->cell[i].alone);
  }
  return DONE;
}

/* ---- report ---- */

static void add_spread(result_table *rows, const dvi_study_spread *seconds)
{
  table_number(rows, seconds->median);
  table_number(rows, seconds->lower);
  table_number(rows, seconds->upper);
}

static result_table *members_table(const comparison *c)
{
  result_table *rows = table_create(columns);
  for (int i = 0; i < c->request->methods->count; i++)
    for (int k = 0; k < c->counts.count; k++) {
      const members_result *at = members_cell(c, i, k);
      table_text(rows, c->request->methods->word[i]);
      table_text(rows, c->request->problem);
      table_number(rows, c->counts.number[k]);
      table_number(rows, c->scene->nq);
      table_number(rows, c->h);
      add_spread(rows, &at->of_together);
      add_spread(rows, &at->of_alone);
      table_number(rows, at->of_alone.median / at->of_together.median);
      table_number(rows, at->evaluations);
    }
  return rows;
}

static void members_print(FILE *stream, const comparison *c, const result_table *rows)
{
  (void)fprintf(stream, "Cost of a member's step on %s\n", c->request->problem);
  machine_print(stream);
  machine_print_calibration(stream, &c->calibration);
  for (int i = 0; i < c->request->methods->count; i++) {
    (void)fprintf(stream, "\n%s\n", c->request->methods->word[i]);
    table_print(rows, stream, 2, i * c->counts.count, (i + 1) * c->counts.count);
  }
  (void)fprintf(stream, "\nstep_seconds: process time of a member's step in an ensemble on one "
                        "thread, alone_seconds: in runs one after\n");
  (void)fprintf(stream,
                "the other; means of the first %ld steps, the start included, repeated; medians of "
                "%ld interleaved rounds\n",
                c->steps, c->request->rounds);
  (void)fprintf(stream, "gain: alone_seconds over step_seconds\n");
}

/* Plot two curves for each method. */
static bool members_plot(const comparison *c)
{
  plot_curve curve[2 * WORDS_MAX];
  static char label[2 * WORDS_MAX][LABEL_SIZE];
  const int methods = c->request->methods->count;
  const int counts = c->counts.count;
  double *y = calloc(2 * (size_t)methods * (size_t)counts, sizeof *y);
  if (y == NULL) {
    complain("out of memory for the plot");
    return false;
  }
  for (int i = 0; i < 2 * methods; i++) {
    for (int k = 0; k < counts; k++) {
      const members_result *at = members_cell(c, i / 2, k);
      y[i * counts + k] = i % 2 == 0 ? at->of_together.median : at->of_alone.median;
    }
    (void)snprintf(label[i], sizeof label[i], "%s%s", c->request->methods->word[i / 2],
                   i % 2 == 0 ? "" : ", alone");
    curve[i] = (plot_curve){
        .label = label[i], .count = counts, .x = c->counts.number, .y = y + i * counts};
  }
  const plot_panel panel = {.title = "CPU time of a member's step against the number of members",
                            .x_label = "members",
                            .y_label = "CPU seconds of a member's step",
                            .logarithmic = true,
                            .curves = 2 * methods,
                            .curve = curve};
  const bool good = plot_write(c->request->plot, 1, &panel);
  free(y);
  return good;
}

static int members_report(const comparison *c)
{
  const scale_request *request = c->request;
  const bool csv_only = request->csv != NULL && strcmp(request->csv, "-") == 0;
  result_table *rows = members_table(c);
  bool good = table_good(rows);
  if (good) members_print(csv_only ? stderr : stdout, c, rows);
  if (good && request->csv != NULL) good = table_write(rows, request->csv);
  if (good && request->plot != NULL) good = members_plot(c);
  table_destroy(&rows);
  return good ? DONE : FAILED;
}

/* ---- request ---- */

static int members_read_counts(comparison *c)
{
  const int code = numbers_read("bench: --scale", c->request->scaled + sizeof axis_word - 1,
                                &c->counts);
  for (int k = 0; k < c->counts.count && code == DONE; k++)
    if (c->counts.number[k] != floor(c->counts.number[k]) || c->counts.number[k] > MEMBERS_MOST)
      return usage_error("bench: --scale members=%s: a whole number from 1 to %d is wanted",
                         c->counts.text[k], (int)MEMBERS_MOST);
  return code;
}

static int members_check_methods(const comparison *c)
{
  int code = DONE;
  for (int i = 0; i < c->request->methods->count && code == DONE; i++) {
    dvi_integrator *integrator = NULL;
    code = open_integrator(c->scene, c->request->methods->word[i], &integrator);
    dvi_integrator_destroy(&integrator);
  }
  return code;
}

static bool members_allocate(comparison *c)
{
  double most = 0.0;
  for (int k = 0; k < c->counts.count; k++) most = fmax(most, c->counts.number[k]);
  const size_t numbers_of_all = (size_t)most * (size_t)c->scene->nq;
  c->q = calloc(numbers_of_all, sizeof *c->q);
  c->p = calloc(numbers_of_all, sizeof *c->p);
  c->point = calloc(2 * (size_t)c->scene->nq, sizeof *c->point);
  c->cell = calloc((size_t)c->request->methods->count * (size_t)c->counts.count, sizeof *c->cell);
  return c->q != NULL && c->p != NULL && c->point != NULL && c->cell != NULL;
}

int members_run(const scale_request *request)
{
  comparison c = {.request = request, .steps = request->steps > 0 ? request->steps : STEPS_DEFAULT};
  if (request->methods->count == 0)
    return usage_error("bench: --scale needs a method: --method SPEC");
  int code = members_read_counts(&c);
  if (code == DONE)
    code = open_shaped(request->problem, request->settings, request->one_point, &c.scene);
  if (code != DONE) return code;
  c.h = isnan(request->h) ? c.scene->h : request->h;
  code = members_check_methods(&c);
  if (code == DONE) events_passed("bench", c.scene);
  if (code == DONE && !members_allocate(&c)) {
    complain("out of memory");
    code = FAILED;
  }
  if (code == DONE) code = members_measure(&c);
  if (code == DONE) code = members_report(&c);
  free(c.q);
  free(c.p);
  free(c.point);
  free(c.cell);
  problem_destroy(&c.scene);
  return code;
}
