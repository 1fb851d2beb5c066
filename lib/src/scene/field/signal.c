/* Functions of time: the factors of currents. */
#include "scene/field/maxwell.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

bool dvi__signal_read(dvi_scene *scene, const dvi__tree *tree, bool is_moment, dvi__signal **signal)
{
  const dvi__expression *e;
  dvi__kernels list = {0};
  dvi__signal *s = *signal = dvi__arena_take(&scene->arena, 1, sizeof *s);
  if (s == NULL) return dvi__scene_no_memory(scene);
  s->is_moment = is_moment;
  const bool good = dvi__tree_expression(scene, tree, &e) &&
                    dvi__kernels_add(scene, DVI__MENTIONS_T, "a function of time", e, 0, &list) &&
                    dvi__kernels_function(scene, &list, 0, &s->term);
  dvi__kernels_free(&list);
  if (!good) return false;
  s->term->role = DVI__ROLE_AUXILIARY;
  return dvi__make_potential(scene, "signal", s->term, &s->potential);
}

int dvi__signal_factor(double t, double *value, void *user)
{
  static const double nowhere[DVI__PLACE_NUMBERS];
  const dvi__signal *s = user;
  return s->potential.value_batch(1, &t, nowhere, value, s->potential.user);
}

int dvi__signal_value(double t, double *value, void *user)
{
  static const double nowhere[DVI__PLACE_NUMBERS];
  const dvi__signal *s = user;
  if (!s->is_moment) return dvi__signal_factor(t, value, user);
  return s->potential.rate_batch(1, &t, nowhere, value, s->potential.user);
}

/* A current is integrated by Gauss's rule with three points. */
int dvi__signal_impulse(double from, double to, double *value, void *user)
{
  static const double node[] = {-0.774596669241483377, 0, 0.774596669241483377},
                      weight[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  const dvi__signal *s = user;
  const double half = (to - from) / 2;
  double at[2], sum = 0;
  int failed;
  if (s->is_moment) {
    failed = dvi__signal_factor(from, at, user);
    if (failed == 0) failed = dvi__signal_factor(to, at + 1, user);
    *value = at[1] - at[0];
    return failed;
  }
  failed = 0;
  for (int i = 0; i < 3 && failed == 0; i++) {
    failed = dvi__signal_factor(from + half * (1 + node[i]), at, user);
    sum += weight[i] * at[0];
  }
  *value = 2 * half * sum;
  return failed;
}
