/* dvi resonance, which searches for the values of a parameter at which a method lets an invariant
 * grow. */
#include <dvi/study.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/events.h"
#include "cli/file.h"
#include "load/open.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "sweep/peaks.h"
#include "plot/plot.h"
#include "load/scene.h"
#include "cli/signals.h"
#include "cli/spelling.h"
#include "csv/table.h"
#include "cli/way.h"

enum {
  GRID_DEFAULT = 65,
  POINTS_DEFAULT = 2000,
  POINTS_MAX = 1000000,
  NAME_SIZE = 128,
  TEXT_SIZE = 256
};

/* Gaps beside a peak are halved down to this fraction of the range. */
static const double width_default = 1e-5;

/* The request of the command line. */
typedef struct resonance_request {
  const char *varied, *watched, *csv, *plot;
  double width, bound;
  long grid, points, threads; /* 0 if not given */
  char name[NAME_SIZE];
  peaks_search search;
} resonance_request;

static const char ended[] = "dvi: resonance: a signal ended the search; nothing was written\n";

/* ---- report ---- */

typedef struct resonance_findings {
  const resonance_task *task;
  const resonance_request *request;
  const problem *model;
  const peaks_found *found;
} resonance_findings;

static const char *watched_name(const resonance_findings *r)
{
  return dvi_system_invariant_name(r->model->system, r->task->watched);
}

/* Return whether a top lies between two other points. A top at an end of the range is the flank of
 * a peak beyond it. */
static bool is_peak(const peaks_found *found, int i)
{
  return i > 0 && i + 1 < found->count && found->top[i];
}

/* Print the tops of peaks, for people. */
static void print_peaks(const resonance_findings *r, FILE *stream)
{
  const table_column columns[] = {{r->task->name, "%.9g"}, {"within", "%.1e"}, {"status", NULL},
                                  {"error", "%.3e"},       {"growth", "%.3e"}, {NULL, NULL}};
  result_table *rows = table_create(columns);
  for (int i = 0; i < r->found->count; i++) {
    const resonance_point *point = &r->found->point[i];
    if (!is_peak(r->found, i)) continue;
    table_number(rows, point->value);
    table_number(rows, fmax(point[1].value - point->value, point->value - point[-1].value));
    table_text(rows, point->status);
    table_number(rows, point->error);
    table_number(rows, point->growth);
  }
  const bool good = table_good(rows);
  if (good && table_rows(rows) > 0) table_print(rows, stream, 0, 0, table_rows(rows));
  if (good && table_rows(rows) == 0) (void)fprintf(stream, "no peaks\n");
  table_destroy(&rows);
}

static bool write_points(const resonance_findings *r)
{
  const table_column columns[] = {{r->task->name, ""}, {"status", NULL}, {"steps", ""}, {"t", ""},
                                  {"error", ""},       {"growth", ""},   {NULL, NULL}};
  result_table *rows = table_create(columns);
  for (int i = 0; i < r->found->count; i++) {
    const resonance_point *point = &r->found->point[i];
    table_number(rows, point->value);
    table_text(rows, point->status);
    table_number(rows, (double)point->steps);
    table_number(rows, point->t);
    table_number(rows, point->error);
    table_number(rows, point->growth);
  }
  return table_finish(&rows, r->request->csv);
}

static bool resonance_draw(const resonance_findings *r)
{
  const int count = r->found->count;
  char title[TEXT_SIZE], label[TEXT_SIZE];
  double *x = calloc(2 * (size_t)count, sizeof *x);
  if (x == NULL) {
    complain("out of memory for the plot");
    return false;
  }
  double *y = x + count;
  for (int i = 0; i < count; i++) {
    x[i] = r->found->point[i].value;
    y[i] = isnan(r->found->point[i].error) ? (double)NAN : peaks_height(&r->found->point[i]);
  }
  (void)snprintf(title, sizeof title, "%s by %s", r->model->name, r->task->method);
  (void)snprintf(label, sizeof label, "log10 of the largest error of %s", watched_name(r));
  const plot_curve curve = {.count = count, .x = x, .y = y};
  const plot_panel panel = {.title = title,
                            .x_label = r->task->name,
                            .y_label = label,
                            .smooth = true,
                            .curves = 1,
                            .curve = &curve};
  const bool good = plot_write(r->request->plot, 1, &panel);
  free(x);
  return good;
}

