/* dvi bench, which measures speed against error, all in one run, or the cost of a step against
 * size. */
#include <dvi/scene.h>
#include <dvi/study.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bare.h"
#include "bench/bench_report.h"
#include "bench/bench_request.h"
#include "cli/command.h"
#include "csv/events.h"
#include "bench/machine.h"
#include "bench/members.h"
#include "load/open.h"
#include "load/open_march.h"
#include "cli/progress.h"
#include "bench/scale.h"
#include "load/scene.h"
#include "module/ranks.h"
#include "scaling/ranks_bench.h"
#include "bench/whole_job.h"
#include "mechanics/motion_study.h"

/* The methods that run if neither the command line nor the scene names one. Methods that the
 * problem's structure excludes are left out. Every kind of system has at least one. */
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

/* Tolerances of peers. Those from FREE_TOLERANCES on are used only as far as a smaller error is
 * asked for. */
static const double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13, 1e-14};
enum {
  TOLERANCES = sizeof tolerances / sizeof *tolerances,
  FREE_TOLERANCES = 5,
  JOBS_MAX = 2 * WORDS_MAX * (WORK_LONGER_MAX + WORK_LEVELS_MAX) + PEERS_MAX * TOLERANCES
};

/* error that is good enough if no errors are asked for */
static const double error_of_judge = 1e-10;

/* A measured method, with steps of time or with a monitor. */
typedef struct entry {
  const char *method;
  pacing how;
  char name[PACED_NAME];
} entry;

/* The state of a bench. */
typedef struct bench {
  const bench_request *request;
  const problem *scene;
  judgement judge;
  judged_motion motion;
  progress_line progress;
  int entries;
  entry entry[WORDS_MAX];
  whole_job of_entry[WORDS_MAX], of_bare[WORDS_MAX], of_peer[PEERS_MAX];
  work work;
} bench;

/* Add a method's levels. */
static int bench_add_method(bench *b, int number)
{
  const entry *of = &b->entry[number];
  motion_study study;
  bool lost = false;
  const int code = motion_study_init(&study, &b->motion, of->method, &of->how, of->name);
  if (code != DONE) return code;
  study.progress = &b->progress;
  whole_job *job = &b->of_entry[number];
  whole_job_of_method(job, &study, of->method, &of->how);
  const int levels = (int)b->request->levels;
  const dvi_status status = work_add_levels(&b->work, &study.subject, &job->subject, levels, &lost);
  job->study = NULL;
  motion_study_clear(&study);
  if (lost) return motion_study_refuse(of->name, b->request->t_end);
  return status == DVI_OK ? DONE : library_error(status);
}

/* Give the degree of a bare loop beside a method, or 0. Methods named twice share one. */
static int bench_bare_degree(const bench *b, int number)
{
  const int degree = b->entry[number].how.transform == NULL ? bare_degree(b->entry[number].method)
                                                            : 0;
  for (int i = 0; i < number; i++)
    if (b->of_bare[i].degree == degree) return 0;
  return degree;
}

/* Add bare loops beside the methods that have the same steps, at all of their levels. */
static int bench_add_bare(bench *b)
{
  const int methods = b->work.jobs;
  dvi_status status = DVI_OK;
  if (!bare_takes(b->scene)) {
    complain("bench: left out bare: it is for constant masses, scalar or diagonal, and potentials "
             "with gradients alone");
    return DONE;
  }
  for (int i = 0; i < b->entries && status == DVI_OK; i++) {
    const int degree = bench_bare_degree(b, i);
    if (degree == 0) continue;
    status = whole_job_of_bare(&b->of_bare[i], degree, &b->of_entry[i], &b->motion);
    for (int k = 0; k < methods && status == DVI_OK; k++)
      if (b->work.job[k].subject == &b->of_entry[i].subject)
        status = work_add(&b->work, &b->of_bare[i].subject, b->work.job[k].level.refinement);
  }
  if (b->work.jobs == methods)
    complain("bench: left out bare: no method here is galerkin:degree=S alone");
  return status == DVI_OK ? DONE : library_error(status);
}

/* Add a peer at its tolerances. A tolerance that it cannot keep is left out with a message. */
static int bench_add_peer(bench *b, int number)
{
  whole_job *job = &b->of_peer[number];
  const dvi_status status = whole_job_of_peer(job, b->request->peers.peer[number], &b->motion);
  if (status != DVI_OK) return library_error(status);
  work_add_tolerances(&b->work, &job->subject, TOLERANCES, tolerances, FREE_TOLERANCES);
  return DONE;
}

