/* The members of the struct of an ensemble, for ensemble.c, ensemble_create.c and ensemble_step.c.
 *
 * A member consists of the numbers of a checkpoint, which can be loaded into an integrator. Each
 * thread has an integrator, which takes the terms of the current block. If systems differ and the
 * method is bound to its system (dvi__stepper), each block has an integrator instead. A block holds
 * the numbers of neighbours side by side, number i of member k at [i*count + k]. */
#ifndef DVI_INTEGRATOR_ENSEMBLE_STRUCT_H
#define DVI_INTEGRATOR_ENSEMBLE_STRUCT_H
#include <dvi/ensemble.h>

#include "num/team.h"
#include "integrator/integrator_struct.h"

enum { DVI__FAILURE_SENTENCE = 900 };

/* Rows of a member's numbers. A step changes t, its compensation, q, p, their compensations [n] and
 * the method's memory. The driver's numbers follow. */
enum { DVI__MEMBER_T, DVI__MEMBER_T_COMPENSATION, DVI__MEMBER_Q };

typedef struct dvi__block {
  int first, count;           /* members */
  const dvi_system *system;   /* the system of all members */
  dvi_integrator *integrator; /* the block's integrator. NULL for the thread's */
  double *numbers;            /* [numbers of a member * count] */
} dvi__block;

/* The worst failure that a thread has met. */
typedef struct dvi__worst_failure {
  dvi_status status;
  int member;
  char sentence[DVI__FAILURE_SENTENCE];
} dvi__worst_failure;

/* The data of a thread. */
typedef struct dvi__worker {
  dvi_integrator *integrator; /* the thread's integrator, or that of the current block */
  /* system of the thread's integrator, which takes the terms of the current block. NULL unless
   * systems differ */
  dvi_system *scene;
  dvi__members members; /* a block's state */
  double *numbers;      /* the block's numbers before a step */
  long *ahead;          /* [capacity] steps of this call after a member's last steps alone */
  int *absence;         /* [capacity] number of a member's last steps alone */
  double *point[2];     /* [n] a start's q and p or v */
  long steps; /* steps of all members. The integrator's count is that of the current member */
  dvi__worst_failure worst;
  long failures;
} dvi__worker;

/* The steps that all blocks take in one call. */
typedef struct dvi__block_task {
  double h;
  long steps;
} dvi__block_task;

/* A start of all members. */
typedef struct dvi__start_task {
  double t;
  const double *q, *second; /* [n*members] q, and p or v */
  int by_velocity;          /* second is v */
  double *numbers;          /* the new states, until all members have started */
} dvi__start_task;

struct dvi_ensemble {
  int members, threads;
  int n;
  int system_is_general; /* the system declares a general Lagrangian */
  /* blocks have integrators of their own, because systems differ and steppers are bound to them */
  int bound;
  size_t state_numbers;  /* numbers of a member that a step changes */
  size_t member_numbers; /* all numbers of a member */
  int capacity;          /* most members of a block */
  dvi__block *blocks;
  int block_count;
  double *numbers; /* numbers of all blocks */
  dvi_status *status;
  dvi__team *team;
  dvi__worker *workers; /* [threads] */
  dvi_integrator **integrators;
  int integrator_count; /* number of threads or blocks. The first is that of member 0 */
  int started;
  long allocations;
  dvi__block_task task;
  dvi__start_task start_task;
};

/* Rows of the driver's numbers of a member, behind those that a step changes: the length of the
 * last step (0 before the first), the number of steps, and for general Lagrangians the last point
 * [n], or before the first step the start's velocity. */
enum { DVI__MEMBER_LAST_H, DVI__MEMBER_STEPS, DVI__MEMBER_LAST };

/* Return one number of all members of a block. dvi__driver_row counts the driver's numbers
 * alone. */
static inline double *dvi__row(const dvi__block *block, size_t number)
{
  return block->numbers + number * (size_t)block->count;
}

static inline double *dvi__driver_row(const dvi_ensemble *e, const dvi__block *block, size_t number)
{
  return dvi__row(block, e->state_numbers + number);
}

/* Load member k of a block into the worker's integrator, and store the integrator's numbers in the
 * block. */
void dvi__member_load(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block, int k);
void dvi__member_store(const dvi_ensemble *e, const dvi__worker *w, const dvi__block *block, int k);

/* Bind the worker's integrator to this block's system. */
void dvi__worker_bind(dvi__worker *w, const dvi__block *block);

/* Clear earlier failures. Record a failure with the thread's error sentence. Return the worst
 * failure of all workers as the status of the call. */
void dvi__ensemble_clear_failures(dvi_ensemble *e);
void dvi__worker_note(dvi__worker *w, int member, dvi_status status);
dvi_status dvi__ensemble_verdict(const dvi_ensemble *e);

#endif
