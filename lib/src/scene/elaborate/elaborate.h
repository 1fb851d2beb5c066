/* The parts of elaborate.c that stand in files of their own. */
#ifndef DVI_SCENE_ELABORATE_H
#define DVI_SCENE_ELABORATE_H
#include "scene/elaborate/context.h"
#include "scene/elaborate/shape.h"

/* Whether something, one of DVI__SAYS_.., may stand here; told if not. */
bool dvi__may_stand(const dvi__context *c, unsigned says, dvi__span span);

dvi__value dvi__name_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__index_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__rate_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__momentum_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__member_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__velocity_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__if_value(dvi__context *c, const dvi__expression *e);

/* The part R or x of a motion; NULL if x is none, or has no such part. */
const dvi__coordinate *dvi__part_of_motion(const dvi__coordinate *x, const char *name);
/* The coordinate that x, x[i], u[i,j], B.R or B[i].x names, and its indices; NULL, and nothing
 * is told, if it is of another form. */
const dvi__coordinate *dvi__member_named(const dvi_scene *scene, const dvi__expression *e,
                                         dvi__subscripts *index);
/* The indices of x[i] or u[i,j]; false if these are more. */
bool dvi__subscripts_of(const dvi__expression *e, dvi__subscripts *index);
/* Refuse a family, or a part of it (as ".R"; else ""), where a member is needed. */
bool dvi__refuse_family(const dvi__context *c, const dvi__coordinate *x, const char *part,
                        dvi__span span);
/* The first number, for every element, of a coordinate or of a member of a family. */
bool dvi__member_numbering(dvi__context *c, const dvi__coordinate *x, const dvi__subscripts *index,
                           const dvi__slots *places, dvi__numbering *numbering);
/* Its numbers. */
dvi__value dvi__coordinate_value(dvi__context *c, const dvi__coordinate *x,
                                 const dvi__subscripts *index, dvi__span span);

/* The rate of an input, a stored number, by the velocities of the state; its momentum, false if it
 * has none of its own. */
bool dvi__input_velocity(dvi__context *c, int input, dvi__node *rate);
bool dvi__input_momentum(dvi__context *c, int input, dvi__node *momentum);
/* The momenta p(x) of a whole coordinate; none, and nothing is told, if the argument is of another
 * form. */
dvi__value dvi__whole_momentum(dvi__context *c, const dvi__expression *e);

#endif
