/* One run of one SUNDIALS code from a start to an end. */
#ifndef DVI_REFERENCE_RUN_H
#define DVI_REFERENCE_RUN_H
#include <dvi/reference.h>

#include "solve/sundials.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__reference_run {
  const dvi_system *system;
  dvi_reference_options options; /* all defaults filled in */
  double t, t_end;
  int n;                      /* size of v and p, and without factors of q */
  double *q;                  /* [nq] the start, after success the end */
  double *v;                  /* [n] as q, and the guess for the next inverse Legendre map */
  double *p;                  /* [n] as q */
  double *force;              /* [n] L_q at the start, or p' of a Hamiltonian. Not with factors */
  double *multiplier;         /* [m] multiplier of a Hamiltonian's constraints at the start */
  double *L_qq, *L_qv, *L_vv; /* Hessian in the order of the system's patterns */
  double *F_q, *F_v;          /* derivatives of forces likewise, NULL without forces */
  dvi__evaluator *evaluator;
  dvi_counters counters;
  SUNContext context;
  dvi_status callback; /* status of the last callback */
  double reached;      /* time that was reached */
  double began;        /* process time at the start, in seconds */
  long steps;
} dvi__reference_run;

/* Integrate by one code. The end is in run->q and run->p. run->reached and run->steps are set. */
dvi_status dvi__reference_ida(dvi__reference_run *run);
dvi_status dvi__reference_hamilton(dvi__reference_run *run);  /* IDA with a Hamiltonian */
dvi_status dvi__reference_holonomic(dvi__reference_run *run); /* IDA with phi(t,q) = 0 */
dvi_status dvi__reference_ida_lift(dvi__reference_run *run);  /* IDA with factors */
dvi_status dvi__reference_cvode(dvi__reference_run *run);
dvi_status dvi__reference_arkode(dvi__reference_run *run);

/* Evaluate the end's p from its q, for a one-form. */
dvi_status dvi__reference_form_momentum(dvi__reference_run *run);

/* Check the options (NULL for all defaults) and fill in the defaults. */
dvi_status dvi__reference_complete(const dvi_system *system, const dvi_reference_options *given,
                                   dvi_reference_options *options);

/* Return the least step, below which the codes give up. Otherwise they would go on with steps that
 * no longer move t. */
double dvi__reference_least_step(const dvi__reference_run *run);

/* Store a callback's status and translate it for SUNDIALS: 0 success, 1 try a smaller step, -1
 * stop. */
int dvi__reference_callback(dvi__reference_run *run, dvi_status status);

/* Translate a code's negative flag, by its number and its name (from malloc, freed here), into a
 * status and a sentence. */
dvi_status dvi__reference_stopped(const dvi__reference_run *run, int flag, char *flag_name);

/* Fail because a code could not be set up. */
dvi_status dvi__reference_no_setup(const dvi__reference_run *run);

/* Make a square matrix, dense if it is small, else in compressed columns of `entries` entries. NULL
 * if there is no memory. */
SUNMatrix dvi__reference_matrix(const dvi__reference_run *run, int size, int entries);

/* Make the direct solver for such a matrix. NULL if there is no memory. */
SUNLinearSolver dvi__reference_linear(const dvi__reference_run *run, N_Vector y, SUNMatrix matrix);

/* Test whether dvi__reference_matrix makes a dense matrix of this size. */
int dvi__reference_is_dense(int size);

/* A writer of a matrix, dense or compressed, column by column with ascending rows. */
typedef struct dvi__columns {
  SUNMatrix matrix;
  int column;
  sunindextype entry;
} dvi__columns;

void dvi__columns_start(dvi__columns *columns, SUNMatrix matrix);
void dvi__columns_next(dvi__columns *columns);
void dvi__columns_put(dvi__columns *columns, int row, double value);

#endif
