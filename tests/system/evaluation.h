/* A batch of points, and an evaluator of everything there. */
#ifndef TESTS_SYSTEM_EVALUATION_H
#define TESTS_SYSTEM_EVALUATION_H
#include "support/suite.h"
#include "support/systems/systems.h"
#include "system/evaluate/evaluator.h"

enum { POINTS = 5, QQ = 3 * SITES - 2, QV = 2 * SITES - 1, VV = 3 * SITES - 2 };

/* A batch of points and everything that can be evaluated there. */
typedef struct evaluation {
  double t[POINTS], q[SITES * POINTS], v[SITES * POINTS];
  double L[POINTS], L_q[SITES * POINTS], L_v[SITES * POINTS];
  double L_qq[QQ * POINTS], L_qv[QV * POINTS], L_vv[VV * POINTS];
} evaluation;

static inline void allocate_evaluation(evaluation *x)
{
  for (int k = 0; k < POINTS; k++) {
    x->t[k] = 0.1 * k;
    for (int i = 0; i < SITES; i++) {
      x->q[i * POINTS + k] = generic_q[i] * (1 + 0.1 * k);
      x->v[i * POINTS + k] = generic_v[i] * (1 - 0.2 * k);
    }
  }
}

static inline dvi__evaluator *make(const dvi_system *s, dvi_counters *counters)
{
  dvi__evaluator *e;
  ck_assert_msg(dvi__evaluator_create(s, POINTS, DVI__HESSIANS, counters, &e) == DVI_OK, "%s",
                dvi_last_error());
  return e;
}

#endif
