/** Cuts of a mesh into many parts, as they would be shared by as many ranks, and a part that
 * marches alone: what ranks have to do is measured without them. */
#ifndef CUTS_H
#define CUTS_H
#include "scaling/step_cost.h"
#include "scaling/timed.h"

/** A cut, and what a step of its largest share takes in this process alone, with nobody to wait
 * for. */
typedef struct cut_run {
  mesh_cut cut;
  dvi_study_spread seconds;
} cut_run;

/** Cut the whole mesh of a march into parts, and time the largest share, of a field of its degree
 * without losses and sources. One part is the whole mesh. Returns DONE, or complains and returns
 * the exit code. */
int cut_run_measure(const timed_request *request, const timed_march *whole, int parts,
                    cut_run *run);
#endif