/* Return the point with the largest error, or -1 if no point has one. */
static int worst_point(const peaks_found *found)
{
  int at = -1;
  for (int i = 0; i < found->count; i++)
    if (!isnan(found->point[i].error) && (at < 0 || found->point[i].error > found->point[at].error))
      at = i;
  return at;
}

static void print_end(const resonance_findings *r, int end, FILE *stream)
{
  const resonance_point *point = &r->found->point[end];
  if (r->found->top[end])
    (void)fprintf(stream, "at the end %.9g of the range the error still rises: %.3e\n",
                  point->value, point->error);
}

static void print_unbounded(const resonance_findings *r, FILE *stream)
{
  int count = 0;
  double first = 0.0, last = 0.0;
  for (int i = 0; i < r->found->count; i++) {
    const resonance_point *point = &r->found->point[i];
    if (!point->unbounded) continue;
    if (count++ == 0) first = point->value;
    last = point->value;
  }
  if (count > 0)
    (void)fprintf(stream, "unbounded at %d points, from %.9g to %.9g\n", count, first, last);
}

static void print_resonances(const resonance_findings *r, int worst, FILE *stream)
{
  const peaks_search *search = &r->request->search;
  (void)fprintf(stream, "Largest errors of %s on %s by %s, to t = %g\n", watched_name(r),
                r->model->name, r->task->method, r->task->t_end);
  print_peaks(r, stream);
  print_end(r, 0, stream);
  print_end(r, r->found->count - 1, stream);
  print_unbounded(r, stream);
  (void)fprintf(stream, "%d points of %s from %g to %g, begun with %ld", r->found->count,
                r->task->name, search->from, search->to, search->grid);
  if (worst >= 0)
    (void)fprintf(stream, "; the largest error is %.3e, at %.9g", r->found->point[worst].error,
                  r->found->point[worst].value);
  (void)fputc('\n', stream);
}

/* Return DONE, or complain and return FAILED if a result is not known, or CHECK_FAILED if the bound
 * does not hold. */
static int resonance_exit_code(const resonance_findings *r, int worst, FILE *stream)
{
  int failed = 0;
  for (int i = 0; i < r->found->count; i++) failed += r->found->point[i].failed;
  if (failed > 0)
    complain("resonance: %d of %d points failed; --csv FILE says which", failed, r->found->count);
  if (!r->found->complete)
    complain("resonance: %d points do not find all peaks to %g; give more --points, a larger "
             "--width, or a smaller range",
             r->found->count, r->request->search.width);
  if (failed > 0 || !r->found->complete) return FAILED;
  if (isnan(r->request->bound)) return DONE;
  const bool holds = r->found->point[worst].error <= r->request->bound;
  (void)fprintf(stream, "bound %g: %s\n", r->request->bound, holds ? "holds" : "MISSED");
  return holds ? DONE : CHECK_FAILED;
}

static int resonance_report(const resonance_findings *r)
{
  FILE *stream = r->request->csv != NULL && strcmp(r->request->csv, "-") == 0 ? stderr : stdout;
  const int worst = worst_point(r->found);
  print_resonances(r, worst, stream);
  if (r->request->csv != NULL && !write_points(r)) return FAILED;
  if (r->request->plot != NULL && !resonance_draw(r)) return FAILED;
  return resonance_exit_code(r, worst, stream);
}

/* ---- request ---- */

