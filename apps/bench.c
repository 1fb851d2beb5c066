/* dvi bench: speed against error, all in one run. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench_job.h"
#include "command.h"
#include "file.h"
#include "levels.h"
#include "open.h"
#include "options.h"
#include "outputs.h"
#include "plot.h"
#include "progress.h"
#include "study.h"
#include "table.h"

enum { LEVELS_DEFAULT = 6, LEVELS_MAX = 20, ROUNDS_DEFAULT = 5, CODES_MAX = 16, TITLE_SIZE = 160 };

/* What runs if no --method is given; those that the problem's structure excludes are left out. */
static const char *const selection[] = {
    "verlet", "composition:order=8,base=verlet", "midpoint", "galerkin:degree=2", "galerkin:degree=4", "galerkin:degree=8", NULL};

static const double first_error = 1e-2; /* of each method, relative to the solution */

static const double tolerances[] = {1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
enum { TOLERANCES = sizeof tolerances / sizeof *tolerances, JOBS_MAX = WORDS_MAX * LEVELS_MAX + CODES_MAX * TOLERANCES };

/* What the command line asks for. */
typedef struct bench_request {
  const char *csv, *plot;
  double t_end;
  long levels, rounds;
  words methods, settings, against;
  bool selected; /* the methods are those of the selection */
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
} bench;

static const table_column columns[] = {
    {"integrator", NULL},     {"problem", NULL},       {"setting", NULL},       {"error", "%.3e"},
    {"energy_error", "%.3e"}, {"cpu_seconds", "%.3e"}, {"evaluations", "%.0f"}, {NULL, NULL},
};

/* Add a method's levels. */
static int add_method(bench *b, const char *method)
{
  order_study study;
  long steps[LEVELS_MAX];
  int code = study_init(&study, b->scene, &b->judge, method, b->request->t_end);
  if (code != DONE) return code;
  const int levels = (int)b->request->levels;
  bool room;
  study.first_error = first_error;
  study.progress = &b->progress;
  dvi_status status = choose_levels(&study, 0.0, 0.0, levels, steps, &room);
  for (int k = 0; k < levels && status == DVI_OK; k++) {
    bench_job *job = &b->job[b->jobs];
    level_trial trial = {.steps = steps[k]};
    job->integrator = method;
    job->steps = steps[k];
    (void)snprintf(job->setting, sizeof job->setting, "h=%.6g", b->request->t_end / (double)steps[k]);
    status = study_watch_energy(&study, &trial);
    job->energy_error = trial.energy_error;
    if (status == DVI_OK) status = bench_job_try(job, b->scene, &b->judge, b->request->t_end);
    b->jobs += status == DVI_OK;
  }
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
    job->code = code;
    job->tolerance = tolerances[k];
    (void)snprintf(job->setting, sizeof job->setting, "tol=%.0e", tolerances[k]);
    if (bench_job_try(job, b->scene, &b->judge, b->request->t_end) == DVI_OK)
      b->jobs++;
    else
      complain("bench: left out %s at %s: %s", job->integrator, job->setting, dvi_last_error());
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
  for (int round = 0; round < b->request->rounds; round++)
    for (int i = 0; i < b->jobs; i++) {
      const double done = (double)(round * b->jobs + i) / (double)(b->request->rounds * b->jobs);
      progress_show(&b->progress, done, "dvi bench");
      const dvi_status status = bench_job_time(&b->job[i], b->scene, b->request->t_end, round);
      if (status != DVI_OK) return library_error(status);
    }
  return DONE;
}

static result_table *make_table(bench *b)
{
  result_table *rows = table_create(columns);
  for (int i = 0; i < b->jobs; i++) {
    bench_job *job = &b->job[i];
    table_text(rows, job->integrator);
    table_text(rows, b->scene->name);
    table_text(rows, job->setting);
    table_number(rows, job->error);
    table_number(rows, job->energy_error);
    table_number(rows, bench_job_median(job, (int)b->request->rounds));
    table_number(rows, (double)job->evaluations);
  }
  return rows;
}

static void print_notes(FILE *stream, const bench *b)
{
  (void)fprintf(stream, "judge at t = %g: %s, error %.1e\n", b->request->t_end, b->judge.kind, b->judge.error);
  (void)fprintf(stream, "cpu_seconds: process time of a whole job, median of %ld interleaved rounds\n", b->request->rounds);
  (void)fprintf(stream, "energy_error: methods: largest over the run; codes of SUNDIALS: at the end\n");
  if (b->request->codes == 0) return;
  (void)fprintf(stream, "SUNDIALS %s. Caution: Debian's packages of SUNDIALS are built without optimisation; its codes linked\n",
                dvi_reference_version());
  (void)fprintf(stream, "from them are several times slower than they can be. Say which build a ratio was measured against.\n");
}

/* One past the last job of the integrator that job `first` belongs to. */
static int group_end(const bench *b, int first)
{
  int end = first;
  while (end < b->jobs && strcmp(b->job[end].integrator, b->job[first].integrator) == 0) end++;
  return end;
}

static void print_for_people(const bench *b, const result_table *rows)
{
  (void)printf("Speed against error on %s\n", b->scene->name);
  for (int first = 0; first < b->jobs; first = group_end(b, first)) {
    (void)printf("\n%s\n", b->job[first].integrator);
    table_print(rows, 2, first, group_end(b, first));
  }
  (void)putchar('\n');
}

static bool write_csv(const result_table *rows, const char *path)
{
  whole_file csv;
  if (!file_open(&csv, path)) return false;
  table_csv(rows, csv.stream);
  return file_keep(&csv);
}

static bool plot_jobs(bench *b)
{
  plot_curve curve[WORDS_MAX + CODES_MAX];
  char title[TITLE_SIZE];
  int curves = 0;
  double *x = calloc(2 * (size_t)b->jobs, sizeof *x);
  if (x == NULL) {
    complain("out of memory for the plot");
    return false;
  }
  double *y = x + b->jobs;
  for (int i = 0; i < b->jobs; i++) {
    x[i] = b->job[i].error;
    y[i] = bench_job_median(&b->job[i], (int)b->request->rounds);
  }
  for (int first = 0; first < b->jobs && curves < WORDS_MAX + CODES_MAX; first = group_end(b, first))
    curve[curves++] = (plot_curve){
        .label = b->job[first].integrator, .count = group_end(b, first) - first, .x = x + first, .y = y + first};
  (void)snprintf(title, sizeof title, "CPU time against error: %s to t = %g", b->scene->name, b->request->t_end);
  const plot_panel panel = {.title = title,
                            .x_label = "largest error of q at the end",
                            .y_label = "CPU seconds",
                            .logarithmic = true,
                            .curves = curves,
                            .curve = curve};
  const bool good = plot_write(b->request->plot, 1, &panel);
  free(x);
  return good;
}

static int report(bench *b)
{
  const bench_request *request = b->request;
  const bool csv_only = request->csv != NULL && strcmp(request->csv, "-") == 0;
  result_table *rows = make_table(b);
  bool good = table_good(rows);
  if (good && !csv_only) print_for_people(b, rows);
  print_notes(csv_only ? stderr : stdout, b);
  if (good && request->csv != NULL) good = write_csv(rows, request->csv);
  if (good && request->plot != NULL) good = plot_jobs(b);
  table_destroy(&rows);
  return good ? DONE : FAILED;
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

static int check_request(bench_request *request)
{
  if (request->levels > LEVELS_MAX)
    return usage_error("bench: --levels %ld is too many, %d are possible", request->levels, (int)LEVELS_MAX);
  if (request->rounds > ROUNDS_MAX)
    return usage_error("bench: --rounds %ld is too many, %d are possible", request->rounds, (int)ROUNDS_MAX);
  if (request->t_end == 0.0) return usage_error("bench: --t-end 0 leaves nothing to do");
  const named_file files[] = {{"csv", request->csv}, {"plot", request->plot}};
  int code = outputs_plot("bench", request->plot);
  if (code == DONE) code = outputs_distinct("bench", 2, files);
  if (code != DONE) return code;
  if (request->csv != NULL && !file_writable(request->csv)) return FAILED;
  if (request->plot != NULL && !file_writable(request->plot)) return FAILED;
  return read_codes(request);
}

static const char details[] =
    "\n"
    "Columns: integrator,problem,setting,error,energy_error,cpu_seconds,evaluations.\n"
    "  setting       h=STEP of a method, tol=TOLERANCE of a SUNDIALS code\n"
    "  error         largest error of a coordinate at the end, against the judge (see dvi order --help)\n"
    "  energy_error  methods: largest |energy - energy at the start| over the run; SUNDIALS codes: at the end\n"
    "  cpu_seconds   process time of one whole job, creation included and diagnostics excluded: the median over the\n"
    "                rounds; every round runs every setting, repeated until 0.02 s have passed\n"
    "  evaluations   points at which the gradient was evaluated\n"
    "\n"
    "Every integrator gets the same callbacks. Debian's packages of SUNDIALS are built without optimisation: its codes\n"
    "are several times slower in them than they can be. The version that ran is printed.\n"
    "\n"
    "Examples:\n"
    "  dvi bench kepler --against cvode,arkode,ida --plot bench.svg\n"
    "  dvi bench outer-solar --method galerkin:degree=8 --method verlet --csv bench.csv\n";

int bench_command(int argc, char **argv)
{
  bench_request r = {.t_end = (double)NAN, .levels = LEVELS_DEFAULT, .rounds = ROUNDS_DEFAULT};
  const option options[] = {
      {.name = "method", .words = &r.methods, .value = "SPEC", .help = "a method; may be repeated; left out: a selection"},
      {.name = "against", .words = &r.against, .value = "CODES", .help = "SUNDIALS codes beside them: of cvode,arkode,ida"},
      {.name = "levels", .count = &r.levels, .value = "N", .help = "how many step sizes of each method; left out: 6"},
      {.name = "rounds", .count = &r.rounds, .value = "N", .help = "how often everything is measured; left out: 5"},
      {.name = "t-end", .number = &r.t_end, .value = "T", .help = "the end; left out: the problem's for order studies"},
      {.name = "set", .words = &r.settings, .value = "NAME=VALUE", .help = "set a parameter of the problem; may be repeated"},
      {.name = "csv", .word = &r.csv, .value = "-|FILE", .help = "write the table as CSV; -: to standard output, words to stderr"},
      {.name = "plot", .word = &r.plot, .value = "FILE.svg", .help = "draw CPU time against error"},
      {.name = NULL},
  };
  const command_line command = {
      .name = "bench",
      .synopsis = "PROBLEM [--method SPEC ...] [--against cvode,arkode,ida] [OPTIONS]",
      .operand = "PROBLEM",
      .summary = "Measure speed against error, of methods and of SUNDIALS' codes, all in one run.\n",
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
  code = bench_problem(&r, scene);
  problem_destroy(&scene);
  return code;
}
