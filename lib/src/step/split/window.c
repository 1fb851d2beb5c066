#include "step/split/window.h"

#include <stdint.h>
#include <string.h>

static void set_arrays(dvi__window *w, double *const arrays[DVI__WINDOW_ARRAYS])
{
  w->at = (dvi__phase){
      .q = arrays[0], .p = arrays[1], .q_compensation = arrays[2], .p_compensation = arrays[3]};
  w->gradient = arrays[4];
}

dvi__window dvi__window_none(const dvi__phase *to, double *gradient)
{
  dvi__window w = {.to = {to->q, to->p, to->q_compensation, to->p_compensation, gradient}};
  set_arrays(&w, w.to);
  return w;
}

/* The operations use no address before the arrays themselves. */
static void place(dvi__window *w, ptrdiff_t first)
{
  double *origin[DVI__WINDOW_ARRAYS];
  for (int k = 0; k < DVI__WINDOW_ARRAYS; k++)
    origin[k] = (double *)((uintptr_t)w->in[k] - (uintptr_t)first * sizeof(double));
  w->first = first;
  set_arrays(w, origin);
}

void dvi__window_open(dvi__window *w, double *numbers, ptrdiff_t stride, ptrdiff_t length,
                      ptrdiff_t first)
{
  for (int k = 0; k < DVI__WINDOW_ARRAYS; k++) w->in[k] = numbers + k * stride;
  w->length = length;
  w->last = first;
  place(w, first);
}

/* Move numbers to the left. For these few thousand bytes memmove takes twice as long. */
static void move_left(double *to, const double *from, ptrdiff_t count)
{
  enum { LINE = 8 };
  ptrdiff_t i = 0;
  for (; i + LINE <= count; i += LINE) {
    double line[LINE];
    memcpy(line, from + i, sizeof line);
    memcpy(to + i, line, sizeof line);
  }
  for (; i < count; i++) to[i] = from[i];
}

void dvi__window_slide(dvi__window *w, ptrdiff_t first, ptrdiff_t unfinished)
{
  const ptrdiff_t done = first - w->first, kept = w->last - first;
  if (w->in[0] == NULL || done <= 0) return;
  for (int k = 0; k < DVI__WINDOW_ARRAYS; k++) {
    memcpy(w->to[k] + w->first, w->in[k], (size_t)unfinished * sizeof(double));
    move_left(w->in[k], w->in[k] + done, kept);
  }
  place(w, first);
}

void dvi__window_take(dvi__window *w, ptrdiff_t first, ptrdiff_t count)
{
  if (w->in[0] == NULL) return;
  for (int k = 0; k < DVI__WINDOW_ARRAYS; k++)
    memcpy(w->in[k] + (first - w->first), w->to[k] + first, (size_t)count * sizeof(double));
  w->last = first + count;
}
