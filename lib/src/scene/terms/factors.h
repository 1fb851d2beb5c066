/* Scenes with manifold coordinates: the factors of the configuration space and the constant
 * mass. */
#ifndef DVI_SCENE_FACTORS_H
#define DVI_SCENE_FACTORS_H
#include "scene/elaborate/model.h"

/* Declare the factors and the mass of a quadratic form: its second derivatives by the rates of what
 * is stored, and after these by omega(R) and rate(u). */
bool dvi__make_factors(dvi_scene *scene, const dvi_pattern *pattern, const double *values);

/* After no system could be made: tell of the inertia that is that of no body, if there is one;
 * false then. */
bool dvi__inertias_are_of_bodies(dvi_scene *scene);

#endif
