/* The one-step method that cuts the motion's Taylor series off, on phase space: (q,p) -> (q,v) ->
 * (q1,v1) -> (q1,p1), with
 *
 *     q1 = sum_k h^k q_k,   v1 = sum_k h^k v_k,   k = 0..degree,     v(q,p) from p = L_v at the start, p1 = L_v at the end,
 * and its derivative, by that of the series (step/onestep/flow_series.h). Of order `degree`. */
#ifndef DVI_ACTION_TAYLOR_H
#define DVI_ACTION_TAYLOR_H
#include "step/onestep/vector_field.h"

typedef struct dvi__taylor dvi__taylor;

/* For so many pieces of a shot; piece i goes from the field's point i to point i+1. The field must
 * outlive it. */
dvi_status dvi__taylor_create(const dvi_system *system, dvi__vector_field *field, int degree,
                              int pieces, dvi_counters *counters, dvi__taylor **taylor);
void dvi__taylor_destroy(dvi__taylor **taylor);

/* Point `piece` is placed: by how much z [2n] moves. */
dvi_status dvi__taylor_advance(dvi__taylor *taylor, int piece, double h, double *moved);

/* Its derivative, for what follows; both points' second derivatives are there. */
dvi_status dvi__taylor_trace(dvi__taylor *taylor, int piece, double h);

/* change [2n]: by how much a motion [2n] of the start changes to the end; by how much a costate
 * [2n] of the end changes to the start. */
dvi_status dvi__taylor_push(dvi__taylor *taylor, int piece, const double *motion, double *change);
dvi_status dvi__taylor_pull(dvi__taylor *taylor, int piece, const double *costate, double *change);

#endif