/* Read NAME=FROM:TO, and keep the name. */
static int read_varied(resonance_request *request)
{
  const char *text = request->varied;
  peaks_search *search = &request->search;
  if (text == NULL)
    return usage_error("resonance: --sweep NAME=FROM:TO is missing: which parameter varies, and "
                       "between which values");
  (void)snprintf(request->name, sizeof request->name, "%s", text);
  char *from = strchr(request->name, '='), *to = strchr(request->name, ':');
  if (strlen(text) >= NAME_SIZE || from == NULL || to == NULL || from == request->name || to < from)
    return usage_error("resonance: --sweep wants NAME=FROM:TO, not '%s'", text);
  *from++ = *to++ = '\0';
  if (!parse_number(from, &search->from) || !parse_number(to, &search->to) ||
      !(search->from < search->to))
    return usage_error(
        "resonance: --sweep %s: two finite numbers are wanted, the first one less than the other",
        text);
  return DONE;
}

/* Check that there is room for the parameter that varies, and that no --set names it, too. */
static int check_varied(const words *settings, const char *name)
{
  if (settings->count == WORDS_MAX) return usage_error("resonance: --set is given too often");
  for (int i = 0; i < settings->count; i++)
    if (strncmp(settings->word[i], name, strlen(name)) == 0 &&
        settings->word[i][strlen(name)] == '=')
      return usage_error("resonance: --set %s: --sweep varies it; leave out one of them",
                         settings->word[i]);
  return DONE;
}

static int complete_search(resonance_request *request)
{
  peaks_search *search = &request->search;
  const double range = search->to - search->from;
  search->grid = request->grid > 0 ? request->grid : GRID_DEFAULT;
  search->most = request->points > 0 ? request->points : POINTS_DEFAULT;
  search->threads = request->threads > 0 ? request->threads : dvi_study_cores();
  if (!isfinite(range * (double)search->grid))
    return usage_error("resonance: --sweep %s: the range is too wide", request->varied);
  search->width = isnan(request->width) ? width_default * range : request->width;
  if (search->grid < 3)
    return usage_error("resonance: --grid %ld is too few, a peak needs 3", search->grid);
  if (search->most > POINTS_MAX)
    return usage_error("resonance: --points: %d at most", (int)POINTS_MAX);
  if (search->grid > search->most)
    return usage_error("resonance: --grid %ld is more than the %ld of --points", search->grid,
                       search->most);
  if (search->threads > DVI_STUDY_THREADS_MAX)
    return usage_error("resonance: at most %d threads", (int)DVI_STUDY_THREADS_MAX);
  if (!(search->width >= 1e-13 * fmax(fabs(search->from), fabs(search->to))))
    return usage_error("resonance: --width %g is below what numbers near %g can tell apart",
                       search->width, search->to);
  return DONE;
}

static int resonance_check_request(resonance_request *request, const resonance_task *task)
{
  const named_file files[] = {{.option = "csv", .path = request->csv},
                              {.option = "plot", .path = request->plot}};
  int code = read_varied(request);
  if (code == DONE) code = check_varied(&task->settings, request->name);
  if (code == DONE) code = complete_search(request);
  if (code == DONE) code = outputs_plot("resonance", "plot", request->plot);
  if (code == DONE) code = scene_spared("resonance", task->operand, 2, files);
  if (code == DONE) code = outputs_distinct("resonance", 2, files);
  if (code != DONE) return code;
  if (!isnan(request->bound) && !(request->bound > 0.0))
    return usage_error("resonance: --bound %g is not positive", request->bound);
  if (request->csv != NULL && !file_writable(request->csv)) return FAILED;
  return request->plot == NULL || file_writable(request->plot) ? DONE : FAILED;
}

static const char *model_parameter_at(int k, const void *list)
{
  return ((const problem_parameter *)list)[k].name;
}

