/* The methods on groups and spheres share this galerkin step in the charts at its start. */
#ifndef DVI_METHOD_LIE_CHARTED_STEP_H
#define DVI_METHOD_LIE_CHARTED_STEP_H
#include "method/method.h"
#include "system/chart/charted.h"

/* The memory is that of galerkin, with the last path in the coordinates of the next chart, followed
 * by this path in its own chart. */
typedef struct dvi__charted_step_of {
  dvi__charted *charted;
  dvi__stepper inner; /* galerkin in the charts */
  /* [4 nx] q, p and their compensations in the charts; the arrays below lie behind */
  double *local;
  double *xi, *rate; /* [nx] */
  double *offset;    /* [nx*s] points of the path */
  double *supply;    /* [1 + symmetries] */
  double power[2];   /* what damping and forces supply to the energy, and its compensation */
} dvi__charted_step_of;

/* Move a state from the charts' centre to the end of the solved path in the memory. Then that path
 * is in the charts at its end, too. */
void dvi__charted_step_arrive(const dvi__charted_step_of *own, double *memory,
                              const dvi__state *local, dvi__state *state);

/* Step members side by side (charted_lanes.c). */
dvi_status dvi__charted_step_prepare_lanes(dvi__stepper *self, int capacity);
void dvi__charted_step_clear_lanes(dvi__stepper *self);
void dvi__charted_step_lanes(dvi__stepper *self, dvi__members *members, double h);

/* Set order, symmetric, memory_count, settings.rest and own of a stepper. The step uses the
 * Lagrangian of the group's own velocity if `reduced` is not 0. */
dvi_status dvi__charted_step_create(dvi__stepper *self, int reduced);

void dvi__charted_step_destroy(dvi__stepper *self);
dvi_status dvi__charted_step(dvi__stepper *self, dvi__state *state, double h);
void dvi__charted_step_path(const dvi__stepper *self, const double *q0, double h, double tau,
                            double *q, double *v);
void dvi__charted_step_explain(const dvi__stepper *self, dvi__text *text);

#define DVI__CHARTED_OPERATIONS                                                                    \
  .takes_rest = 1, .needs = DVI__FACTORS, .destroy = dvi__charted_step_destroy,                    \
  .step = dvi__charted_step, .path = dvi__charted_step_path, .explain = dvi__charted_step_explain, \
  .prepare_lanes = dvi__charted_step_prepare_lanes, .clear_lanes = dvi__charted_step_clear_lanes,  \
  .step_lanes = dvi__charted_step_lanes

#endif