static int bench_add_jobs(bench *b)
{
  int code = DONE;
  for (int i = 0; i < b->entries && code == DONE; i++) code = bench_add_method(b, i);
  if (b->request->peers.bare && code == DONE) code = bench_add_bare(b);
  for (int i = 0; i < b->request->peers.count && code == DONE; i++) code = bench_add_peer(b, i);
  return code;
}

static int bench_run_rounds(bench *b)
{
  const dvi_status status = work_run(&b->work, machine_multiplications);
  return status == DVI_OK ? DONE : library_error(status);
}

static int bench_print(bench *b)
{
  const bench_results results = {&b->motion, b->request->one_point, &b->work};
  return bench_report(&results, &b->request->outputs);
}

/* Ask the judge, find the levels, and run the rounds. The progress line shows these stages. */
static int judge_and_measure(bench *b)
{
  const double asked = work_smallest_asked(&b->request->outputs.asked);
  const judge_request judge = {.kind = b->request->judge,
                               .wanted = isfinite(asked) ? asked / DVI_STUDY_FLOOR_MARGIN
                                                         : error_of_judge,
                               .progress = &b->progress};
  progress_start(&b->progress, true);
  int code = judge_init(&b->judge, b->scene, b->request->t_end, &judge);
  b->motion = (judged_motion){b->scene, &b->judge, b->request->t_end};
  b->work.judge_error = b->judge.error;
  if (code == DONE) code = bench_add_jobs(b);
  if (code == DONE) {
    progress_end(&b->progress);
    progress_start(&b->progress, true);
    code = bench_run_rounds(b);
  }
  progress_end(&b->progress);
  return code;
}

static int bench_measure(bench *b)
{
  b->work = (work){.command = "bench",
                   .shown = "dvi bench",
                   .asked = &b->request->outputs.asked,
                   .rounds = b->request->rounds,
                   .progress = &b->progress,
                   .room = JOBS_MAX,
                   .job = calloc(JOBS_MAX, sizeof *b->work.job)};
  int code = b->work.job != NULL ? judge_and_measure(b) : library_error(DVI_NO_MEMORY);
  if (code == DONE) code = bench_print(b);
  for (int i = 0; i < PEERS_MAX; i++) whole_job_clear(&b->of_peer[i]);
  for (int i = 0; i < WORDS_MAX; i++) whole_job_clear(&b->of_bare[i]);
  free(b->work.job);
  judge_clear(&b->judge);
  return code;
}

static void bench_keep_entry(bench *b, const char *method, const pacing *how)
{
  entry *e = &b->entry[b->entries++];
  e->method = method;
  e->how = *how;
  paced_name(method, how, e->name, sizeof e->name);
}

/* Add a method, unless its structure forbids it. A method of the selection is then left out. A
 * requested method is refused, or left out with a message if there are other times for it. */
static int bench_add_entry(bench *b, const char *method, const pacing *how,
                           const dvi_monitor *monitor)
{
  dvi_integrator *integrator = NULL;
  const bool asked = b->request->methods.count > 0, several = b->request->transforms.count > 1;
  if (b->entries == WORDS_MAX)
    return usage_error("bench: more than %d methods and time transforms", (int)WORDS_MAX);
  if (dvi_scene_marches(b->scene->scene, method)) {
    const int code = check_studied_march("bench", b->scene, method);
    if (code == DONE) bench_keep_entry(b, method, how);
    return code;
  }
  const dvi_status status = create_paced(b->scene, method, how, monitor, &integrator);
  dvi_integrator_destroy(&integrator);
  if (status == DVI_OK) bench_keep_entry(b, method, how);
  if (status == DVI_OK || (!asked && status == DVI_UNSUPPORTED)) return DONE;
  /* open_paced says why it fails */
  if (!several || status != DVI_UNSUPPORTED) return open_paced(b->scene, method, how, &integrator);
  complain("bench: left out %s @ %s: %s", method, how->transform != NULL ? how->transform : "none",
           dvi_last_error());
  return DONE;
}

