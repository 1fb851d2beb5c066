/** What can be shown of fields with a density at points of space. */
#ifndef QUANTITY_H
#define QUANTITY_H
#include <dvi/density.h>
#include <stdbool.h>

#include "problem.h"

enum { QUANTITIES_MAX = 3 * DVI_COMPONENTS_MAX, QUANTITY_NAME = 80 };

typedef enum quantity_kind {
  QUANTITY_VALUE,  /**< of a component: "u", "psi_re" */
  QUANTITY_SQUARE, /**< of a complex field's modulus: "|psi|^2" */
  QUANTITY_PHASE,  /**< of a complex field, from -pi to pi: "phase(psi)" */
  QUANTITY_RATE    /**< of a component: "u'" */
} quantity_kind;

typedef struct quantity {
  char name[QUANTITY_NAME];
  quantity_kind kind;
  int component;           /**< of a complex field the first one */
  int order[DVI_AXES_MAX]; /**< derivatives along each axis, of a component or its rate */
} quantity;

/** The fields as coefficients [components*functions], and their rates, which may be NULL if no rate
 * is shown. */
typedef struct quantity_state {
  const double *U, *rate;
} quantity_state;

/** List what a scene's fields can show, field by field, values and squares first. Fields of first
 * order have no rates. Returns the number. */
int quantities_of(const problem *scene, quantity list[QUANTITIES_MAX]);

/** Return whether a quantity is written to files: values and squares are. */
bool quantity_is_usual(const quantity *shown);

/** Find a quantity by its name, also a derivative in space of a component or a rate, as "d(u,x)" or
 * "d(u',x,x)". Without a name it is that of the first field, of a complex one |psi|^2.
 * Returns DONE, or complains about `option` and returns the exit code. */
int quantity_choose(const problem *scene, const char *option, const char *name, quantity *chosen);

/** Evaluate a quantity at points x [dimension*count], axis by axis. Returns DONE, or complains and
 * returns the exit code. */
int quantity_evaluate(const quantity *shown, const dvi_space *space, quantity_state at,
                      int64_t count, const double *x, double *value);
#endif
