#include "field/mesh/faces.h"

int dvi__corners_of_set(int set, int *corner)
{
  int count = 0;
  for (int c = 0; c < DVI__SIMPLEX_CORNERS; c++)
    if (set >> c & 1) corner[count++] = c;
  return count;
}

void dvi__number_faces(const dvi_mesh *mesh, int64_t cell, int64_t number[DVI__CORNER_SETS])
{
  const int whole = (1 << (mesh->n + 1)) - 1;
  number[whole] = cell;
  for (int set = whole; set > 0; set--) {
    int corner[DVI__SIMPLEX_CORNERS];
    const int k = dvi__corners_of_set(set, corner) - 1;
    for (int j = 0; j <= k && k > 1; j++)
      number[set & ~(1 << corner[j])] = mesh->facet[k][number[set] * (k + 1) + j];
    for (int j = 0; j < 2 && k == 1; j++)
      number[1 << corner[j]] = mesh->corner[1][number[set] * 2 + j];
  }
}
