/* dvi bench: speed against error, all in one run; and the cost of a step against size. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench_job.h"
#include "study/work_report.h"
#include "bench/bench_request.h"
#include "cli/command.h"
#include "csv/events.h"
#include "study/levels.h"
#include "bench/machine.h"
#include "bench/members.h"
#include "load/open.h"
#include "cli/progress.h"
#include "study/samples.h"
#include "bench/scale.h"
#include "mechanics/order_study.h"

enum { LEVELS_DEFAULT = 6 };

/* What runs if neither the command line nor the scene names a method; those that the problem's
 * structure excludes are left out. For every kind of system there is one at least. */
static const char *const selection[] = {"verlet",
                                        "composition:order=8,base=verlet",
                                        "midpoint",
                                        "galerkin:degree=2",
                                        "galerkin:degree=4",
                                        "galerkin:degree=8",
                                        "lie-verlet",
                                        "lie-galerkin:degree=2",
                                        "lie-galerkin:degree=4",
                                        "lie-galerkin:degree=8",
                                        "vprk:nodes=2",
                                        "vprk:nodes=4",
                                        "dg-phase:degree=2",
                                        "hamiltonian:degree=2",
                                        "hamiltonian:degree=4",
                                        NULL};

static const double first_error = 1e-2; /* of each method, relative to the solution */
static const double above_asked = 1e3;  /* the first error over the largest asked one, at most, as far as that takes */
static const double more_steps = 4.0;   /* times as many at most */

/* Of peers; from FREE_TOLERANCES on only as far as a smaller error is asked for. */
static const double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13, 1e-14};
enum {
  TOLERANCES = sizeof tolerances / sizeof *tolerances,
  FREE_TOLERANCES = 5,
  LONGER_MAX = 8,
  JOBS_MAX = WORDS_MAX * (LONGER_MAX + LEVELS_MAX) + PEERS_MAX * TOLERANCES
};

static const double error_of_judge = 1e-10; /* that is good enough if no errors are asked for */

/* A method as it is measured: with steps of time, or that follow a monitor. */
typedef struct entry {
  const char *method;
  pacing how;
  char name[PACED_NAME];
} entry;

/* All the work: jobs in the order of the table. */
typedef struct bench {
  const bench_request *request;
  const problem *scene;
  judgement judge;
  progress_line progress;
  int entries;
  entry entry[WORDS_MAX];
  int jobs;
  bench_job *job; /* [JOBS_MAX] */
  double calibration[ROUNDS_MAX];
} bench;

static void leave_out(const bench_job *job, const char *reason)
{
  complain("bench: left out %s at %s: %s", job->integrator, job->setting, reason);
}

/* Add one level of the study's method; one whose steps cannot be solved is left out. */
static dvi_status add_level(bench *b, const entry *of, order_study *study, long steps)
{
  bench_job *job = &b->job[b->jobs];
  level_trial trial = {.steps = steps};
  job->integrator = study->method;
  job->peer = -1;
  job->method = of->method;
  job->how = of->how;
  job->steps = steps;
  job->h = study->span / (double)steps;
  (void)snprintf(job->setting, sizeof job->setting, "h=%.6g", job->h);
  dvi_status status = study_watch(study, &trial);
  job->energy_error = trial.energy_error;
  if (status == DVI_OK) status = bench_job_try(job, b->scene, &b->judge, b->request->t_end);
  b->jobs += status == DVI_OK;
  if (status <= 0) return status;
  leave_out(job, dvi_last_error());
  return DVI_OK;
}

/* The smallest error that was asked for; infinite without --at. */
static double smallest_asked(const numbers *asked)
{
  double smallest = HUGE_VAL;
  for (int i = 0; i < asked->count; i++) smallest = fmin(smallest, asked->number[i]);
  return smallest;
}

