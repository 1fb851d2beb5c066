#include "study/work_report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "study/asked.h"
#include "cli/command.h"
#include "bench/machine.h"
#include "csv/table.h"

enum { SUBJECT_SIZE = 96 };

const table_column bench_columns[] = {
    {"integrator", NULL},       {"problem", NULL},
    {"setting", NULL},          {"error", "%.3e"},
    {"energy_error", "%.3e"},   {"cpu_seconds", "%.3e"},
    {"evaluations", "%.0f"},    {"cpu_lower", "%.3e"},
    {"cpu_upper", "%.3e"},      {"steps", "%.0f"},
    {"create_seconds", "%.3e"}, {"calibration_seconds", ""},
    {"calibration_least", ""},  {NULL, NULL},
};

int bench_group_end(const bench_results *results, int first)
{
  int end = first;
  while (end < results->jobs &&
         strcmp(results->job[end].integrator, results->job[first].integrator) == 0)
    end++;
  return end;
}

static result_table *make_table(const bench_results *results)
{
  result_table *rows = table_create(bench_columns);
  for (int i = 0; i < results->jobs; i++) {
    const bench_job *job = &results->job[i];
    table_text(rows, job->integrator);
    table_text(rows, results->scene->name);
    table_text(rows, job->setting);
    table_number(rows, job->error);
    table_number(rows, job->energy_error);
    table_number(rows, job->seconds.median);
    table_number(rows, (double)job->evaluations);
    table_number(rows, job->seconds.lower);
    table_number(rows, job->seconds.upper);
    table_number(rows, (double)job->taken);
    table_number(rows, job->creation_seconds);
    table_number(rows, results->calibration.median);
    table_number(rows, results->calibration.least);
  }
  return rows;
}

static bool has_sundials(const bench_results *results)
{
  for (int i = 0; i < results->jobs; i++)
    if (results->job[i].peer >= 0 &&
        dvi_reference_name((dvi_reference_code)results->job[i].peer) != NULL)
      return true;
  return false;
}

static void print_head(FILE *stream, const bench_results *results)
{
  (void)fprintf(stream, "Speed against error on %s\n", results->scene->name);
  machine_print(stream);
  machine_print_calibration(stream, &results->calibration);
  if (results->one_point) (void)fprintf(stream, "callbacks: one point a call\n");
}

static void print_notes(FILE *stream, const bench_results *results)
{
  (void)fprintf(stream, "judge at t = %g: %s, error %.1e\n", results->t_end, results->judge->words,
                results->judge->error);
  (void)fprintf(stream,
                "cpu_seconds: process time of a whole job, median of %ld interleaved rounds; "
                "cpu_lower, cpu_upper: quartiles\n",
                results->rounds);
  (void)fprintf(stream,
                "create_seconds: its part that creates the integrator; of peers not known\n");
  (void)fprintf(stream, "energy_error: methods: largest over the run; peers: largest of %d times\n",
                (int)ENERGY_TIMES);
  if (!has_sundials(results)) return;
  (void)fprintf(stream,
                "SUNDIALS %s. Caution: Debian's packages of SUNDIALS are built without "
                "optimisation; its codes linked\n",
                dvi_reference_version());
  (void)fprintf(stream, "from them are several times slower than they can be. Say which build a "
                        "ratio was measured against.\n");
}

static void print_table(FILE *stream, const bench_results *results, const result_table *rows)
{
  for (int first = 0; first < results->jobs; first = bench_group_end(results, first)) {
    (void)fprintf(stream, "\n%s\n", results->job[first].integrator);
    table_print(rows, stream, 2, first, bench_group_end(results, first));
  }
  (void)fputc('\n', stream);
}

static bool plot_jobs(const bench_results *results, const result_table *rows, const plot_axes *axes,
                      const char *path)
{
  char subject[SUBJECT_SIZE];
  (void)snprintf(subject, sizeof subject, "%s, to t = %g", results->scene->name, results->t_end);
  return axes_plot(rows, axes, subject, 0, NULL, path);
}

static bool on_standard_output(const char *path)
{
  return path != NULL && strcmp(path, "-") == 0;
}

static bool report_asked(FILE *stream, const bench_results *results, const bench_outputs *outputs)
{
  if (outputs->asked.count == 0) return true;
  result_table *rows = asked_table(results, &outputs->asked);
  bool good = table_good(rows);
  if (good && !on_standard_output(outputs->at_csv))
    asked_print(results, &outputs->asked, rows, stream);
  if (good && outputs->at_csv != NULL) good = table_write(rows, outputs->at_csv);
  table_destroy(&rows);
  return good;
}

int bench_report(const bench_results *results, const bench_outputs *outputs)
{
  FILE *report = on_standard_output(outputs->csv) || on_standard_output(outputs->at_csv) ? stderr
                                                                                         : stdout;
  result_table *rows = make_table(results);
  bool good = table_good(rows);
  print_head(report, results);
  if (good && !on_standard_output(outputs->csv)) print_table(report, results, rows);
  good = good && report_asked(report, results, outputs);
  print_notes(report, results);
  if (good && outputs->csv != NULL) good = table_write(rows, outputs->csv);
  if (good && outputs->plot != NULL) good = plot_jobs(results, rows, &outputs->axes, outputs->plot);
  table_destroy(&rows);
  return good ? DONE : FAILED;
}
