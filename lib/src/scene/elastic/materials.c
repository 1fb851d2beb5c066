/* The section materials of a solid: laws and constants, by part of the mesh. */
#include <math.h>
#include <string.h>

#include "scene/elastic/scene_elastic.h"
#include "scene/sections/sections.h"

static const char *const law_word[] = {"linear", "svk", "neo-hookean", "mooney-rivlin"};
static const dvi_elastic_law law_of[] = {DVI_ELASTIC_LINEAR, DVI_ELASTIC_SVK,
                                         DVI_ELASTIC_NEO_HOOKEAN, DVI_ELASTIC_MOONEY_RIVLIN};
enum { LAWS = sizeof law_word / sizeof *law_word };

bool dvi__solid_number(dvi_scene *scene, const dvi__tree *tree, const char *what, bool may_vanish,
                       double *number)
{
  if (!dvi__tree_number(scene, tree, what, number)) return false;
  return (isfinite(*number) && (*number > 0 || (may_vanish && *number == 0))) ||
         dvi__scene_refuse(scene, tree->span, "%s is %g, where a number %s is wanted", what,
                           *number, may_vanish ? "of at least 0" : "above 0");
}

/* Read a number that may be left out. */
static bool read_optional(dvi_scene *scene, const dvi__tree *material, const char *name,
                          bool may_vanish, double usual, double *number)
{
  const dvi__tree *tree = dvi__tree_find(material, name);
  *number = usual;
  return tree == NULL || dvi__solid_number(scene, tree, name, may_vanish, number);
}

/* ---- constants ---- */

/* Lame's constants, with lambda > -2 mu/n, for which the energy is least at rest. */
static bool read_lame(dvi_scene *scene, const dvi__tree *lambda, const dvi__tree *mu,
                      dvi_elastic_material *m)
{
  const int n = scene->field->space;
  if (!dvi__tree_number(scene, lambda, "lambda", &m->lambda) ||
      !dvi__solid_number(scene, mu, "mu", false, &m->mu))
    return false;
  return (m->lambda > -2 * m->mu / n && m->lambda < HUGE_VAL) ||
         dvi__scene_refuse(scene, lambda->span,
                           "lambda is %g, where a number above -2 mu/%d is "
                           "wanted, here %g",
                           m->lambda, n, -2 * m->mu / n);
}

static bool read_young(dvi_scene *scene, const dvi__tree *young, const dvi__tree *poisson,
                       dvi_elastic_material *m)
{
  double E, nu;
  if (!dvi__solid_number(scene, young, "young", false, &E) ||
      !dvi__tree_number(scene, poisson, "poisson", &nu))
    return false;
  m->mu = E / (2 * (1 + nu));
  m->lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  return (nu > -1 && nu < 0.5) ||
         dvi__scene_refuse(scene, poisson->span,
                           "poisson is %g, where a number above -1 and below 0.5 is wanted", nu);
}

/* Read one of the two pairs of constants. */
static bool read_constants(dvi_scene *scene, const dvi__tree *tree, dvi_elastic_material *m)
{
  const dvi__tree *lambda = dvi__tree_find(tree, "lambda"), *mu = dvi__tree_find(tree, "mu"),
                  *young = dvi__tree_find(tree, "young"),
                  *poisson = dvi__tree_find(tree, "poisson");
  const bool is_lame = lambda != NULL && mu != NULL, is_young = young != NULL && poisson != NULL;
  const int count = (lambda != NULL) + (mu != NULL) + (young != NULL) + (poisson != NULL);
  if (count != 2 || is_lame == is_young)
    return dvi__scene_refuse(scene, tree->span,
                             "a material has lambda and mu, or young and poisson, as in '{law: "
                             "neo-hookean, young: 1e6, poisson: 0.3, rho: 1000}'");
  if (!(is_lame ? read_lame(scene, lambda, mu, m) : read_young(scene, young, poisson, m)))
    return false;
  const dvi__tree *mooney = dvi__tree_find(tree, "mooney");
  if (mooney == NULL) return true;
  if (m->law != DVI_ELASTIC_MOONEY_RIVLIN)
    return dvi__scene_refuse(scene, mooney->span, "'mooney' is of 'law: mooney-rivlin'");
  return dvi__solid_number(scene, mooney, "mooney", true, &m->mooney) &&
         (m->mooney <= m->mu || dvi__scene_refuse(scene, mooney->span,
                                                  "mooney is %g, where a number from 0 to mu, here "
                                                  "%g, is wanted",
                                                  m->mooney, m->mu));
}

