/* Meshes by the library's generators, for tests. */
#ifndef TESTS_SUPPORT_FIELD_GENERATED_H
#define TESTS_SUPPORT_FIELD_GENERATED_H
#include <dvi/mesh.h>

dvi_mesh *generated(const char *name, dvi_generator_options options);

/* A mesh with the same number of cells, and the same grading, along each axis. */
dvi_mesh *grid_mesh(const char *name, int dimension, int cells, double grading);

#endif
