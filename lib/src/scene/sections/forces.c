/* The sections forces, dissipation, damping and noise. */
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
  if (!refuse_other_motions(scene, section, "force")) return false;
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
  if (!refuse_other_motions(scene, section, "dissipation")) return false;
  bool good = dvi__tree_expression(scene, section, &e) &&
              dvi__kernels_add(scene,
                               DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_T | DVI__OF_STATE,
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
  if (!dvi__elastic_refuse_section(scene, section, "damping") ||
      !refuse_other_motions(scene, section, "damping") ||
      !dvi__tree_number(scene, section, "damping", gamma))
    return false;
  return *gamma >= 0 || dvi__scene_refuse(scene, section->span,
                                          "damping must not be negative, and is %.17g", *gamma);
}

/* ---- noise ---- */

static bool refuse_other_masses(dvi_scene *scene, const dvi__tree *section)
{
  const dvi_system_terms *terms = &scene->terms;
  if (!dvi__refuse_factors(scene, section, "noise")) return false;
  if (terms->nonholonomic_count + terms->contact_count > 0 || terms->damping > 0)
    return dvi__scene_refuse(
        scene, section->span,
        "beside nonholonomic constraints, contacts and damping there is no noise");
  return (terms->lagrangian == NULL && terms->one_form == NULL && terms->hamiltonian == NULL) ||
         dvi__scene_refuse(scene, section->span,
                           "noise needs a constant mass, and that of this scene is none");
}

/* Read a number that may not be negative. Noise functions alone need no bath. */
static bool read_strength(dvi_scene *scene, const dvi__tree *section, const char *name,
                          double *number)
{
  const dvi__tree *tree = dvi__tree_find(section, name);
  *number = 0;
  if (tree == NULL && dvi__tree_find(section, "functions") != NULL) return true;
  if (tree == NULL)
    return dvi__scene_refuse(
        scene, section->span,
        "noise needs a temperature and a friction, as in {temperature: 1, friction: 0.5, seed: 7}");
  if (!dvi__tree_number(scene, tree, name, number)) return false;
  return *number >= 0 ||
         dvi__scene_refuse(scene, tree->span, "a %s cannot be negative, and this one is %.17g",
                           name, *number);
}

/* Read a whole number, 0 if it is left out. */
static bool read_label(dvi_scene *scene, const dvi__tree *section, const char *name, int *number)
{
  const dvi__tree *tree = dvi__tree_find(section, name);
  *number = 0;
  return tree == NULL || dvi__tree_whole(scene, tree, name, 0, number);
}

static bool read_noise_function(dvi_scene *scene, const dvi__tree *key, const dvi__tree *tree,
                                dvi_potential *function)
{
  const dvi__expression *e;
  dvi__scene_term *term;
  dvi__kernels h = {0};
  dvi__degree degree = {.degree = 0};
  bool good = dvi__want_name(scene, key->text, key->span) &&
              dvi__tree_expression(scene, tree, &e) &&
              dvi__kernels_add(scene, DVI__MENTIONS_Q, "a noise function", e, 0, &h) &&
              dvi__kernels_degree(scene, &h, DVI__COORDINATES, &degree);
  if (good && degree.degree == 0)
    good = dvi__scene_refuse(scene, e->span, "a noise function of no coordinate has no force");
  good = good && dvi__kernels_function(scene, &h, 0, &term) &&
         dvi__make_potential(scene, key->text, term, function);
  function->rate_batch = NULL;
  dvi__kernels_free(&h);
  return good;
}

static bool read_noise_functions(dvi_scene *scene, const dvi__tree *section)
{
  const dvi__tree *list = dvi__tree_find(section, "functions");
  dvi_noise *noise = &scene->noise;
  if (list == NULL) return true;
  if (!dvi__want_mapping(scene, list, "functions")) return false;
  dvi_potential *functions = dvi__arena_take(&scene->arena, (size_t)list->count + 1,
                                             sizeof *functions);
  if (functions == NULL) return dvi__scene_no_memory(scene);
  for (int k = 0; k < list->count; k++)
    if (!read_noise_function(scene, list->key[k], list->child[k], &functions[k])) return false;
  noise->function_count = list->count;
  if (list->count > 0) noise->functions = functions;
  return true;
}

bool dvi__read_noise(dvi_scene *scene, const dvi__tree *section)
{
  static const char *const known[] = {"temperature", "friction", "seed", "stream", "functions"};
  dvi_noise *noise = &scene->noise;
  int seed, stream;
  if (!dvi__want_mapping(scene, section, "noise") ||
      !dvi__want_keys(scene, section, "noise", 5, known) || !refuse_other_masses(scene, section) ||
      !read_strength(scene, section, "temperature", &noise->temperature) ||
      !read_strength(scene, section, "friction", &noise->friction) ||
      !read_label(scene, section, "seed", &seed) ||
      !read_label(scene, section, "stream", &stream) || !read_noise_functions(scene, section))
    return false;
  noise->seed = (unsigned long long)seed;
  noise->stream = (unsigned)stream;
  scene->terms.noise = noise;
  return true;
}
