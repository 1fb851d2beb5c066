/* Checks and copies of a declared term. */
#ifndef DVI_SYSTEM_TERM_DECLARE_H
#define DVI_SYSTEM_TERM_DECLARE_H
#include "system/system.h"

/* Group columns that are differenced together. */
dvi_status dvi__group_columns(const dvi__pattern *pattern, dvi__groups *groups);

/* Refuse a callback in both shapes, of which one alone would be called. Each argument says if both
 * shapes are given. */
dvi_status dvi__check_shapes(const char *owner, int values, int gradients, int hessians, int rates);

/* Refuse a rate of an autonomous system, which would never be called. */
dvi_status dvi__check_rate(const dvi_system *system, const char *owner, int given);

/* Declare a function of q and v, or of q and p, as the system's. `part` names its Hessian's
 * blocks. */
dvi_status dvi__declare_function(dvi_system *system, const dvi_lagrangian *given, const char *name,
                                 const char *const part[3]);

#endif
