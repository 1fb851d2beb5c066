/* What stands in a file of a mesh that is read in parts (docs/fields/shares.md, "Meshes in parts").
 */
#ifndef DVI_PETSC_MESH_FILE_H
#define DVI_PETSC_MESH_FILE_H
#include <dvi/mesh.h>

#include "slabs.h"

enum { DVI__PART_PATH = 64, DVI__PART_NAME = 1024 };

/* What all processes know of the mesh. */
typedef struct dvi__mesh_head {
  dvi_cell_kind kind;
  int n, space, corners;
  int is_oriented;
  int parts;                                 /* "all", which is not in the file, included */
  int64_t count[DVI_MESH_DIMENSION_MAX + 1]; /* of the k-cells */
  double metric[DVI_MESH_SPACE_MAX], period[DVI_MESH_SPACE_MAX];
} dvi__mesh_head;

dvi_status dvi__read_head(const dvi__slabs *file, dvi__mesh_head *head);

/* Write the paths of part p, parts/P and what is added, and of its k-cells. Return `path`. */
const char *dvi__part_path(char path[DVI__PART_PATH], int p, const char *added);
const char *dvi__cells_path(char path[DVI__PART_PATH], int p, int k);

#endif
