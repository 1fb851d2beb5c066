#include "watch/verify.h"

#include <dvi/reference.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "csv/columns.h"
#include "cli/command.h"
#include "watch/energy_watch.h"
#include "csv/events.h"
#include "mechanics/judge.h"
#include "load/natural_scale.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "study/trust.h"
#include "watch/verify_report.h"

/* IDA's three runs may take as long as those of the method, or so many seconds. Nothing ends a
 * factorisation on the way: so many coordinates bound that of a full Jacobian, which has three
 * unknowns for each. */
enum { WITNESS_STEPS = 200000 };
static const double witness_seconds = 2.0;

/* The distances of IDA's runs, whose tolerances are apart by such a factor, tell its own error
 * up to the other one. */
static const double tolerance_factor = 10.0, doubt = 10.0;

static const char ended_again[] = "dvi: run: a second Ctrl-C ended the verification at once\n";

/* The numbers of an end: t, q, p, and the columns. */
typedef struct verifier {
  const run_request *request;
  const problem *scene;
  dvi_integrator *integrator;
  run_columns columns;
  event_list events;
  progress_line progress;
  const volatile sig_atomic_t *caught;
  int count;
  double *number[TRUST_LEVELS];  /* [count] the ends */
  double *witness[TRUST_LEVELS]; /* [count] those of the other method, the tightest one first */
  double *witness_error;         /* [count] what it leaves uncertain */
  natural_scale scale;           /* of the invariants */
  double seconds;                /* of process time that the levels took */
  double *size;                  /* [count] largest magnitudes on the way */
  double *error;                 /* [count] */
  int level;
  long steps;
  trust_verdict verdict;
} verifier;

static bool start(verifier *v)
{
  const dvi_start_options options = {.project = v->request->project};
  const dvi_status status = dvi_integrator_start_with(v->integrator, 0.0, v->scene->q, v->scene->p, &options);
  return status == DVI_OK || library_error(status) == DONE;
}

static bool read_numbers(verifier *v, double *number)
{
  const size_t nq = (size_t)v->scene->nq, nv = (size_t)v->scene->nv;
  if (!columns_measure(&v->columns, v->integrator)) return false;
  number[0] = dvi_integrator_time(v->integrator);
  memcpy(number + 1, dvi_integrator_q(v->integrator), nq * sizeof *number);
  memcpy(number + 1 + nq, dvi_integrator_p(v->integrator), nv * sizeof *number);
  for (int k = 0; k < v->columns.count; k++) number[1 + nq + nv + (size_t)k] = columns_number(&v->columns, v->integrator, k);
  return true;
}

/* How large the numbers become is seen in the first run; its end is their room until it is
 * there. */
static int observe(dvi_integrator *integrator, void *user)
{
  verifier *v = user;
  const double part = dvi_integrator_time(integrator) / v->request->t_end, done = ldexp(1.0, v->level);
  progress_show(&v->progress, (done - 1.0 + done * part) / (ldexp(1.0, TRUST_LEVELS) - 1.0), "dvi run --verify");
  const long steps = v->steps++;
  if (v->level > 0 || !energy_look_due(steps)) return 0;
  if ((steps & (steps - 1)) == 0 && v->columns.shows[COLUMN_INVARIANT]) natural_scale_look(&v->scale, integrator);
  if (!read_numbers(v, v->number[0])) return -1;
  for (int i = 0; i < v->count; i++) v->size[i] = fmax(v->size[i], fabs(v->number[0][i]));
  return 0;
}

/* A column that is 0 up to rounding has the scale of the terms that cancel in it. */
static void measure_sizes(verifier *v)
{
  const int nq = v->scene->nq, nv = v->scene->nv, first = 1 + nq + nv;
  for (int i = 0; i < v->count; i++) v->size[i] = fmax(v->size[i], fabs(v->number[0][i]));
  const double q = judge_largest(nq, v->size + 1), p = judge_largest(nv, v->size + 1 + nq);
  for (int k = 0; k < v->columns.count; k++) {
    const shown_column *column = &v->columns.column[k];
    double *size = &v->size[first + k];
    if (column->kind == COLUMN_COORDINATE) *size = trust_size(*size, q);
    if (column->kind == COLUMN_MOMENTUM) *size = trust_size(*size, p);
    if (column->kind == COLUMN_INVARIANT) *size = fmax(*size, natural_scale_of(&v->scale, column->index));
  }
}

