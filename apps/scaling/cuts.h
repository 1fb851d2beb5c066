/** Cuts of a mesh into many parts, as they would be shared by as many ranks, and a part that
 * marches alone: what ranks have to do is measured without them. */
#ifndef CUTS_H
#define CUTS_H
#include "scaling/step_cost.h"
#include "scaling/timed.h"
#include "shares/blocks.h"

/** A cut, and what a step of its largest share takes in this process alone, with nobody to wait
 * for. */
typedef struct cut_run {
  mesh_cut cut;
  dvi_study_spread seconds;
} cut_run;

/** Cut the whole mesh or grid of a march into parts, and time the largest share: of a field one
 * without losses and sources, of a solid one that begins at rest, of a grid a block in the
 * middle. One part is the whole. `cut.parts` is 0 if there are not as many blocks. Returns DONE, or
 * complains and returns the exit code. */
int cut_run_measure(const timed_request *request, const timed_march *whole, int parts,
                    cut_run *run);

/** Give the mean over the steps of what a block receives, and with what of it it computes. */
mesh_cut cut_of_block(const block *found, int parts);
#endif
