/* dvi order, which measures whether a method has the order that it claims. */
#include <dvi/study.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plot/axes.h"
#include "cli/command.h"
#include "csv/events.h"
#include "cli/file.h"
#include "study/levels.h"
#include "load/open.h"
#include "load/open_march.h"
#include "cli/options.h"
#include "study/order_report.h"
#include "cli/outputs.h"
#include "cli/progress.h"
#include "load/scene.h"
#include "mechanics/judge.h"
#include "mechanics/motion_study.h"
#include "mechanics/single_steps.h"
#include "csv/table.h"

/* A high order is asymptotic only near the floor, if at all. More levels there let the window begin
 * where it is. */
enum { LEVELS_DEFAULT = 6, LEVELS_HIGH_ORDER = 12, HIGH_ORDER = 8, LENGTHENINGS = 3 };
static const double lengthening = 4.0;

/* The request of the command line. */
typedef struct order_request {
  const char *csv, *plot, *judged_by;
  judge_kind judge;
  double h, t_end, ratio;
  long levels;                    /* 0 for a choice */
  words methods, settings, asked; /* asked holds the axes of the plot */
  table_column columns[ORDER_COLUMNS_MAX];
  plot_axes axes;
  pacing how;
} order_request;

/* The study of one method, and its judge. */
typedef struct order_study {
  const order_request *request;
  const problem *scene;
  judgement judge;
  double judged_at; /* time that the judge was asked for, or NaN before */
  dvi_study_levels choice;
  progress_line progress;
  result_table *rows;
} order_study;

/* Get the judge's answer for this time. */
static int ask_judge(order_study *ask, double t_end)
{
  const judge_request request = {.kind = ask->request->judge, .progress = &ask->progress};
  if (t_end == ask->judged_at) return DONE;
  judge_clear(&ask->judge);
  ask->judged_at = (double)NAN;
  progress_show(&ask->progress, -1.0, "judge");
  const int code = judge_init(&ask->judge, ask->scene, t_end, &request);
  if (code == DONE) ask->judged_at = t_end;
  return code;
}

static int level_count(const order_request *request, int order)
{
  if (request->levels > 0) return (int)request->levels;
  return order < HIGH_ORDER ? LEVELS_DEFAULT : LEVELS_HIGH_ORDER;
}

/* Choose the levels of a method, and run them, except if they must fit above the floor and do
 * not. */
static dvi_status run_levels(order_study *ask, const study_subject *of, bool must_fit,
                             order_result *to)
{
  const order_request *request = ask->request;
  const dvi_study_search wanted = {.length = isnan(request->h) ? 0.0 : request->h,
                                   .ratio = isnan(request->ratio) ? 0.0 : request->ratio,
                                   .levels = level_count(request, of->order)};
  dvi_status status = levels_choose(of, &wanted, &ask->choice);
  const bool there = status == DVI_OK && ask->choice.parts[0] > 0;
  if (!there || (must_fit && !ask->choice.room)) return status;
  status = order_measure(of, &ask->choice, wanted.levels, ask->rows, to);
  return status == DVI_OK && request->levels == 0 ? order_extend(of, ask->rows, to) : status;
}

/* Study up to t_end. If the levels do not fit above the floor there, and that matters, *room
 * becomes false instead. */
static int study_until(order_study *ask, const char *method, double t_end, bool *room,
                       order_result *to)
{
  motion_study study;
  char name[PACED_NAME];
  int code = ask_judge(ask, t_end);
  if (code != DONE) return code;
  paced_name(method, &ask->request->how, name, sizeof name);
  const judged_motion motion = {.scene = ask->scene, .judge = &ask->judge, .t_end = t_end};
  code = motion_study_init(&study, &motion, method, &ask->request->how, name);
  if (code != DONE) return code;
  study.progress = &ask->progress;
  const dvi_status status = run_levels(ask, &study.subject, *room, to);
  motion_study_clear(&study);
  if (status == DVI_OK) {
    *room = ask->choice.room;
    return ask->choice.parts[0] > 0 ? DONE : motion_study_refuse(name, t_end);
  }
  (void)library_error(status);
  complain("order: %s failed on %s; try a smaller --h", method, ask->scene->name);
  return FAILED;
}

/* Study single steps if the span does not show the claimed order, because they are measured in more
 * digits. With fewer levels than a verdict needs none is wanted, and with a monitor a step has no
 * length of its own. */
