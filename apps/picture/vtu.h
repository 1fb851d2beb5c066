/** Grids of cells with values, as dvi writes them to .vtu files. */
#ifndef VTU_H
#define VTU_H
#include <stdbool.h>
#include <stdint.h>

enum { VTU_FIELDS = 256, VTU_NAME = 64, VTU_CORNERS = 8 };

/** Kinds of cells, by their numbers in VTK. */
typedef enum vtu_cell {
  VTU_LINE = 3,
  VTU_TRIANGLE = 5,
  VTU_PIXEL = 8, /**< a rectangle, with its corners in the order of bits */
  VTU_TETRAHEDRON = 10,
  VTU_VOXEL = 11 /**< a box, with its corners in the order of bits */
} vtu_cell;

/** Values at the points or in the cells. Those of vectors are their lengths, and their components
 * are fields of their own: E, E_x, E_y. */
typedef struct vtu_field {
  char name[VTU_NAME];
  bool is_by_cell;
  double *value; /**< [points] or [cells] */
} vtu_field;

/** A grid. */
typedef struct vtu_grid {
  vtu_cell kind;
  int corners; /**< of a cell */
  int64_t points, cells;
  double *point;   /**< [points*3] */
  int64_t *vertex; /**< [cells*corners] */
  int fields;
  vtu_field field[VTU_FIELDS];
} vtu_grid;

/** Read a file. Returns DONE, or complains and returns FAILED. */
int vtu_read(const char *path, vtu_grid *g);

/** A file that is read in parts. */
typedef struct vtu_file vtu_file;

/** Open a file, whose path lasts as long. Complains and returns NULL if that fails. */
vtu_file *vtu_open(const char *path);

/** Read the grid without fields. Complains and returns false if that fails. */
bool vtu_read_grid(const vtu_file *file, vtu_grid *g);

/** Read rows of the values at the points or in the cells: numbers [rows][components]. Complains and
 * returns false if that fails. */
bool vtu_read_rows(const vtu_file *file, bool is_by_cell, const char *name, int64_t first,
                   int64_t rows, double *number);

void vtu_close(vtu_file **file);

/** Add numbers [points or cells][components] as a field, and the components of vectors as fields,
 * too, as far as there is room. Complains and returns false without memory. */
bool vtu_add_fields(vtu_grid *g, const char *name, bool is_by_cell, int components,
                    const double *number);

/** Return the number of corners of a kind of cells, or 0 if it is none of these. */
int vtu_corners(int kind);

/** Return why the points and cells are none of a grid, or NULL if they are. */
const char *vtu_flaw(const vtu_grid *g);

/** Return the field of a name, or NULL. */
const vtu_field *vtu_find(const vtu_grid *g, const char *name);

void vtu_clear(vtu_grid *g);
#endif
