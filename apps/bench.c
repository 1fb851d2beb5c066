/* dvi bench: speed against error, all in one run; and the cost of a step against size. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "bench_report.h"
#include "command.h"
#include "file.h"
#include "levels.h"
#include "machine.h"
#include "members.h"
#include "open.h"
#include "options.h"
#include "outputs.h"
#include "progress.h"
#include "samples.h"
#include "scale.h"
#include "study.h"

enum { LEVELS_DEFAULT = 6, LEVELS_MAX = 20, ROUNDS_DEFAULT = 5, CODES_MAX = 16 };

/* What runs if no --method is given; those that the problem's structure excludes are left out. */
static const char *const selection[] = {
    "verlet", "composition:order=8,base=verlet", "midpoint", "galerkin:degree=2", "galerkin:degree=4", "galerkin:degree=8", NULL};

static const double first_error = 1e-2; /* of each method, relative to the solution */

static const double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
enum { TOLERANCES = sizeof tolerances / sizeof *tolerances, JOBS_MAX = WORDS_MAX * LEVELS_MAX + CODES_MAX * TOLERANCES };

/* What the command line asks for. */
typedef struct bench_request {
  bench_outputs outputs;
  const char *at, *scale;
  double t_end, h;
  long levels, rounds;
  words methods, settings, against;
  bool selected; /* the methods are those of the selection */
  bool extend;   /* the number of levels is free: more may follow */
  int codes;
  dvi_reference_code code[CODES_MAX];
} bench_request;

/* All the work: jobs in the order of the table. */
typedef struct bench {
  const bench_request *request;
  const problem *scene;
  judgement judge;
  progress_line progress;
  int jobs;
  bench_job *job; /* [JOBS_MAX] */
  double calibration[ROUNDS_MAX];
} bench;

static void leave_out(const bench_job *job)
{
  complain("bench: left out %s at %s: %s", job->integrator, job->setting, dvi_last_error());
}

/* Add one level of the study's method; one whose steps cannot be solved is left out. */
static dvi_status add_level(bench *b, order_study *study, long steps)
{
  bench_job *job = &b->job[b->jobs];
  level_trial trial = {.steps = steps};
  job->integrator = study->method;
  job->steps = steps;
  (void)snprintf(job->setting, sizeof job->setting, "h=%.6g", b->request->t_end / (double)steps);
  dvi_status status = study_watch_energy(study, &trial);
  job->energy_error = trial.energy_error;
  if (status == DVI_OK) status = bench_job_try(job, b->scene, &b->judge, b->request->t_end);
  b->jobs += status == DVI_OK;
  if (status <= 0) return status;
  leave_out(job);
  return DVI_OK;
}

/* The smallest error that was asked for; infinite without --at. */
static double smallest_asked(const numbers *asked)
{
  double smallest = HUGE_VAL;
  for (int i = 0; i < asked->count; i++) smallest = fmin(smallest, asked->number[i]);
  return smallest;
}

/* Go on with smaller steps to the smallest asked error, as long as they make the error smaller. */
static dvi_status extend_levels(bench *b, order_study *study, int first_job)
{
  static const double ratio = 1.5;
  static const double steps_max = 1L << 20; /* of one job: some seconds at most for a small problem */
  const double wanted = smallest_asked(&b->request->outputs.asked);
  dvi_status status = DVI_OK;
  double steps = b->jobs > first_job ? (double)b->job[b->jobs - 1].steps : HUGE_VAL;
  for (int k = (int)b->request->levels; k < LEVELS_MAX && status == DVI_OK; k++) {
    const bench_job *last = &b->job[b->jobs - 1];
    steps = ceil(ratio * steps);
    if (steps > steps_max || last->error <= wanted) break;
    if (b->jobs > first_job + 1 && !(last->error < (last - 1)->error)) break;
    status = add_level(b, study, lround(steps));
  }
  return status;
}

/* Add a method's levels. */
static int add_method(bench *b, const char *method)
{
  order_study study;
  long steps[LEVELS_MAX];
  int code = study_init(&study, b->scene, &b->judge, method, b->request->t_end);
  if (code != DONE) return code;
  const int levels = (int)b->request->levels, first_job = b->jobs;
  bool room;
  study.first_error = first_error;
  study.progress = &b->progress;
  dvi_status status = choose_levels(&study, 0.0, 0.0, levels, steps, &room);
  for (int k = 0; k < levels && status == DVI_OK; k++) status = add_level(b, &study, steps[k]);
  if (status == DVI_OK && b->request->extend) status = extend_levels(b, &study, first_job);
  study_clear(&study);
  return status == DVI_OK ? DONE : library_error(status);
}

