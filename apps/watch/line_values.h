/** Values at the vertices of a mesh on a line, of which each process has a share. */
#ifndef LINE_VALUES_H
#define LINE_VALUES_H
#include <dvi/mesh.h>
#include <stdbool.h>

/** What processes give each other. */
typedef struct line_values {
  const dvi_mesh *mesh;
  int64_t vertices; /**< of the whole mesh */
  size_t numbers;   /**< of a message: how many vertices a process owns, their numbers and values */
  double *own, *all; /**< [numbers] and [processes*numbers], NULL without other processes */
} line_values;

/** Begin with a mesh or its share, on all processes. Complains and returns false if that fails, on
 * all of them. */
bool line_values_start(line_values *line, const dvi_mesh *mesh);
void line_values_clear(line_values *line);

/** Give the values [vertices] of the whole mesh, of those of the share. Called on all processes.
 * Complains and returns false if they cannot speak with each other. */
bool line_values_gather(line_values *line, const double *value, double *whole);
#endif