/* Where a method of this order begins: levels far above the errors that are asked for would tell nothing, and of a high order take long. */
static double first_error_of(const bench *b, const order_study *study)
{
  double asked = 0.0;
  for (int i = 0; i < b->request->outputs.asked.count; i++) asked = fmax(asked, b->request->outputs.asked.number[i]);
  if (asked == 0.0) return first_error;
  const double judged = STUDY_FLOOR_MARGIN * STUDY_FLOOR_MARGIN * b->judge.error; /* else no level would lie above the floor */
  const double near = fmin(first_error, fmax(above_asked * asked, judged) / study_size(study));
  return fmax(near, first_error * pow(more_steps, -study->order));
}

/* Whether the last level took clearly less time than the one before: smaller steps are cheaper where they let a simpler solver work. */
static bool became_cheaper(const bench *b, int first_job)
{
  static const double clearly = 0.9;
  const bench_job *last = &b->job[b->jobs - 1];
  return b->jobs > first_job + 1 && last->tried < clearly * (last - 1)->tried;
}

/* Whether neither of the last two levels is better than all before them: one may be worse than a larger step by chance. */
static bool floor_is_reached(const bench *b, int first_job)
{
  double best = HUGE_VAL;
  if (b->jobs < first_job + 3) return false;
  for (int i = first_job; i < b->jobs - 2; i++) best = fmin(best, b->job[i].error);
  return b->job[b->jobs - 2].error >= best && b->job[b->jobs - 1].error >= best;
}

/* Go on with smaller steps to the smallest asked error, as long as they make the error smaller; and beyond it as long as they make the job
 * cheaper. */
static dvi_status extend_levels(bench *b, const entry *of, order_study *study, int first_job)
{
  static const double ratio = 1.5;
  static const double steps_max = 1L << 20; /* of one job: some seconds at most for a small problem */
  const double wanted = smallest_asked(&b->request->outputs.asked);
  dvi_status status = DVI_OK;
  if (b->jobs == first_job) return DVI_OK;
  double steps = (double)b->job[b->jobs - 1].steps;
  for (int k = LEVELS_DEFAULT; k < LEVELS_MAX && status == DVI_OK; k++) {
    const bench_job *last = &b->job[b->jobs - 1];
    steps = ceil(ratio * steps);
    if (steps > steps_max || (last->error <= wanted && !became_cheaper(b, first_job))) break;
    if (floor_is_reached(b, first_job)) break;
    status = add_level(b, of, study, lround(steps));
  }
  return status;
}

/* Add longer steps, twice as long each, as long as their errors are about that of the first level: those of fast phases do not fall with the step before it resolves
 * them. */
static dvi_status add_longer(bench *b, const entry *of, order_study *study, long steps)
{
  static const double as_good = 1.5;
  long longer[LONGER_MAX];
  int count = 0;
  level_trial first, trial;
  dvi_status status = study_run(study, steps, &first);
  while (status == DVI_OK && steps > 1 && count < LONGER_MAX) {
    steps /= 2;
    status = study_run(study, steps, &trial);
    if (status != DVI_OK || !(trial.error <= as_good * first.error)) break;
    longer[count++] = steps;
  }
  if (status > 0) status = DVI_OK;
  while (status == DVI_OK && count > 0) status = add_level(b, of, study, longer[--count]);
  return status;
}

/* Add a method's levels. */
static int add_method(bench *b, const entry *of)
{
  order_study study;
  long steps[LEVELS_MAX];
  int code = study_init(&study, b->scene, &b->judge, of->method, &of->how, b->request->t_end);
  if (code != DONE) return code;
  study.method = of->name;
  const bool extend = b->request->levels == 0;
  const int levels = extend ? LEVELS_DEFAULT : (int)b->request->levels;
  bool room;
  study.first_error = first_error_of(b, &study);
  study.progress = &b->progress;
  dvi_status status = choose_levels(&study, 0.0, 0.0, levels, steps, &room);
  const bool lost = status == DVI_OK && steps[0] == 0;
  if (lost) code = study_refuse(&study);
  if (status == DVI_OK && !lost && extend) status = add_longer(b, of, &study, steps[0]);
  const int first_job = b->jobs;
  for (int k = 0; k < levels && status == DVI_OK && !lost; k++) status = add_level(b, of, &study, steps[k]);
  if (status == DVI_OK && !lost && extend) status = extend_levels(b, of, &study, first_job);
  study_clear(&study);
  return status == DVI_OK ? code : library_error(status);
}

