/* Blocks that are thrown at obstacles, judged in quadruple precision. */
#ifndef TESTS_SUPPORT_SOLID_THROWS_H
#define TESTS_SUPPORT_SOLID_THROWS_H
#include "support/solid/judged_solids.h"
#include "support/solid/quad_contact.h"

/* A block that flies as a whole, turns if it does, and meets an obstacle with a corner. */
typedef struct thrown {
  judged_solid s;
  dvi_obstacle obstacle;
  double *u, *rate;  /* [size] the start */
  quad *end, *speed; /* [size] */
  double span;
  quad_hits hits;
} thrown;

thrown throw_block(const solid_case *of, const dvi_obstacle *obstacle, double turn, double span);
void end_throw(thrown *c);

#endif
