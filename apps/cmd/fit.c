/* dvi fit, which finds parameters and starts for which a run comes nearest to measurements. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"
#include "csv/table.h"
#include "varied/fit.h"

typedef struct fit_request {
  const char *to, *columns, *method, *out;
  words vary, settings;
} fit_request;

/* ---- the quantities ---- */

static int find_quantity(const varied *v, fit_quantity *q)
{
  for (int k = 0; k < varied_count(v); k++) {
    if (varied_name(v, k) == NULL || strcmp(varied_name(v, k), q->name) != 0) continue;
    q->index = k;
    q->value = varied_value(v, k);
    return DONE;
  }
  return usage_error("fit: --vary %s: %s has no such coordinate, momentum or parameter that is one "
                     "number, and not made of others",
                     q->name, v->scene->name);
}

/* Read NAME or NAME=LEAST:MOST. */
static int read_quantity(const varied *v, const char *text, fit_quantity *q)
{
  const char *equals = strchr(text, '=');
  const size_t length = equals != NULL ? (size_t)(equals - text) : strlen(text);
  *q = (fit_quantity){.least = -HUGE_VAL, .most = HUGE_VAL};
  if (length == 0 || length >= sizeof q->name)
    return usage_error("fit: --vary %s: a name stands there, perhaps with bounds, k=0:5", text);
  memcpy(q->name, text, length);
  if (equals != NULL) {
    char bound[64] = "";
    const char *colon = strchr(equals, ':');
    const size_t first = colon != NULL ? (size_t)(colon - equals - 1) : 0;
    if (colon != NULL && first < sizeof bound) memcpy(bound, equals + 1, first);
    if (colon == NULL || !parse_number(bound, &q->least) || !parse_number(colon + 1, &q->most) ||
        !(q->least < q->most))
      return usage_error("fit: --vary %s: bounds are two numbers, the smaller one first, k=0:5",
                         text);
  }
  const int code = find_quantity(v, q);
  if (code != DONE) return code;
  if (q->value >= q->least && q->value <= q->most) return DONE;
  return usage_error("fit: --vary %s: the scene's %g is not within the bounds; set another one by "
                     "--set",
                     text, q->value);
}

static int read_quantities(const fit_request *r, const varied *v, fit *f)
{
  for (int i = 0; i < r->vary.count; i++) {
    const int code = read_quantity(v, r->vary.word[i], &f->quantity[i]);
    if (code != DONE) return code;
    for (int k = 0; k < i; k++)
      if (f->quantity[k].index == f->quantity[i].index)
        return usage_error("fit: --vary %s is given twice", f->quantity[i].name);
  }
  f->n = v->n;
  f->count = r->vary.count;
  return DONE;
}

/* Keep the settings of parameters that are not varied. */
static void keep_settings(const fit_request *r, fit *f)
{
  for (int k = 0; k < r->settings.count; k++) {
    const char *word = r->settings.word[k];
    bool varies = false;
    for (int i = 0; i < f->count; i++) {
      const size_t length = strlen(f->quantity[i].name);
      varies |= strncmp(word, f->quantity[i].name, length) == 0 && word[length] == '=';
    }
    if (!varies) f->settings.word[f->settings.count++] = word;
  }
}

/* ---- the fit ---- */

static void write_results(const fit *f, FILE *stream)
{
  (void)fputs("name,value,standard_error\n", stream);
  for (int i = 0; i < f->count; i++) {
    csv_text(stream, f->quantity[i].name);
    (void)fprintf(stream, ",%.17g,", f->quantity[i].value);
    if (!isnan(f->quantity[i].error)) (void)fprintf(stream, "%.3g", f->quantity[i].error);
    (void)fputc('\n', stream);
  }
}

static int solve_and_write(const fit_request *r, fit *f)
{
  whole_file file = {0};
  int code = fit_solve(f);
  if (code != DONE) return code;
  (void)fprintf(stderr,
                "dvi: fit: %d numbers, %d varied; root mean square difference %.3g after "
                "%d iterations\n",
                fit_differences(f), f->count, sqrt(f->squares / fit_differences(f)), f->iterations);
  if (!file_open(&file, r->out)) return FAILED;
  write_results(f, file.stream);
  if (!file_keep(&file)) code = FAILED;
  file_discard(&file);
  return code;
}

