/* Arithmetic of numbers, vectors and matrices of nodes. */
#ifndef DVI_SCENE_ELABORATE_SHAPE_H
#define DVI_SCENE_ELABORATE_SHAPE_H
#include "scene/elaborate/context.h"

#define DVI__NO_VALUE ((dvi__value){.shape = {-1, 0, 0}})

/* Return no value, after a complaint. dvi__failed tells such a value. */
static inline dvi__value dvi__refused(bool told)
{
  (void)told;
  return DVI__NO_VALUE;
}

static inline bool dvi__failed(dvi__value value)
{
  return value.shape.rank < 0;
}

static inline bool dvi__same_shape(dvi__shape a, dvi__shape b)
{
  return a.rank == b.rank && a.rows == b.rows && a.columns == b.columns;
}

/* Refuse a value of another shape. */
bool dvi__want_shape(const dvi__context *c, dvi__span span, dvi__shape found, dvi__shape right);

/* Return how many numbers a value has. dvi__value_at returns the i-th of them. */
int dvi__value_size(dvi__value value);
dvi__node dvi__value_at(dvi__value value, int i);

dvi__value dvi__number_value(dvi__node node);
/* Make a value with room for its nodes. */
dvi__value dvi__value_make(dvi__context *c, int rank, int rows, int columns);

/* Apply an operation to values. A message about shapes that do not fit points to `span`. */
dvi__value dvi__value_negate(dvi__context *c, dvi__value a);
dvi__value dvi__value_add(dvi__context *c, dvi__op op, dvi__value a, dvi__value b, dvi__span span);
dvi__value dvi__value_multiply(dvi__context *c, dvi__value a, dvi__value b, dvi__span span);
dvi__value dvi__value_divide(dvi__context *c, dvi__value a, dvi__value b, dvi__span span);
dvi__value dvi__value_power(dvi__context *c, dvi__value a, dvi__value b, dvi__span span);
/* Call a function of the language that is no operator. */
dvi__value dvi__value_call(dvi__context *c, const dvi__expression *call,
                           const dvi__value *argument);

#endif