/* Add a peer at a tolerance. One that it cannot keep is left out, and said. */
static void add_tolerance(bench *b, int peer, double tolerance)
{
  bench_job *job = &b->job[b->jobs];
  job->integrator = peer_name(peer);
  job->peer = peer;
  job->tolerance = tolerance;
  (void)snprintf(job->setting, sizeof job->setting, "tol=%.0e", tolerance);
  if (bench_job_try(job, b->scene, &b->judge, b->request->t_end) == DVI_OK)
    b->jobs++;
  else
    leave_out(job, peer_error());
}

/* Whether the smallest asked error is not met by the jobs from `first` on. */
static bool more_wanted(const bench *b, int first)
{
  const double wanted = smallest_asked(&b->request->outputs.asked);
  for (int i = first; i < b->jobs; i++)
    if (b->job[i].error <= wanted) return false;
  return isfinite(wanted);
}

static void add_peer(bench *b, int peer)
{
  const int first = b->jobs;
  for (int k = 0; k < TOLERANCES && (k < FREE_TOLERANCES || more_wanted(b, first)); k++) {
    progress_show(&b->progress, -1.0, peer_name(peer));
    add_tolerance(b, peer, tolerances[k]);
  }
}

static int add_jobs(bench *b)
{
  int code = DONE;
  for (int i = 0; i < b->entries && code == DONE; i++) code = add_method(b, &b->entry[i]);
  for (int i = 0; i < b->request->peers.count && code == DONE; i++) add_peer(b, b->request->peers.peer[i]);
  return code;
}

/* Every round runs every job once, so that whatever slows the machine for a while slows all of them. */
static int run_rounds(bench *b)
{
  for (int round = 0; round < b->request->rounds; round++) {
    b->calibration[round] = machine_multiplications();
    for (int i = 0; i < b->jobs; i++) {
      const double done = (double)(round * b->jobs + i) / (double)(b->request->rounds * b->jobs);
      progress_show(&b->progress, done, "dvi bench");
      const dvi_status status = bench_job_time(&b->job[i], b->scene, b->request->t_end, round);
      if (status != DVI_OK) return library_error(status);
    }
  }
  for (int i = 0; i < b->jobs; i++) bench_job_finish(&b->job[i], (int)b->request->rounds);
  return DONE;
}

static int report(bench *b)
{
  const bench_results results = {.scene = b->scene,
                                 .judge = &b->judge,
                                 .t_end = b->request->t_end,
                                 .one_point = b->request->one_point,
                                 .rounds = b->request->rounds,
                                 .jobs = b->jobs,
                                 .job = b->job,
                                 .calibration = samples_spread((int)b->request->rounds, b->calibration)};
  return bench_report(&results, &b->request->outputs);
}

/* Ask the judge, find the levels, and run the rounds: what is shown on the progress line. */
static int judge_and_measure(bench *b)
{
  const double asked = smallest_asked(&b->request->outputs.asked);
  const judge_request judge = {
      .kind = b->request->judge, .wanted = isfinite(asked) ? asked / STUDY_FLOOR_MARGIN : error_of_judge, .progress = &b->progress};
  progress_start(&b->progress, true);
  int code = judge_init(&b->judge, b->scene, b->request->t_end, &judge);
  if (code == DONE) code = add_jobs(b);
  if (code == DONE) {
    progress_end(&b->progress);
    progress_start(&b->progress, true);
    code = run_rounds(b);
  }
  progress_end(&b->progress);
  return code;
}

