/* Kick, drift, kick over a long chain, with all substeps of a step in one pass through memory.
 *
 * If each operation takes all coordinates in turn, each substep moves them through memory several
 * times. But an operation on a coordinate depends on its neighbours within `reach` alone. Therefore
 * the operations follow each other along the chain. While A_1 is at x, A_2 is 2 r behind and A_3 4
 * r behind, and their data stays in the cache.
 *
 *     A_k   kicks and drift of substep k, each coordinate alone:   p += ..., q += h_k v
 *     G_k   the gradient at its end, V_q(i) from q(i-r) .. q(i+r)
 *
 *              x-4r           x-3r           x-2r           x-r            x          x+block
 *     done so far:
 *     A_1       ##########################################################################
 *     G_1       ###########################################################
 *     A_2       ############################################
 *     G_2       #############################
 *     A_3       ##############
 *
 * G_k on a coordinate needs A_k on all its neighbours, so that A_k is r ahead. A_k+1 overwrites q,
 * which G_k on its neighbours still needs, so that A_k+1 is r behind. Hence one array holds all
 * times at once, and each coordinate undergoes the same operations, bit for bit, as without
 * blocking.
 *
 * The operations on a long chain work in a window, which moves along with them. The last one writes
 * the new state to memory, past the caches.
 *
 * Each thread takes a part of the chain. A part begins where it can without its left neighbour,
 * operation number l at l r to the right of the cut. There the thread leaves a staircase of
 * coordinates at the times that the left neighbour needs. The left neighbour continues over the cut
 * by as much when its own part is done. */
#ifndef DVI_STEP_SPLIT_TEMPORAL_BLOCKING_H
#define DVI_STEP_SPLIT_TEMPORAL_BLOCKING_H
#include "num/simd/lanes.h"
#include "system/system.h"

typedef struct dvi__blocking dvi__blocking;

enum { DVI__BLOCKING_SUBSTEPS = 32 };

/* One step. */
typedef struct dvi__blocking_step {
  int count;              /* substeps, 1 to DVI__BLOCKING_SUBSTEPS */
  const double *h;        /* [count] */
  double t0;              /* time at the start */
  const double *t;        /* [count] time at the end of each substep */
  dvi__phase from, to;    /* [n] each; `from` is only read */
  const double *gradient; /* [n] gradient at the start, or NULL if not known */
  double *gradient_to;    /* [n] gradient at the end */
} dvi__blocking_step;

/* NULL if temporal blocking is possible. This needs a diagonal mass, and potentials that declare
 * gradient_range. Otherwise the obstacle, in words. */
const char *dvi__blocking_obstacle(const dvi_system *system);

/* Create the blocking for at least 1 thread. There must be no obstacle. */
dvi_status dvi__blocking_create(const dvi_system *system, int threads, dvi__blocking **blocking);
void dvi__blocking_destroy(dvi__blocking **blocking);

/* The most substeps of one pass, which are as many as fit into the cache. */
int dvi__blocking_depth(const dvi__blocking *blocking);

/* The threads of a pass with so many substeps. A short chain does not have enough coordinates for
 * all threads. */
int dvi__blocking_threads(const dvi__blocking *blocking, int count);

/* Run the step. Returns 0 if a callback failed or gave a number that is not finite, or if the new
 * state has one. Then `to` and gradient_to are invalid, and the plain operations find the first
 * failure. */
int dvi__blocking_run(dvi__blocking *blocking, const dvi__blocking_step *step);

/* Bytes that a step of so many substeps moves if the chain fits in no cache. They include the
 * numbers that are read and written, and the lines that are fetched to be written. */
double dvi__blocking_traffic(const dvi__blocking *blocking, int count);

/* Set the block length for blockings that are created from now on, for tests (default 0, the usual
 * length). */
void dvi__blocking_choose_block(int block);

/* Set from how many coordinates on a chain counts as long, likewise for tests. */
void dvi__blocking_choose_long_chain(int coordinates);

#endif
