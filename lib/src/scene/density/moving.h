/* A mesh of a scene that moves. */
#ifndef DVI_SCENE_DENSITY_MOVING_H
#define DVI_SCENE_DENSITY_MOVING_H
#include <dvi/moving.h>

#include "scene/density/scene_density.h"

struct dvi__scene_moving {
  const struct dvi__scene_density *density;
  const dvi__tree *section;
  dvi_moving_terms terms;
  dvi__local *whole;  /* the density */
  dvi__local *placed; /* with the position as variables, or NULL */
  dvi__local *monitor;
  dvi__local *motion[DVI_MOVING_AXES_MAX], *velocity[DVI_MOVING_AXES_MAX]; /* or NULL */
  /* of the start, or NULL */
  dvi__local *slope[DVI_MOVING_AXES_MAX][DVI_MOVING_COMPONENTS_MAX];
  double jump[DVI_MOVING_AXES_MAX * DVI_MOVING_COMPONENTS_MAX];
  double end[2][DVI_MOVING_COMPONENTS_MAX]; /* fixed values */
  int fixed[2];                             /* conditions that fix one */
  dvi_moving *made;
};

/* Derivatives by the position, as in dvi_moving_terms. `user` is the scene_moving. */
int dvi__moving_place_derivative(int count, double t, const double *x, const double *z, double *l_x,
                                 double *l_xz, double *l_xx, void *user);

/* Give the start, as in dvi_moving_start. `user` is the scene_moving. */
dvi_moving_wave dvi__moving_wave;

/* Refuse a section initial that is off the values that are fixed (ends.c). */
bool dvi__moving_check_ends(dvi_scene *scene);

/* Count the nodes that at the start are as fast as waves, or faster, and give the position of the
 * first one. */
int dvi__moving_fast_nodes(const dvi_scene *scene, double *x);

/* Name the coordinates: the positions that are unknown by the axes, and values by their fields. */
bool dvi__moving_name_unknowns(dvi_scene *scene);

#endif
