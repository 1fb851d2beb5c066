#include "field/forms/component.h"

#include "field/mesh/volume.h"
#include "num/simd/fused.h"

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

/* Columns a, b, .. of as many rows. */
FUSED_INLINE dvi__twofold minor_of_two(const dvi__twofold *first, const dvi__twofold *second, int a,
                                       int b)
{
  return dvi__twofold_less_product(dvi__twofold_times(first[a], second[b]), first[b], second[a]);
}

FUSED_INLINE dvi__twofold minor_of_three(const dvi__twofold *const *row, int a, int b, int c)
{
  const dvi__twofold ends = dvi__twofold_times(row[0][a], minor_of_two(row[1], row[2], b, c)),
                     most = dvi__twofold_add_product(ends, row[0][c],
                                                     minor_of_two(row[1], row[2], a, b));
  return dvi__twofold_less_product(most, row[0][b], minor_of_two(row[1], row[2], a, c));
}

FUSED_INLINE dvi__twofold minor_of_four(const dvi__twofold *const *row, const int *axis)
{
  const int a = axis[0], b = axis[1], c = axis[2], d = axis[3];
  dvi__twofold sum = dvi__twofold_times(row[0][a], minor_of_three(row + 1, b, c, d));
  sum = dvi__twofold_less_product(sum, row[0][b], minor_of_three(row + 1, a, c, d));
  sum = dvi__twofold_add_product(sum, row[0][c], minor_of_three(row + 1, a, b, d));
  return dvi__twofold_less_product(sum, row[0][d], minor_of_three(row + 1, a, b, c));
}

FUSED static double minor_in_twofolds(int k, const dvi__twofold *const *row, const int *axis)
{
  if (k == 0) return 1;
  if (k == 1) return row[0][axis[0]].head;
  if (k == 2) return minor_of_two(row[0], row[1], axis[0], axis[1]).head;
  if (k == 3) return minor_of_three(row, axis[0], axis[1], axis[2]).head;
  return minor_of_four(row, axis).head;
}

double dvi__exact_minor(int k, const dvi__twofold *const *row, const int *axis)
{
  return minor_in_twofolds(k, row, axis);
}
