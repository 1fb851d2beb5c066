/* A field of rotations of a scene. */
#ifndef DVI_SCENE_DENSITY_ROTATIONS_H
#define DVI_SCENE_DENSITY_ROTATIONS_H
#include <dvi/rotations.h>

#include "scene/density/scene_density.h"

/* The field of the scene. */
const dvi_rotations *dvi__rotations_made(const dvi_scene *scene);

#endif
