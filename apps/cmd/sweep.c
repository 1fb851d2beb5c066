/* dvi sweep, which runs a problem once at each point of a grid of parameters. */
#define _POSIX_C_SOURCE 200809L
#include <dvi/study.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"
#include "load/open.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "module/store.h"
#include "store/table_output.h"
#include "sweep/sweep_join.h"
#include "sweep/sweep_part.h"
#include "sweep/sweep_point.h"
#include "cli/way.h"

/* The state of a sweep. */
typedef struct sweep {
  const sweep_task *task;
  const char *command; /* the command line */
  long points;         /* number of all points */
  study_part own;      /* part of the points that is run here */
  long there;          /* number of points that an earlier sweep left */
  sweep_row *row;      /* [points] a row without a text is still to be run */
  long done;
  sweep_part part;
  progress_line progress;
  bool lost;    /* a row could not be written, or had no memory */
  bool written; /* all rows are written to their destination */
} sweep;

typedef struct sweep_request {
  const char *out, *divided; /* divided is the value of --part, or NULL */
  study_part part;
  word_list join;
  long threads; /* 0 if not given */
  words settings;
  char *command; /* the command line, without --join */
} sweep_request;

static const char ended[] =
    "dvi: sweep: a signal ended the sweep; the same command goes on where it stopped\n";

/* ---- points ---- */

static dvi_status open_point(const dvi_study_point *at, dvi_study_run *run, void *user)
{
  return sweep_open(((const sweep *)user)->task, at, run);
}

static void close_point(dvi_study_run *run, void *user)
{
  (void)user;
  sweep_close(run);
}

/* Keep a row. */
static int take_row(const dvi_study_point *at, const dvi_study_run *run, const dvi_study_row *found,
                    void *user)
{
  sweep *s = user;
  const long k = (long)at->number;
  const sweep_row *row = &s->row[k];
  s->row[k] = sweep_make_row(s->task, run, found);
  if (row->text == NULL) complain("out of memory");
  s->lost = row->text == NULL || !sweep_part_add(&s->part, k, row);
  s->done++;
  const long left = study_part_size(&s->own, s->points) - s->there;
  progress_show(&s->progress, (double)s->done / (double)left, "dvi sweep");
  return s->lost ? -1 : 0;
}

static int sweep_run_points(sweep *s, int threads)
{
  const long left = study_part_size(&s->own, s->points) - s->there;
  char *skip = calloc((size_t)s->points, 1);
  if (skip == NULL) {
    complain("out of memory");
    return FAILED;
  }
  for (long k = 0; k < s->points; k++) skip[k] = s->row[k].text != NULL;
  const dvi_study_sweep_options options = {.size = sizeof options,
                                           .axes = s->task->grid.axes,
                                           .axis = s->task->grid.study,
                                           .part = s->own.part,
                                           .parts = s->own.parts,
                                           .skip = skip,
                                           .threads = threads < left ? threads : (int)left,
                                           .open = open_point,
                                           .found = take_row,
                                           .close = close_point,
                                           .user = s};
  progress_start(&s->progress, true);
  const dvi_status status = dvi_study_sweep(&options, NULL);
  progress_end(&s->progress);
  free(skip);
  if (status == DVI_OK || s->lost) return status == DVI_OK ? DONE : FAILED;
  return library_error(status);
}

/* ---- rows ---- */

static long count_rows(const sweep *s, bool failed_only)
{
  long count = 0;
  for (long k = 0; k < s->points; k++)
    count += s->row[k].text != NULL && (s->row[k].failed || !failed_only);
  return count;
}

/* Spell the header of the table. To be freed, NULL without memory. */
static char *spell_header(const sweep_task *task)
{
  char *text = NULL;
  size_t size;
  FILE *stream = open_memstream(&text, &size);
  if (stream == NULL) return NULL;
  sweep_header(task, stream);
  (void)fclose(stream);
  return text;
}

static bool sweep_store_rows(const sweep *s, const char *path)
{
  const sweep_task *task = s->task;
  fact_list facts = {.count = 0};
  char *header = spell_header(task);
  const char **line = calloc((size_t)s->points, sizeof *line);
  bool good = header != NULL && line != NULL;
  if (!good) complain("out of memory");
  for (long k = 0; k < s->points && good; k++) line[k] = s->row[k].text;
  good = good && facts_add_problem(&facts, task->model, s->command);
  facts_add_text(&facts, "method", task->method != NULL ? task->method : task->model->method,
                 false);
  facts_add_number(&facts, "h", isnan(task->h) ? task->model->h : task->h, false);
  facts_add_number(&facts, "t_end", isnan(task->t_end) ? task->model->t_end : task->t_end, false);
  good = good && table_output_write(path, &facts, header, s->points, line);
  facts_clear(&facts);
  free(line);
  free(header);
  return good;
}

static bool sweep_write_rows(const sweep *s, const char *path)
{
  if (store_is_wanted(path)) return sweep_store_rows(s, path);
  whole_file out;
  if (!file_open(&out, path)) return false;
  sweep_header(s->task, out.stream);
  for (long k = 0; k < s->points; k++) (void)fprintf(out.stream, "\n%s", s->row[k].text);
  (void)fputc('\n', out.stream);
  return file_keep(&out);
}

