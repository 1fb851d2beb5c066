/* The side of singular points on which a state lies, and the rank of constraints. */
#include <stdio.h>

#include "core/status.h"
#include "integrator/integrator_struct.h"
#include "system/dynamics/holonomic.h"
#include "system/evaluate/dynamics.h"

dvi_status dvi__integrator_find_side(dvi_integrator *I)
{
  const dvi__state_constraint *constraint = I->system->dynamics->constraint;
  if (constraint == NULL || I->now.side != 0) return DVI_OK;
  return constraint->side(I->evaluator, I->now.t, I->now.q, I->now.p, 0, &I->now.side);
}

dvi_status dvi__check_side(dvi_integrator *I)
{
  const dvi__state_constraint *constraint = I->system->dynamics->constraint;
  if (constraint == NULL) return DVI_OK;
  DVI_TRY(
      constraint->side(I->evaluator, I->next.t, I->next.q, I->next.p, I->now.side, &I->next.side));
  if (I->next.side == I->now.side) return DVI_OK;
  return dvi__fail(
      DVI_NOT_CONVERGED,
      "the step leads over a point where the %s is singular, beyond which no trajectory goes on",
      constraint->matrix);
}

dvi_status dvi__name_trajectory_end(const dvi_integrator *I, double h, dvi_status status)
{
  char sentence[1024];
  const dvi__state_constraint *constraint = I->system->dynamics->constraint;
  if (constraint == NULL || constraint->ends == NULL || I->monitored != NULL ||
      (status < 0 && status != DVI_SINGULAR))
    return status;
  (void)snprintf(sentence, sizeof sentence, "%s", dvi_last_error());
  if (!constraint->ends(I->evaluator, I->now.t, I->now.q, h, I->next.p, I->next.q))
    return dvi__fail(status, "%s", sentence);
  return dvi__fail(
      status, "%s; the %s becomes singular within this step, and no trajectory goes on from there",
      sentence, constraint->matrix);
}

void dvi__explain_dependent_rows(const dvi_integrator *I, dvi__text *out)
{
  char rows[1024];
  const int count = I->system->place_rows > 0 ? dvi__rows_dependent(I->evaluator, rows, sizeof rows)
                                              : 0;
  if (count > 0)
    dvi__text_add(out,
                  "constraints: %d rows of rank %d; %s: redundant, in agreement with the others; "
                  "of the multipliers lambda only G^T lambda is determined\n",
                  I->system->row_count, I->system->row_count - count, rows);
}