/* ---- laws ---- */

/* Return the law of a word, or that of an energy for any other text. */
static dvi_elastic_law find_law(const dvi__tree *tree)
{
  for (int k = 0; k < LAWS; k++)
    if (tree->kind == DVI__SCALAR && strcmp(tree->text, law_word[k]) == 0) return law_of[k];
  return DVI_ELASTIC_ENERGY;
}

/* A lone name that means nothing is a law that there is not. */
static bool is_unknown_word(const dvi_scene *scene, const dvi__tree *tree)
{
  const char *text = tree->text;
  if (tree->kind != DVI__SCALAR || strspn(text, "0123456789.") > 0) return false;
  for (const char *at = text; *at != '\0'; at++)
    if (strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_- .'", *at) == NULL)
      return false;
  return dvi__names_find(&scene->names, text) == NULL;
}

static bool read_energy(dvi_scene *scene, const dvi__tree *law, const dvi__tree *tree,
                        dvi_elastic_material *m)
{
  static const char *const known[] = {"law", "rho", "alpha", "beta"};
  dvi__solid_function *W;
  int which;
  if (is_unknown_word(scene, law))
    return dvi__tree_word(scene, law, "a law", LAWS, law_word, &which);
  if (!dvi__want_keys(scene, tree, "a material with a stored energy", 4, known) ||
      !dvi__solid_function_read(scene, law, DVI__SOLID_ENERGY, 1, "a stored energy", &W))
    return false;
  m->energy = dvi__solid_energy;
  m->user = W;
  return true;
}

static bool read_material(dvi_scene *scene, const char *part, dvi__span span, const dvi__tree *tree)
{
  static const char *const known[] = {"law",    "lambda", "mu",    "young", "poisson",
                                      "mooney", "rho",    "alpha", "beta"};
  struct dvi__scene_elastic *s = scene->field->elastic;
  dvi_elastic_material *m = s->material + s->materials;
  if (!dvi__has_part_of_cells(scene->field->mesh, part))
    return dvi__refuse_part(scene, span, part, true);
  if (!dvi__want_mapping(scene, tree, "a material") ||
      !dvi__want_keys(scene, tree, "a material", 9, known))
    return false;
  const dvi__tree *law = dvi__tree_find(tree, "law");
  if (law == NULL)
    return dvi__scene_refuse(scene, tree->span,
                             "a material has a law: linear, svk, neo-hookean, mooney-rivlin, or a "
                             "stored energy as an expression of F, I1, I2 and J");
  s->material_span[s->materials++] = tree->span;
  *m = (dvi_elastic_material){.part = part, .law = find_law(law)};
  const bool is_given = m->law == DVI_ELASTIC_ENERGY;
  return (is_given ? read_energy(scene, law, tree, m) : read_constants(scene, tree, m)) &&
         read_optional(scene, tree, "rho", false, 1, &m->rho) &&
         read_optional(scene, tree, "alpha", true, 0, &m->alpha) &&
         read_optional(scene, tree, "beta", true, 0, &m->beta);
}

bool dvi__elastic_read_materials(dvi_scene *scene, const dvi__tree *section)
{
  struct dvi__scene_elastic *s = scene->field->elastic;
  const size_t room = (size_t)section->count + 1;
  s->material = dvi__arena_take(&scene->arena, room, sizeof *s->material);
  s->material_span = dvi__arena_take(&scene->arena, room, sizeof *s->material_span);
  if (s->material == NULL || s->material_span == NULL) return dvi__scene_no_memory(scene);
  return dvi__read_all_first(scene, section, read_material);
}