static int study_single_steps(order_study *ask, const char *method, order_result *result)
{
  const order_request *request = ask->request;
  const bool few = request->levels > 0 && request->levels < DVI_STUDY_FIT_LEAST;
  if (order_holds(result) || few || dvi_scene_marches(ask->scene->scene, method) ||
      request->how.transform != NULL || request->how.control != NULL)
    return DONE;
  const words *settings = &request->settings;
  const double t_end = result->extent;
  progress_line *progress = &ask->progress;
  closer_look *look = &result->closer;
  const dvi_status status = single_steps_measure(ask->scene, settings, method, t_end, progress,
                                                 look);
  return status == DVI_OK ? DONE : library_error(status);
}

/* Return the end of the study, before any lengthening. */
static double study_end(const order_request *request, const problem *scene)
{
  return isnan(request->t_end) ? scene->order_t_end : request->t_end;
}

/* Study one method. If the problem's own span is so short that a few steps meet the floor, it is
 * lengthened. This is not done if there is a stored result, which is for this span. It would be
 * replaced by IDA, whose error would leave less room than the longer span gains. */
static int study_method(order_study *ask, const char *method, order_result *result)
{
  const order_request *request = ask->request;
  const bool fixed = !isnan(request->t_end) || !isnan(request->h) ||
                     request->judge == JUDGE_STORED ||
                     (ask->scene->exact == NULL && ask->scene->digits_q != NULL);
  double t_end = study_end(request, ask->scene);
  for (int i = 0;; i++) {
    bool room = !fixed && i < LENGTHENINGS;
    const bool must_fit = room;
    const int code = study_until(ask, method, t_end, &room, result);
    if (code != DONE) return code;
    if (room || !must_fit) return study_single_steps(ask, method, result);
    t_end *= lengthening;
  }
}

/* Refuse a first step that would not be taken as it is. */
static int order_check_step(const order_request *request, const problem *scene)
{
  const double t_end = study_end(request, scene);
  if (!(fabs(t_end) / request->h > DVI_STUDY_FIRST_PARTS_MAX)) return DONE;
  return usage_error(
      "order: --h %g is too small: %g steps to t = %g, %d are possible at the first level",
      request->h, fabs(t_end) / request->h, t_end, (int)DVI_STUDY_FIRST_PARTS_MAX);
}

static bool order_write_csv(const result_table *rows, const char *path)
{
  whole_file csv;
  if (!file_open(&csv, path)) return false;
  table_csv(rows, csv.stream);
  return file_keep(&csv);
}

/* Print and write tables, verdicts and files. Returns the exit code. */
static int order_report(const order_study *ask, order_result *result)
{
  const order_request *request = ask->request;
  const int results = request->methods.count;
  const bool csv_only = request->csv != NULL && strcmp(request->csv, "-") == 0;
  bool all_hold = true;
  if (!csv_only) order_print_tables(ask->scene->name, ask->rows, results, result);
  for (int i = 0; i < results; i++) {
    order_print_verdict(csv_only ? stderr : stdout, &result[i]);
    all_hold = all_hold && order_holds(&result[i]);
  }
  if (request->csv != NULL && !order_write_csv(ask->rows, request->csv)) return FAILED;
  if (request->plot != NULL &&
      !order_plot(ask->scene->name, ask->rows, &request->axes, results, result, request->plot))
    return FAILED;
  return all_hold ? DONE : CHECK_FAILED;
}

static int study_all(const order_request *request, const problem *scene)
{
  result_table *rows = table_create(request->columns);
  order_study ask = {.request = request, .scene = scene, .judged_at = (double)NAN, .rows = rows};
  order_result *result = calloc((size_t)request->methods.count, sizeof *result);
  int code = result != NULL && table_good(ask.rows) ? DONE : FAILED;
  progress_start(&ask.progress, true);
  for (int i = 0; i < request->methods.count && code == DONE; i++)
    code = study_method(&ask, request->methods.word[i], &result[i]);
  progress_end(&ask.progress);
  if (code == DONE) code = table_good(ask.rows) ? order_report(&ask, result) : FAILED;
  free(result);
  table_destroy(&ask.rows);
  judge_clear(&ask.judge);
  return code;
}

/* Take the scene's method if none is asked for. */
static int wish_method(order_request *request, const problem *scene)
{
  const char *wish = NULL;
  if (request->methods.count > 0) return DONE;
  const int code = open_wish("order", scene, &wish);
  if (code == DONE) request->methods.word[request->methods.count++] = wish;
  return code;
}

