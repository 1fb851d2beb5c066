/** Marches of fields, as studies run them. */
#ifndef FIELD_MOTION_H
#define FIELD_MOTION_H
#include <stdbool.h>

#include "problem.h"

/** The result of a march. */
typedef struct field_motion_end {
  double steps, updates; /**< as dvi_march_facts counts them */
  double energy_error;   /**< largest change of the energy, NaN if it was not watched */
  double seconds;        /**< process time of creation and start */
} field_motion_end;

/** Run a march of so many steps from the scene's start to t_end.
 *
 *  @param[out] q       [nq] the end, as the coordinates of the field's mechanical system. NULL to
 *                      run for the clock, in the fastest way
 *  @param      watched look at the energy after every step
 *  @param[out] end     may be NULL */
dvi_status field_motion(const problem *scene, const char *method, double steps, double t_end,
                        bool watched, double *q, field_motion_end *end);
#endif