/* Tell of points that failed, whose rows are in the file. Returns the exit code. */
static int report_failures(const sweep *s, const char *path)
{
  const long failed = count_rows(s, true);
  if (failed == 0) return DONE;
  complain("sweep: %ld of %ld points failed; column status of '%s' says which", failed,
           count_rows(s, false), path);
  return FAILED;
}

static int sweep_finish(sweep *s, const char *path)
{
  s->written = !s->lost && sweep_write_rows(s, path);
  return s->written ? report_failures(s, path) : FAILED;
}

/* Run the points that are not in the file of the sweep or its part yet. */
static int sweep_run(sweep *s, const sweep_request *request, const sweep_key *key)
{
  int code = FAILED;
  if (sweep_part_open(&s->part, request->out, key, s->points, s->row)) {
    s->there = count_rows(s, false);
    if (s->there > 0)
      complain("sweep: %ld of %ld points are in '%s' already", s->there,
               study_part_size(&s->own, s->points), s->part.path);
    code = sweep_run_points(s, request->threads > 0 ? (int)request->threads : dvi_study_cores());
    if (code == DONE)
      code = s->own.given ? report_failures(s, s->part.path) : sweep_finish(s, request->out);
  }
  sweep_part_close(&s->part, s->written);
  return code;
}

static int sweep_all(const sweep_task *task, const sweep_request *request)
{
  sweep s = {
      .task = task, .command = request->command, .points = task->grid.points, .own = request->part};
  const sweep_key key = sweep_key_of(task, &s.own);
  int code = FAILED;
  s.row = calloc((size_t)s.points, sizeof *s.row);
  if (s.row == NULL)
    complain("out of memory");
  else if (request->join.count == 0)
    code = sweep_run(&s, request, &key);
  else if (sweep_join(&key, &request->join, s.points, s.row))
    code = sweep_finish(&s, request->out);
  for (long k = 0; s.row != NULL && k < s.points; k++) free(s.row[k].text);
  free(s.row);
  return code;
}

/* ---- request ---- */

/* Check the task. Errors at all points are reported before the first one. */
static int check_task(const sweep_task *task)
{
  const problem *model = task->model;
  const char *method = task->method;
  dvi_integrator *integrator = NULL;
  int code = open_wish("sweep", model, &method);
  if (code == DONE) code = open_integrator(model, method, &integrator);
  dvi_integrator_destroy(&integrator);
  if (code != DONE) return code;
  const double t_end = isnan(task->t_end) ? model->t_end : task->t_end;
  return way_check("sweep", isnan(task->h) ? copysign(model->h, t_end) : task->h, t_end, t_end,
                   true);
}

/* Refuse files to join that would be overwritten. */
static int check_join(const sweep_request *request)
{
  if (request->join.count > 0 && request->part.given)
    return usage_error("sweep: --part and --join exclude each other: parts are joined when all of "
                       "them are there");
  for (int i = 0; i < request->join.count; i++)
    if (file_same(request->join.word[i], request->out))
      return usage_error("sweep: --out %s is one of the parts of --join", request->out);
  return DONE;
}

static int sweep_check_request(sweep_request *request)
{
  int code = study_part_read("sweep", request->divided, &request->part);
  if (code != DONE) return code;
  if (request->out == NULL)
    return usage_error("sweep: --out FILE.csv is missing: where the rows go, and from where an "
                       "interrupted sweep goes on");
  if (strcmp(request->out, "-") == 0)
    return usage_error("sweep: --out -: rows go to a file, not to standard output, for an "
                       "interrupted sweep goes on from there");
  if (request->threads > DVI_STUDY_THREADS_MAX)
    return usage_error("sweep: at most %d threads", (int)DVI_STUDY_THREADS_MAX);
  code = check_join(request);
  if (code != DONE) return code;
  if (!file_writable(request->out)) return FAILED;
  return !store_is_wanted(request->out) || store_module(request->out) != NULL ? DONE : FAILED;
}

static int sweep_run_request(const sweep_request *request, sweep_task *task)
{
  grid_point fixed;
  problem *model = NULL;
  int code = scene_is_path(task->operand) ? scene_load(task->operand, &task->text) : DONE;
  if (code == DONE) code = grid_read(&request->settings, &task->grid);
  grid_fixed(&task->grid, &fixed);
  if (code == DONE) code = open_text(task->operand, &task->text, &fixed.settings, &model);
  task->model = model;
  if (code == DONE) code = grid_complete(model, &task->grid);
  if (code == DONE) code = check_task(task);
  if (code == DONE) code = sweep_all(task, request);
  problem_destroy(&model);
  grid_clear(&task->grid);
  free(task->text.text);
  return code;
}

