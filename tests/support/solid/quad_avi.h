/* Asynchronous steps of a solid in quadruple precision, event by event, with the next event found
 * by looking at all cells: a cell K of its own step h_K has events at t_0 + k h_K, at which
 *
 *     u_a += v_a (t - t_a),  t_a = t,      v_a += h_K f_a/m_a   for its nodes a,
 *
 * where h_K is half as large at the start. Cells of one time are taken in their order. Source: Lew,
 * Marsden, Ortiz and West 2003. */
#ifndef SUPPORT_SOLID_QUAD_AVI_H
#define SUPPORT_SOLID_QUAD_AVI_H
#include "support/solid/quad_solid.h"

typedef struct quad_avi {
  const quad_solid *s;
  double *step;       /* [cells] */
  long *count;        /* [cells] events so far */
  quad start, *u, *v; /* [size] */
  quad *clock;        /* [vertices] times of the last events */
  long events;
} quad_avi;

/* Give the longest stable step of a cell by itself, 2/sqrt(lambda) with its own lumped mass, over
 * the components that are free. */
double quad_solid_bound(const quad_solid *s, int cell);

/* Set step [cells] to `fraction` of the bounds, or with classes to the shortest of these times
 * powers of 2, below them. With a span the shortest one (without classes each one) is made shorter
 * so that a whole number of them makes it. */
void quad_avi_steps(const quad_solid *s, double fraction, int has_classes, double span,
                    double *step);

/* Begin with displacements and rates [size] at a time. `step` [cells] is copied. */
quad_avi quad_avi_of(const quad_solid *s, const double *step, quad t, const quad *u, const quad *v);
void quad_avi_clear(quad_avi *avi);

/* Return the time of the next event, and let the events of this time happen. */
quad quad_avi_next(const quad_avi *avi);
void quad_avi_event(quad_avi *avi);

/* Let all events before a time and at it happen, and give u and v there: u goes on with v, and v
 * gets of each cell what its last kick lacks of the time until then, by the forces at that u. */
void quad_avi_advance(quad_avi *avi, quad t, quad *u, quad *v);

#endif
