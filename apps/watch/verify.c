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
#include "load/natural_scale.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "study/norms.h"
#include "study/trust_levels.h"
#include "watch/verify_report.h"

/* The limits of IDA's three runs, which may take as long as those of the method, or so many
 * seconds. Nothing can end a factorisation, so the number of coordinates is bounded. A full
 * Jacobian has three unknowns for each coordinate. */
enum { WITNESS_STEPS = 200000 };
static const double witness_seconds = 2.0;

/* The scales of invariants are measured so often on the way. */
enum { SCALE_LOOKS = 20 };

static const char ended_again[] = "dvi: run: a second Ctrl-C ended the verification at once\n";

/* The numbers of a result are t, q, p, and the columns. */
typedef struct verifier {
  const run_request *request;
  const problem *scene;
  dvi_integrator *integrator;
  run_columns columns;
  event_list events;
  progress_line progress;
  const volatile sig_atomic_t *caught;
  trust_group group[TRUST_GROUPS]; /* coordinates and momenta */
  trust_study trust;
  natural_scale scale;      /* scales of the invariants */
  int next_look;            /* when to look for them, in parts of the run */
  double seconds;           /* process time of the levels */
  double witness_tolerance; /* tolerance of the witness */
  double refinement;        /* refinement of the current level */
  double moved;             /* largest change of a coordinate in the first run */
  long steps;
  bool by_event; /* an event ended a run */
  bool refused;  /* the witness does not take the system */
  int code;      /* exit code of the level that failed */
} verifier;

static bool verify_start(verifier *v)
{
  const dvi_start_options options = {.project = v->request->project};
  const dvi_status status = dvi_integrator_start_with(v->integrator, 0.0, v->scene->q, v->scene->p,
                                                      &options);
  return status == DVI_OK || library_error(status) == DONE;
}

static bool read_numbers(verifier *v, double *number)
{
  const size_t nq = (size_t)v->scene->nq, nv = (size_t)v->scene->nv;
  if (!columns_measure(&v->columns, v->integrator)) return false;
  number[0] = dvi_integrator_time(v->integrator);
  memcpy(number + 1, dvi_integrator_q(v->integrator), nq * sizeof *number);
  memcpy(number + 1 + nq, dvi_integrator_p(v->integrator), nv * sizeof *number);
  for (int k = 0; k < v->columns.count; k++)
    number[1 + nq + nv + (size_t)k] = columns_number(&v->columns, v->integrator, k);
  return true;
}

/* Measure the sizes of the numbers, and how far the coordinates are from the start. */
static void measure_motion(verifier *v)
{
  const double *number = v->trust.number[0];
  for (int i = 0; i < v->trust.count; i++)
    v->trust.size[i] = fmax(v->trust.size[i], fabs(number[i]));
  for (int i = 0; i < v->scene->nq; i++)
    v->moved = fmax(v->moved, fabs(number[1 + i] - v->scene->q[i]));
}

/* Give the momenta of a system at rest, which are roundings, a size. Returns that of all. A
 * Hamiltonian need not move coordinates by momenta. */
static double measure_momenta(verifier *v, double q)
{
  const int nv = v->scene->nv;
  double *size = v->trust.size + 1 + v->scene->nq;
  const double p = norm_largest(nv, size);
  if (v->scene->terms->one_form != NULL || v->scene->terms->hamiltonian != NULL) return p;
  const double of_all = trust_momentum(p, q, v->moved);
  for (int i = 0; i < nv && of_all > p; i++) size[i] = of_all;
  return of_all;
}

/* Observe the sizes of the numbers in the first run. The vector of its end serves as working memory
 * until the end. */
static int verify_observe(dvi_integrator *integrator, void *user)
{
  verifier *v = user;
  const double part = dvi_integrator_time(integrator) / v->request->t_end, done = v->refinement;
  progress_show(&v->progress, (done - 1.0 + done * part) / (ldexp(1.0, TRUST_LEVELS) - 1.0),
                "dvi run --verify");
  const long steps = v->steps++;
  if (v->refinement > 1.0) return 0;
  if (part * SCALE_LOOKS >= v->next_look && v->columns.shows[COLUMN_INVARIANT]) {
    natural_scale_look(&v->scale, integrator);
    v->next_look = (int)(part * SCALE_LOOKS) + 1;
  }
  if (!energy_look_due(steps)) return 0;
  if (!read_numbers(v, v->trust.number[0])) return -1;
  measure_motion(v);
  return 0;
}

/* Measure the sizes. A column that is 0 up to rounding has the scale of the terms that cancel in
 * it. */
static void measure_result_sizes(verifier *v)
{
  const int nq = v->scene->nq, nv = v->scene->nv, first = 1 + nq + nv;
  measure_motion(v);
  const double q = norm_largest(nq, v->trust.size + 1), p = measure_momenta(v, q);
  for (int k = 0; k < v->columns.count; k++) {
    const shown_column *column = &v->columns.column[k];
    double *size = &v->trust.size[first + k];
    if (column->kind == COLUMN_COORDINATE) *size = trust_size(*size, q);
    if (column->kind == COLUMN_MOMENTUM) *size = trust_size(*size, p);
    if (column->kind == COLUMN_INVARIANT)
      *size = fmax(*size, natural_scale_of(&v->scale, column->index));
  }
}

static double level_step(const verifier *v)
{
  return v->request->h / v->refinement;
}

