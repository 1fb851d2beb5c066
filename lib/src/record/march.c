/* Recordings of marches. Between rows a march advances as it would without them. */
#include <dvi/march.h>

#include <limits.h>
#include <math.h>
#include <stdio.h>

#include "core/memory.h"
#include "core/status.h"
#include "march/kind.h"
#include "record/recording.h"

enum { FORMS = 3, CANCEL_STEPS = 32 };
/* Doubles count at most this many rows. */
static const double rows_max = 0x1p53;
/* The last interval between rows may be longer by this part of it. */
static const double stretch = 1e-9;

static const char *const form_name[FORMS] = {"A", "E", "B"};

typedef struct march_record {
  dvi_march *march;
  const dvi_march_record_options *options;
  dvi_recording *recording;
  unsigned parts;
  double start;
  int64_t rows; /* rows that are wanted */
  int width[DVI__PARTS];
} march_record;

/* ---- what is asked for ---- */

static dvi_status check_times(const march_record *r)
{
  const dvi_march_record_options *o = r->options;
  if (o->time_count < 0 || (o->time_count > 0) != (o->times != NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "record: %lld times, and their list is %s",
                     (long long)o->time_count, o->times != NULL ? "given" : "NULL");
  if (!isfinite(o->t_end) || o->t_end < r->start)
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "record: t_end = %.17g; a time at or after that of the march, %.17g, is needed", o->t_end,
        r->start);
  if (!(isfinite(o->every) && o->every >= 0) || (o->every > 0 && o->times != NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "record: every = %g%s; 0 or more is possible without times",
                     o->every, o->times != NULL ? ", and times are given" : "");
  for (int64_t k = 0; k < o->time_count; k++) {
    const double before = k > 0 ? o->times[k - 1] : r->start;
    if (!isfinite(o->times[k]) || o->times[k] < before || o->times[k] > o->t_end)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "record: time %lld is %.17g; times must go on from %.17g to %.17g",
                       (long long)k, o->times[k], before, o->t_end);
  }
  return DVI_OK;
}

static dvi_status count_rows(march_record *r)
{
  const dvi_march_record_options *o = r->options;
  const double way = o->t_end - r->start,
               intervals = o->every > 0 ? ceil(way / o->every * (1 - stretch)) : way > 0;
  if (!(intervals < rows_max))
    return dvi__fail(
        DVI_BAD_SIZE,
        "record: every = %g makes %.3g rows to t_end = %g; at most 2^53 can be counted", o->every,
        intervals + 1, o->t_end);
  r->rows = o->times != NULL ? o->time_count : (int64_t)intervals + 1;
  return DVI_OK;
}

static dvi_status set_width(march_record *r, dvi__row_part part, int64_t width)
{
  if (width > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE,
                     "record: %lld numbers of a part in a row; at most %d can be kept",
                     (long long)width, INT_MAX);
  r->width[part] = (int)width;
  return DVI_OK;
}

static dvi_status choose_cells(march_record *r, dvi_march_form form)
{
  const int64_t count = r->options->cell_count[form], size = dvi_march_size(r->march, form);
  const int *cell = r->options->cell[form];
  const char *name = form_name[form];
  const dvi__row_part part = (dvi__row_part)(DVI__ROW_A + (int)form);
  const int is_kept = (r->parts >> part & 1) != 0;
  if (count < 0 || (count > 0) != (cell != NULL) || (cell != NULL && !is_kept))
    return dvi__fail(DVI_BAD_ARGUMENT, "record: %lld cells of %s, whose list is %s%s",
                     (long long)count, name, cell != NULL ? "given" : "NULL",
                     is_kept ? "" : ", and it is not recorded");
  if (!is_kept) return DVI_OK;
  if (size == 0) return dvi__fail(DVI_UNSUPPORTED, "record: the march has no form %s", name);
  for (int64_t i = 0; i < count; i++)
    if (cell[i] < 0 || cell[i] >= size)
      return dvi__fail(DVI_BAD_ARGUMENT, "record: cell %d of %s is not from 0 to %lld", cell[i],
                       name, (long long)size - 1);
  return set_width(r, part, cell != NULL ? count : size);
}

static dvi_status choose_observables(march_record *r)
{
  const dvi_march_record_options *o = r->options;
  const int count = o->observable_count, is_kept = (r->parts & DVI_RECORD_OBSERVABLES) != 0;
  int all = 0;
  if (count < 0 || (count > 0) != (o->observable != NULL) || (o->observable != NULL && !is_kept))
    return dvi__fail(DVI_BAD_ARGUMENT, "record: %d observables, whose list is %s%s", count,
                     o->observable != NULL ? "given" : "NULL",
                     is_kept ? "" : ", and they are not recorded");
  while (dvi_march_observable(r->march, all) != NULL) all++;
  for (int i = 0; i < count; i++)
    if (o->observable[i] < 0 || o->observable[i] >= all)
      return dvi__fail(DVI_BAD_ARGUMENT, "record: observable %d is not from 0 to %d",
                       o->observable[i], all - 1);
  return is_kept ? set_width(r, DVI__ROW_OBSERVABLES, o->observable != NULL ? count : all) : DVI_OK;
}

static dvi_status choose_parts(march_record *r)
{
  const unsigned known = DVI_RECORD_T | DVI_RECORD_A | DVI_RECORD_E | DVI_RECORD_B |
                         DVI_RECORD_OBSERVABLES;
  r->parts = r->options->parts != 0 ? r->options->parts : DVI_RECORD_OBSERVABLES;
  if ((r->parts & ~known) != 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "record: parts = %#x has some that no march has; %#x are all", r->parts,
                     known);
  r->width[DVI__ROW_T] = 1;
  for (int form = 0; form < FORMS; form++) DVI_TRY(choose_cells(r, (dvi_march_form)form));
  return choose_observables(r);
}

