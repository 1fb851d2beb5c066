/* The parts of elaborate.c that stand in files of their own. */
#ifndef DVI_SCENE_ELABORATE_H
#define DVI_SCENE_ELABORATE_H
#include "scene/context.h"
#include "scene/shape.h"

/* Whether something, one of DVI__SAYS_.., may stand here; told if not. */
bool dvi__may_stand(const dvi__context *c, unsigned says, dvi__span span);

dvi__value dvi__name_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__index_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__rate_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__momentum_value(dvi__context *c, const dvi__expression *e);

#endif