/* Add a SUNDIALS code at all tolerances. One that it cannot keep is left out, and said. */
static void add_code(bench *b, dvi_reference_code code)
{
  for (int k = 0; k < TOLERANCES; k++) {
    bench_job *job = &b->job[b->jobs];
    progress_show(&b->progress, -1.0, dvi_reference_name(code));
    job->integrator = dvi_reference_name(code);
    job->peer = true;
    job->code = code;
    job->tolerance = tolerances[k];
    (void)snprintf(job->setting, sizeof job->setting, "tol=%.0e", tolerances[k]);
    if (bench_job_try(job, b->scene, &b->judge, b->request->t_end) == DVI_OK)
      b->jobs++;
    else
      leave_out(job);
  }
}

static int add_jobs(bench *b)
{
  int code = DONE;
  for (int i = 0; i < b->request->methods.count && code == DONE; i++) code = add_method(b, b->request->methods.word[i]);
  for (int i = 0; i < b->request->codes && code == DONE; i++) add_code(b, b->request->code[i]);
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
  for (int i = 0; i < b->jobs; i++) b->job[i].seconds = samples_spread((int)b->request->rounds, b->job[i].cpu);
  return DONE;
}

static int report(bench *b)
{
  const bench_results results = {.scene = b->scene,
                                 .judge = &b->judge,
                                 .t_end = b->request->t_end,
                                 .rounds = b->request->rounds,
                                 .jobs = b->jobs,
                                 .job = b->job,
                                 .calibration = samples_spread((int)b->request->rounds, b->calibration)};
  return bench_report(&results, &b->request->outputs);
}

static int measure(bench *b)
{
  b->job = calloc(JOBS_MAX, sizeof *b->job);
  if (b->job == NULL) {
    complain("out of memory");
    return FAILED;
  }
  progress_start(&b->progress, true);
  int code = add_jobs(b);
  if (code == DONE) {
    progress_end(&b->progress);
    progress_start(&b->progress, true);
    code = run_rounds(b);
  }
  progress_end(&b->progress);
  if (code == DONE) code = report(b);
  free(b->job);
  return code;
}

/* Refuse a wrong method before anything runs; of the selection, keep what the problem's structure allows. */
static int choose_methods(bench_request *request, const problem *scene)
{
  words *methods = &request->methods;
  request->selected = methods->count == 0;
  for (int i = 0; request->selected && selection[i] != NULL; i++) {
    dvi_integrator *integrator = NULL;
    if (dvi_integrator_create(scene->system, selection[i], &integrator) == DVI_OK) methods->word[methods->count++] = selection[i];
    dvi_integrator_destroy(&integrator);
  }
  int code = DONE;
  for (int i = 0; !request->selected && i < methods->count && code == DONE; i++) {
    dvi_integrator *integrator = NULL;
    code = open_integrator(scene, methods->word[i], &integrator);
    dvi_integrator_destroy(&integrator);
  }
  return code;
}

static int bench_problem(bench_request *request, const problem *scene)
{
  if (isnan(request->t_end)) request->t_end = scene->order_t_end;
  int code = choose_methods(request, scene);
  if (code != DONE) return code;
  bench b = {.request = request, .scene = scene};
  const dvi_status status = judge_init(&b.judge, scene, request->t_end);
  code = status == DVI_OK ? measure(&b) : library_error(status);
  judge_clear(&b.judge);
  return code;
}

/* Read one name. "cvode" alone is its Adams formula, the better one where nothing is stiff. */
static int read_code(bench_request *request, const char *text, size_t length)
{
  int code = 0;
  const char *name;
  while ((name = dvi_reference_name((dvi_reference_code)code)) != NULL && strncmp(name, text, length) != 0) code++;
  const bool whole = name != NULL && (name[length] == '\0' || (length == strlen("cvode") && name[length] == '-'));
  if (!whole || length == 0)
    return usage_error("bench: --against knows cvode (cvode-adams, cvode-bdf), arkode and ida, not '%.*s'", (int)length, text);
  for (int i = 0; i < request->codes; i++)
    if (request->code[i] == (dvi_reference_code)code) return usage_error("bench: --against names %s twice", name);
  request->code[request->codes++] = (dvi_reference_code)code; /* each once: there are fewer than CODES_MAX */
  return DONE;
}

/* Read "cvode,ida" into codes. */
static int read_codes(bench_request *request)
{
  int result = DONE;
  for (int i = 0; i < request->against.count; i++)
    for (const char *text = request->against.word[i]; text != NULL && result == DONE;) {
      const size_t length = strcspn(text, ",");
      result = read_code(request, text, length);
      text = text[length] == ',' ? text + length + 1 : NULL;
    }
  return result;
}