static const char *const details[] = {
    "Points: all combinations of the values of the scene's section sweep and of --set, the last "
    "one's changes first;\n"
    "--set of a parameter replaces its values in the section. Each point reads the scene anew.\n",
    "Columns: the parameters; status, DVI_OK, 'event NAME' where an event of the scene ended the "
    "run, why it failed, or refused\n"
    "where the problem cannot be made; steps; t, the coordinates, the momenta and the invariants "
    "at the end, or where the run\n"
    "ended; energy_error, the largest change of the energy since the start. 17 digits; cells "
    "without a number are empty. Rows\n"
    "stand in the order of the points and do not depend on the number of threads. If points "
    "failed, all others are there, and\n"
    "the exit code is 1.\n",
    "Rows are kept in FILE.csv.part as they are found. A sweep that was interrupted, however it "
    "was, goes on from there when\n"
    "the same command is given again; with another scene, method, step, end or values it is "
    "refused. When all points are\n"
    "there, FILE.csv is written whole. FILE.h5 has the columns of numbers in the dataset rows, "
    "their "
    "names in its attribute\n"
    "columns, and status in the group text.\n",
    "--part K/N keeps its rows in FILE.csv.K-of-N, from where it goes on when it is given again. "
    "When all N parts are there,\n"
    "the same command with --join FILE.csv.*-of-N instead of --part writes FILE.csv or FILE.h5, "
    "the "
    "same bytes as without\n"
    "parts. Parts of another scene, method, step, end, grid or version are refused, and so are "
    "missing and unfinished ones.\n"
    "The number of threads and the machines do not matter; see docs/tools/cluster.md.\n",
    "Examples:\n"
    "  dvi init cart.yaml\n"
    "  dvi sweep cart.yaml --out cart.csv\n"
    "  dvi sweep cart.yaml --set l=0.2:1:5 --set m=0.2 --out lengths.csv\n"
    "  dvi sweep kepler --method galerkin:degree=4 --set e=0:0.9:10 --out kepler.csv\n"
    "  dvi sweep cart.yaml --set l=0.2:1:64 --out l.csv --part 3/4\n"
    "  dvi sweep cart.yaml --set l=0.2:1:64 --out l.csv --join l.csv.*-of-4\n",
    NULL,
};

/* The options. */
typedef struct sweep_line {
  sweep_task task;
  sweep_request request;
} sweep_line;

static const option command_options[] = {
    {.name = "set",
     OPTION_AT(sweep_line, request.settings),
     .value = "NAME=VALUES",
     .help = "a parameter's values: V1,V2,.. or FROM:TO:COUNT, or a single one; may be repeated"},
    {.name = "method",
     OPTION_AT(sweep_line, task.method),
     .value = "SPEC",
     .help = "the method; default: the scene's"},
    {.name = "h",
     OPTION_AT(sweep_line, task.h),
     .value = "H",
     .help = "the step; default: the problem's"},
    {.name = "t-end",
     OPTION_AT(sweep_line, task.t_end),
     .value = "T",
     .help = "the end, from t = 0; default: the problem's"},
    {.name = "threads",
     OPTION_AT(sweep_line, request.threads),
     .value = "N",
     .help = "runs at a time; default: as many as there are cores"},
    {.name = "out",
     OPTION_AT(sweep_line, request.out),
     .value = "FILE.csv|FILE.h5",
     .help = "where the rows go, as HDF5 if the name ends in .h5"},
    {.name = "part",
     OPTION_AT(sweep_line, request.divided),
     .value = "K/N|slurm",
     .help = "run every N-th point from the K-th; slurm: K and N of this task of a job array"},
    {.name = "join",
     OPTION_AT(sweep_line, request.join),
     .value = "FILE...",
     .help = "run nothing, and put the files of all parts together"},
    {.name = NULL},
};

static const command_line command = {
    .name = "sweep",
    .synopsis = "PROBLEM --out FILE.csv|FILE.h5 [--set NAME=VALUES ...] [OPTIONS]",
    .operand = "PROBLEM",
    .summary = "Run a problem at each point of a grid of parameters, on all cores, and write the "
               "ends as CSV.\n",
    .options = command_options,
    .details = details,
};

/* Spell the command line without --join and its files, because the file is the one of a sweep that
 * was never divided. */
static char *spell_command(int argc, char **argv, const word_list *join)
{
  char **kept = calloc((size_t)argc + 1, sizeof *kept);
  int count = 0;
  if (kept == NULL) return NULL;
  const long first = join->count > 0 ? (long)(join->word - argv) - 1 : argc;
  for (int i = 0; i < argc; i++)
    if (i < first || i > first + join->count) kept[count++] = argv[i];
  char *text = command_spelled("sweep", count, kept);
  free(kept);
  return text;
}

int sweep_command(int argc, char **argv)
{
  sweep_line r = {.task = {.h = (double)NAN, .t_end = (double)NAN}};
  int code;
  if (!options_parse(&command, argc, argv, &r, &r.task.operand, &code)) return code;
  code = sweep_check_request(&r.request);
  const named_file out = {.option = "out", .path = r.request.out};
  if (code == DONE) code = scene_spared("sweep", r.task.operand, 1, &out);
  if (code != DONE) return code;
  signals_end(true, ended);
  r.request.command = spell_command(argc, argv, &r.request.join);
  code = sweep_run_request(&r.request, &r.task);
  free(r.request.command);
  return code;
}
