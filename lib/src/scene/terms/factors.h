/* Scenes with manifold coordinates. This declares the factors of the configuration space and the
 * constant mass. */
#ifndef DVI_SCENE_TERMS_FACTORS_H
#define DVI_SCENE_TERMS_FACTORS_H
#include "scene/elaborate/model.h"

/* Declare the factors and the mass of a quadratic form. It has second derivatives by the rates of
 * the stored numbers, and after these by omega(R) and rate(u). */
bool dvi__make_factors(dvi_scene *scene, const dvi_pattern *pattern, const double *values);

/* Complain of an inertia that no body has, after no system could be made. Returns false if there is
 * one. */
bool dvi__inertias_are_of_bodies(dvi_scene *scene);

#endif
