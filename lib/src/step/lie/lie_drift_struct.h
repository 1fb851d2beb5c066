/* The members of a drift, for lie_drift*.c. */
#ifndef DVI_STEP_LIE_LIE_DRIFT_STRUCT_H
#define DVI_STEP_LIE_LIE_DRIFT_STRUCT_H
#include "step/lie/coupled_drift.h"
#include "step/lie/lie_drift_members.h"
#include "step/lie/mass_blocks.h"

struct dvi__lie_drift {
  dvi__mass_blocks blocks;
  dvi__moser_veselov_map by;
  dvi__coupled_drift *together; /* NULL without coupled slots */
  int *run;     /* [alone] number of blocks from this one on that are alike and side by side */
  double *rows; /* the numbers of a run, NULL without one that is long enough */
};

/* Slots of one kind with one mass, of which each is a lane. Number i of lane k is [i*count + k]. */
typedef struct dvi__slot_lanes {
  const dvi__mass_block *block;
  size_t count;
  double h;
  const double *V; /* covector, for kicks */
  double *y, *y_low, *p, *p_low;
  double *moved; /* displacement */
  double *work;  /* [DVI__LIE_DRIFT_WORK*count] */
  char *left;    /* [count] set where a slot would turn too far */
} dvi__slot_lanes;

void dvi__slot_lanes_drift(const dvi__slot_lanes *lanes);

/* Find the runs of like blocks (lie_drift_runs.c), to be released with the drift. */
dvi_status dvi__lie_drift_find_runs(dvi__lie_drift *drift);

/* Drift the run from block i on, in lanes. Return 0 if one of its slots would turn too far, with
 * the state as it was. */
int dvi__lie_drift_run(const dvi__lie_drift *drift, int i, double h, const dvi__phase *state,
                       double *displacement);

#endif
