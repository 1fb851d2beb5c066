/** The model of a step (step_cost.h) from what was measured. */
#ifndef RANKS_MODEL_H
#define RANKS_MODEL_H
#include "scaling/ranks_bench.h"

/** Fit the model. Oversubscribed runs tell nothing of it. Returns false, and complains, if what was
 * measured gives none. */
bool ranks_model_fit(ranks_bench *b);

/** Predict a step on ranks, with the scene's mesh divided among them (strong scaling) or one for
 * each (weak scaling). Its efficiency is 1 on one rank. Returns false if there are no more cells
 * than ranks. */
bool ranks_model_predict(const ranks_bench *b, double ranks, bool is_weak, step_prediction *p,
                         double *efficiency);

/** Predict a step of a run that was measured. Its seconds are NaN if there is no prediction. */
void ranks_model_run(const ranks_bench *b, const shared_run *run, step_prediction *p);
#endif