static int check_outputs(const bench_outputs *outputs)
{
  const char *const paths[] = {outputs->csv, outputs->plot, outputs->at_csv};
  const named_file files[] = {{"csv", outputs->csv}, {"plot", outputs->plot}, {"at-csv", outputs->at_csv}};
  enum { FILES = sizeof files / sizeof *files };
  int code = outputs_plot("bench", outputs->plot);
  if (code == DONE) code = outputs_distinct("bench", FILES, files);
  if (code != DONE) return code;
  if (outputs->csv != NULL && outputs->at_csv != NULL && strcmp(outputs->csv, "-") == 0 && strcmp(outputs->at_csv, "-") == 0)
    return usage_error("bench: --csv - and --at-csv - would mix two tables on standard output");
  for (int i = 0; i < FILES; i++)
    if (paths[i] != NULL && !file_writable(paths[i])) return FAILED;
  return DONE;
}

/* With --scale every method takes the same few steps, and nothing has an error. */
static int check_modes(const bench_request *r)
{
  static const char reason[] = "--scale measures single steps";
  if (r->scale == NULL && !isnan(r->h)) return usage_error("bench: --h goes with --scale; else the steps are chosen by the error");
  if (r->outputs.at_csv != NULL && r->at == NULL) return usage_error("bench: --at-csv needs the errors: --at 1e-6,1e-9");
  if (r->scale == NULL) return DONE;
  if (r->at != NULL) return usage_error("bench: %s: --at has no meaning there", reason);
  if (r->against.count > 0) return usage_error("bench: %s: the codes of --against choose their own", reason);
  if (r->levels > 0) return usage_error("bench: %s: --levels has no meaning there", reason);
  if (!isnan(r->t_end)) return usage_error("bench: %s: --t-end has no meaning there", reason);
  return r->h == 0.0 ? usage_error("bench: --h 0 leads nowhere") : DONE;
}

/* The settings of a method that is named twice could not be told apart. */
static int check_methods(const words *methods)
{
  for (int i = 0; i < methods->count; i++)
    for (int j = 0; j < i; j++)
      if (strcmp(methods->word[i], methods->word[j]) == 0) return usage_error("bench: --method names %s twice", methods->word[i]);
  return DONE;
}

static int check_request(bench_request *request)
{
  if (request->levels > LEVELS_MAX)
    return usage_error("bench: --levels %ld is too many, %d are possible", request->levels, (int)LEVELS_MAX);
  if (request->rounds > ROUNDS_MAX)
    return usage_error("bench: --rounds %ld is too many, %d are possible", request->rounds, (int)ROUNDS_MAX);
  if (request->t_end == 0.0) return usage_error("bench: --t-end 0 leaves nothing to do");
  int code = check_modes(request);
  if (code == DONE) code = check_methods(&request->methods);
  if (code == DONE && request->at != NULL) code = numbers_read("bench: --at", request->at, &request->outputs.asked);
  if (code == DONE) code = read_codes(request);
  return code == DONE ? check_outputs(&request->outputs) : code;
}

static int scale_problem(const bench_request *r, const char *name)
{
  const scale_request request = {.problem = name,
                                 .sizes = r->scale,
                                 .methods = &r->methods,
                                 .settings = &r->settings,
                                 .h = r->h,
                                 .rounds = r->rounds,
                                 .csv = r->outputs.csv,
                                 .plot = r->outputs.plot};
  return members_asked(r->scale) ? members_run(&request) : scale_run(&request);
}

static int bench_named(bench_request *r, const char *name)
{
  problem *scene;
  if (r->scale != NULL) return scale_problem(r, name);
  r->extend = r->levels == 0;
  if (r->extend) r->levels = LEVELS_DEFAULT;
  int code = open_problem(name, &r->settings, &scene);
  if (code != DONE) return code;
  code = bench_problem(r, scene);
  problem_destroy(&scene);
  return code;
}

