/* Point masses under Newton's gravity, L = sum m_a |v_a|^2/2 + sum_{a<b} G m_a m_b/|x_a - x_b|,
 * shared by several problems. */
#ifndef PROBLEMS_NBODY_H
#define PROBLEMS_NBODY_H
#include "problem.h"

#define NBODY_MAX 6
#define NBODY_PAIRS_MAX (NBODY_MAX * (NBODY_MAX - 1) / 2)

/* Masses and start. q holds body after body. */
typedef struct nbody {
  int bodies;    /* at most NBODY_MAX */
  int dimension; /* 2 or 3 */
  double G;
  double mass[NBODY_MAX];
  const char *name[NBODY_MAX];
  double position[NBODY_MAX][3], velocity[NBODY_MAX][3];
} nbody;

/* The outer solar system, the Sun last. */
extern const nbody outer_solar_bodies;

/* Allocate, label and fill the problem and create its system, with momenta and angular momenta as
 * symmetries. */
dvi_status nbody_make(const nbody *bodies, problem *made);

#endif
