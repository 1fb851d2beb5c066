/* Meshes that are read from files in parts. */
#ifndef TESTS_PETSC_PARTS_H
#define TESTS_PETSC_PARTS_H
#include <dvi/mesh.h>
#include <stddef.h>

/* Give all processes the same path of a file of this run. */
void parts_path(char *text, size_t size, const char *name);

/* Compare shares that are read with those that are cut out of the whole mesh. */
void check_parts(void);

/* Try files that are refused, and failures. */
void check_refused_parts(void);

/* Count what is different in two meshes: 0 if they are the same. */
int share_differs(const dvi_mesh *a, const dvi_mesh *b);

#endif
