/* Solids among obstacles in quadruple precision: the motion of quad_solid, stopped at each hit. */
#ifndef SUPPORT_SOLID_QUAD_CONTACT_H
#define SUPPORT_SOLID_QUAD_CONTACT_H
#include "support/solid/quad_solid.h"

enum { QUAD_HITS_MOST = 64 };

typedef struct quad_hits {
  int count, node[QUAD_HITS_MOST];
  quad t[QUAD_HITS_MOST];
} quad_hits;

/* Give the gap of a node, and its outer normal [3]. Normals of planes have length 1 then. */
quad quad_gap(const quad_solid *s, const dvi_obstacle *o, int node, const quad *u, quad *normal);

/* Advance u and v from 0 to t. Hits are looked for at the ends of `pieces` pieces of this time, and
 * the first one of a piece is found by Newton's method. `hits` may be NULL. */
void quad_solid_advance_among(const quad_solid *s, const dvi_obstacle *obstacle, int obstacles,
                              quad t, int pieces, quad *u, quad *v, quad_hits *hits);

#endif
