/* Search for a solution of the energy equation, and a substitute if there is none.
 *
 * The mismatch D(h) is followed along the rows' solutions, from the last step's length outwards, to
 * both bounds, in steps of a factor of sqrt(2), or to where the rows themselves have no solution. A
 * change of sign between neighbours brackets a root. Without one, a root can only hide where D
 * turns towards zero between them. Where its slope says so, the turning point is found, and the
 * sign there decides. The root nearest to the last length counts. If there is none, the length with
 * the least D^2 is taken, which is a turning point or a bound. */
#ifndef DVI_METHOD_ELEMENT_ENERGY_SEARCH_H
#define DVI_METHOD_ELEMENT_ENERGY_SEARCH_H
#include "method/element/bordered.h"

typedef struct dvi__energy_search {
  dvi__bordered *b;
  double *numbers;        /* numbers of `state` */
  double *memory;         /* the element's memory before the step */
  dvi__state state;       /* end of the last trial */
  const dvi__state *from; /* start of all trials */
  double target;          /* E+ of the step before */
  dvi__mismatch best;     /* trial with the least |D| so far */
  int tried;
} dvi__energy_search;

dvi_status dvi__energy_search_create(dvi__bordered *b, dvi__energy_search *search);
void dvi__energy_search_clear(dvi__energy_search *search);

/* Begin a step from this state, which must stay as it is until the step is taken. */
void dvi__energy_search_begin(dvi__energy_search *search, const dvi__state *state, double target);

/* Try an ordinary step of length h, and find its mismatch. Its path is the element's last one then.
 * The slope is computed with `sloping` only. */
dvi_status dvi__energy_search_try(dvi__energy_search *search, double h, int sloping,
                                  dvi__mismatch *found);

/* Tell whether a mismatch is roundoff alone. */
int dvi__energy_solved(const dvi__mismatch *found);

/* Find the length by the search above, as the last trial. least and most bound |h|, `last` is the
 * length of the step before. */
dvi_status dvi__energy_search_find(dvi__energy_search *search, double last, double least,
                                   double most, dvi__mismatch *found);

/* Take the last trial as the step. */
void dvi__energy_search_take(const dvi__energy_search *search, dvi__state *state);

#endif