/* Add every method with every time transform. */
static int choose_methods(bench *b)
{
  const words *methods = &b->request->methods, *transforms = &b->request->transforms;
  const char *const *method = methods->count > 0 ? methods->word : selection;
  const int count = methods->count > 0 ? methods->count
                                       : (int)(sizeof selection / sizeof *selection) - 1;
  int code = DONE;
  for (int k = 0; (k < transforms->count || k == 0) && code == DONE; k++) {
    const bool plain = transforms->count == 0 || strcmp(transforms->word[k], "none") == 0;
    const pacing how = {.transform = plain ? NULL : transforms->word[k]};
    dvi_monitor monitor = {0};
    code = open_monitor(b->scene, &how, &monitor);
    for (int i = 0; i < count && code == DONE; i++)
      code = bench_add_entry(b, method[i], &how, &monitor);
  }
  return code == DONE && b->entries == 0 ? usage_error("bench: no method is left") : code;
}

static int bench_problem(bench_request *request, const problem *scene)
{
  if (isnan(request->t_end)) request->t_end = scene->order_t_end;
  if (request->methods.count == 0 && scene->method != NULL)
    request->methods.word[request->methods.count++] = scene->method;
  bench b = {.request = request, .scene = scene};
  const int code = choose_methods(&b);
  if (code == DONE) events_passed("bench", scene);
  return code == DONE ? bench_measure(&b) : code;
}

/* Check what is for ranks, and for nothing else. */
static int check_ranks(const bench_request *r)
{
  const bool is_ranks = rank_counts_asked(r->scale);
  const double number[] = {r->latency, r->bandwidth};
  if (!is_ranks && ranks_count() > 1)
    return usage_error("bench: %d processes share --scale ranks= alone; leave mpirun out",
                       ranks_count());
  if (!is_ranks && (r->weak != NULL || !isnan(r->latency) || !isnan(r->bandwidth)))
    return usage_error("bench: --weak, --latency and --bandwidth go with --scale ranks=");
  if (!is_ranks) return DONE;
  for (int i = 0; i < 2; i++)
    if (!isnan(number[i]) && !(isfinite(number[i]) && number[i] > 0))
      return usage_error("bench: --%s wants a number above 0", i == 0 ? "latency" : "bandwidth");
  if (r->one_point) return usage_error("bench: --scale ranks=: --one-point has no meaning there");
  if (r->methods.count > 1)
    return usage_error("bench: --scale ranks= takes one method, not %d", r->methods.count);
  for (int i = 0; i < r->methods.count; i++)
    if (strcmp(r->methods.word[i], "leapfrog") != 0 && strcmp(r->methods.word[i], "yee") != 0 &&
        strcmp(r->methods.word[i], "verlet") != 0)
      return usage_error("bench: --scale ranks=: steps of leapfrog, yee and verlet are timed, not "
                         "those of %s",
                         r->methods.word[i]);
  return scene_is_path(r->name) ? DONE
                                : usage_error("bench: --scale ranks=: ranks share the mesh of a "
                                              "scene's field, and '%s' is no scene",
                                              r->name);
}

static int scale_ranks(const bench_request *r, int argc, char **argv)
{
  enum { STEPS_DEFAULT = 32 };
  const ranks_request request = {
      .timed = {.scene = r->name,
                .settings = &r->settings,
                .method = r->methods.count > 0 ? r->methods.word[0] : NULL,
                .h = r->h,
                .rounds = r->rounds,
                .steps = r->steps > 0 ? r->steps : STEPS_DEFAULT},
      .scaled = r->scale,
      .weak = r->weak,
      .latency = r->latency,
      .bandwidth = r->bandwidth,
      .csv = r->outputs.csv,
      .plot = r->outputs.plot};
  return ranks_count() > 1 ? ranks_bench_run(&request) : ranks_bench_start(&request, argc, argv);
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

static int bench_alone(int argc, char **argv)
{
  bench_request request;
  int code;
  problem *scene;
  if (!bench_request_read(argc, argv, &request, &code)) return code;
  code = check_ranks(&request);
  if (code != DONE) return code;
  if (rank_counts_asked(request.scale)) return scale_ranks(&request, argc, argv);
  if (request.scale != NULL) return scale_problem(&request);
  code = open_shaped(request.name, &request.settings, request.one_point, &scene);
  if (code != DONE) return code;
  code = refuse_noise("bench", scene);
  if (code == DONE) code = bench_problem(&request, scene);
  problem_destroy(&scene);
  return code;
}

int bench_command(int argc, char **argv)
{
  const int code = ranks_begin();
  return ranks_end(code == DONE ? bench_alone(argc, argv) : code);
}
