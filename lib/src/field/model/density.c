/* The potential sum_v w_v V(x_v, q_v), evaluated in blocks without the heap. */
#include "field/model/field.h"

enum { BLOCK = 256 };

static void scale(int64_t count, const double *weight, const double *from, double *to)
{
  for (int64_t i = 0; i < count && to != NULL; i++) to[i] = weight[i] * from[i];
}

int dvi__field_density(const dvi_field *field, const double *q, int64_t first, int64_t last,
                       const dvi__density *density)
{
  const dvi_field_potential *V = &field->potential;
  double value[BLOCK] = {0}, slope[BLOCK], curvature[BLOCK];
  if (density->sum != NULL) *density->sum = 0;
  for (int64_t i = first; i < last; i += BLOCK) {
    const int64_t count = last - i < BLOCK ? last - i : BLOCK, at = i - first;
    const int failed = V->density(
        count, field->point + i * field->mesh->space, q + i, density->sum != NULL ? value : NULL,
        density->first != NULL ? slope : NULL, density->second != NULL ? curvature : NULL, V->user);
    if (failed != 0) return failed;
    for (int64_t j = 0; j < count && density->sum != NULL; j++)
      *density->sum += field->weight[i + j] * value[j];
    if (density->first != NULL) scale(count, field->weight + i, slope, density->first + at);
    if (density->second != NULL) scale(count, field->weight + i, curvature, density->second + at);
  }
  return 0;
}
