/* Whether the energy equation has a solution, and what to do if it has none.
 *
 * The test: the mismatch D(h) is followed along the rows' solutions, from the last step's length
 * outwards, to both bounds, in steps of a factor of sqrt(2), or to where the rows themselves have
 * no solution. A change of sign between neighbours brackets a root. Without one, a root can only
 * hide where D turns towards zero between them: where its slope says so, the turning point is
 * found, and the sign there decides. The root nearest to the last length counts. If there is none,
 * the length with the least D^2 is taken: a turning point, or a bound. */
#ifndef DVI_METHOD_ENERGY_SEARCH_H
#define DVI_METHOD_ENERGY_SEARCH_H
#include "method/element/bordered.h"

typedef struct dvi__energy_search {
  dvi__bordered *b;
  double *numbers;        /* of `state` */
  double *memory;         /* the element's, as it was before the step */
  dvi__state state;       /* where the last trial ends */
  const dvi__state *from; /* where all begin */
  double target;          /* E+ of the step before */
  dvi__mismatch best;     /* of all trials so far the one with the least |D| */
  int tried;
} dvi__energy_search;

dvi_status dvi__energy_search_create(dvi__bordered *b, dvi__energy_search *search);
void dvi__energy_search_clear(dvi__energy_search *search);

/* A step from this state begins. Until it is taken the state stays, and must. */
void dvi__energy_search_begin(dvi__energy_search *search, const dvi__state *state, double target);

/* A trial: an ordinary step of length h, and its mismatch; its path is the element's last one then.
 * Only with `sloping` its slope is computed. */
dvi_status dvi__energy_search_try(dvi__energy_search *search, double h, int sloping,
                                  dvi__mismatch *found);

/* Whether a mismatch is roundoff alone. */
int dvi__energy_solved(const dvi__mismatch *found);

/* The length by the test above, as the last trial; least and most bound |h|, `last` is the length
 * of the step before. */
dvi_status dvi__energy_search_find(dvi__energy_search *search, double last, double least,
                                   double most, dvi__mismatch *found);

/* The last trial is the step. */
void dvi__energy_search_take(const dvi__energy_search *search, dvi__state *state);

#endif
