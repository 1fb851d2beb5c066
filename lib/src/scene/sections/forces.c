/* The sections forces, dissipation and damping. */
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"

static bool refuse_other_motions(dvi_scene *scene, const dvi__tree *section, const char *name)
{
  if (scene->terms.one_form == NULL && scene->terms.hamiltonian == NULL) return true;
  return dvi__scene_refuse(scene, section->span,
                           "beside a %s there is no %s; forces go with lagrangian, or kinetic and "
                           "potentials, of second degree in the velocities or more",
                           scene->form, name);
}

/* Take the place of the next force. */
static dvi_force *next_force(dvi_scene *scene)
{
  scene->terms.forces = scene->force;
  return &scene->force[scene->terms.force_count++];
}

bool dvi__read_forces(dvi_scene *scene, const dvi__tree *section)
{
  dvi__scene_term *term;
  if (!refuse_other_motions(scene, section, "forces")) return false;
  if (!dvi__field_read(scene, section,
                       DVI__MENTIONS_V | DVI__MENTIONS_T | DVI__MENTIONS_U | DVI__OF_STATE,
                       "a force", &term))
    return false;
  if (scene->control_count > 0 && !dvi__make_control_force(scene, term)) return false;
  return dvi__make_force(scene, term, next_force(scene));
}

bool dvi__read_dissipation(dvi_scene *scene, const dvi__tree *section)
{
  const dvi__expression *e;
  dvi__scene_term *term;
  dvi__kernels R = {0};
  dvi__degree degree = {.degree = 0};
  if (!dvi__refuse_factors(scene, section, "dissipation") ||
      !refuse_other_motions(scene, section, "dissipation"))
    return false;
  bool good = dvi__tree_expression(scene, section, &e) &&
              dvi__kernels_add(scene, DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_T,
                               "a dissipation", e, 1, &R) &&
              dvi__kernels_degree(scene, &R, DVI__VELOCITIES, &degree);
  if (good && degree.degree == 0)
    good = dvi__scene_refuse(scene, e->span, "there is no velocity in it, so that it has no force");
  good = good && dvi__kernels_function(scene, &R, 0, &term) &&
         dvi__make_dissipation(scene, term, next_force(scene));
  dvi__kernels_free(&R);
  return good;
}

bool dvi__read_damping(dvi_scene *scene, const dvi__tree *section)
{
  double *gamma = &scene->terms.damping;
  if (!refuse_other_motions(scene, section, "damping") ||
      !dvi__tree_number(scene, section, "damping", gamma))
    return false;
  return *gamma >= 0 || dvi__scene_refuse(scene, section->span,
                                          "damping must not be negative, and is %.17g", *gamma);
}
