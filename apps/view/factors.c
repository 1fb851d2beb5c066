#include "view/factors.h"

const dvi_factor *factor_of(const problem *scene, int i)
{
  static const int width[] = {[DVI_SO3] = 9, [DVI_SE3] = 12, [DVI_S2] = 3, [DVI_U1] = 2};
  int end = 0;
  for (int k = 0; k < scene->terms->factor_count; k++) {
    const dvi_factor *factor = &scene->terms->factors[k];
    end += factor->kind == DVI_RN ? factor->size : width[factor->kind];
    if (i < end) return factor;
  }
  return NULL;
}

bool is_of_direction(const problem *scene, int i)
{
  const dvi_factor *factor = factor_of(scene, i);
  return factor != NULL && (factor->kind == DVI_S2 || factor->kind == DVI_U1);
}
