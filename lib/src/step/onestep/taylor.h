/* The one-step method that truncates the motion's Taylor series, on phase space. The step is
 * (q,p) -> (q,v) -> (q1,v1) -> (q1,p1), with
 *
 *     q1 = sum_k h^k q_k,   v1 = sum_k h^k v_k,   k = 0..degree,
 *     v(q,p) from p = L_v at the start, p1 = L_v at the end.
 *
 * Its derivative is that of the series (step/onestep/flow_series.h), and its order is `degree`. */
#ifndef DVI_STEP_ONESTEP_TAYLOR_H
#define DVI_STEP_ONESTEP_TAYLOR_H
#include "step/onestep/vector_field.h"

typedef struct dvi__taylor dvi__taylor;

/* Create the method for all pieces of a shot. Piece i goes from the field's point i to point i+1.
 * The field must outlive the method. */
dvi_status dvi__taylor_create(const dvi_system *system, dvi__vector_field *field, int degree,
                              int pieces, dvi_counters *counters, dvi__taylor **taylor);
void dvi__taylor_destroy(dvi__taylor **taylor);

/* Compute the motion of z [2n] from point `piece`, which is placed. */
dvi_status dvi__taylor_advance(dvi__taylor *taylor, int piece, double h, double *moved);

/* Compute the derivative of a piece. The second derivatives of both points must be known. */
dvi_status dvi__taylor_trace(dvi__taylor *taylor, int piece, double h);

/* Compute change [2n]. dvi__taylor_push gives the change of a motion [2n] from the start to the
 * end, and dvi__taylor_pull that of a costate [2n] from the end to the start. */
dvi_status dvi__taylor_push(dvi__taylor *taylor, int piece, const double *motion, double *change);
dvi_status dvi__taylor_pull(dvi__taylor *taylor, int piece, const double *costate, double *change);

#endif
