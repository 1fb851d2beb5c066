/* The inside of a step by one element, for the files element_*.c. */
#ifndef DVI_METHOD_ELEMENT_ELEMENT_STRUCT_H
#define DVI_METHOD_ELEMENT_ELEMENT_STRUCT_H
#include "step/element/decoupled.h"
#include "method/element/blocks.h"
#include "method/element/element_step.h"
#include "solve/branch.h"

/* Arguments of a step, which are its start and the results of the step before. */
typedef struct dvi__element_place {
  double t, h;
  const double *q, *p;
  double last_h; /* 0 if there was none */
  /* last unknowns, or what stands in their place; without a step before, a guess of the velocity
   * [n] */
  const double *last_Y;
  const double *last_g; /* last forces, NULL if not known */
} dvi__element_place;

/* Form of the Jacobian in Newton's method, which is chosen when it is first needed
 * (element_newton.c). */
typedef struct dvi__newton_form {
  int is_operator;         /* the Jacobian is an operator, not a matrix */
  dvi__operator A;         /* products of the Jacobian and their preconditioner */
  dvi__decoupled *systems; /* decoupled systems that precondition, NULL for the kinetic part */
  dvi__decoupled *owned;   /* the same systems, where simplified Newton's method has none */
  double *point;           /* work, the point at which they are frozen */
  int is_frozen;           /* the preconditioner belongs to the current place of the equations */
} dvi__newton_form;

/* Places of a frozen part of the memory, which are the step's length (0 if nothing is frozen), the
 * number of iterations with the new factor, and the point of the frozen Jacobian, or the Jacobian,
 * or the inverses of its blocks. */
enum { DVI__FROZEN_H, DVI__FROZEN_ITERATIONS, DVI__FROZEN_POINT };

/* Number of iterations that a kept factor may cost more than a new one, about as much as making
 * one. */
enum { DVI__MORE_ITERATIONS = 2 };

typedef struct dvi__element {
  dvi__action *action;
  dvi_counters *counters;
  /* systems of simplified Newton's method, or NULL */
  dvi__decoupled *decoupled;
  int is_weighed, is_dear; /* the cost of their factors is known, and is too high for the ladder */
  /* paths are in charts at their start, and a path that is not near its guess is followed */
  int centred;
  int keeps_whole; /* the whole Jacobian is kept over steps */
  /* nothing in a step by fixed-point iteration needs its path, and its forces give it later */
  int late_paths;
  /* blocks of the Jacobian, which come first in the ladder, or NULL; the last rung used them, or
   * uses them now */
  dvi__blocks *blocks;
  int by_blocks, in_blocks;
  /* symmetric Jacobians, and real parts of them, are definite for short steps, because the mass is
   * constant and positive */
  int definite;
  /* a potential without a Hessian, so that fixed-point iteration is the only rung; its name, or
   * NULL */
  const char *without_hessian;
  int quadratic;  /* the Lagrangian is */
  int has_forces; /* forces without a potential make Jacobians that are not symmetric */
  int has_rates;  /* the Lagrangian depends on time, and tells its rate */
  dvi__solver *solver;
  dvi__newton_form newton;
  int choice;     /* choice of the solver */
  dvi__rung rung; /* the rung tried last */
  double *Y;      /* unknowns, followed by the arrays below */
  double *frozen; /* the frozen part of the memory */
  int keeps;      /* the Jacobian is not frozen anew */
  /* the place whose iteration starts from the last step's forces, NULL if it starts from Y */
  const dvi__element_place *forces_of;
  double *dq, *dq_low, *dp;
  /* the time that passes in the step */
  double duration;
  double *supply; /* [1 + symmetries] what forces supply in the step */
  /* the most steps of a march, because of what certifies them; marches to be left out after one
   * that was not certified, and their number the last time */
  int most_together, uncertified, wait;
  double work;    /* what forces and time supply to the energy */
  double *guess;  /* [unknowns] guess of the iteration, in charts, or the last step's unknowns */
  double *branch; /* [DVI__BRANCH_ROOM * unknowns] work to follow a branch, NULL until needed */
} dvi__element;

/* Put the equations at a step of length h from there. */
void dvi__element_put(dvi__element *own, const dvi__element_place *at, double h);

/* Tell whether the last iteration shows a residual. It does not where forces lag. */
int dvi__element_shows_residuals(const dvi__element *own);

/* Tell the driver whether the element marches. */
void dvi__element_admit_march(dvi__stepper *self);

/* The most iterations with kept blocks that are as good as new ones, of which a new one took that
 * many. */
static inline int dvi__element_keeps(double iterations_with_new, int iterations)
{
  return iterations <= iterations_with_new + DVI__MORE_ITERATIONS;
}

/* Give the frozen part of the blocks in the memory. */
size_t dvi__element_blocks_part(const dvi__stepper *self);

/* Advance the state by the increments of a solved step, and keep its path. */
void dvi__element_advance(dvi__stepper *self, dvi__state *state, double h);

/* Tell whether the rungs follow one after the other. */
int dvi__element_is_ladder(const dvi__element *own);

/* Set the members of the equations that Newton's methods need, and free their memory. */
void dvi__element_set_newton(dvi__equations *equations);
void dvi__element_clear_newton(dvi__element *own);

/* Invert the blocks of the Jacobian at Y into a frozen part's point. */
dvi_status dvi__element_invert_blocks(const dvi__element *own, const double *Y, double *inverse);

/* Find whether the factors of simplified Newton's method are too expensive for the ladder.
 * DVI_NO_MEMORY, DVI_BAD_SIZE, DVI_SOLVER_FAILED. */
dvi_status dvi__element_weigh(dvi__element *own);

/* Give the systems that the last rung used, or NULL if it used the whole Jacobian, or none. */
const dvi__decoupled *dvi__element_frozen(const dvi__element *own);

/* Guess Y by a straight line along the velocity at the start, which is found from that of the last
 * path. */
dvi_status dvi__element_straight(dvi__stepper *self, const dvi__element_place *at, double *Y);

/* Guess Y by the continued last path, or by a straight line without one. */
dvi_status dvi__element_guess(dvi__stepper *self, const dvi__element_place *at, double *Y);

/* Note for the next guess how the solved path of a step h, whose guess is known, bends away from
 * the continued one. */
void dvi__element_note_bending(dvi__stepper *self, double h);

/* Find Y of the solution that continues those of shorter steps. `whole` is the failure of the
 * ladder, with the thread's sentence, or DVI_OK. */
dvi_status dvi__element_follow(dvi__stepper *self, const dvi__element_place *at, dvi_status whole,
                               double *Y);

/* Tell whether the mass is constant, and all potentials are declared quadratic. */
int dvi__element_is_quadratic(const dvi_system *system);

/* Tell whether the mass makes the symmetric parts of a short step's Jacobian definite. */
int dvi__element_is_definite(const dvi_system *system, const dvi__evaluator *evaluator);

/* Tell how certain it is that the ladder's solution lies on the branch connected to h = 0. */
dvi__doubt dvi__element_doubt(const dvi__stepper *self, const dvi__element_place *at,
                              const dvi__solve_report *report);

/* Tell the same in charts, where the turn from the guess decides whether the branch is followed. */
int dvi__element_strays(const dvi__stepper *self, const dvi__element_place *at);

#endif
