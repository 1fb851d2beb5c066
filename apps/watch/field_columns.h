/** The columns of a field's run. */
#ifndef FIELD_COLUMNS_H
#define FIELD_COLUMNS_H
#include <dvi/march.h>
#include <stdbool.h>

#include "problem.h"

/** A number that a row shows: an observable of the march, or an invariant of the scene's system. */
typedef struct field_column {
  const char *name;
  int observable; /**< its index, or -1 */
  int invariant;  /**< index among the system's, or -1 */
} field_column;

typedef struct field_columns {
  const problem *scene;
  const dvi_march *march;
  int there, count;
  field_column *all, *column; /**< [there], and the shown ones [count] */
  int *place;                 /**< [count] places of the shown ones that were asked for */
  double *number;             /**< [count] as measured */
  double *state;              /**< room for q and p, NULL if the march has none of the system */
} field_columns;

/** Choose the columns "A,B,.." if `asked` is not NULL, else those that the scene wants, else energy
 * and probes. Returns DONE, or complains and returns the exit code. Call field_columns_clear
 * afterwards in any case. */
int field_columns_choose(field_columns *columns, const problem *scene, const dvi_march *march,
                         const char *asked);
void field_columns_clear(field_columns *columns);

/** Evaluate the columns. Complains and returns false if one of them fails or is not finite. */
bool field_columns_measure(field_columns *columns);

/** Give the row [1 + count], as measured: the time and the shown columns. */
void field_columns_row(const field_columns *columns, double *row);
#endif
