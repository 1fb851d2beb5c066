/* dvi stability, which tells how fast a field or a solid grows under its steps, before a run. */
#include <dvi/scene.h>
#include <dvi/march.h>
#include <math.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "csv/table.h"
#include "load/elastic.h"
#include "load/field.h"
#include "load/open.h"

/* The options. */
typedef struct stability_request {
  const char *csv;
  double fraction, span;
  words methods, settings;
} stability_request;

/* Add a row, or complain and return the exit code. */
static int examine(const stability_request *r, const problem *scene, const dvi_field *field,
                   const char *method, result_table *rows)
{
  const dvi_scene_plan *plan = dvi_scene_plan_of(scene->scene);
  const dvi_march_options options = {.size = sizeof options,
                                     .method = method,
                                     .fraction = !isnan(r->fraction) ? r->fraction
                                                                     : plan->fraction};
  dvi_stability report;
  const double span = isnan(r->span) ? 0 : r->span;
  const dvi_status status = field != NULL
                                ? dvi_field_stability(field, &options, span, &report)
                                : dvi_elastic_stability(elastic_of(scene), &options, span, &report);
  if (status != DVI_OK) return library_error(status);
  table_text(rows, method);
  table_text(rows, report.schedule);
  table_number(rows, report.period);
  table_number(rows, report.growth);
  table_number(rows, report.growth > 1 ? log(report.growth) : 0);
  table_number(rows, report.resolution);
  table_text(rows, report.is_stable ? "stable" : "grows");
  return DONE;
}

static int examine_all(const stability_request *r, const problem *scene, const dvi_field *field)
{
  static const table_column columns[] = {
      {"method", NULL}, {"schedule", NULL},     {"period", "%.9g"}, {"growth", "%.9f"},
      {"rate", "%.3e"}, {"resolution", "%.1e"}, {"result", NULL},   {NULL, NULL}};
  const char *own = scene->method != NULL ? scene->method : "avi";
  FILE *stream = r->csv != NULL && strcmp(r->csv, "-") == 0 ? stderr : stdout;
  result_table *rows = table_create(columns);
  int code = DONE;
  for (int i = 0; i < (r->methods.count > 0 ? r->methods.count : 1) && code == DONE; i++)
    code = examine(r, scene, field, r->methods.count > 0 ? r->methods.word[i] : own, rows);
  if (code == DONE && !table_good(rows)) code = FAILED;
  if (code == DONE) {
    (void)fprintf(stream, "Growth in a unit of time of %s\n", scene->name);
    table_print(rows, stream, 0, 0, table_rows(rows));
    if (r->csv != NULL && !table_write(rows, r->csv)) code = FAILED;
  }
  table_destroy(&rows);
  return code;
}

static const char *const details[] = {
    "Asynchronous steps and tents can be in resonance with a field, which then grows "
    "exponentially, however slowly. The growth is the factor\n"
    "of the fastest field's amplitude in a unit of time, and the rate its logarithm. A small field "
    "is followed through a common period of\n"
    "all steps, with all of its modes; of a large field, and of steps without a common period, as "
    "most tents are, the fields that grow\n"
    "fastest are searched, and the resolution says which growth the search can have missed. Losses "
    "are counted, and sources left out. Of a solid small vibrations about rest are followed, "
    "without loads and obstacles.\n"
    "The exit code is 0 for growth, too.\n",
    "Columns of --csv: method, schedule, period, growth, rate, resolution, result.\n",
    "Examples:\n"
    "  dvi stability gap.yaml --method avi --method avi:classes=no\n"
    "  dvi stability coax.yaml --method tents --method tents:least=0.5,seed=3\n"
    "  dvi stability gap.yaml --method avi --fraction 0.95 --csv -\n",
    NULL,
};

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(stability_request, methods),
     .value = "SPEC",
     .help = "avi, avi:classes=no, or tents of a field; may be repeated; default: the scene's, or "
             "avi"},
    {.name = "fraction",
     OPTION_AT(stability_request, fraction),
     .value = "F",
     .help = "of the local stable steps; default: the scene's, or 0.5"},
    {.name = "span",
     OPTION_AT(stability_request, span),
     .value = "T",
     .help = "time for which fields are followed at least; default: what the steps need"},
    {.name = "csv",
     OPTION_AT(stability_request, csv),
     .value = "FILE",
     .help = "write the table as CSV; - for standard output",
     .is_csv = true},
    {.name = "set",
     OPTION_AT(stability_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the scene; may be repeated"},
    {.name = NULL},
};

static const command_line command = {
    .name = "stability",
    .synopsis = "SCENE.yaml [--method SPEC] [OPTIONS]",
    .operand = "SCENE.yaml",
    .summary =
        "Find how fast a field grows under asynchronous steps or tents, before a run shows it.\n",
    .options = command_options,
    .details = details,
};

int stability_command(int argc, char **argv)
{
  stability_request r = {.fraction = (double)NAN, .span = (double)NAN};
  const char *name;
  const dvi_field *field;
  const dvi_elastic *solid;
  problem *scene;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  if (!isnan(r.fraction) && !(r.fraction > 0 && r.fraction < 1))
    return usage_error("stability: --fraction %g: above 0 and below 1 are possible", r.fraction);
  if (!isnan(r.span) && !(r.span > 0))
    return usage_error("stability: --span %g: a time above 0 is wanted", r.span);
  code = open_any(name, &r.settings, &scene);
  if (code == DONE) code = field_choose("stability", name, &scene, &field, NULL, &solid);
  if (code != DONE) return code;
  code = examine_all(&r, scene, field);
  problem_destroy(&scene);
  return code;
}
