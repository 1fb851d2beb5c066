/* dvi spectrum, which finds the spectral lines of columns of a CSV file. */
#include <dvi/spectrum.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "csv/series.h"
#include "csv/table.h"

/* The options. */
typedef struct spectrum_request {
  const char *columns, *band, *csv;
  double from, tolerance;
  long count;
} spectrum_request;

/* The series of a file, and their lines. */
typedef struct spectrum_study {
  const spectrum_request *request;
  const char *path;
  series_table table;
  int time, probes; /* index of the column t, and number of the others */
  int first, samples;
  double interval;
  double *series; /* [probes*samples] */
  int lines;
  dvi_spectral_line *line;   /* [count] */
  double *amplitude, *phase; /* [count*probes] */
  dvi_spectrum_report report;
} spectrum_study;

static void study_clear(spectrum_study *s)
{
  series_clear(&s->table);
  free(s->series);
  free(s->line);
  free(s->amplitude);
}

/* ---- the series ---- */

/* Read the columns that are asked for, or all, and the times. */
static int read_columns(spectrum_study *s)
{
  char name[FIELD_SIZE];
  const char *text = s->request->columns;
  while (text != NULL) {
    rows_field(&text, name);
    if (name[0] == '\0')
      return usage_error("spectrum: --columns wants names with commas between them, not '%s'",
                         s->request->columns);
    if (series_want(&s->table, name) < 0) return FAILED;
  }
  if (s->request->columns != NULL && series_want(&s->table, "t") < 0) return FAILED;
  s->table.of_run = true;
  int code = series_read("spectrum", s->path, &s->table);
  if (code != DONE) return code;
  s->time = -1;
  for (int k = 0; k < s->table.columns; k++)
    if (strcmp(s->table.column[k].name, "t") == 0) s->time = k;
  s->probes = s->table.columns - 1;
  if (s->time < 0) return usage_error("spectrum: '%s' has no column 't'", s->path);
  if (s->probes == 0) return usage_error("spectrum: '%s' has no column beside 't'", s->path);
  return DONE;
}

/* Return the first of `rows` times that is not where equal intervals put it, or -1. */
static int first_uneven(const double *t, int rows)
{
  const double interval = (t[rows - 1] - t[0]) / (rows - 1);
  for (int i = 0; i < rows; i++)
    if (!(interval > 0 && fabs(t[i] - t[0] - i * interval) <= 1e-6 * interval)) return i;
  return -1;
}

static int first_row_from(const double *t, int rows, double from)
{
  int i = 0;
  while (i < rows && !(t[i] >= from)) i++;
  return i;
}

/* Find the rows from the asked time on. A run may end between two rows of equal intervals, and its
 * last row is then left out. */
static int choose_rows(spectrum_study *s)
{
  const double *t = s->table.column[s->time].value;
  const double from = s->request->from;
  s->first = isnan(from) ? 0 : first_row_from(t, s->table.rows, from);
  s->samples = s->table.rows - s->first;
  t += s->first;
  if (s->samples < 3)
    return usage_error("spectrum: '%s' has %d row%s%s: too few for a spectrum", s->path, s->samples,
                       s->samples == 1 ? "" : "s", isnan(from) ? "" : " from there on");
  if (first_uneven(t, s->samples) >= 0 && first_uneven(t, s->samples - 1) < 0) s->samples--;
  s->interval = (t[s->samples - 1] - t[0]) / (s->samples - 1);
  if (first_uneven(t, s->samples) < 0) return DONE;
  double step = t[1] - t[0];
  int i = 2;
  while (i < s->samples && fabs(t[i] - t[i - 1] - step) <= 1e-6 * fabs(step)) i++;
  return usage_error("spectrum: the rows of '%s' are not equally spaced: from t = %g to %g, but "
                     "from %g to %g; let steps of one length make them",
                     s->path, t[0], t[1], t[i - 1 < s->samples ? i - 1 : 1],
                     t[i < s->samples ? i : 1]);
}

static int copy_series(spectrum_study *s)
{
  int p = 0;
  s->series = calloc((size_t)s->probes * (size_t)s->samples, sizeof *s->series);
  s->line = calloc((size_t)s->request->count, sizeof *s->line);
  s->amplitude = calloc((size_t)s->request->count * (size_t)s->probes, 2 * sizeof *s->amplitude);
  if (s->series == NULL || s->line == NULL || s->amplitude == NULL)
    return library_error(DVI_NO_MEMORY);
  s->phase = s->amplitude + (size_t)s->request->count * (size_t)s->probes;
  for (int k = 0; k < s->table.columns; k++) {
    const series_column *column = &s->table.column[k];
    if (k == s->time) continue;
    for (int i = 0; i < s->samples; i++) {
      const double value = column->value[s->first + i];
      if (isnan(value))
        return usage_error("spectrum: '%s': line %d has no number in column '%s'", s->path,
                           s->first + i + 2, column->name);
      s->series[(size_t)p * (size_t)s->samples + (size_t)i] = value;
    }
    p++;
  }
  return DONE;
}