static dvi_status make_recording(march_record *r)
{
  double width = 0;
  for (int k = 0; k < DVI__PARTS; k++) width += r->width[k];
  const int is_small = (double)r->rows * width <= DVI__MOST_RESERVED;
  DVI_TRY(dvi__recording_allocate(
      r->width, is_small || r->rows < DVI__FIRST_ROWS ? r->rows : DVI__FIRST_ROWS, &r->recording));
  r->recording->report = (dvi_run_report){.event_time = (double)NAN, .event = -1};
  return DVI_OK;
}

/* ---- rows ---- */

static dvi_status fill_form(const march_record *r, dvi_march_form form)
{
  double *row = dvi__recording_row(r->recording, (dvi__row_part)(DVI__ROW_A + (int)form));
  if (row == NULL) return DVI_OK;
  const dvi_status status = dvi_march_sample(r->march, form, r->options->cell_count[form],
                                             r->options->cell[form], row);
  return dvi__march_agree(r->march, status);
}

static dvi_status fill_row(const march_record *r)
{
  const int *chosen = r->options->observable;
  double *observed = dvi__recording_row(r->recording, DVI__ROW_OBSERVABLES);
  *dvi__recording_row(r->recording, DVI__ROW_T) = dvi_march_time(r->march);
  for (int form = 0; form < FORMS; form++) DVI_TRY(fill_form(r, (dvi_march_form)form));
  for (int i = 0; i < r->width[DVI__ROW_OBSERVABLES]; i++)
    DVI_TRY(dvi_march_observe(r->march, chosen != NULL ? chosen[i] : i, observed + i));
  return DVI_OK;
}

static dvi_status record_row(const march_record *r)
{
  dvi_status status = dvi__march_agree(r->march, dvi__recording_open_rows(r->recording, 1));
  if (status == DVI_OK) status = fill_row(r);
  if (status != DVI_OK)
    return dvi__fail_in(status, "record: no row at t = %.9g", dvi_march_time(r->march));
  r->recording->rows++;
  return DVI_OK;
}

/* ---- the run ---- */

static double row_time(const march_record *r, int64_t row)
{
  if (r->options->times != NULL) return r->options->times[row];
  return row < r->rows - 1 ? r->start + (double)row * r->options->every : r->options->t_end;
}

/* Tell whether the run is cancelled, on any of the processes that march together. */
static int is_stopped(const march_record *r)
{
  const volatile int *cancel = r->options->cancel;
  if (cancel == NULL) return 0;
  const dvi_status status = *cancel ? dvi__fail(DVI_BAD_STATE, "record: cancelled") : DVI_OK;
  return dvi__march_agree(r->march, status) != DVI_OK;
}

/* Advance to t, or until the run is cancelled. Only a run that can be is cut into pieces. */
static dvi_status advance(const march_record *r, double t)
{
  const volatile int *cancel = r->options->cancel;
  dvi_march_facts facts;
  dvi_march_facts_of(r->march, &facts);
  for (double now; (now = dvi_march_time(r->march)) < t;) {
    if (is_stopped(r)) {
      r->recording->report.end = DVI_RUN_CANCELLED;
      return DVI_OK;
    }
    const double next = now + CANCEL_STEPS * facts.longest;
    DVI_TRY(dvi_march_advance(r->march, cancel != NULL && next > now && next < t ? next : t));
  }
  return DVI_OK;
}

static int is_cancelled(const march_record *r)
{
  return r->recording->report.end == DVI_RUN_CANCELLED;
}

static dvi_status record_rows(const march_record *r)
{
  for (int64_t row = 0; row < r->rows; row++) {
    DVI_TRY(advance(r, row_time(r, row)));
    if (is_cancelled(r)) return r->options->times == NULL ? record_row(r) : DVI_OK;
    DVI_TRY(record_row(r));
  }
  return advance(r, r->options->t_end);
}

static dvi_status run_recorded(const march_record *r)
{
  dvi_run_report *report = &r->recording->report;
  dvi_march_facts before, after;
  dvi_march_facts_of(r->march, &before);
  const dvi_status status = record_rows(r);
  dvi_march_facts_of(r->march, &after);
  report->steps = (long)(after.steps - before.steps);
  if (status != DVI_OK) report->end = DVI_RUN_FAILED;
  return status;
}

static dvi_status check_march(const dvi_march *march, const dvi_march_record_options *options)
{
  if (march == NULL || options == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "record: a march and options are needed");
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "record: set options.size to sizeof(dvi_march_record_options)");
  if (!isnan(dvi_march_time(march))) return DVI_OK;
  return dvi__fail(DVI_BAD_STATE, "record: the march has not been started; call dvi_march_start "
                                  "first");
}

static dvi_status prepare(march_record *r)
{
  DVI_TRY(check_times(r));
  DVI_TRY(count_rows(r));
  DVI_TRY(choose_parts(r));
  return make_recording(r);
}

dvi_status dvi_march_record(dvi_march *march, const dvi_march_record_options *options,
                            dvi_recording **recording)
{
  if (recording == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "record: a place for the recording is needed");
  *recording = NULL;
  DVI_TRY(check_march(march, options));
  march_record r = {.march = march, .options = options, .start = dvi_march_time(march)};
  const dvi_status status = dvi__march_agree(march, prepare(&r));
  *recording = r.recording;
  if (status == DVI_OK && r.recording != NULL) return run_recorded(&r);
  dvi_recording_destroy(recording);
  return status;
}