static int measure(bench *b)
{
  b->job = calloc(JOBS_MAX, sizeof *b->job);
  int code = b->job != NULL ? judge_and_measure(b) : library_error(DVI_NO_MEMORY);
  if (code == DONE) code = report(b);
  free(b->job);
  judge_clear(&b->judge);
  return code;
}

static void keep_entry(bench *b, const char *method, const pacing *how)
{
  entry *e = &b->entry[b->entries++];
  e->method = method;
  e->how = *how;
  paced_name(method, how, e->name, sizeof e->name);
}

/* Add a method, unless its structure forbids it: of the selection it is left out then; one that is asked for is refused, or, if there are other
 * times to take it in, left out with a word. */
static int add_entry(bench *b, const char *method, const pacing *how, const dvi_monitor *monitor)
{
  dvi_integrator *integrator = NULL;
  const bool asked = b->request->methods.count > 0, several = b->request->transforms.count > 1;
  if (b->entries == WORDS_MAX) return usage_error("bench: more than %d methods and time transforms", (int)WORDS_MAX);
  const dvi_status status = create_paced(b->scene, method, how, monitor, &integrator);
  dvi_integrator_destroy(&integrator);
  if (status == DVI_OK) keep_entry(b, method, how);
  if (status == DVI_OK || (!asked && status == DVI_UNSUPPORTED)) return DONE;
  if (!several || status != DVI_UNSUPPORTED) return open_paced(b->scene, method, how, &integrator); /* which says why it fails */
  complain("bench: left out %s @ %s: %s", method, how->transform != NULL ? how->transform : "none", dvi_last_error());
  return DONE;
}

/* Every method with every time transform. */
static int choose_methods(bench *b)
{
  const words *methods = &b->request->methods, *transforms = &b->request->transforms;
  const char *const *method = methods->count > 0 ? methods->word : selection;
  const int count = methods->count > 0 ? methods->count : (int)(sizeof selection / sizeof *selection) - 1;
  int code = DONE;
  for (int k = 0; (k < transforms->count || k == 0) && code == DONE; k++) {
    const bool plain = transforms->count == 0 || strcmp(transforms->word[k], "none") == 0;
    const pacing how = {.transform = plain ? NULL : transforms->word[k]};
    dvi_monitor monitor = {0};
    code = open_monitor(b->scene, &how, &monitor);
    for (int i = 0; i < count && code == DONE; i++) code = add_entry(b, method[i], &how, &monitor);
  }
  return code == DONE && b->entries == 0 ? usage_error("bench: no method is left") : code;
}

static int bench_problem(bench_request *request, const problem *scene)
{
  if (isnan(request->t_end)) request->t_end = scene->order_t_end;
  if (request->methods.count == 0 && scene->method != NULL) request->methods.word[request->methods.count++] = scene->method;
  bench b = {.request = request, .scene = scene};
  const int code = choose_methods(&b);
  if (code == DONE) events_passed("bench", scene);
  return code == DONE ? measure(&b) : code;
}

static int scale_problem(const bench_request *r)
{
  const scale_request request = {.problem = r->name,
                                 .scaled = r->scale,
                                 .methods = &r->methods,
                                 .settings = &r->settings,
                                 .one_point = r->one_point,
                                 .h = r->h,
                                 .rounds = r->rounds,
                                 .steps = r->steps,
                                 .csv = r->outputs.csv,
                                 .plot = r->outputs.plot};
  return members_asked(r->scale) ? members_run(&request) : scale_run(&request);
}

int bench_command(int argc, char **argv)
{
  bench_request request;
  int code;
  problem *scene;
  if (!bench_request_read(argc, argv, &request, &code)) return code;
  if (request.scale != NULL) return scale_problem(&request);
  code = open_shaped(request.name, &request.settings, request.one_point, &scene);
  if (code != DONE) return code;
  code = bench_problem(&request, scene);
  problem_destroy(&scene);
  return code;
}