static dvi_status drive(verifier *v, dvi_run_report *report)
{
  const dvi_run_options options = {.h = ldexp(v->request->h, -v->level),
                                   .t_end = v->request->t_end,
                                   .observe = observe,
                                   .user = v,
                                   .events = v->events.event,
                                   .event_count = v->events.count,
                                   .cancel = v->caught};
  return dvi_run(v->integrator, &options, report);
}

static int run_level(verifier *v)
{
  dvi_run_report report = {0};
  if (!start(v)) return FAILED;
  const dvi_status status = drive(v, &report);
  if (status != DVI_OK) {
    const int code = library_error(status);
    complain("run: --verify: that was the run with --h %g", ldexp(v->request->h, -v->level));
    return code;
  }
  if (*v->caught != 0) {
    complain("run: signal %d ended the verification", (int)*v->caught);
    return 128 + (int)*v->caught;
  }
  v->verdict.by_event = v->verdict.by_event || report.end == DVI_RUN_EVENT;
  return read_numbers(v, v->number[v->level]) ? DONE : FAILED;
}

/* How the numbers from first on fall, all together. */
static double fall(const verifier *v, int first, int count)
{
  const double *const *level = (const double *const *)v->number;
  return trust_ratio(judge_distance(count, level[0] + first, level[1] + first),
                     judge_distance(count, level[1] + first, level[2] + first));
}

/* A number falls as all coordinates do, or as all momenta, or more slowly. */
static void estimate(verifier *v)
{
  const int nq = v->scene->nq, nv = v->scene->nv;
  v->verdict.ratio = fmax(fall(v, 1, nq), nv > 0 ? fall(v, 1 + nq, nv) : 0.0);
  for (int i = 0; i < v->count; i++) {
    const double first = v->number[0][i], second = v->number[1][i], third = v->number[2][i];
    const double own = trust_ratio(fabs(first - second), fabs(second - third));
    v->error[i] = trust_error(first, second, third, fmax(v->verdict.ratio, own));
  }
}

/* IDA shares no code with the methods. It is asked from the start as the integrator has it,
 * projected if it was off. */
static bool run_witness(verifier *v, double tolerance, double *number, dvi_reference_report *report)
{
  const int nq = v->scene->nq, nv = v->scene->nv;
  double *q = number + 1, *p = q + nq;
  const dvi_reference_options options = {
      .relative_tolerance = tolerance, .max_steps = WITNESS_STEPS, .max_seconds = fmax(witness_seconds, v->seconds) / TRUST_LEVELS};
  if (!start(v)) return false;
  memcpy(q, dvi_integrator_q(v->integrator), (size_t)nq * sizeof *q);
  memcpy(p, dvi_integrator_p(v->integrator), (size_t)nv * sizeof *p);
  if (dvi_reference_solve(v->scene->system, 0.0, v->request->t_end, q, p, &options, report) != DVI_OK) return false;
  const dvi_start_options project = {.project = 1};
  return dvi_integrator_start_with(v->integrator, v->request->t_end, q, p, &project) == DVI_OK && read_numbers(v, number);
}

/* At the default tolerance, and a tenth of it, and ten times that. */
static bool ask_witness(verifier *v)
{
  dvi_reference_report report;
  if (!run_witness(v, 0.0, v->witness[1], &report)) return false;
  const double tolerance = report.relative_tolerance;
  return run_witness(v, tolerance / tolerance_factor, v->witness[0], &report) &&
         run_witness(v, tolerance * tolerance_factor, v->witness[2], &report);
}

/* Two tolerances may agree by chance, three hardly do. The error of the loosest one is a hundred
 * times that of the tightest. */
static double witness_distance(const verifier *v, int first, int count)
{
  const double *const *witness = (const double *const *)v->witness;
  return fmax(judge_distance(count, witness[0] + first, witness[1] + first),
              judge_distance(count, witness[0] + first, witness[2] + first) / (tolerance_factor * tolerance_factor));
}