/* Refuse a wrong method before the judge starts to work. */
static int order_check_methods(const order_request *request, const problem *scene)
{
  int code = DONE;
  for (int i = 0; i < request->methods.count && code == DONE; i++) {
    const char *method = request->methods.word[i];
    dvi_integrator *integrator = NULL;
    code = dvi_scene_marches(scene->scene, method)
               ? check_studied_march("order", scene, method)
               : open_paced(scene, method, &request->how, &integrator);
    dvi_integrator_destroy(&integrator);
  }
  return code;
}

static int order_check_request(order_request *request, const char *name)
{
  const int most = DVI_STUDY_LEVELS_MAX;
  if (request->levels > most)
    return usage_error("order: --levels %ld is too many, %d are possible", request->levels, most);
  if (request->t_end == 0.0) return usage_error("order: --t-end 0 leaves nothing to do");
  if (!isnan(request->h) && !(request->h > 0.0))
    return usage_error(
        "order: --h %g is not positive; for a study backward in time set --t-end below 0",
        request->h);
  if (!isnan(request->ratio) && !(request->ratio >= 1.01 && request->ratio <= 10.0))
    return usage_error("order: --ratio %g is not between 1.01 and 10", request->ratio);
  if (pacing_check("order", &request->how) != DONE ||
      words_distinct("order", "method", &request->methods) != DONE)
    return USAGE;
  const named_file files[] = {{.option = "csv", .path = request->csv},
                              {.option = "plot", .path = request->plot}};
  int code = request->judged_by != NULL
                 ? judge_read("order: --judge", request->judged_by, &request->judge)
                 : DONE;
  if (code == DONE) code = outputs_plot("order", "plot", request->plot);
  if (code == DONE) code = scene_spared("order", name, 2, files);
  if (code == DONE) code = outputs_distinct("order", 2, files);
  if (code != DONE) return code;
  if (request->csv != NULL && !file_writable(request->csv)) return FAILED;
  return request->plot == NULL || file_writable(request->plot) ? DONE : FAILED;
}

