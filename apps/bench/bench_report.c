#include "bench/bench_report.h"

#include <dvi/study.h>
#include <stdio.h>
#include <string.h>

#include "bench/machine.h"
#include "bench/sundials_build.h"
#include "cli/command.h"

enum { SUBJECT_SIZE = 96 };

static bool has_sundials(const work *w)
{
  for (int i = 0; i < w->jobs; i++) {
    const whole_job *job = w->job[i].subject->user;
    if (job->peer >= 0) return true;
  }
  return false;
}

static void print_head(FILE *stream, const bench_results *results)
{
  (void)fprintf(stream, "Speed against error on %s\n", results->motion->scene->name);
  machine_print(stream);
  machine_print_calibration(stream, &results->work->calibration);
  if (results->one_point) (void)fprintf(stream, "callbacks: one point a call\n");
}

/* Compare the steps of methods with those of bare loops, at each step that both took. */
static void print_bare(FILE *stream, const work *w)
{
  for (int first = 0; first < w->jobs; first = work_group_end(w, first)) {
    const whole_job *loop = w->job[first].subject->user;
    double ratio[WORK_LONGER_MAX + WORK_LEVELS_MAX];
    int count = 0;
    for (int i = first; i < work_group_end(w, first) && loop->beside != NULL; i++)
      for (int k = 0; k < first; k++)
        if (w->job[k].subject == &loop->beside->subject &&
            w->job[k].level.refinement == w->job[i].level.refinement)
          ratio[count++] = (w->job[k].seconds.median - w->job[k].preparation_seconds) /
                           (w->job[i].seconds.median - w->job[i].preparation_seconds);
    if (count == 0) continue;
    const dvi_study_spread of = dvi_study_spread_of(count, ratio);
    (void)fprintf(stream,
                  "%s over %s at equal steps, without creation: %.2f (least %.2f, quartiles %.2f, "
                  "%.2f)\n",
                  loop->beside->subject.name, w->job[first].subject->name, of.median, of.least,
                  of.lower, of.upper);
  }
}

/* Name the program that users of Yee's method compare with. */
static void print_meep(FILE *stream, const bench_results *results)
{
  bool has_yee = false;
  for (int i = 0; i < results->work->jobs; i++)
    has_yee = has_yee || strncmp(results->work->job[i].subject->name, "yee", 3) == 0;
  if (has_yee)
    (void)fprintf(
        stream, "yee: Meep 1.25 marches the same grid with S = 0.5 (fraction 0.87 of the bound in "
                "three dimensions), averages of eps and PML as its defaults; apps/examples/meep.sh "
                "runs it beside yee\n");
}

static void print_notes(FILE *stream, const bench_results *results)
{
  (void)fprintf(stream, "judge at t = %g: %s, error %.1e\n", results->motion->t_end,
                results->motion->judge->words, results->motion->judge->error);
  print_meep(stream, results);
  print_bare(stream, results->work);
  (void)fprintf(stream,
                "cpu_seconds: process time of a whole job, median of %ld interleaved rounds; "
                "cpu_lower, cpu_upper: quartiles\n",
                results->work->rounds);
  (void)fprintf(stream,
                "create_seconds: its part that creates the integrator; of peers not known\n");
  (void)fprintf(stream, "energy_error: methods: largest over the run; peers: largest of %d times\n",
                (int)ENERGY_TIMES);
  if (has_sundials(results->work)) sundials_build_print(stream);
}

static bool plot_jobs(const bench_results *results, const result_table *rows, const plot_axes *axes,
                      const char *path)
{
  char subject[SUBJECT_SIZE];
  (void)snprintf(subject, sizeof subject, "%s, to t = %g", results->motion->scene->name,
                 results->motion->t_end);
  return axes_plot(rows, axes, subject, 0, NULL, path);
}

static bool is_standard_output(const char *path)
{
  return path != NULL && strcmp(path, "-") == 0;
}

static bool report_asked(FILE *stream, const work *w, const bench_outputs *outputs)
{
  table_column columns[ASKED_COLUMNS_MAX];
  if (outputs->asked.count == 0) return true;
  asked_columns(&whole_job_words, columns);
  result_table *rows = asked_table(w, columns);
  bool good = table_good(rows);
  if (good && !is_standard_output(outputs->at_csv)) asked_print(w, rows, stream);
  if (good && outputs->at_csv != NULL) good = table_write(rows, outputs->at_csv);
  table_destroy(&rows);
  return good;
}

int bench_report(const bench_results *results, const bench_outputs *outputs)
{
  FILE *report = is_standard_output(outputs->csv) || is_standard_output(outputs->at_csv) ? stderr
                                                                                         : stdout;
  result_table *rows = work_table(results->work, outputs->columns);
  bool good = table_good(rows);
  print_head(report, results);
  if (good && !is_standard_output(outputs->csv)) work_print(results->work, rows, report);
  good = good && report_asked(report, results->work, outputs);
  print_notes(report, results);
  if (good && outputs->csv != NULL) good = table_write(rows, outputs->csv);
  if (good && outputs->plot != NULL) good = plot_jobs(results, rows, &outputs->axes, outputs->plot);
  table_destroy(&rows);
  return good ? DONE : FAILED;
}
