/** The factors of a system's configuration space by its coordinates. */
#ifndef VIEW_FACTORS_H
#define VIEW_FACTORS_H
#include <stdbool.h>

#include "problem.h"

/** Return the factor to which coordinate i belongs, or NULL without factors. */
const dvi_factor *factor_of(const problem *scene, int i);

/** Return whether coordinate i is of a direction or an angle, and so of a unit vector. */
bool is_of_direction(const problem *scene, int i);
#endif
