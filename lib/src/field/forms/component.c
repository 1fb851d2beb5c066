#include "field/forms/component.h"

#include "field/mesh/volume.h"

int dvi_form_components(int space, int k)
{
  int count = 1;
  if (space < 1 || space > DVI_MESH_SPACE_MAX || k < 0 || k > space) return 0;
  for (int i = 0; i < k; i++) count = count * (space - i) / (i + 1);
  return count;
}

void dvi__first_axes(int k, int *axis)
{
  for (int i = 0; i < k; i++) axis[i] = i;
}

int dvi__next_axes(int space, int k, int *axis)
{
  int i = k - 1;
  while (i >= 0 && axis[i] == space - k + i) i--;
  if (i < 0) return 0;
  axis[i]++;
  for (i++; i < k; i++) axis[i] = axis[i - 1] + 1;
  return 1;
}

double dvi__minor(int k, const double *const *row, const int *axis)
{
  double matrix[DVI_MESH_DIMENSION_MAX * DVI_MESH_DIMENSION_MAX];
  for (int i = 0; i < k; i++)
    for (int j = 0; j < k; j++) matrix[i * k + j] = row[i][axis[j]];
  return dvi__determinant(k, matrix);
}
