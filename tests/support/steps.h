/* Asynchronous steps of meshes, for tests. */
#ifndef TESTS_SUPPORT_STEPS_H
#define TESTS_SUPPORT_STEPS_H
#include "field/avi/avi.h"

/* A mesh with its star, and the terms of a k-form on it. */
typedef struct stepped {
  dvi_mesh *mesh;
  dvi_star *star;
  int k;
  int64_t edges, faces, nodes;
  int8_t *is_fixed; /* [edges], the boundary if it is fixed */
  dvi__avi_terms terms;
} stepped;

/* Take a mesh, which the result owns then. */
stepped stepped_mesh(dvi_mesh *mesh, int k, int is_fixed);
void end_stepped(stepped *s);

/* A generated mesh with the same number of cells along each axis. */
dvi_mesh *grid_mesh(const char *name, int dimension, int cells, double grading);

/* Give the rectangles of a mesh steps of fraction/sqrt(1/hx^2 + 1/hy^2), or the largest powers of 2 of
 * the shortest of them that are not longer. */
void step_of_boxes(const dvi_mesh *mesh, double fraction, int is_free, double *step);

/* Start with random E, and A = 0. */
void start_at_random(const stepped *s, dvi__avi *avi, unsigned long long seed);

dvi__avi *avi_of(const dvi__avi_terms *terms);
double energy_of(const dvi__avi *avi);
void advance_to(dvi__avi *avi, double t);

#endif