/* ---- the band ---- */

static const double pi = 3.14159265358979323846;

/* Read "LO:HI", of which one may be left out. */
static int read_band(const char *text, dvi_spectrum_options *options)
{
  char low[FIELD_SIZE];
  const char *colon = text != NULL ? strchr(text, ':') : NULL;
  if (text == NULL) return DONE;
  if (colon != NULL && colon - text < FIELD_SIZE) {
    (void)snprintf(low, FIELD_SIZE, "%.*s", (int)(colon - text), text);
    const bool good_low = low[0] == '\0' || parse_number(low, &options->lowest),
               good_high = colon[1] == '\0' || parse_number(colon + 1, &options->highest);
    if (good_low && good_high && (colon[1] == '\0' || options->highest > options->lowest))
      return DONE;
  }
  return usage_error("spectrum: --band %s: two angular frequencies are wanted, as in 1:10", text);
}

static int find_lines(spectrum_study *s)
{
  dvi_spectrum_options options = {.size = sizeof options, .tolerance = s->request->tolerance};
  int code = read_band(s->request->band, &options);
  if (code == DONE) code = read_columns(s);
  if (code == DONE) code = choose_rows(s);
  if (code == DONE) code = copy_series(s);
  if (code != DONE) return code;
  const dvi_status status = dvi_spectrum(s->samples, s->probes, s->series, s->interval, &options,
                                         (int)s->request->count, &s->lines, s->line, s->amplitude,
                                         s->phase, &s->report);
  if (status == DVI_OK) return DONE;
  code = library_error(status);
  const double most = pi / s->interval;
  return options.lowest < 0 || fmax(options.lowest, options.highest) > most ? USAGE : code;
}

/* ---- the table ---- */

/* The columns of the table. Amplitudes and phases of each series are for CSV files only. */
typedef struct spectrum_titles {
  table_column *column;
  char (*name)[2 * FIELD_SIZE];
} spectrum_titles;

/* A decay is resolved if it is so many times its standard error. */
enum { TITLES = 6, RESOLVED = 3 };

static const char *probe_name(const spectrum_study *s, int p)
{
  return s->table.column[p < s->time ? p : p + 1].name;
}

static bool titles_create(const spectrum_study *s, spectrum_titles *titles)
{
  static const table_column shared[TITLES] = {{"index", "%.0f"},     {"omega", "%.12g"},
                                              {"decay", "%.6g"},     {"Q", "%.6g"},
                                              {"amplitude", "%.6g"}, {"error", "%.1e"}};
  const size_t probes = (size_t)s->probes;
  titles->column = calloc(TITLES + 2 * probes + 1, sizeof *titles->column);
  titles->name = calloc(2 * probes, sizeof *titles->name);
  if (titles->column == NULL || titles->name == NULL) return false;
  memcpy(titles->column, shared, sizeof shared);
  for (int i = 0; i < 2 * s->probes; i++) {
    (void)snprintf(titles->name[i], sizeof *titles->name, "%s_%s",
                   i % 2 == 0 ? "amplitude" : "phase", probe_name(s, i / 2));
    titles->column[TITLES + i] = (table_column){titles->name[i], ""};
  }
  return true;
}

/* Take away a decay that is not resolved, and Q with it. */
static dvi_spectral_line resolved(const dvi_spectral_line *line)
{
  dvi_spectral_line shown = *line;
  if (!(fabs(line->decay) > RESOLVED * line->error)) shown.decay = shown.quality = (double)NAN;
  return shown;
}

/* Fill the table for people, or with all numbers for a CSV file. */
static void fill_table(const spectrum_study *s, bool for_people, result_table *rows)
{
  for (int k = 0; k < s->lines; k++) {
    const dvi_spectral_line *line = &s->line[k];
    const dvi_spectral_line shown = for_people ? resolved(line) : *line;
    const double row[TITLES] = {k + 1,         line->frequency, shown.decay,
                                shown.quality, line->amplitude, line->error};
    for (int i = 0; i < TITLES; i++) table_number(rows, row[i]);
    for (int p = 0; p < s->probes; p++) {
      table_number(rows, s->amplitude[k * s->probes + p]);
      table_number(rows, s->phase[k * s->probes + p]);
    }
  }
}