static const char *const details[] = {
    "Columns: "
    "method,problem,h,steps,error,slope,energy_error,cpu_seconds,residuals,jacobians,"
    "factorizations.\n"
    "  error         largest error of a coordinate at the end, against the judge\n"
    "  slope         log(error ratio) / log(step ratio) from the level before; empty at the first "
    "level\n"
    "  energy_error  largest |energy - energy at the start| over the run (an untimed run of its "
    "own)\n"
    "  cpu_seconds   process time of one run (short ones are repeated until 0.02 s have passed)\n"
    "  the rest      counted by the library in one run; of problems with rotations and directions "
    "there is one more,\n"
    "  distance      largest distance over the run of R from the nearest rotation, or ||q| - 1|\n",
    "The judge is the problem's exact solution; or its stored quadruple-precision result, if "
    "parameters and end are\n"
    "the problem's own; or whoever states the smaller error: IDA of SUNDIALS, which shares no code "
    "with the methods, run\n"
    "at two tolerances, or two runs of high degree, of which IDA remains the witness. --judge "
    "chooses: exact, stored,\n"
    "ida or runs (see dvi bench --help). An error counts if it is above the floor: ten times the "
    "judge's own error, and\n"
    "ten times what a change of the start in its last digit does to the end. It must also be below "
    "1 % of the solution.\n"
    "The order is fitted to the longest run of 4 or more such levels over which the slope is "
    "settled: the same within\n"
    "0.1 in the coarser and the finer half, with a standard error of 0.05 at most. The claimed "
    "order has no part in that\n"
    "choice. Without --levels up to six further levels are added while the slope has not settled "
    "but comes near the\n"
    "claimed order, errors are above the floor, and a run takes no more than a second. Exit code "
    "0: the fitted order is the claimed one within 0.2. Exit code 3: it is not "
    "(MISSED), or there is\n"
    "no such run (not decided); the cause is said, and what to try.\n",
    "Where the span does not show the claimed order, as it mostly is from order 10 or 12 on, "
    "galerkin on Lagrangians of\n"
    "R^n is judged by single steps in quadruple precision, from 5 points of the motion, by the "
    "same rule: expressions (a\n"
    "scene's, or those of the catalogue's scenes) are evaluated with 113 bits, and the library's "
    "own steps must be these\n"
    "to 1 % of an error that doubles show. A table of its own has them; the CSV has the span "
    "alone.\n",
    "The first step is searched up to 2^17 steps to the end, the last level has up to 2^22; --h "
    "goes beyond. A span\n"
    "too short for the levels of a high order is lengthened, unless a stored result would be lost "
    "by that.\n",
    "With --time-transform or --step-control h is a step of the other time, whose span is measured "
    "by a run of its own; the\n"
    "number of steps is what that span gives, and the last one is shortened to end at t_end.\n",
    "Examples:\n"
    "  dvi order kepler --method galerkin:degree=2\n"
    "  dvi order cart.yaml --plot order.svg\n"
    "  dvi order pendulum --method verlet --method composition:order=6,base=verlet --plot "
    "order.svg\n"
    "  dvi order kepler --set e=0.9 --method galerkin:degree=2 --time-transform distance\n"
    "  dvi order pendulum-3d --method lie-verlet --method lie-rk --plot lie.svg --axes "
    "h:energy_error --axes h:distance\n"
    "  dvi order toda --method galerkin:degree=3,quadrature=lobatto,nodes=3 --h 0.5 --levels 8 "
    "--csv order.csv\n",
    NULL,
};

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(order_request, methods),
     .value = "SPEC",
     .help = "a method: name[:key=value,...]; may be repeated; default: the scene's"},
    {.name = "h",
     OPTION_AT(order_request, h),
     .value = "H",
     .help = "first step (T/H is rounded to whole steps); default: searched"},
    {.name = "levels",
     OPTION_AT(order_request, levels),
     .value = "N",
     .help = "how many step sizes; default: 6, or 12 from order 8"},
    {.name = "ratio",
     OPTION_AT(order_request, ratio),
     .value = "R",
     .help = "of neighbouring steps; default: 2, or less for high orders"},
    {.name = "t-end",
     OPTION_AT(order_request, t_end),
     .value = "T",
     .help = "the end; default: the problem's for order studies"},
    {.name = "time-transform",
     OPTION_AT(order_request, how.transform),
     .value = "MONITOR",
     .help = "steps of equal length in another time: distance[:power=P], arclength or "
             "acceleration[:power=P]"},
    {.name = "step-control",
     OPTION_AT(order_request, how.control),
     .value = "MONITOR",
     .help = "steps that follow a monitor reversibly: cheaper, symmetric, not symplectic"},
    {.name = "judge",
     OPTION_AT(order_request, judged_by),
     .value = "WHO",
     .help = "auto, exact, stored, ida or runs; default: auto"},
    {.name = "set",
     OPTION_AT(order_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the problem; may be repeated"},
    {.name = "csv",
     OPTION_AT(order_request, csv),
     .value = "-|FILE",
     .help = "write the table as CSV; -: to standard output, words to stderr",
     .is_csv = true},
    {.name = "plot",
     OPTION_AT(order_request, plot),
     .value = "FILE.svg",
     .help = "draw error against step, with the claimed slopes"},
    {.name = "axes",
     OPTION_AT(order_request, asked),
     .value = "X:Y",
     .help = "draw these columns of the table instead; may be repeated"},
    {.name = NULL},
};

static const command_line command = {
    .name = "order",
    .synopsis = "PROBLEM|SCENE.yaml [--method SPEC ...] [OPTIONS]",
    .operand = "PROBLEM",
    .summary = "Measure the order of methods: the error at the end for a sequence of steps, and "
               "the slope fitted to it.\n",
    .options = command_options,
    .details = details,
};

int order_command(int argc, char **argv)
{
  order_request r = {.h = (double)NAN, .t_end = (double)NAN, .ratio = (double)NAN};
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  code = order_check_request(&r, name);
  if (code != DONE) return code;
  problem *scene;
  code = open_problem(name, &r.settings, &scene);
  if (code != DONE) return code;
  order_columns(motion_words(scene), r.columns);
  code = axes_read("order", &r.asked, r.plot, "h:error", r.columns, &r.axes);
  if (code == DONE) code = refuse_noise("order", scene);
  if (code == DONE) code = wish_method(&r, scene);
  if (code == DONE) code = order_check_step(&r, scene);
  if (code == DONE) code = order_check_methods(&r, scene);
  if (code == DONE) events_passed("order", scene);
  if (code == DONE) scene_warn("order", scene);
  if (code == DONE) code = study_all(&r, scene);
  problem_destroy(&scene);
  return code;
}
