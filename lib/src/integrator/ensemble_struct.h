/* The inside of an ensemble, for ensemble.c, ensemble_create.c and ensemble_step.c.
 *
 * A member is what a checkpoint of its integrator would hold: numbers that an integrator can be put
 * to. There is one for each thread, which takes the terms of the block at hand; or one for each
 * block, if systems differ and the method is bound to its own (dvi__stepper). A block holds the
 * numbers of neighbours side by side: number i of member k is [i*count + k]. */
#ifndef DVI_METHOD_ENSEMBLE_STRUCT_H
#define DVI_METHOD_ENSEMBLE_STRUCT_H
#include <dvi/ensemble.h>

#include "num/team.h"
#include "integrator/integrator_struct.h"

enum { DVI__MISFORTUNE_SENTENCE = 900 };

/* A member's numbers: t, its carry, q, p, their carries [n], the method's memory, which are what a
 * step changes; then the driver's. */
enum { DVI__MEMBER_T, DVI__MEMBER_T_CARRY, DVI__MEMBER_Q };

typedef struct dvi__block {
  int first, count;           /* members */
  const dvi_system *system;   /* of all of them */
  dvi_integrator *integrator; /* its own; NULL: it is the thread's */
  double *numbers;            /* [numbers of a member * count] */
} dvi__block;

/* The worst failure that a thread has met. */
typedef struct dvi__worst_failure {
  dvi_status status;
  int member;
  char sentence[DVI__MISFORTUNE_SENTENCE];
} dvi__worst_failure;

/* What a thread works with. */
typedef struct dvi__worker {
  dvi_integrator *integrator; /* the thread's, or that of the block at hand */
  dvi_system *
      /* the thread's integrator's system, if systems differ: it takes the terms of the block at
       * hand. NULL: there is no such thing */
      scene;
  dvi__members members; /* a block's state */
  double *numbers;      /* what it was before a step */
  /* [capacity] steps of this march that a member has taken when it last went alone */
  long *ahead;
  int *absence;     /* [capacity] for how many it did so */
  double *point[2]; /* [n] a start's q and p or v */
  /* taken by members; the integrator's own count is that of the member at hand */
  long steps;
  dvi__worst_failure worst;
  long failures;
} dvi__worker;

/* What is asked of all blocks. */
typedef struct dvi__march {
  double h;
  long steps;
} dvi__march;

typedef struct dvi__departure {
  double t;
  const double *q, *second; /* [n*members]; second: p, or v */
  int by_velocity;
  double *numbers; /* of the new states: until all members have started the old ones stay */
} dvi__departure;

struct dvi_ensemble {
  int members, threads;
  int n;
  int system_is_general; /* it declares a general Lagrangian */
  /* systems differ, and the method's steppers are bound to them: blocks have integrators of their
   * own */
  int bound;
  size_t state_numbers;  /* of a member: those that a step changes */
  size_t member_numbers; /* all */
  int capacity;          /* members of a block at most */
  dvi__block *blocks;
  int block_count;
  double *numbers; /* the memory of all blocks */
  dvi_status *status;
  dvi__team *team;
  dvi__worker *workers; /* [threads] */
  dvi_integrator **integrators;
  int integrator_count; /* threads, or blocks; the first one is the first member's */
  int started;
  long allocations;
  dvi__march march;
  dvi__departure departure;
};

/* The driver's numbers of a member, which follow those that a step changes: the length of the last
 * step (0: none), the steps taken, and for general Lagrangians the last point [n], or before the
 * first step the start's velocity. */
enum { DVI__MEMBER_LAST_H, DVI__MEMBER_STEPS, DVI__MEMBER_LAST };

/* One number of all members of a block; the second form counts the driver's numbers alone. */
static inline double *dvi__row(const dvi__block *block, size_t number)
{
  return block->numbers + number * (size_t)block->count;
}

static inline double *dvi__driver_row(const dvi_ensemble *e, const dvi__block *block, size_t number)
{
  return dvi__row(block, e->state_numbers + number);
}

/* Put a worker's integrator to member k of a block, and back. */
void dvi__member_load(const dvi_ensemble *e, dvi__worker *w, const dvi__block *block, int k);
void dvi__member_store(const dvi_ensemble *e, const dvi__worker *w, const dvi__block *block, int k);

/* Let a worker have an integrator of this block's system. */
void dvi__worker_bind(dvi__worker *w, const dvi__block *block);

/* Forget earlier failures; note one, with the thread's error sentence; the worst of all workers as
 * the status of the call. */
void dvi__ensemble_clear_failures(dvi_ensemble *e);
void dvi__worker_note(dvi__worker *w, int member, dvi_status status);
dvi_status dvi__ensemble_verdict(const dvi_ensemble *e);

#endif