static int fit_scene(const char *path, const fit_request *r)
{
  scene_text text = {0};
  varied v = {.scene = NULL};
  fit_data data = {0};
  fit_quantity quantity[WORDS_MAX];
  fit f = {.path = path, .method = r->method, .text = &text, .data = &data, .quantity = quantity};
  const named_file out = {.option = "out", .path = r->out};
  int code = scene_spared("fit", path, 1, &out);
  if (code == DONE) code = scene_load(path, &text);
  if (code == DONE) code = varied_open("fit", path, &text, &r->settings, r->method, &v);
  if (code == DONE) code = read_quantities(r, &v, &f);
  if (code == DONE) code = fit_data_read(r->to, v.scene, r->columns, &data);
  if (code == DONE) keep_settings(r, &f);
  if (code == DONE && f.settings.count + f.count > WORDS_MAX)
    code = usage_error("fit: more than %d settings and varied parameters", WORDS_MAX);
  if (code == DONE && fit_differences(&f) < f.count)
    code = usage_error("fit: %d numbers do not determine %d quantities", fit_differences(&f),
                       f.count);
  varied_close(&v);
  if (code == DONE) code = solve_and_write(r, &f);
  fit_data_clear(&data);
  free(text.text);
  return code;
}

static const char *const details[] = {
    "FILE.csv has a header with t and some coordinates and momenta, as dvi run writes it; "
    "--columns "
    "chooses among them. The\n"
    "run starts at t = 0, and takes equal steps of at most the scene's from each time of the file "
    "to the next. The sum of\n"
    "the squares of all differences is made least, each with the same weight.\n",
    "Columns: name, value, standard_error. The standard error is that of independent differences "
    "of one size; it is left\n"
    "out for a quantity at its bound, and where there are no more numbers than quantities.\n",
    "Examples:\n"
    "  dvi fit pendulum.yaml --to measured.csv --vary length=0.1:2 --vary friction\n"
    "  dvi fit pendulum.yaml --to measured.csv --columns theta --vary friction --vary theta\n",
    NULL,
};

static const option command_options[] = {
    {.name = "to",
     OPTION_AT(fit_request, to),
     .value = "FILE.csv",
     .help = "the measurements; -: standard input"},
    {.name = "vary",
     OPTION_AT(fit_request, vary),
     .value = "NAME[=LEAST:MOST]",
     .help = "a parameter, or a coordinate or momentum of the start; may be repeated"},
    {.name = "columns",
     OPTION_AT(fit_request, columns),
     .value = "A,B,...",
     .help = "columns of FILE.csv beside t; default: all"},
    {.name = "method",
     OPTION_AT(fit_request, method),
     .value = "SPEC",
     .help = "as for dvi gradient; default: the scene's"},
    {.name = "set",
     OPTION_AT(fit_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the scene, or where it begins; may be repeated"},
    {.name = "out",
     OPTION_AT(fit_request, out),
     .value = "FILE",
     .help = "where the rows go; left out, or -: standard output",
     .is_csv = true},
    {.name = NULL},
};

static const command_line command = {
    .name = "fit",
    .synopsis = "SCENE.yaml --to FILE.csv --vary NAME [OPTIONS]",
    .operand = "SCENE",
    .summary = "Fit parameters and the start of a run to measurements, by least squares.\n",
    .options = command_options,
    .details = details,
};

int fit_command(int argc, char **argv)
{
  fit_request r = {.out = "-"};
  const char *path;
  int code;
  if (!options_parse(&command, argc, argv, &r, &path, &code)) return code;
  if (!scene_is_path(path))
    return usage_error("fit: '%s' is no scene, and runs of scenes alone can be fitted", path);
  if (r.to == NULL) return usage_error("fit: --to is missing: the file of the measurements");
  if (r.vary.count == 0)
    return usage_error("fit: --vary is missing: what is to be found, as in --vary k=0:5");
  return fit_scene(path, &r);
}
