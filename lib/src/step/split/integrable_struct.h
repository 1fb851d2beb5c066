/* The inside of an integrable part. A kind is one const struct of functions. */
#ifndef DVI_STEP_SPLIT_INTEGRABLE_STRUCT_H
#define DVI_STEP_SPLIT_INTEGRABLE_STRUCT_H
#include "step/split/integrable.h"
#include "step/split/modes.h"
#include "step/split/orbit.h"

typedef struct dvi__integrable_kind {
  const char *words;
  dvi_status (*move)(dvi__integrable *own, const dvi__points *points, double *to_q, double *to_p);
  /* phi_tau(z) - z of one state into dq and dp [n] */
  dvi_status (*change)(dvi__integrable *own, double tau, const double *q, const double *p);
  dvi_status (*pullback)(dvi__integrable *own, const dvi__points *points, const double *lambda_q,
                         const double *lambda_p, double *by_q, double *by_p);
} dvi__integrable_kind;

struct dvi__integrable {
  const dvi__integrable_kind *kind;
  const dvi_system *system;
  const dvi_flow *flow;
  dvi_system *fast;
  dvi__evaluator *evaluator; /* of the fast part */
  int n, capacity;
  double *dq, *dp; /* [n] */
  /* rotation */
  dvi__modes *modes;
  double *shift;         /* [n] X^T b */
  double *y, *w, *f, *z; /* [n] work */
  /* kepler */
  int dimension, bodies;
  double *mu, *mass;  /* [bodies] k/m, and m */
  dvi__orbit *orbits; /* [bodies*capacity] */
};

/* Tell if the fast potentials are -k/|q| of each body in a plane or in space, and make the kepler
 * kind. */
dvi_status dvi__integrable_find_centres(dvi__integrable *own, int *found);

/* Make the rotation kind. */
dvi_status dvi__integrable_find_modes(dvi__integrable *own, dvi_counters *counters);

extern const dvi__integrable_kind dvi__integrable_rotation, dvi__integrable_kepler;

#endif
