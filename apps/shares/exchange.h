/** What processes exchange in the steps of a march, as foreseen and as counted. */
#ifndef EXCHANGE_H
#define EXCHANGE_H
#include <dvi/march.h>

#include "module/ranks.h"
#include "problem.h"

typedef enum exchange_kind {
  EXCHANGE_FORM,     /**< leapfrog: the form of the field, once a step */
  EXCHANGE_PLACES,   /**< verlet: where nodes are, once a step */
  EXCHANGE_SLOTS,    /**< avi: the same, before some of the shortest steps */
  EXCHANGE_EVENTS,   /**< avi:classes=no: where nodes of single cells are */
  EXCHANGE_PLANES,   /**< yee: planes of E and B */
  EXCHANGE_SOLUTION, /**< implicit methods: unknowns, as often as a solution takes */
} exchange_kind;

/** What is exchanged at once. */
typedef struct exchange {
  exchange_kind kind;
  int degree; /**< of the form on the mesh */
  int times;  /**< that it is exchanged, once for each component or stage */
  int steps;  /**< for which it is enough */
} exchange;

/** Return that of a method, which share_check has let pass. */
exchange exchange_of(const problem *scene, const char *method);

/** Print what all processes exchange at once, `bytes` in `messages` together. `march` is NULL if
 * there is none. */
void exchange_tell(const exchange *what, const dvi_march *march, double bytes, double messages);

/** Count what the processes receive in the first steps of a march, and print it. `bytes` are those
 *  that are exchanged at once. Called by all of them. Returns DONE, or complains and returns the
 *  exit code. */
int exchange_count(const exchange *what, dvi_march *march, double bytes);
#endif