static const char details[] =
    "\n"
    "Columns: integrator,problem,setting,error,energy_error,cpu_seconds,evaluations,cpu_lower,cpu_upper,steps.\n"
    "  setting       h=STEP of a method, tol=TOLERANCE of a SUNDIALS code\n"
    "  error         largest error of a coordinate at the end, against the judge (see dvi order --help)\n"
    "  energy_error  largest |energy - energy at the start|: of methods over all steps, of SUNDIALS codes at 8 evenly\n"
    "                spaced times, the end included\n"
    "  cpu_seconds   process time of one whole job, creation included and diagnostics excluded: the median over the\n"
    "                rounds; every round runs every setting, repeated until 0.02 s have passed\n"
    "  evaluations   points at which the gradient was evaluated\n"
    "  cpu_lower, cpu_upper   quartiles over the rounds\n"
    "  steps         of a code those that it chose\n"
    "\n"
    "--at: for each integrator, seconds and evaluations at these errors. Of its settings those count that no other one\n"
    "beats in both error and cost; between two neighbours the logarithms are interpolated, beyond the ends nothing is.\n"
    "Unless --levels is given, smaller steps follow until the smallest of these errors is met, 20 levels at most.\n"
    "Columns of --at-csv: asked_error,problem,judged,integrator,cpu_seconds,ratio,evaluations,answer.\n"
    "  judged        yes; no if the judge's own error is above a tenth of the asked one\n"
    "  ratio         seconds over those of the fastest integrator at this error\n"
    "  answer        interpolated; at most (the cheapest setting is already better); not reached\n"
    "\n"
    "--scale: a problem's parameter and the values at which a step is measured, with the exponents of cost against the\n"
    "number of coordinates n. The first 32 steps from the start are run again and again. Repeat --method to compare\n"
    "degrees. Columns: method,problem,parameter,value,n,h,step_seconds,step_lower,step_upper,bytes,step_evaluations;\n"
    "bytes is what the integrator holds of the heap (mallinfo2; empty where there is no such function).\n"
    "--scale members=1,64,4096: members of an ensemble instead, near the problem's start, beside runs one after the other.\n"
    "Columns: method,problem,members,n,h,step_seconds,step_lower,step_upper,alone_seconds,alone_lower,alone_upper,gain,\n"
    "step_evaluations; seconds are those of one step of one member, on one thread, and gain is their ratio.\n"
    "\n"
    "Processor, compiler and flags are printed, and the time of 1e8 dependent multiplications, measured once a round:\n"
    "it tells times of two machines or two hours apart. Every integrator gets the same callbacks. Debian's packages of\n"
    "SUNDIALS are built without optimisation: its codes are several times slower in them than they can be.\n"
    "\n"
    "Examples:\n"
    "  dvi bench kepler --against cvode,arkode,ida --at 1e-6,1e-9 --plot bench.svg\n"
    "  dvi bench outer-solar --method galerkin:degree=8 --method verlet --csv bench.csv\n"
    "  dvi bench fpu --method galerkin:degree=2 --method galerkin:degree=4 --scale ell=100,1000,10000\n"
    "  dvi bench kepler --method verlet --method galerkin:degree=2 --scale members=1,64,4096\n";

int bench_command(int argc, char **argv)
{
  bench_request r = {.t_end = (double)NAN, .h = (double)NAN, .rounds = ROUNDS_DEFAULT};
  const option options[] = {
      {.name = "method", .words = &r.methods, .value = "SPEC", .help = "a method; may be repeated; left out: a selection"},
      {.name = "against", .words = &r.against, .value = "CODES", .help = "SUNDIALS codes beside them: of cvode,arkode,ida"},
      {.name = "at", .word = &r.at, .value = "ERRORS", .help = "compare at these errors, for example 1e-6,1e-9"},
      {.name = "at-csv", .word = &r.outputs.at_csv, .value = "-|FILE", .help = "write that comparison as CSV"},
      {.name = "scale", .word = &r.scale, .value = "NAME=V,V...", .help = "measure steps instead, as this parameter grows"},
      {.name = "h", .number = &r.h, .value = "H", .help = "the step of --scale; left out: the problem's"},
      {.name = "levels",
       .count = &r.levels,
       .value = "N",
       .help = "how many step sizes of each method; left out: 6, or more for --at"},
      {.name = "rounds", .count = &r.rounds, .value = "N", .help = "how often everything is measured; left out: 5"},
      {.name = "t-end", .number = &r.t_end, .value = "T", .help = "the end; left out: the problem's for order studies"},
      {.name = "set", .words = &r.settings, .value = "NAME=VALUE", .help = "set a parameter of the problem; may be repeated"},
      {.name = "csv",
       .word = &r.outputs.csv,
       .value = "-|FILE",
       .help = "write the table as CSV; -: to standard output, words to stderr"},
      {.name = "plot", .word = &r.outputs.plot, .value = "FILE.svg", .help = "draw CPU time against error, or against size"},
      {.name = NULL},
  };
  const command_line command = {
      .name = "bench",
      .synopsis = "PROBLEM [--method SPEC ...] [--against cvode,arkode,ida] [OPTIONS]",
      .operand = "PROBLEM",
      .summary =
          "Measure speed against error, of methods and of SUNDIALS' codes, all in one run; or the cost of a step against size.\n",
      .options = options,
      .details = details,
  };
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &name, &code)) return code;
  code = check_request(&r);
  return code == DONE ? bench_named(&r, name) : code;
}
