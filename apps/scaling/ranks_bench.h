/** dvi bench --scale ranks=1,2,4,...,1e5: a step of a field on ranks that share its mesh, measured
 * as far as there are processes, and predicted for more. */
#ifndef RANKS_BENCH_H
#define RANKS_BENCH_H
#include "scaling/cuts.h"
#include "scaling/rank_counts.h"
#include "scaling/step_cost.h"
#include "scaling/timed.h"

/** The request. */
typedef struct ranks_request {
  timed_request timed;
  const char *scaled;        /**< "ranks=1,2,4" */
  const char *weak;          /**< the parameter with which the number of cells grows, or NULL */
  double latency, bandwidth; /**< of another network, NaN for the measured one */
  const char *csv, *plot;    /**< or NULL */
} ranks_request;

/** The mesh and a step on it. */
typedef struct whole_run {
  timed_kind kind;
  const char *method;
  int dimension;       /**< of the mesh, 1 for a grid */
  double cells;        /**< of the highest degree, or values of a grid */
  double numbered;     /**< of the degree that has most cells. 0 for a grid */
  double bytes, flops; /**< that a step moves and takes, NaN if not counted */
  double state_bytes;  /**< of a saved state */
  dvi_study_spread seconds;
} whole_run;

/** A step on some of the processes. */
typedef struct shared_run {
  int ranks;
  bool is_weak; /**< the mesh grows with the ranks */
  bool is_oversubscribed;
  double cells; /**< of the whole mesh */
  mesh_cut cut;
  dvi_study_spread seconds;
  double plane;      /**< of a grid: values of a plane that comes from a neighbour */
  double exchange;   /**< seconds of a refresh alone, the least of the rounds */
  double agreements; /**< of all ranks in a step */
} shared_run;

/** The triad on some of the processes at once. */
typedef struct triad_run {
  int ranks;
  double bandwidth; /**< bytes a second of all together, NaN if oversubscribed */
} triad_run;

enum { SHARED_MAX = 16 };

/** All that was measured. */
typedef struct ranks_bench {
  const ranks_request *request;
  rank_counts asked;
  int cores; /**< of a machine */
  whole_run whole;
  int cuts; /**< the first one is the whole mesh */
  cut_run cut[CUTS_MAX];
  double mesh_bytes; /**< of the heap that the whole mesh holds, NaN if not known */
  bool is_in_parts;  /**< no process holds the whole mesh */
  /** of a grid: the blocks of as many ranks as are asked for, with 0 parts beyond the most that can
   *  share it, and a slab with one neighbour, which each rank has on both sides of a longer grid */
  mesh_cut foreseen[RANK_COUNTS_MAX], beside;
  double base; /**< the parameter of weak scaling for one rank */
  int shared;
  shared_run run[2 * SHARED_MAX];
  int triads;
  triad_run triad[SHARED_MAX + 1];
  double latency, bandwidth; /**< between the first two processes */
  double refresh;            /**< seconds of a refresh that brings one number from one process */
  bool is_one_machine;       /**< these two are on one */
  step_cost cost;
  double deviation[CUTS_MAX]; /**< of the fit from the cuts */
  double own;                 /**< factor of the scene's own losses and sources in a step */
  bool has_sharing;           /**< the cost of a shared memory was measured */
} ranks_bench;

/** Start as many processes of this command line as the ranks that are asked for and the cores of
 * the machine allow, in place of this process. Complains, and returns the exit code, if that fails.
 */
int ranks_bench_start(const ranks_request *request, int argc, char **argv);

/** Measure and report. Called by all processes. Returns an exit code. */
int ranks_bench_run(const ranks_request *request);
#endif
