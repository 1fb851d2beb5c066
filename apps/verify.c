#include "verify.h"

#include <dvi/reference.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "columns.h"
#include "command.h"
#include "energy_watch.h"
#include "events.h"
#include "judge.h"
#include "progress.h"
#include "signals.h"
#include "trust.h"
#include "verify_report.h"

/* IDA is asked for spans that it crosses in about a second. Its two runs tell its own error up
 * to such a factor. */
enum { WITNESS_STEPS = 200000 };
static const double doubt = 10.0;

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
  double *number[TRUST_LEVELS]; /* [count] the ends */
  double *witness;              /* [count] that of the other method */
  double *size;                 /* [count] largest magnitudes on the way */
  double *error;                /* [count] */
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
  if (v->level > 0 || !energy_look_due(v->steps++)) return 0;
  if (!read_numbers(v, v->number[0])) return -1;
  for (int i = 0; i < v->count; i++) v->size[i] = fmax(v->size[i], fabs(v->number[0][i]));
  return 0;
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
static dvi_status ask_witness(verifier *v, double *error)
{
  const int nq = v->scene->nq, nv = v->scene->nv;
  double *q = v->witness + 1, *p = q + nq;
  const dvi_reference_options options = {.max_steps = WITNESS_STEPS};
  dvi_reference_report report;
  if (!start(v)) return DVI_BAD_STATE;
  memcpy(q, dvi_integrator_q(v->integrator), (size_t)nq * sizeof *q);
  memcpy(p, dvi_integrator_p(v->integrator), (size_t)nv * sizeof *p);
  dvi_status status = dvi_reference_judge(v->scene->system, 0.0, v->request->t_end, q, p, &options, &report);
  if (status != DVI_OK) return status;
  *error = report.error;
  status = dvi_integrator_start_with(v->integrator, v->request->t_end, q, p, &(dvi_start_options){.project = 1});
  return status == DVI_OK && !read_numbers(v, v->witness) ? DVI_NOT_FINITE : status;
}

/* A second opinion: the larger error is told, as far as the witness's own leaves it certain. */
static void hear_witness(verifier *v)
{
  const int nq = v->scene->nq;
  trust_verdict *verdict = &v->verdict;
  verdict->witness = !verdict->by_event && ask_witness(v, &verdict->witness_error) == DVI_OK;
  if (!verdict->witness) return;
  const double own = judge_largest(nq, v->error + 1), unsure = doubt * verdict->witness_error;
  const double relative = unsure / fmax(judge_largest(nq, v->size + 1), DBL_MIN);
  verdict->apart = judge_distance(nq, v->number[0] + 1, v->witness + 1);
  verdict->contradicted = verdict->apart > 2.0 * own + unsure;
  for (int i = 0; i < v->count; i++) v->error[i] = fmax(v->error[i], fabs(v->number[0][i] - v->witness[i]) - relative * v->size[i]);
}

static int examine(verifier *v)
{
  int code = DONE;
  v->caught = signals_note(ended_again);
  progress_start(&v->progress, true);
  for (v->level = 0; v->level < TRUST_LEVELS && code == DONE; v->level++) code = run_level(v);
  progress_end(&v->progress);
  if (code != DONE) return code;
  for (int i = 0; i < v->count; i++) v->size[i] = fmax(v->size[i], fabs(v->number[0][i]));
  estimate(v);
  hear_witness(v);
  const trust_numbers numbers = {v->count, v->number[0], v->size, v->error};
  return verify_tell(v->request, v->scene, v->integrator, &v->columns, &numbers, &v->verdict);
}

int verify(const run_request *request, const problem *scene, dvi_integrator *integrator)
{
  enum { VECTORS = TRUST_LEVELS + 3 };
  verifier v = {.request = request, .scene = scene, .integrator = integrator};
  int code = columns_choose(&v.columns, scene, integrator, request->columns);
  v.count = 1 + scene->nq + scene->nv + v.columns.count;
  double *room = calloc((size_t)VECTORS * (size_t)v.count, sizeof *room);
  double **vector[VECTORS] = {&v.number[0], &v.number[1], &v.number[2], &v.witness, &v.size, &v.error};
  for (int k = 0; k < VECTORS && room != NULL; k++) *vector[k] = room + (size_t)k * (size_t)v.count;
  if (code == DONE && room == NULL) code = library_error(DVI_NO_MEMORY);
  if (code == DONE) code = events_list(&v.events, scene, NULL, NULL) ? examine(&v) : FAILED;
  events_clear(&v.events);
  columns_clear(&v.columns);
  free(room);
  return code;
}
