/** The columns of dvi run's table, all of them or those that were asked for. Quantities that no
 * column shows are not evaluated. */
#ifndef COLUMNS_H
#define COLUMNS_H
#include <stdbool.h>

#include "csv/reactions.h"
#include "problem.h"

enum { BALANCE_NAME_SIZE = 128 };

/** The quantity that a column shows. */
typedef enum column_kind {
  COLUMN_COORDINATE,
  COLUMN_VELOCITY, /**< only with factors */
  COLUMN_MOMENTUM,
  COLUMN_INVARIANT,
  COLUMN_BALANCE,  /**< defect of an invariant's balance, with forces */
  COLUMN_STEP,     /**< length of the last step, of methods that choose it */
  COLUMN_DISTANCE, /**< distance from the manifold, with factors */
  /** |p - alpha(q)| with a one-form, |phi(q,p)| of a constrained Hamiltonian, |phi(t,q)| */
  COLUMN_CONSTRAINT,
  COLUMN_GAP,         /**< smallest gap of all contacts */
  COLUMN_TEMPERATURE, /**< kinetic temperature, with noise */
  COLUMN_JUMP,        /**< jump, of methods whose trajectories jump */
  COLUMN_REACTION,    /**< multiplier of a holonomic constraint, shown only if it is asked for */
  COLUMN_FORCE,       /**< force of a contact that may be held, likewise */
  COLUMN_KINDS
} column_kind;

typedef struct shown_column {
  const char *name;
  column_kind kind;
  int index; /**< index in q, v, p, the invariants, the balances or the contacts */
} shown_column;

typedef struct run_columns {
  const problem *scene;
  int there, count; /**< number of columns of the run, and number of shown ones after t */
  shown_column *all, *column;
  int *place;        /**< [count] places of the shown ones that were asked for */
  double *invariant; /**< [invariants] the shown invariants, set by columns_measure */
  double *balance;   /**< [invariants] the shown defects of balances, set likewise */
  char (*balance_name)[BALANCE_NAME_SIZE]; /**< [invariants] */
  double *velocity;                        /**< [nv] with factors */
  double *room;                            /**< [nq + nv] with factors */
  double constraint, gap, temperature;
  double *reaction; /**< [rows] multipliers, set likewise, and the names of their columns */
  char (*reaction_name)[REACTION_NAME_SIZE];
  double *force; /**< [contacts] likewise */
  char (*force_name)[REACTION_NAME_SIZE];
  bool shows[COLUMN_KINDS];
} run_columns;

/** Choose the columns "A,B,.." if `asked` is not NULL, else those that the problem wants, else all.
 * Returns DONE, or complains, with the nearest name, and returns the exit code. Call columns_clear
 * afterwards in any case. */
int columns_choose(run_columns *columns, const problem *scene, const dvi_integrator *integrator,
                   const char *asked);

void columns_clear(run_columns *columns);

/** Evaluate the quantities of a row. Complains and returns false if one of them is not a finite
 * number. */
bool columns_measure(run_columns *columns, dvi_integrator *integrator);

/** Return the number of shown column k at the state, as measured. */
double columns_number(const run_columns *columns, const dvi_integrator *integrator, int k);

/** Give the row [1 + count] of the state, as measured: the time and the shown columns. */
void columns_row(const run_columns *columns, const dvi_integrator *integrator, double *row);
#endif
