/* The arrays of a recording, which grow row by row and event by event. */
#ifndef DVI_RECORD_RECORDING_H
#define DVI_RECORD_RECORDING_H
#include <dvi/run.h>

enum { DVI__PARTS = 8 };

/* The numbers of one part. */
typedef struct dvi__part_rows {
  double *number; /* [room*width], NULL if the part is not kept */
  int width;
} dvi__part_rows;

struct dvi_recording {
  dvi__part_rows part[DVI__PARTS]; /* part k has the bit 1 << k */
  int64_t rows, room;
  dvi_recorded_event *event; /* [event_room], whose q and v are set by dvi_recording_event */
  double *event_point;       /* [event_room*(nq+nv)] */
  int64_t events, event_room;
  int nq, nv;
  dvi_run_report report;
};

/* Make a recording without rows for parts of a system, with room for some rows. */
dvi_status dvi__recording_create(const dvi_system *system, unsigned parts, int64_t rows,
                                 dvi_recording **recording);

/* Make room for one more row. The row is `rows`, until the caller counts it. */
dvi_status dvi__recording_open_row(dvi_recording *recording);

/* Return the numbers of a part in the row that is open, or NULL if the part is not kept. */
double *dvi__recording_row(const dvi_recording *recording, dvi_record_part part);

/* Keep an event. */
dvi_status dvi__recording_add_event(dvi_recording *recording, int event, double t, const double *q,
                                    const double *v);

#endif
