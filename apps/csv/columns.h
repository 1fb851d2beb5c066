/** The columns of dvi run's table: all that there are, or those that were asked for. What none of
 * them shows is not evaluated. */
#ifndef COLUMNS_H
#define COLUMNS_H
#include <stdbool.h>
#include <stdio.h>

#include "problem.h"

/** What a column shows. */
typedef enum column_kind {
  COLUMN_COORDINATE,
  COLUMN_VELOCITY, /**< with factors alone */
  COLUMN_MOMENTUM,
  COLUMN_INVARIANT,
  COLUMN_STEP,       /**< the length of the last one, of methods that choose it */
  COLUMN_DISTANCE,   /**< from the manifold, with factors */
  COLUMN_CONSTRAINT, /**< with a one-form |p - alpha(q)|, of a Hamiltonian |phi(q,p)| */
  COLUMN_JUMP,       /**< of methods whose trajectories jump */
  COLUMN_KINDS
} column_kind;

typedef struct shown_column {
  const char *name;
  column_kind kind;
  int index; /**< in q, v, p or the invariants */
} shown_column;

typedef struct run_columns {
  const problem *scene;
  int there, count; /**< how many columns the run has; how many are shown, behind t */
  shown_column *all, *column;
  bool *shown;       /**< [there] */
  double *invariant; /**< [invariants] those that are shown: set by columns_measure */
  double *velocity;  /**< [nv] with factors */
  double *room;      /**< [nq + nv] likewise */
  double constraint;
  bool shows[COLUMN_KINDS];
} run_columns;

/** Choose the columns: "A,B,.." if that is not NULL, else those that the problem wants, else all.
 *  Returns DONE, or complains, with the nearest name, and returns the exit code; columns_clear
 *  afterwards in any case. */
int columns_choose(run_columns *columns, const problem *scene, const dvi_integrator *integrator,
                   const char *asked);

void columns_clear(run_columns *columns);

void columns_header(const run_columns *columns, FILE *stream);

/** Fetch what must be evaluated for a row. False, with a complaint, if any of it is no number. */
bool columns_measure(run_columns *columns, dvi_integrator *integrator);

/** The number of shown column k at the state, as measured. */
double columns_number(const run_columns *columns, const dvi_integrator *integrator, int k);

/** Write the row of the state, as measured. */
void columns_row(const run_columns *columns, const dvi_integrator *integrator, FILE *stream);
#endif
