/* Marches of a scene with a density. */
#include <dvi/scene.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

static bool is_lattice(const char *method)
{
  const size_t length = strcspn(method, ":");
  return length == strlen("multisymplectic") && strncmp(method, "multisymplectic", length) == 0;
}

bool dvi__density_marches(const dvi_scene *scene, const char *method)
{
  return dvi__equation_marches(scene, method) || (!scene->density->is_static && is_lattice(method));
}

const char *dvi_scene_march_refused(const dvi_scene *scene, const char *method,
                                    const char **section)
{
  if (!dvi_scene_marches(scene, method) || scene->density == NULL) return NULL;
  if (method == NULL) method = scene->plan.method;
  return is_lattice(method) ? dvi__lattice_refused(scene, section)
                            : dvi__equation_refused(scene, section);
}

int dvi_scene_march_order(const dvi_scene *scene, const char *method)
{
  if (!dvi_scene_marches(scene, method)) return 0;
  if (scene->density == NULL) return 2;
  if (method == NULL) method = scene->plan.method;
  if (!is_lattice(method)) return dvi__equation_order(method);
  return dvi__lattice_is_semidiscrete(scene, method) ? 2 : 0;
}

dvi_status dvi__density_march(const dvi_scene *scene, const dvi_march_options *options,
                              dvi_march **march)
{
  const char *section;
  if (dvi_scene_march_refused(scene, options->method, &section) != NULL) return DVI_UNSUPPORTED;
  return is_lattice(options->method) ? dvi__lattice_march(scene, options, march)
                                     : dvi__equation_march(scene, options, march);
}

dvi_status dvi_scene_march_laws(const dvi_scene *scene, const dvi_march_options *options, int steps,
                                dvi_law *law, int *count)
{
  const char *section;
  if (scene == NULL || options == NULL || law == NULL || count == NULL) return DVI_BAD_ARGUMENT;
  if (dvi__is_elastic(scene)) return dvi__elastic_laws(scene, options, steps, law, count);
  if (scene->density == NULL)
    return dvi_field_laws(dvi_scene_field(scene), options, steps, law, count);
  if (options->method == NULL || !dvi__density_marches(scene, options->method) ||
      dvi_scene_march_refused(scene, options->method, &section) != NULL)
    return DVI_UNSUPPORTED;
  return (is_lattice(options->method) ? dvi__lattice_laws : dvi__equation_laws)(scene, options,
                                                                                steps, law, count);
}

/* ---- the state ---- */

/* Give the coordinates and velocities of values at the vertices, and the momenta of these. Those of
 * fields of first order are functions of the coordinates. */
static dvi_status find_state(const dvi_scene *scene, const dvi_march *march, double *U, double *q,
                             double *p)
{
  const int64_t values = dvi_march_size(march, DVI_FORM_A);
  double *const rate = U + values, *const v = rate + values;
  const dvi_system *system = dvi_scene_system(scene);
  dvi_status status = dvi_march_sample(march, DVI_FORM_A, 0, NULL, U);
  if (status == DVI_OK && dvi_march_size(march, DVI_FORM_E) == 0)
    return dvi_density_project(scene->density->density, U, NULL, q, v, p);
  if (status == DVI_OK) status = dvi_march_sample(march, DVI_FORM_E, 0, NULL, rate);
  for (int64_t i = 0; i < values; i++) rate[i] = -rate[i];
  if (status == DVI_OK) status = dvi_density_project(scene->density->density, U, rate, q, v, NULL);
  if (status != DVI_OK || p == NULL) return status;
  return system != NULL ? dvi_system_momentum(system, dvi_march_time(march), q, v, p)
                        : DVI_UNSUPPORTED;
}

dvi_status dvi__density_march_state(const dvi_scene *scene, const dvi_march *march, double *q,
                                    double *p)
{
  const size_t values = (size_t)dvi_march_size(march, DVI_FORM_A);
  double *U = dvi__heap_take(2 * values + (size_t)scene->n, sizeof *U);
  if (U == NULL) return DVI_NO_MEMORY;
  const dvi_status status = find_state(scene, march, U, q, p);
  dvi__heap_free(U);
  return status;
}

/* ---- columns ---- */

/* Tell if a name is "position_x" or "momentum_x" of an axis. */
static bool is_of_axis(const struct dvi__scene_density *s, const char *name, bool *is_periodic)
{
  static const char *const start[] = {"momentum_", "position_"};
  enum { LENGTH = 9 };
  const bool fits = strncmp(name, start[0], LENGTH) == 0 || strncmp(name, start[1], LENGTH) == 0;
  for (int d = 0; d < s->jets.dimension; d++)
    if (fits && strcmp(name + LENGTH, s->jets.axis[d]) == 0) {
      *is_periodic = s->mesh == NULL && s->axis[d].periodic && name[0] == 'm';
      return true;
    }
  return false;
}

bool dvi__density_has_column(const dvi_scene *scene, const char *name)
{
  static const char *const of_equation[] = {"norm", "kinetic", "potential", "interaction"};
  const struct dvi__scene_density *s = scene->density;
  bool is_periodic = false;
  if (is_of_axis(s, name, &is_periodic)) return s->equation != NULL || is_periodic;
  for (int i = 0; i < s->symmetries; i++)
    if (strcmp(s->symmetry[i].name, name) == 0) return true;
  for (size_t k = 0; s->equation != NULL && k < sizeof of_equation / sizeof *of_equation; k++)
    if (strcmp(of_equation[k], name) == 0) return true;
  return false;
}
