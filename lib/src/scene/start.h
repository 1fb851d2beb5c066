/* The rest of a start, once there is a system. It computes momenta of velocities, or velocities of
 * momenta. */
#ifndef DVI_SCENE_START_H
#define DVI_SCENE_START_H
#include "scene/elaborate/model.h"

bool dvi__scene_complete_start(dvi_scene *scene);

#endif