/* Find the varied parameter of the problem, or the step if no parameter has the name h. */
static int find_varied(const problem *model, resonance_task *task)
{
  char hint[TEXT_SIZE];
  for (const problem_parameter *p = model->parameter; p->name != NULL; p++)
    if (strcmp(p->name, task->name) == 0) return DONE;
  task->steps_vary = strcmp(task->name, "h") == 0;
  if (task->steps_vary) return DONE;
  return usage_error(
      "resonance: %s has no parameter '%s' that could be swept%s", model->name, task->name,
      suggestion(task->name, model_parameter_at, model->parameter, hint, sizeof hint));
}

static int find_watched(const problem *model, const char *name, resonance_task *task)
{
  const int count = dvi_system_invariant_count(model->system);
  for (task->watched = 0; name != NULL && task->watched < count; task->watched++)
    if (strcmp(dvi_system_invariant_name(model->system, task->watched), name) == 0) return DONE;
  return name == NULL ? DONE
                      : usage_error("resonance: %s has no invariant '%s'", model->name, name);
}

/* Complete the task. Errors at all points are reported before the first one. */
static int complete_task(const resonance_request *request, const problem *model,
                         resonance_task *task)
{
  dvi_integrator *integrator = NULL;
  int code = find_varied(model, task);
  if (code == DONE) code = find_watched(model, request->watched, task);
  if (code == DONE) code = refuse_noise("resonance", model);
  if (code == DONE) code = open_wish("resonance", model, &task->method);
  if (code == DONE) code = open_integrator(model, task->method, &integrator);
  dvi_integrator_destroy(&integrator);
  if (code != DONE) return code;
  if (isnan(task->t_end)) task->t_end = model->t_end;
  if (task->steps_vary && !isnan(task->h))
    return usage_error("resonance: --h is what --sweep h varies; leave out one of them");
  if (isnan(task->h)) task->h = copysign(model->h, task->t_end);
  const double t_end = task->t_end;
  if (t_end == 0.0) return usage_error("resonance: --t-end 0 leaves nothing to run");
  code = way_check("resonance", task->steps_vary ? request->search.from : task->h, t_end, t_end,
                   true);
  if (code == DONE && task->steps_vary)
    code = way_check("resonance", request->search.to, t_end, t_end, true);
  if (code != DONE) return code;
  events_passed("resonance", model);
  return DONE;
}

static int search_peaks(const resonance_request *request, const problem *model,
                        const resonance_task *task)
{
  peaks_found found;
  const resonance_findings r = {.task = task, .request = request, .model = model, .found = &found};
  const int code = peaks_find(task, &request->search, &found) ? resonance_report(&r) : FAILED;
  peaks_clear(&found);
  return code;
}

static int resonance_run_request(resonance_request *request, resonance_task *task)
{
  problem *model = NULL;
  int code = scene_is_path(task->operand) ? scene_load(task->operand, &task->text) : DONE;
  task->name = request->name;
  if (code == DONE) code = open_text(task->operand, &task->text, &task->settings, &model);
  if (code == DONE) code = complete_task(request, model, task);
  if (code == DONE) code = search_peaks(request, model, task);
  problem_destroy(&model);
  free(task->text.text);
  return code;
}

static const char *const details[] = {
    "The error of a run is the largest change of the energy, or of the invariant that --watch "
    "names, over all its steps, divided\n"
    "by its size at the start unless that is 0. The search begins with --grid even points. A point "
    "is the top of a peak if its\n"
    "error is more than twice the least ones on both sides, before larger errors or the range's "
    "end; those up to 1e-12 count as\n"
    "1e-12. Gaps beside a top are halved, and so are gaps over which the error changes more than "
    "tenfold, until they are no\n"
    "wider than --width. A peak is missed if no point of the first grid is raised by it: errors "
    "near a resonance fall off as\n"
    "the inverse of the distance from it, so a few points between neighbouring ones are enough, "
    "however narrow they are.\n",
    "Printed for each peak: the value; within what distance its top lies; status; error; growth, "
    "the rate of the error's "
    "logarithm\n"
    "over the last half to three quarters of the run. --csv has all points; its columns: the "
    "parameter, status (DVI_OK; "
    "unbounded,\n"
    "where the invariant moved by 1e30 times its start and the run was ended; why it failed; or "
    "refused, where the problem cannot\n"
    "be made), steps, t, error, growth. The results do not depend on the number of threads.\n",
    "Exit code 0: done, and all errors are within --bound; 1: points failed, or --points did not "
    "suffice; 3: the bound is "
    "missed.\n",
    "Examples:\n"
    "  dvi resonance oscillators --method respa:substeps=100 --h 0.1 --t-end 1000 --sweep "
    "omega=1:140 --plot respa.svg\n"
    "  dvi resonance oscillators --method imex --h 0.1 --t-end 1000 --sweep omega=1:140 --bound "
    "0.003\n"
    "  dvi resonance fpu --method respa:substeps=exact --t-end 200 --sweep h=0.01:0.2 --watch I "
    "--csv steps.csv\n",
    NULL,
};

