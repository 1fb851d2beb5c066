#include "record/recording.h"

#include <limits.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { FIRST_EVENTS = 16 };

static int part_index(dvi_record_part part)
{
  int k = 0;
  while (k < DVI__PARTS && 1u << k != (unsigned)part) k++;
  return k;
}

static int part_width(const dvi_system *system, dvi__row_part part)
{
  switch (part) {
  case DVI__ROW_Q: return dvi_system_nq(system);
  case DVI__ROW_P:
  case DVI__ROW_V: return dvi_system_nv(system);
  case DVI__ROW_INVARIANTS: return dvi_system_invariant_count(system);
  case DVI__ROW_REACTIONS: return dvi_system_constraint_count(system);
  default: return 1;
  }
}

int dvi__row_width(const dvi_system *system, unsigned parts)
{
  int width = 0;
  for (int k = 0; k < DVI__PARTS; k++)
    if ((parts >> k & 1) != 0) width += part_width(system, (dvi__row_part)k);
  return width;
}

/* ---- arrays that grow ---- */

/* Move `used` numbers to an array of `wanted`. The old one stays on failure. */
static dvi_status grow(double **number, int64_t used, int64_t wanted)
{
  double *larger = DVI_NEW(double, wanted);
  if (larger == NULL)
    return dvi__fail(DVI_NO_MEMORY, "record: no memory for %lld numbers", (long long)wanted);
  if (used > 0) memcpy(larger, *number, (size_t)used * sizeof *larger);
  dvi__release(*number);
  *number = larger;
  return DVI_OK;
}

/* Make room for `room` rows. What has grown before a failure has more room than is told. */
static dvi_status reserve_rows(dvi_recording *r, int64_t room)
{
  for (int k = 0; k < DVI__PARTS; k++) {
    dvi__part_rows *part = &r->part[k];
    if (part->width > 0) DVI_TRY(grow(&part->number, r->rows * part->width, room * part->width));
  }
  r->room = room;
  return DVI_OK;
}

dvi_status dvi__recording_open_rows(dvi_recording *r, int more)
{
  return r->rows + more <= r->room ? DVI_OK : reserve_rows(r, 2 * r->room + more);
}

static dvi_status reserve_events(dvi_recording *r)
{
  const int64_t room = r->event_room > 0 ? 2 * r->event_room : FIRST_EVENTS, width = r->nq + r->nv;
  dvi_recorded_event *event = DVI_NEW(dvi_recorded_event, room);
  const dvi_status status = event != NULL
                                ? grow(&r->event_point, r->events * width, room * width)
                                : dvi__fail(DVI_NO_MEMORY, "record: no memory for %lld events",
                                            (long long)room);
  if (status != DVI_OK) {
    dvi__release(event);
    return status;
  }
  if (r->events > 0) memcpy(event, r->event, (size_t)r->events * sizeof *event);
  dvi__release(r->event);
  r->event = event;
  r->event_room = room;
  for (int64_t i = 0; i < r->events; i++) {
    event[i].q = r->event_point + i * width;
    event[i].v = event[i].q + r->nq;
  }
  return DVI_OK;
}

dvi_status dvi__recording_add_event(dvi_recording *r, int event, double t, const double *q,
                                    const double *v)
{
  if (r->events == r->event_room) DVI_TRY(reserve_events(r));
  double *point = r->event_point + r->events * (r->nq + r->nv);
  memcpy(point, q, (size_t)r->nq * sizeof *q);
  memcpy(point + r->nq, v, (size_t)r->nv * sizeof *v);
  r->event[r->events++] = (dvi_recorded_event){
      .t = t, .event = event, .q = point, .v = point + r->nq};
  return DVI_OK;
}

/* ---- the recording ---- */

dvi_status dvi__recording_allocate(const int width[DVI__PARTS], int64_t rows,
                                   dvi_recording **recording)
{
  dvi_recording *r = DVI_NEW(dvi_recording, 1);
  if (r == NULL) return dvi__fail(DVI_NO_MEMORY, "record: no memory for a recording");
  for (int k = 0; k < DVI__PARTS; k++) r->part[k].width = width[k];
  const dvi_status status = reserve_rows(r, rows);
  if (status == DVI_OK)
    *recording = r;
  else
    dvi_recording_destroy(&r);
  return status;
}

dvi_status dvi__recording_create(const dvi_system *system, unsigned parts, int64_t rows,
                                 dvi_recording **recording)
{
  int width[DVI__PARTS];
  for (int k = 0; k < DVI__PARTS; k++)
    width[k] = (parts >> k & 1) != 0 ? part_width(system, (dvi__row_part)k) : 0;
  DVI_TRY(dvi__recording_allocate(width, rows, recording));
  (*recording)->system = system;
  (*recording)->nq = dvi_system_nq(system);
  (*recording)->nv = dvi_system_nv(system);
  return DVI_OK;
}

void dvi_recording_destroy(dvi_recording **recording)
{
  if (recording == NULL || *recording == NULL) return;
  for (int k = 0; k < DVI__PARTS; k++) dvi__release((*recording)->part[k].number);
  dvi__release((*recording)->event);
  dvi__release((*recording)->event_point);
  dvi__release(*recording);
  *recording = NULL;
}

int64_t dvi_recording_rows(const dvi_recording *r)
{
  return r != NULL ? r->rows : 0;
}

const double *dvi_recording_part(const dvi_recording *r, dvi_record_part part, int *width)
{
  const int k = r != NULL ? part_index(part) : DVI__PARTS;
  const int there = k < DVI__PARTS && r->part[k].number != NULL;
  if (width != NULL) *width = there ? r->part[k].width : 0;
  return there ? r->part[k].number : NULL;
}

const dvi_recorded_event *dvi_recording_event(const dvi_recording *r, int64_t i)
{
  return r != NULL && i >= 0 && i < r->events ? &r->event[i] : NULL;
}

const dvi_run_report *dvi_recording_report(const dvi_recording *r)
{
  return r != NULL ? &r->report : NULL;
}
