/* Meshes for tests, made without the library's generators. */
#ifndef TESTS_SUPPORT_MESHES_H
#define TESTS_SUPPORT_MESHES_H
#include <dvi/mesh.h>

/* Return a number between 0 and 1 of a sequence that *state continues. */
double random_number(unsigned long long *state);

/* Kuhn's simplices of cells^n cubes in the unit cube of dimension n, with inner points moved at
 * random by up to `jitter` edges. In `space` coordinates, of which the last ones are 0. */
dvi_mesh *jittered_mesh(int n, int space, int cells, double jitter, unsigned long long seed);

/* One simplex with random corners in [0,1]^space, n <= space. */
dvi_mesh *random_simplex(int n, int space, const double *metric, unsigned long long seed);

/* The triangles of `across` by `up` strips of the unit square, whose odd rows are staggered by
 * half of an edge. */
dvi_mesh *staggered_mesh(int across, int up);

/* A circle of length 1 with this many points, moved at random by up to `jitter` edges. */
dvi_mesh *ring_mesh(int points, double jitter, unsigned long long seed);

/* Equilateral triangles with sides of 1/across, in a rectangle of length 1 that repeats itself.
 * The number of rows, `up`, is even. */
dvi_mesh *equilateral_torus(int across, int up);

#endif
