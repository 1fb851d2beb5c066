/* The functions of elaborate.c and of the files beside it that they share. */
#ifndef DVI_SCENE_ELABORATE_ELABORATE_H
#define DVI_SCENE_ELABORATE_ELABORATE_H
#include "scene/elaborate/context.h"
#include "scene/elaborate/shape.h"

/* Return true if a mention, one of DVI__MENTIONS_.., is allowed here. Complains if not. */
bool dvi__check_mention(const dvi__context *c, unsigned mentions, dvi__span span);

dvi__value dvi__name_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__index_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__rate_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__momentum_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__member_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__velocity_value(dvi__context *c, const dvi__expression *e);
dvi__value dvi__if_value(dvi__context *c, const dvi__expression *e);

/* Return the part R or x of a motion, or NULL if x is no motion, or has no such part. */
const dvi__coordinate *dvi__part_of_motion(const dvi__coordinate *x, const char *name);
/* Find the coordinate that x, x[i], u[i,j], B.R or B[i].x names, and its indices. Returns NULL for
 * any other form, without a complaint. */
const dvi__coordinate *dvi__member_named(const dvi_scene *scene, const dvi__expression *e,
                                         dvi__subscripts *index);
/* Read the indices of x[i] or u[i,j]. Returns false if there are more. */
bool dvi__subscripts_of(const dvi__expression *e, dvi__subscripts *index);
/* Refuse a family, or a part of it (`part` is ".R", say, else ""), instead of a member. */
bool dvi__refuse_family(const dvi__context *c, const dvi__coordinate *x, const char *part,
                        dvi__span span);
/* Find the first number, for every element, of a coordinate or of a member of a family. */
bool dvi__member_numbering(dvi__context *c, const dvi__coordinate *x, const dvi__subscripts *index,
                           const dvi__slots *places, dvi__numbering *numbering);
/* Return the numbers of a coordinate. */
dvi__value dvi__coordinate_value(dvi__context *c, const dvi__coordinate *x,
                                 const dvi__subscripts *index, dvi__span span);

/* Find the rate of an input, a stored number, by the velocities of the state, or its momentum.
 * Returns false if it has no momentum of its own. */
bool dvi__input_velocity(dvi__context *c, int input, dvi__node *rate);
bool dvi__input_momentum(dvi__context *c, int input, dvi__node *momentum);
/* Derive a value by the chain rule, with the derivatives of its inputs by a rule. The rule refuses
 * an input by returning false. `axis` is the rule's. */
typedef bool dvi__input_rule(dvi__context *c, int input, dvi__span span, int axis, dvi__node *to);
dvi__value dvi__chain_rule(dvi__context *c, dvi__value value, dvi__span span, dvi__input_rule *rule,
                           int axis);
/* Tell if a call is d(..), grad(..), re(..) or im(..) in the scene of a density, and return its
 * value. */
bool dvi__is_word_of_field(const dvi__context *c, const dvi__expression *call);
dvi__value dvi__field_word_value(dvi__context *c, const dvi__expression *e);
/* Return the total derivative of a value along an axis of the density's domain. */
dvi__value dvi__derivative_along(dvi__context *c, dvi__value value, int axis, dvi__span span);
/* Return the momenta p(x) of a whole coordinate. Returns none for an argument of another form,
 * without a complaint. */
dvi__value dvi__whole_momentum(dvi__context *c, const dvi__expression *e);

#endif
