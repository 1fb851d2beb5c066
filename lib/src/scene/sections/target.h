/* Coordinates as keys of mappings. */
#ifndef DVI_SCENE_TARGET_H
#define DVI_SCENE_TARGET_H
#include "scene/elaborate/context.h"

/* x, x[3] or x[i], u[i,3], of a motion B.R or B.x; and of these the numbers, the velocities x',
 * omega(R) or rate(u), or the momenta p(x). */
typedef struct dvi__target {
  const dvi__coordinate *x;
  unsigned says;            /* DVI__SAYS_Q, _V or _P */
  dvi__subscripts index;    /* each a number, or the name in `each` */
  const char *each[2];      /* the index of a formula for all its values, or NULL */
  int fixed;                /* how many indices are numbers */
  const char *call;         /* "omega" or "rate", or NULL */
  const dvi__slots *places; /* in q, or in v and p */
  dvi__span span;
} dvi__target;

bool dvi__read_target(dvi_scene *scene, const dvi__tree *key, dvi__target *target);

/* In a context that dvi__context_make has made, elaborate what stands at a target: as many numbers
 * as it has, or as each of its members has, and where these are in q, v or p. */
bool dvi__target_value(dvi__context *c, const dvi__target *target, const dvi__tree *tree,
                       dvi__value *value, dvi__numbering *numbering, const dvi__expression **e);

/* How far number k of that value is from the first one. */
int dvi__target_place(const dvi__target *target, int k);

#endif
