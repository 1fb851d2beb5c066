/* Coordinates as keys of mappings. */
#ifndef DVI_SCENE_SECTIONS_TARGET_H
#define DVI_SCENE_SECTIONS_TARGET_H
#include "scene/elaborate/context.h"

/* A target x, x[3] or x[i], u[i,3], or B.R or B.x of a motion. It may stand for its numbers, for
 * the velocities x', omega(R) or rate(u), or for the momenta p(x). */
typedef struct dvi__target {
  const dvi__coordinate *x;
  unsigned mentions;        /* DVI__MENTIONS_Q, _V or _P */
  dvi__subscripts index;    /* each is a number, or the name in `each` */
  const char *each[2];      /* the index of a formula for all its values, or NULL */
  int fixed;                /* indices that are numbers */
  const char *call;         /* "omega" or "rate", or NULL */
  const dvi__slots *places; /* slots in q, or in v and p */
  dvi__span span;
} dvi__target;

bool dvi__read_target(dvi_scene *scene, const dvi__tree *key, dvi__target *target);

/* Elaborate the value of a target, in a context that dvi__context_make has made. The value has as
 * many numbers as the target, or as each of its members. Finds their places in q, v or p, too. */
bool dvi__target_value(dvi__context *c, const dvi__target *target, const dvi__tree *tree,
                       dvi__value *value, dvi__numbering *numbering, const dvi__expression **e);

/* Return how far number k of that value is from the first one. */
int dvi__target_place(const dvi__target *target, int k);

#endif
