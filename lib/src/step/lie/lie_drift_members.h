/* Kicks and drifts of lie_drift.h for members of an ensemble side by side. Number i of member k is
 * [i*count + k]. Every member has the bits of its own drift. */
#ifndef DVI_STEP_LIE_LIE_DRIFT_MEMBERS_H
#define DVI_STEP_LIE_LIE_DRIFT_MEMBERS_H
#include "step/lie/lie_drift.h"

enum { DVI__LIE_DRIFT_WORK = 10 }; /* rows of work */

/* Tell whether all slots drift alone, and bodies by Cayley's map. */
int dvi__lie_drift_has_members(const dvi__lie_drift *drift);

/* Set p -= h times the covectors V_q [nq*count]. */
void dvi__lie_drift_kick_members(const dvi__lie_drift *drift, int count, double h,
                                 const double *V_q, const dvi__phase *members);

/* Set p += h F for forces F [nv*count]. */
void dvi__lie_drift_push_members(const dvi__lie_drift *drift, int count, double h, const double *F,
                                 const dvi__phase *members);

/* Take the drifts, with displacement [nv*count] and work [DVI__LIE_DRIFT_WORK*count]. Members that
 * would turn too far are marked in left [count], and their numbers are invalid. */
void dvi__lie_drift_drift_members(const dvi__lie_drift *drift, int count, double h,
                                  const dvi__phase *members, double *displacement, double *work,
                                  char *left);

#endif
