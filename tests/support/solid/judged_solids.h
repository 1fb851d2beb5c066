/* Solids for tests, each with its judge. */
#ifndef SUPPORT_SOLID_JUDGED_SOLIDS_H
#define SUPPORT_SOLID_JUDGED_SOLIDS_H
#include "support/solid/quad_solid.h"

/* What a solid has beside a material. */
enum {
  SOLID_LOADED = 1, /* a swinging force per volume of a part, and a pressure that depends on time */
  SOLID_MOVED = 2,  /* the side X = 0 swings, and one component is held at the bottom */
  SOLID_DAMPED = 4, /* Rayleigh's damping */
  SOLID_OF_TWO = 8  /* the second half, of random cells, is of another material */
};

typedef struct solid_case {
  int n, cells;
  double grading, jitter; /* of inner nodes, in shortest edges */
  dvi_elastic_law law;
  unsigned traits;
  int split;
  unsigned long long seed; /* of nodes and materials. 0: lambda = mu = rho = 1 */
} solid_case;

/* A mesh has the parts "soft" (cells), "left" (X = 0), "right" (X = 1) and "bottom" (the last
 * coordinate is 0). */
typedef struct judged_solid {
  dvi_mesh *mesh;
  dvi_elastic_material material[2];
  dvi_elastic *elastic;
  quad_solid judge;
} judged_solid;

judged_solid make_judged(const solid_case *of, const dvi_obstacle *obstacle, int obstacles);
void end_judged_solid(judged_solid *s);

/* Words for messages. They are valid until the next call. */
const char *name_solid(const solid_case *of);

/* Set u [size] to 0 and v to `size` times a turning start, both with what is given at t = 0. */
void start_judged(const judged_solid *s, double size, quad *u, quad *v);

/* Round [count] numbers to doubles, for free(). */
double *rounded(int count, const quad *x);

/* Give the largest |a_i - b_i|. */
double error_of_solid(int count, const double *a, const quad *b);

#endif
