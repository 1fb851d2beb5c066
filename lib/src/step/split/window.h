/* The window in which the operations of temporal blocking work on a long chain. It holds some
 * coordinates of the five arrays that a step changes, and moves along the chain with the
 * operations. */
#ifndef DVI_STEP_SPLIT_WINDOW_H
#define DVI_STEP_SPLIT_WINDOW_H
#include <stddef.h>

#include "num/simd/lanes.h"

/* q, p, their compensations, and the gradient. */
enum { DVI__WINDOW_ARRAYS = 5 };

typedef struct dvi__window {
  double *to[DVI__WINDOW_ARRAYS]; /* the arrays of the new state */
  double *in[DVI__WINDOW_ARRAYS]; /* [length] each; NULL if the operations work in `to` itself */
  ptrdiff_t length;
  ptrdiff_t first, last; /* the window has coordinates first to last-1 */
  /* where the operations find coordinate 0, or would if the window reached that far */
  dvi__phase at;
  double *gradient;
} dvi__window;

/* Let the operations work in `to` itself. */
dvi__window dvi__window_none(const dvi__phase *to, double *gradient);

/* Let them work in `numbers`, five arrays of `length`, `stride` apart, from coordinate `first`
 * on. */
void dvi__window_open(dvi__window *window, double *numbers, ptrdiff_t stride, ptrdiff_t length,
                      ptrdiff_t first);

/* Move the window to `first`, at most to its last coordinate. The coordinates before are lost. The
 * last operation has written them to memory, but for the first `unfinished` ones, which are written
 * here. */
void dvi__window_slide(dvi__window *window, ptrdiff_t first, ptrdiff_t unfinished);

/* Take in coordinates from memory, `count` from `first` on, which is at most the window's last. */
void dvi__window_take(dvi__window *window, ptrdiff_t first, ptrdiff_t count);

#endif
