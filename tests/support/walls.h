/* Systems with contacts, whose hits are known. */
#ifndef SUPPORT_WALLS_H
#define SUPPORT_WALLS_H
#include <dvi/dvi.h>

/* What moves, and between which walls. */
typedef enum walls_place {
  WALLS_PENDULUM, /* -cos x, wall at x = 0.8 */
  WALLS_CIRCLE,   /* a ball of gravity 9.81 in the unit circle */
  WALLS_POLAR,    /* the same in polar coordinates, by a general Lagrangian */
  WALLS_DROP,     /* a ball above a floor */
  WALLS_CHANNEL,  /* a free particle between 0 and 1 */
  WALLS_MOVING,   /* a free particle above a floor at 0.5 t */
  WALLS_FAST,     /* L = -sqrt(1 - v^2) between 0 and 1 */
  WALLS_WEDGE,    /* a free particle above y = 0 and below 0.6 x = 0.8 y */
  WALLS_CORNER,   /* a free particle in the quadrant x, y > 0 */
  WALLS_STONE,    /* a free particle outside of the unit circle */
  WALLS_HILL,     /* a particle of gravity 9.81 outside of the unit circle */
  WALLS_ROUND,    /* the same in polar coordinates, by a general Lagrangian */
  WALLS_PRESSED,  /* -cos x, wall at x = 0.3, against which the pendulum falls */
  WALLS_TABLE,    /* a ball of gravity 9.81 above a floor, left of a wall at x = 1 */
  WALLS_SLOPE,    /* the same above the slope y = -0.3 x */
  WALLS_RAMP,     /* the same as the table, with a wall x = 1 + y/2 that lifts */
  WALLS_NOOK,     /* the same as the table, with a force of 3 along x */
  WALLS_LIFT      /* a ball above a floor that moves by sin(t) */
} walls_place;

/* Create a system whose contacts have this restitution. Those of the second function may be
 * held. */
dvi_system *create_walls(walls_place place, double restitution);
dvi_system *create_holding_walls(walls_place place, double restitution);

#endif
