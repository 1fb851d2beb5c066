/* What asynchronous steps store, and the passage of an edge from one of its events to the next. */
#ifndef DVI_FIELD_AVI_ENGINE_H
#define DVI_FIELD_AVI_ENGINE_H
#include "field/avi/avi.h"
#include "num/compensated.h"
#include "num/team.h"

/* Steps are at most 2^30 times the shortest one. */
enum { DVI__AVI_CLASSES = 31 };

/* The edges whose shortest face has a class: first those that pass freely, then, from `extra` on,
 * those with a damping or a current. The faces of this class end at `faces`. */
typedef struct dvi__avi_class {
  int64_t first, extra, end, faces;
  int64_t pushes; /* of currents at its edges */
} dvi__avi_class;

/* An edge with a damping or a current. */
typedef struct dvi__avi_extra {
  double damping;
  int push, pushes;         /* entries of `push` */
  double delivered, excess; /* integral of J + C E so far, and its compensation */
  double worked;            /* sum of the sizes of the currents' works so far */
} dvi__avi_extra;

/* The part of an edge in a current. */
typedef struct dvi__avi_push {
  int current;
  double profile;
} dvi__avi_push;

/* What an observation computed of edges, beside the state. */
typedef struct dvi__avi_view {
  double t;         /* NaN if nothing is valid */
  unsigned stamp;   /* of the values that are valid */
  unsigned *made;   /* [edges+faces] the stamps of the values */
  double *A, *D;    /* [edges] at t, D without what the faces owe it */
  double *B;        /* [faces] */
  double *worked;   /* [extras] works of currents since the last events */
  double *half;     /* [2*currents] */
  double *node_sum; /* [2*nodes] */
  unsigned summed;  /* the stamp of the sums: */
  double energy, growth;
} dvi__avi_view;

/* Edges and faces have numbers of their own: edges by their class, faces by their step, fixed edges
 * and faces without events last. A code is the number of a cell, or its complement if the sign is
 * negative. */
struct dvi__avi {
  int64_t edges, free_edges, faces, active_faces;
  int width;
  int *edge_number, *face_number; /* of the user's cells */
  int *edge_name, *face_name;     /* the user's cells */
  int *facet;                     /* [faces*width] codes */
  int64_t *coface_start;          /* [free_edges+1] */
  int *coface;                    /* codes of faces with events, ascending */
  double *M1, *inverse;           /* [edges], 0 for fixed ones */
  double *M2, *step, *kick;       /* [faces], kick = step M2 */
  int8_t *edge_class, *face_class;
  int classes;
  dvi__avi_class class[DVI__AVI_CLASSES];
  int *extra; /* [edges] place in `extras`, or -1. NULL if there are none */
  int64_t extra_count;
  dvi__avi_extra *extras;
  dvi__avi_push *push;
  dvi__avi_current *current;
  int currents;
  int64_t nodes;
  int node_width;
  int *node;         /* [edges*node_width] codes of nodes */
  int8_t *node_open; /* [nodes] not 0 for those with a fixed edge */
  double *charge;    /* [nodes] at the start */
  double shortest, longest, bound, band;
  int is_queued;
  dvi__team *team; /* NULL for a single thread */
  int threads;
  /* The state. */
  double *A, *D, *bias; /* B - dA at the start */
  double *impulse;      /* [faces] of the last event */
  double t0, t;
  int64_t slot; /* shortest steps since t0 */
  int64_t events, checks;
  double start_energy, allowed; /* the band, doubled after each alarm */
  double *clock;                /* [edges] of the queue: times of the last events */
  int64_t *count;               /* [faces] of the queue: events so far */
  double *next;                 /* [faces] of the queue: times of the next events */
  int *heap;                    /* [active_faces] the next event first */
  double *half; /* [2*currents] for each class, or for each edge of a face: integrals of signals */
  dvi__avi_view *view;
};

/* Integrate the signals over both halves of an interval between events, all of them, or those of an
 * edge with a damping or a current. `half` [2*currents] keeps its place for the others. */
dvi_status dvi__avi_signals(const dvi__avi *avi, double from, double to, double *half);
dvi_status dvi__avi_signals_at(const dvi__avi *avi, int64_t e, double from, double to,
                               double *half);

/* Begin again at a time, without events so far. */
void dvi__avi_rewind(dvi__avi *avi, double t);

/* Order the heap. */
void dvi__avi_order_events(dvi__avi *avi);

/* Let the events up to a time happen, by classes or from the queue. */
dvi_status dvi__avi_run_slots(dvi__avi *avi, double limit);
dvi_status dvi__avi_run_queue(dvi__avi *avi, double limit);

/* Give the number behind a code. */
static inline int dvi__avi_number(int code)
{
  return code < 0 ? ~code : code;
}

/* Give B on a face. */
static inline double dvi__avi_field(const dvi__avi *avi, int64_t face, const double *A)
{
  const int *code = avi->facet + face * avi->width;
  double sum = avi->bias[face];
  for (int c = 0; c < avi->width; c++) sum += code[c] < 0 ? -A[~code[c]] : A[code[c]];
  return sum;
}

/* The time of a slot. */
static inline double dvi__avi_slot_time(const dvi__avi *avi, int64_t slot)
{
  return avi->t0 + (double)slot * avi->shortest;
}

/* What an edge is after a passage. */
typedef struct dvi__avi_passage {
  double A, D, delivered, worked;
} dvi__avi_passage;

/* Give what an edge with a damping or a current is after a passage of length `span`. */
dvi__avi_passage dvi__avi_passage_of(const dvi__avi *avi, int64_t e, double span,
                                     const double *half);

/* Give the time for which a face still owes its force to an edge, below 0 if it has paid more, at
 * a time `since` after the face's last event. */
double dvi__avi_owed_time(const dvi__avi *avi, int64_t e, int64_t f, double since);

static inline void dvi__avi_pass_extra(dvi__avi *avi, int64_t e, double span, const double *half)
{
  dvi__avi_extra *extra = avi->extras + avi->extra[e];
  const dvi__avi_passage passage = dvi__avi_passage_of(avi, e, span, half);
  avi->A[e] = passage.A;
  avi->D[e] = passage.D;
  dvi__add_compensated(&extra->delivered, &extra->excess, passage.delivered);
  extra->worked += passage.worked;
}

static inline void dvi__avi_pass(dvi__avi *avi, int64_t e, double span)
{
  avi->A[e] -= avi->D[e] * avi->inverse[e] * span;
}

#endif
