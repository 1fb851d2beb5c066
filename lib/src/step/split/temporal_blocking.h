/* Kick, drift, kick over a long chain, all substeps of a step in one pass through memory.
 *
 * Swept one operation after the other, each substep takes all coordinates through memory several
 * times. But an operation on a coordinate depends on its neighbours within `reach` alone, so the
 * operations follow each other along the chain like waves: while A_1 is at x, A_2 is 2 r behind,
 * A_3 4 r behind, and what they work on stays in the cache.
 *
 *     A_k   kicks and drift of substep k, each coordinate for itself:       p += ..., q += h_k v
 *     G_k   the gradient at its end, V_q(i) from q(i-r) .. q(i+r)
 *
 *                       x-4r            x-3r            x-2r            x-r             x           x+block
 *     A_1 has been here  #################################################################################
 *     G_1                ##################################################################
 *     A_2                ##################################################
 *     G_2                ##################################
 *     A_3                ##################
 *
 * G_k on a coordinate needs A_k on all its neighbours: A_k is r ahead. A_k+1 overwrites q, which
 * G_k on its neighbours still needs: it is r behind. So one array holds all times at once, and each
 * coordinate sees the operations, bit for bit, that the plain sweep does on it.
 *
 * Several threads take a part of the chain each. A part begins where it can without its left
 * neighbour: operation number l, l r to the right of the cut. There it leaves a staircase of
 * coordinates at the times that the left neighbour needs, who goes on over the cut by as much, when
 * he gets there. */
#ifndef DVI_ACTION_WAVE_H
#define DVI_ACTION_WAVE_H
#include "num/simd/lanes.h"
#include "system/system.h"

typedef struct dvi__blocking dvi__blocking;

enum { DVI__WAVE_SUBSTEPS = 32 };

/* One step. */
typedef struct dvi__blocking_step {
  int count;              /* substeps, 1 to DVI__WAVE_SUBSTEPS */
  const double *h;        /* [count] */
  double t0;              /* where it starts, and */
  const double *t;        /* [count] where each substep ends */
  dvi__phase from, to;    /* [n] each; `from` is only read */
  const double *gradient; /* [n] at the start; NULL: not known */
  double *gradient_to;    /* [n] at the end */
} dvi__blocking_step;

/* NULL if waves are possible: a mass for each coordinate, and potentials that declare
 * gradient_range. Else what stands against it, in words. */
const char *dvi__blocking_obstacle(const dvi_system *system);

/* For so many threads, at least 1. Only without an obstacle. */
dvi_status dvi__blocking_create(const dvi_system *system, int threads, dvi__blocking **wave);
void dvi__blocking_destroy(dvi__blocking **wave);

/* How many substeps one pass takes at most: as many as fit into the cache. */
int dvi__blocking_depth(const dvi__blocking *wave);

/* Threads that a pass of so many substeps is divided among: a short chain has not enough for
 * all. */
int dvi__blocking_threads(const dvi__blocking *wave, int count);

/* 1 if all went well. 0 if a callback failed or gave, or the new state holds, a number that is not
 * finite: `to` and gradient_to are spoiled then, and the plain sweep finds what came first. */
int dvi__blocking_run(dvi__blocking *wave, const dvi__blocking_step *step);

/* Bytes that a step of so many substeps moves if the chain fits in no cache: what it reads and
 * writes, and lines that are fetched to be written. */
double dvi__blocking_traffic(const dvi__blocking *wave, int count);

/* For tests: waves made from now on have this block length; 0: the usual one. */
void dvi__blocking_choose_block(int block);

#endif
