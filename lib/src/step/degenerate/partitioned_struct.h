/* The inside of a partitioned step, for the files that share it. */
#ifndef DVI_STEP_DEGENERATE_PARTITIONED_STRUCT_H
#define DVI_STEP_DEGENERATE_PARTITIONED_STRUCT_H
#include "step/degenerate/partitioned.h"
#include "step/degenerate/stage_inverse.h"
#include "step/joint.h"
#include "step/onestep/collocation.h"

/* The kicks are k0 = before lambda + carried times the last lambda, and k1 = after lambda. Their
 * directions are taken at the mean of q0 and q1, or at the ends. */
typedef struct kicks {
  double before, carried, after;
  int has_multiplier, at_mean;
} kicks;

struct dvi__partitioned {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int n, s, m; /* coordinates, stages, unknowns of a coordinate */
  double a[DVI__STAGES_MOST][DVI__STAGES_MOST], abar[DVI__STAGES_MOST][DVI__STAGES_MOST],
      b[DVI__STAGES_MOST], c[DVI__STAGES_MOST];
  /* the same by columns, padded with zeros */
  double a_by_columns[DVI__STAGES_MOST][DVI__STAGES_MOST],
      abar_by_columns[DVI__STAGES_MOST][DVI__STAGES_MOST];
  dvi__stage_inverse *inverse; /* that of the Jacobian, NULL if it is factored */
  double ratio; /* the lengths of steps for which `shift` continues the velocities, 0 if none */
  double shift[DVI__STAGES_MOST][DVI__STAGES_MOST];
  kicks kick;
  dvi__pattern joint, pattern; /* joint is the pattern of one block, pattern that of the Jacobian */
  dvi__joint_entry *block;     /* [entries of joint] */
  /* The current step. */
  double t0, h;
  const double *q0, *p0, *carried;
  int has_gradients; /* qv0 has the gradients of alpha at q0 */
  /* Values at the stages, component by component [n*s]. */
  double *t, *Q, *V, *L_q, *L_v, *H_qq, *H_qv, *H_vv;
  /* Values at the ends, [n] each. These are the kicks, their effect on p, the increments of q
   * before k1 and in all, the points, and alpha at q1. */
  double *k0, *k1, *K0, *K1, *dq, *q1, *mean, *alpha1, *dp, *unwanted;
  double *qq0, *qv0, *qq1, *qv1, *qv_end, *qq_end; /* Hessians at the ends */
};

static inline double partitioned_dot(int count, const double *x, const double *y)
{
  double sum = 0;
  for (int j = 0; j < count; j++) sum += x[j] * y[j];
  return sum;
}

/* Compute the points at x. */
void dvi__partitioned_points(dvi__partitioned *p, const double *x);

/* Make the weights that continue velocities by this ratio of lengths, unless they are there. */
void dvi__partitioned_shift(dvi__partitioned *p, double ratio);

/* Create the inverse, if it can serve (partitioned_jacobian.c). */
dvi_status dvi__partitioned_create_inverse(dvi__partitioned *p);

#endif