/* The options. */
typedef struct resonance_line {
  resonance_task task;
  resonance_request request;
} resonance_line;

static const option command_options[] = {
    {.name = "sweep",
     OPTION_AT(resonance_line, request.varied),
     .value = "NAME=FROM:TO",
     .help = "the parameter that varies, or h: the step"},
    {.name = "method",
     OPTION_AT(resonance_line, task.method),
     .value = "SPEC",
     .help = "the method; default: the scene's"},
    {.name = "h",
     OPTION_AT(resonance_line, task.h),
     .value = "H",
     .help = "the step; default: the problem's"},
    {.name = "t-end",
     OPTION_AT(resonance_line, task.t_end),
     .value = "T",
     .help = "the end, from t = 0; default: the problem's"},
    {.name = "set",
     OPTION_AT(resonance_line, task.settings),
     .value = "NAME=VALUE",
     .help = "set another parameter; may be repeated"},
    {.name = "watch",
     OPTION_AT(resonance_line, request.watched),
     .value = "NAME",
     .help = "the invariant whose change counts; default: energy"},
    {.name = "grid",
     OPTION_AT(resonance_line, request.grid),
     .value = "N",
     .help = "how many points to begin with; default: 65"},
    {.name = "width",
     OPTION_AT(resonance_line, request.width),
     .value = "W",
     .help = "to find peaks to; default: 1e-5 of the range"},
    {.name = "points",
     OPTION_AT(resonance_line, request.points),
     .value = "N",
     .help = "how many points at most; default: 2000"},
    {.name = "bound",
     OPTION_AT(resonance_line, request.bound),
     .value = "B",
     .help = "check that no error is larger"},
    {.name = "threads",
     OPTION_AT(resonance_line, request.threads),
     .value = "N",
     .help = "runs at a time; default: as many as there are cores"},
    {.name = "csv",
     OPTION_AT(resonance_line, request.csv),
     .value = "-|FILE",
     .help = "write all points as CSV; -: to standard output, words to stderr",
     .is_csv = true},
    {.name = "plot",
     OPTION_AT(resonance_line, request.plot),
     .value = "FILE.svg",
     .help = "draw the errors against the parameter"},
    {.name = NULL},
};

static const command_line command = {
    .name = "resonance",
    .synopsis = "PROBLEM --sweep NAME=FROM:TO [OPTIONS]",
    .operand = "PROBLEM",
    .summary = "Find the values of a parameter at which a method lets an invariant grow: many "
               "runs on all cores, ever closer to "
               "each peak\n"
               "of the error.\n",
    .options = command_options,
    .details = details,
};

int resonance_command(int argc, char **argv)
{
  resonance_line r = {.task = {.h = (double)NAN, .t_end = (double)NAN},
                      .request = {.width = (double)NAN, .bound = (double)NAN}};
  int code;
  if (!options_parse(&command, argc, argv, &r, &r.task.operand, &code)) return code;
  code = resonance_check_request(&r.request, &r.task);
  if (code != DONE) return code;
  signals_end(true, ended);
  return resonance_run_request(&r.request, &r.task);
}
