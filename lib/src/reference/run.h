/* One run of one SUNDIALS code from a start to an end. */
#ifndef DVI_REFERENCE_RUN_H
#define DVI_REFERENCE_RUN_H
#include <dvi/reference.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

#include "solve/sundials_compat.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__reference_run {
  const dvi_system *system;
  dvi_reference_options options; /* complete: no zeros */
  double t, t_end;
  int n; /* numbers of v and p, and without factors of q */
  double *q, *v,
      /* q [nq], v and p [n]: the start; the end after success. v is also the guess for the next
       * inverse Legendre map */
      *p;
  double *force;              /* [n] L_q at the start; with a Hamiltonian p'; not with factors */
  double *multiplier;         /* [m] with a Hamiltonian: its constraints', at the start */
  double *L_qq, *L_qv, *L_vv; /* in the order of the system's patterns */
  dvi__evaluator *evaluator;
  dvi_counters counters;
  SUNContext context;
  dvi_status callback; /* status of the last callback */
  double reached;      /* time */
  double began;        /* process time, in seconds */
  long steps;
} dvi__reference_run;

/* The codes. They leave the end in run->q and run->p, and what they did in run->reached and
 * run->steps. */
dvi_status dvi__reference_ida(dvi__reference_run *run);
dvi_status dvi__reference_hamilton(dvi__reference_run *run); /* IDA with a Hamiltonian */
dvi_status dvi__reference_ida_lift(dvi__reference_run *run); /* of systems with factors */
dvi_status dvi__reference_cvode(dvi__reference_run *run);
dvi_status dvi__reference_arkode(dvi__reference_run *run);

/* With a one-form: the end's p from its q. */
dvi_status dvi__reference_form_momentum(dvi__reference_run *run);

/* Check the options (NULL: all defaults) and fill in what is left out. */
dvi_status dvi__reference_complete(const dvi_system *system, const dvi_reference_options *given,
                                   dvi_reference_options *options);

/* The codes would go on with steps that no longer move t; below this they give up. */
double dvi__reference_least_step(const dvi__reference_run *run);

/* Remember a callback's status and say it in SUNDIALS' way: 0 success, 1 try a smaller step, -1
 * stop. */
int dvi__reference_callback(dvi__reference_run *run, dvi_status status);

/* Turn a code's negative flag, by its number and its name (from malloc, freed here), into a status
 * and a sentence. */
dvi_status dvi__reference_stopped(const dvi__reference_run *run, int flag, char *flag_name);

/* The status for a code that could not be set up. */
dvi_status dvi__reference_no_setup(const dvi__reference_run *run);

/* A square matrix: dense if it is small, compressed columns with room for `entries` if not; NULL if
 * there is no memory. */
SUNMatrix dvi__reference_matrix(const dvi__reference_run *run, int size, int entries);

/* The direct solver for such a matrix; NULL if there is no memory. */
SUNLinearSolver dvi__reference_linear(const dvi__reference_run *run, N_Vector y, SUNMatrix matrix);

/* Whether dvi__reference_matrix makes a dense matrix of this size. */
int dvi__reference_is_dense(int size);

/* Writes a matrix column by column, rows ascending, dense or compressed. */
typedef struct dvi__columns {
  SUNMatrix matrix;
  int column;
  sunindextype entry;
} dvi__columns;

void dvi__columns_start(dvi__columns *columns, SUNMatrix matrix);
void dvi__columns_next(dvi__columns *columns);
void dvi__columns_put(dvi__columns *columns, int row, double value);

#endif