static void print_heading(const spectrum_study *s, FILE *stream)
{
  const double *t = s->table.column[s->time].value + s->first;
  (void)fprintf(stream, "Spectrum of %s: %d samples from t = %g to %g", s->path, s->samples, t[0],
                t[s->samples - 1]);
  for (int p = 0; p < s->probes && p < 8; p++)
    (void)fprintf(stream, "%s %s", p == 0 ? " of" : ",", probe_name(s, p));
  (void)fprintf(stream, "%s\n", s->probes > 8 ? ", .." : "");
  (void)fprintf(stream, "%d line%s leave%s %.1e of the series%s\n", s->report.lines,
                s->report.lines == 1 ? "" : "s", s->report.lines == 1 ? "s" : "",
                s->report.residual, s->report.lines > s->lines ? "; the strongest are shown" : "");
  if (0.8 * s->report.room < s->report.exponentials)
    (void)fprintf(stream,
                  "the series is short for so many lines, whose errors may be larger than told; "
                  "take more samples, or more columns\n");
}

static int print_lines(const spectrum_study *s)
{
  const char *csv = s->request->csv;
  FILE *stream = csv != NULL && strcmp(csv, "-") == 0 ? stderr : stdout;
  spectrum_titles titles = {0};
  const bool titled = titles_create(s, &titles);
  result_table *shown = titled ? table_create(titles.column) : NULL,
               *rows = titled ? table_create(titles.column) : NULL;
  if (shown != NULL) fill_table(s, true, shown);
  if (rows != NULL) fill_table(s, false, rows);
  bool good = table_good(shown) && table_good(rows);
  if (good) {
    print_heading(s, stream);
    if (s->lines > 0) table_print(shown, stream, 0, 0, table_rows(shown));
    good = csv == NULL || table_write(rows, csv);
  }
  table_destroy(&shown);
  table_destroy(&rows);
  free(titles.column);
  free(titles.name);
  return good ? DONE : FAILED;
}

static const char *const details[] = {
    "A line is A exp(-decay t) cos(omega t + phase), t counted from the first row. All columns "
    "share the lines, and have amplitudes of their own. Rows have to be equally spaced in the "
    "column t.\n"
    "The frequencies are not those of a Fourier transform: without noise they are right to "
    "roundoff, with noise to the standard error in the last column.\n",
    "A decay, and Q, are printed where the decay is three times its standard error; --csv has them "
    "all.\n",
    "Columns of --csv: index, omega, decay, Q = omega/(2 decay), the largest amplitude of all "
    "columns, the standard error of omega and of the decay, then amplitude_NAME and phase_NAME of "
    "each column NAME.\n",
    "Examples:\n"
    "  dvi run fpu --method verlet --h 0.01 --t-end 60 --every 5 --columns q1,q2 --out fpu.csv\n"
    "  dvi spectrum fpu.csv --band 0.1:3\n"
    "  dvi spectrum fpu.csv --columns q1 --from 10 --csv -\n",
    NULL,
};

static const option command_options[] = {
    {.name = "columns",
     OPTION_AT(spectrum_request, columns),
     .value = "A,B,..",
     .help = "the columns; default: all but t"},
    {.name = "band",
     OPTION_AT(spectrum_request, band),
     .value = "LO:HI",
     .help = "angular frequencies; default: from 0 to the highest that the rows tell"},
    {.name = "from",
     OPTION_AT(spectrum_request, from),
     .value = "T",
     .help = "leave out the rows before this time"},
    {.name = "count",
     OPTION_AT(spectrum_request, count),
     .value = "K",
     .help = "the strongest K lines at most; default: 32"},
    {.name = "tolerance",
     OPTION_AT(spectrum_request, tolerance),
     .value = "X",
     .help = "the part of the series below which all is noise; default: 1e-10"},
    {.name = "csv",
     OPTION_AT(spectrum_request, csv),
     .value = "FILE",
     .help = "write the lines as CSV; - for standard output",
     .is_csv = true},
    {.name = NULL},
};

static const command_line command = {
    .name = "spectrum",
    .synopsis = "FILE.csv|FILE.h5 [OPTIONS]",
    .operand = "FILE.csv",
    .summary = "Find the frequencies, decay rates and amplitudes in columns of a file that dvi "
               "run has written; - is standard input.\n",
    .options = command_options,
    .details = details,
};

int spectrum_command(int argc, char **argv)
{
  spectrum_request r = {.count = 32, .from = (double)NAN};
  spectrum_study s = {.request = &r};
  int code;
  if (!options_parse(&command, argc, argv, &r, &s.path, &code)) return code;
  if (r.count > 100000) return usage_error("spectrum: --count %ld: 100000 at most", r.count);
  if (!(r.tolerance >= 0 && r.tolerance < 1))
    return usage_error("spectrum: --tolerance %g: a number below 1 is wanted", r.tolerance);
  code = find_lines(&s);
  if (code == DONE) code = print_lines(&s);
  study_clear(&s);
  return code;
}
