/* Events by classes. A slot is one of the shortest steps, and in slot n all faces act whose class j
 * divides it, 2^j | n. They are the first ones, and so are their edges. Each edge is written by one
 * thread, which adds the pushes of the faces in their order, so that the bits are those of the
 * queue for any number of threads. */
#include <math.h>

#include "core/status.h"
#include "field/avi/engine.h"

/* Fewer cells than this are not worth a team. */
enum { CELLS_FOR_A_TEAM = 4000 };

typedef struct slot {
  dvi__avi *avi;
  int due; /* the largest class that acts */
  int members;
  double span[DVI__AVI_CLASSES];
} slot;

typedef struct range {
  int64_t from, to;
} range;

/* The part of a member of the numbers from `from` to `to`-1. */
static range portion(const slot *now, int member, int64_t from, int64_t to)
{
  const int64_t count = to - from;
  return (range){from + count * member / now->members, from + count * (member + 1) / now->members};
}

static void pass_edges(void *user, int member)
{
  const slot *now = user;
  dvi__avi *avi = now->avi;
  for (int c = 0; c <= now->due; c++) {
    const dvi__avi_class *class = avi->class + c;
    const range plain = portion(now, member, class->first, class->extra),
                extra = portion(now, member, class->extra, class->end);
    const double *half = avi->half + 2 * (int64_t)avi->currents * c;
    for (int64_t e = plain.from; e < plain.to; e++) dvi__avi_pass(avi, e, now->span[c]);
    for (int64_t e = extra.from; e < extra.to; e++) dvi__avi_pass_extra(avi, e, now->span[c], half);
  }
}

static void act_faces(void *user, int member)
{
  const slot *now = user;
  dvi__avi *avi = now->avi;
  const range part = portion(now, member, 0, avi->class[now->due].faces);
  for (int64_t f = part.from; f < part.to; f++)
    avi->impulse[f] = avi->kick[f] * dvi__avi_field(avi, f, avi->A);
}

static void kick_edges(void *user, int member)
{
  const slot *now = user;
  dvi__avi *avi = now->avi;
  const range part = portion(now, member, 0, avi->class[now->due].end);
  const int64_t due = avi->class[now->due].faces;
  for (int64_t e = part.from; e < part.to; e++) {
    double D = avi->D[e];
    for (int64_t i = avi->coface_start[e]; i < avi->coface_start[e + 1]; i++) {
      const int code = avi->coface[i], f = dvi__avi_number(code);
      if (f >= due) break;
      D += code < 0 ? -avi->impulse[f] : avi->impulse[f];
    }
    avi->D[e] = D;
  }
}

static int class_of_slot(const dvi__avi *avi, int64_t n)
{
  int j = 0;
  while (j < avi->classes - 1 && n % (INT64_C(2) << j) == 0) j++;
  return j;
}

/* The signals may fail, and are integrated before anything is changed. */
static dvi_status find_spans(const dvi__avi *avi, int64_t n, slot *now)
{
  const double t = dvi__avi_slot_time(avi, n);
  for (int c = 0; c <= now->due; c++) {
    const double last = dvi__avi_slot_time(avi, n - (INT64_C(1) << c));
    now->span[c] = t - last;
    if (avi->class[c].pushes > 0)
      DVI_TRY(dvi__avi_signals(avi, last, t, avi->half + 2 * (int64_t)avi->currents * c));
  }
  return DVI_OK;
}

static dvi_status run_slot(dvi__avi *avi, int64_t n)
{
  slot now = {.avi = avi, .due = class_of_slot(avi, n), .members = 1};
  void (*const work[])(void *, int) = {pass_edges, act_faces, kick_edges};
  DVI_TRY(find_spans(avi, n, &now));
  if (avi->class[now.due].end >= CELLS_FOR_A_TEAM) now.members = avi->threads;
  for (int i = 0; i < 3; i++)
    if (now.members > 1)
      dvi__team_run(avi->team, now.members, work[i], &now);
    else
      work[i](&now, 0);
  avi->slot = n;
  avi->events += avi->class[now.due].faces;
  return DVI_OK;
}

dvi_status dvi__avi_run_slots(dvi__avi *avi, double limit)
{
  for (;;) {
    const double next = dvi__avi_slot_time(avi, avi->slot + 1);
    if (!(next <= limit)) return DVI_OK;
    DVI_TRY(run_slot(avi, avi->slot + 1));
    avi->t = fmax(avi->t, next);
  }
}