static double relative(double error, double size)
{
  return size > 0.0 ? error / size : 0.0;
}

/* An error of the whole state turns from coordinates into momenta and back, and no column's own
 * error is less in its size. */
static void measure_witness(verifier *v)
{
  const int nq = v->scene->nq, nv = v->scene->nv;
  const double of_q = relative(witness_distance(v, 1, nq), judge_largest(nq, v->size + 1));
  const double of_p = relative(witness_distance(v, 1 + nq, nv), judge_largest(nv, v->size + 1 + nq));
  for (int i = 0; i < v->count; i++) v->witness_error[i] = fmax(fmax(of_q, of_p) * v->size[i], witness_distance(v, i, 1));
}

/* Whether the witness is farther away than both errors explain; of coordinates and momenta the
 * last part that was judged is told. */
static bool judge_part(verifier *v, const char *name, int first, int count)
{
  trust_verdict *verdict = &v->verdict;
  const double apart = judge_distance(count, v->number[0] + first, v->witness[0] + first);
  const double error = judge_largest(count, v->witness_error + first);
  verdict->contradicted = apart > 2.0 * judge_largest(count, v->error + first) + doubt * error;
  verdict->part = name;
  verdict->apart = apart;
  verdict->witness_error = error;
  return verdict->contradicted;
}

/* A second opinion: the larger error is told, as far as the witness's own leaves it certain. */
static void hear_witness(verifier *v)
{
  const int nq = v->scene->nq, nv = v->scene->nv;
  v->verdict.too_large = nq > WITNESS_COORDINATES;
  v->verdict.witness = !v->verdict.by_event && !v->verdict.too_large && ask_witness(v);
  if (!v->verdict.witness) return;
  measure_witness(v);
  const bool in_momenta = judge_part(v, "momenta", 1 + nq, nv);
  if (!judge_part(v, "coordinates", 1, nq) && in_momenta) (void)judge_part(v, "momenta", 1 + nq, nv);
  for (int i = 0; i < v->count; i++)
    v->error[i] = fmax(v->error[i], fabs(v->number[0][i] - v->witness[0][i]) - doubt * v->witness_error[i]);
}

static int examine(verifier *v)
{
  int code = DONE;
  v->caught = signals_note(ended_again);
  const clock_t began = clock();
  progress_start(&v->progress, true);
  for (v->level = 0; v->level < TRUST_LEVELS && code == DONE; v->level++) code = run_level(v);
  progress_end(&v->progress);
  if (code != DONE) return code;
  v->seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
  measure_sizes(v);
  estimate(v);
  hear_witness(v);
  const trust_numbers numbers = {v->count, v->number[0], v->size, v->error};
  return verify_tell(v->request, v->scene, v->integrator, &v->columns, &numbers, &v->verdict);
}

int verify(const run_request *request, const problem *scene, dvi_integrator *integrator)
{
  enum { VECTORS = 2 * TRUST_LEVELS + 3 };
  verifier v = {.request = request, .scene = scene, .integrator = integrator};
  int code = columns_choose(&v.columns, scene, integrator, request->columns);
  v.count = 1 + scene->nq + scene->nv + v.columns.count;
  double *room = calloc((size_t)VECTORS * (size_t)v.count, sizeof *room);
  double **vector[VECTORS] = {&v.number[0],  &v.number[1],     &v.number[2], &v.witness[0], &v.witness[1],
                              &v.witness[2], &v.witness_error, &v.size,      &v.error};
  for (int k = 0; k < VECTORS && room != NULL; k++) *vector[k] = room + (size_t)k * (size_t)v.count;
  if (code == DONE && room == NULL) code = library_error(DVI_NO_MEMORY);
  if (code == DONE && !start(&v)) code = FAILED;
  if (code == DONE && !natural_scale_start(&v.scale, scene, integrator)) code = FAILED;
  if (code == DONE) code = events_list(&v.events, scene, NULL, NULL) ? examine(&v) : FAILED;
  natural_scale_clear(&v.scale);
  events_clear(&v.events);
  columns_clear(&v.columns);
  free(room);
  return code;
}