static dvi_status verify_drive(verifier *v, dvi_run_report *report)
{
  const dvi_run_options options = {.h = level_step(v),
                                   .t_end = v->request->t_end,
                                   .observe = verify_observe,
                                   .user = v,
                                   .events = v->events.event,
                                   .event_count = v->events.count,
                                   .cancel = v->caught};
  return dvi_run(v->integrator, &options, report);
}

static int verify_run_level(verifier *v, double *number)
{
  dvi_run_report report = {0};
  if (!verify_start(v)) return FAILED;
  const dvi_status status = verify_drive(v, &report);
  if (status != DVI_OK) {
    const int code = library_error(status);
    complain("run: --verify: that was the run with --h %g", level_step(v));
    return code;
  }
  if (*v->caught != 0) {
    complain("run: signal %d ended the verification", (int)*v->caught);
    return 128 + (int)*v->caught;
  }
  v->by_event = v->by_event || report.end == DVI_RUN_EVENT;
  return read_numbers(v, number) ? DONE : FAILED;
}

/* Run the method, refined by its step. Complains about a failure at once. */
static dvi_status verify_run(void *user, double refinement, study_level *level)
{
  verifier *v = user;
  v->refinement = refinement;
  v->code = verify_run_level(v, level->number);
  return v->code == DONE ? DVI_OK : DVI_CALLBACK_FAILED;
}

/* Run IDA, which shares no code with the methods, from the integrator's start, which may have been
 * projected. Its default tolerance is refined. */
static dvi_status witness_run(void *user, double refinement, study_level *level)
{
  verifier *v = user;
  const int nq = v->scene->nq, nv = v->scene->nv;
  const double tolerance = v->witness_tolerance;
  double *q = level->number + 1, *p = q + nq;
  const dvi_reference_options options = {
      .relative_tolerance = refinement > 1.0 ? tolerance / refinement
                                             : tolerance * (1.0 / refinement),
      .max_steps = WITNESS_STEPS,
      .max_seconds = fmax(witness_seconds, v->seconds) / TRUST_LEVELS};
  dvi_reference_report report;
  if (!verify_start(v)) return DVI_CALLBACK_FAILED;
  memcpy(q, dvi_integrator_q(v->integrator), (size_t)nq * sizeof *q);
  memcpy(p, dvi_integrator_p(v->integrator), (size_t)nv * sizeof *p);
  dvi_status status = dvi_reference_solve(v->scene->system, 0.0, v->request->t_end, q, p, &options,
                                          &report);
  v->refused = status == DVI_UNSUPPORTED;
  if (status != DVI_OK) return status;
  if (!(v->witness_tolerance > 0.0)) v->witness_tolerance = report.relative_tolerance;
  status = dvi_integrator_start_with(v->integrator, v->request->t_end, q, p,
                                     &(dvi_start_options){.project = 1});
  if (status != DVI_OK) return status;
  return read_numbers(v, level->number) ? DVI_OK : DVI_CALLBACK_FAILED;
}

static int verify_examine(verifier *v)
{
  const study_subject method = {.run = verify_run, .user = v},
                      witness = {.run = witness_run, .user = v};
  v->caught = signals_note(ended_again);
  const clock_t began = clock();
  progress_start(&v->progress, true);
  const dvi_status status = trust_run(&v->trust, &method);
  progress_end(&v->progress);
  if (status != DVI_OK) return v->code;
  v->seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
  measure_result_sizes(v);
  trust_estimate(&v->trust);
  const bool too_large = v->scene->nq > WITNESS_COORDINATES;
  if (!v->by_event && !too_large) trust_hear(&v->trust, &witness);
  const verify_verdict verdict = {.trust = v->trust.verdict,
                                  .by_event = v->by_event,
                                  .too_large = too_large,
                                  .refused = v->refused};
  const trust_numbers numbers = {.count = v->trust.count,
                                 .value = v->trust.number[0],
                                 .size = v->trust.size,
                                 .error = v->trust.error};
  return verify_tell(v->request, v->scene, v->integrator, &v->columns, &numbers, &verdict);
}

int verify(const run_request *request, const problem *scene, dvi_integrator *integrator)
{
  enum { VECTORS = 2 * TRUST_LEVELS + 3 };
  verifier v = {.request = request,
                .scene = scene,
                .integrator = integrator,
                .group = {{.name = "coordinates", .first = 1, .count = scene->nq},
                          {.name = "momenta", .first = 1 + scene->nq, .count = scene->nv}}};
  trust_study *t = &v.trust;
  int code = columns_choose(&v.columns, scene, integrator, request->columns);
  t->group = v.group;
  t->count = 1 + scene->nq + scene->nv + v.columns.count;
  double *room = calloc((size_t)VECTORS * (size_t)t->count, sizeof *room);
  double **vector[VECTORS] = {&t->number[0],     &t->number[1],  &t->number[2],
                              &t->witness[0],    &t->witness[1], &t->witness[2],
                              &t->witness_error, &t->size,       &t->error};
  for (int k = 0; k < VECTORS && room != NULL; k++)
    *vector[k] = room + (size_t)k * (size_t)t->count;
  if (code == DONE && room == NULL) code = library_error(DVI_NO_MEMORY);
  if (code == DONE && !verify_start(&v)) code = FAILED;
  if (code == DONE && !natural_scale_start(&v.scale, scene, integrator)) code = FAILED;
  if (code == DONE) code = events_list(&v.events, scene, NULL, NULL) ? verify_examine(&v) : FAILED;
  natural_scale_clear(&v.scale);
  events_clear(&v.events);
  columns_clear(&v.columns);
  free(room);
  return code;
}
