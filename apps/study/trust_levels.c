#include "study/trust_levels.h"

#include <math.h>

#include "study/norms.h"

/* The ratio of the refinements of the witness's runs, whose distances tell its own error up to the
 * factor `doubt`. */
static const double witness_factor = 10.0, doubt = 10.0;

dvi_status trust_run(trust_study *t, const study_subject *subject)
{
  dvi_status status = DVI_OK;
  for (int k = 0; k < TRUST_LEVELS && status == DVI_OK; k++) {
    study_level level = {.number = t->number[k]};
    status = study_run(subject, ldexp(1.0, k), &level);
  }
  return status;
}

/* Return the factor by which the numbers of a group fall, all together. */
static double group_ratio(const trust_study *t, const trust_group *g)
{
  const double *const *level = (const double *const *)t->number;
  return trust_ratio(norm_distance(g->count, level[0] + g->first, level[1] + g->first),
                     norm_distance(g->count, level[1] + g->first, level[2] + g->first));
}

/* Estimate the errors. A number falls as all of the first group do, or as all of the second, or
 * more slowly. */
void trust_estimate(trust_study *t)
{
  const trust_group *g = t->group;
  t->verdict.ratio = fmax(group_ratio(t, &g[0]), g[1].count > 0 ? group_ratio(t, &g[1]) : 0.0);
  for (int i = 0; i < t->count; i++) {
    const double first = t->number[0][i], second = t->number[1][i], third = t->number[2][i];
    const double own = trust_ratio(fabs(first - second), fabs(second - third));
    t->error[i] = trust_error(first, second, third, fmax(t->verdict.ratio, own));
  }
}

/* ---- the witness ---- */

/* Run the witness at its own refinement, at a finer one, and at a coarser one. */
static bool run_witness(trust_study *t, const study_subject *witness)
{
  static const int number[TRUST_LEVELS] = {1, 0, 2};
  const double refinement[TRUST_LEVELS] = {1.0, witness_factor, 1.0 / witness_factor};
  for (int k = 0; k < TRUST_LEVELS; k++) {
    study_level level = {.number = t->witness[number[k]]};
    if (study_run(witness, refinement[k], &level) != DVI_OK) return false;
  }
  return true;
}

/* Estimate the witness's error from three levels, because two may agree by chance. The error of the
 * coarsest level is a hundred times that of the finest. */
static double witness_distance(const trust_study *t, int first, int count)
{
  const double *const *witness = (const double *const *)t->witness;
  return fmax(norm_distance(count, witness[0] + first, witness[1] + first),
              norm_distance(count, witness[0] + first, witness[2] + first) /
                  (witness_factor * witness_factor));
}

static double relative_error(double error, double size)
{
  return size > 0.0 ? error / size : 0.0;
}

/* Estimate the witness's errors. An error of the whole result turns from one group into the other
 * and back, so that no number's own relative error is taken as smaller. */
static void measure_witness(trust_study *t)
{
  double whole = 0.0;
  for (int k = 0; k < TRUST_GROUPS; k++) {
    const trust_group *g = &t->group[k];
    whole = fmax(whole, relative_error(witness_distance(t, g->first, g->count),
                                       norm_largest(g->count, t->size + g->first)));
  }
  for (int i = 0; i < t->count; i++)
    t->witness_error[i] = fmax(whole * t->size[i], witness_distance(t, i, 1));
}

/* Return whether the witness is farther away than both errors explain. The verdict tells of the
 * last group that was judged. */
static bool trust_judge_group(trust_study *t, const trust_group *g)
{
  trust_verdict *verdict = &t->verdict;
  const double apart = norm_distance(g->count, t->number[0] + g->first, t->witness[0] + g->first);
  const double error = norm_largest(g->count, t->witness_error + g->first);
  verdict->contradicted = apart > 2.0 * norm_largest(g->count, t->error + g->first) + doubt * error;
  verdict->part = g->name;
  verdict->apart = apart;
  verdict->witness_error = error;
  return verdict->contradicted;
}

void trust_hear(trust_study *t, const study_subject *witness)
{
  t->verdict.witness = run_witness(t, witness);
  if (!t->verdict.witness) return;
  measure_witness(t);
  const bool in_second = trust_judge_group(t, &t->group[1]);
  if (!trust_judge_group(t, &t->group[0]) && in_second) (void)trust_judge_group(t, &t->group[1]);
  for (int i = 0; i < t->count; i++)
    t->error[i] = fmax(t->error[i],
                       fabs(t->number[0][i] - t->witness[0][i]) - doubt * t->witness_error[i]);
}
