/* The arrays of a recording, which grow row by row and event by event. */
#ifndef DVI_RECORD_RECORDING_H
#define DVI_RECORD_RECORDING_H
#include <dvi/run.h>

#include "system/evaluate/evaluator.h"

/* The parts of a row, of which part k has the bit 1 << k in dvi_record_part. */
typedef enum dvi__row_part {
  DVI__ROW_T,
  DVI__ROW_Q,
  DVI__ROW_P,
  DVI__ROW_V,
  DVI__ROW_INVARIANTS,
  DVI__ROW_STEP,
  DVI__ROW_CONSTRAINT,
  DVI__ROW_REACTIONS,
  DVI__ROW_A, /* from here on those of a march */
  DVI__ROW_E,
  DVI__ROW_B,
  DVI__ROW_OBSERVABLES,
  DVI__PARTS
} dvi__row_part;

/* The numbers of one part. */
typedef struct dvi__part_rows {
  double *number; /* [room*width], NULL if the part is not kept */
  int width;
} dvi__part_rows;

struct dvi_recording {
  dvi__part_rows part[DVI__PARTS];
  int64_t rows, room;
  dvi_recorded_event *event; /* [event_room], whose q and v are set by dvi_recording_event */
  double *event_point;       /* [event_room*(nq+nv)] */
  int64_t events, event_room;
  const dvi_system *system; /* NULL for a march */
  int nq, nv;
  dvi_run_report report;
};

/* Count the numbers of a row with these parts. */
int dvi__row_width(const dvi_system *system, unsigned parts);

/* More numbers than these are not reserved for a run whose rows are known. Others begin with room
 * for these rows. */
#define DVI__MOST_RESERVED 1e8
enum { DVI__FIRST_ROWS = 256 };

/* Make a recording without rows, with room for some, for parts with these numbers of a row, 0 of a
 * part that is not kept. */
dvi_status dvi__recording_allocate(const int width[DVI__PARTS], int64_t rows,
                                   dvi_recording **recording);

/* Make the recording of an integrator of a system. */
dvi_status dvi__recording_create(const dvi_system *system, unsigned parts, int64_t rows,
                                 dvi_recording **recording);

/* Make room for more rows. The first is `rows`, until the caller counts it. */
dvi_status dvi__recording_open_rows(dvi_recording *recording, int more);

/* Return the numbers of a part in the first row that is open, or NULL if the part is not kept. */
static inline double *dvi__recording_row(const dvi_recording *recording, dvi__row_part part)
{
  const dvi__part_rows *rows = &recording->part[part];
  return rows->number != NULL ? rows->number + recording->rows * rows->width : NULL;
}

/* Evaluate the velocity v [nv], from a guess, and invariants unless they are NULL, of a row that
 * has coordinates and momenta. */
dvi_status dvi__recording_derive_row(const dvi_recording *recording, int64_t row,
                                     dvi__evaluator *evaluator, double *v, double *invariants);

/* Keep an event. */
dvi_status dvi__recording_add_event(dvi_recording *recording, int event, double t, const double *q,
                                    const double *v);

#endif
