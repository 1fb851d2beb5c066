/* The inside of a time-transformed system, for the files that evaluate it. */
#ifndef DVI_SYSTEM_RESCALE_TRANSFORMED_STRUCT_H
#define DVI_SYSTEM_RESCALE_TRANSFORMED_STRUCT_H
#include "system/rescale/transformed.h"
#include "system/evaluate/evaluator.h"

/* Work for a batch, all in one block. */
typedef struct dvi__transformed_work {
  double *numbers;
  double *v, *g_q, *L_q, *L_v, *d, *Mv; /* work [n*capacity], with Mv = L_vv v */
  /* work [capacity], with lag = E0 - E and vMv = v.L_vv v */
  double *g, *lag, *vMv;
  /* Hessians [entries*capacity] of g, and of the system's L */
  double *g_qq, *base_qq, *base_qv, *base_vv;
} dvi__transformed_work;

struct dvi__transformed {
  const dvi_system *base;
  dvi_system *system;
  dvi_monitor given;
  dvi__monitor *monitor;
  dvi__evaluator *evaluator; /* evaluator of base */
  dvi_counters *counters;
  double energy;
  int capacity;
  dvi__transformed_work work;
};

/* Compute g and v = w/g at a batch of places. */
dvi_status dvi__transformed_velocities(dvi__transformed *transformed, int count, const double *q,
                                       const double *w);

/* Compute all terms of first order, v, g, g_q, L_q, L_v and lag = E0 - E. */
dvi_status dvi__transformed_first_order(dvi__transformed *transformed, int count, const double *t,
                                        const double *q, const double *w);

/* Compute the Hessian of Lg, or L_ww alone if the others are NULL. `of` is a dvi__transformed. */
dvi_status dvi__transformed_hessian(void *of, int count, const double *t, const double *q,
                                    const double *w, double *L_qq, double *L_qw, double *L_ww);

#endif
