/* The section schroedinger, a short form of a density.
 *
 * For a complex field psi = a + i b the density
 *
 *     l = hbar (b a' - a b') - hbar^2/(2 m) (|grad a|^2 + |grad b|^2) - V |psi|^2 - beta/2 |psi|^4
 *
 * is the real part of i hbar conj(psi) psi', less the energy. Its equation of motion is i hbar psi'
 * = -hbar^2/(2 m) laplace psi + (V + beta |psi|^2) psi (docs/fields/schroedinger.md). */
#include "expr/graph_make.h"
#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"

/* ---- what is given ---- */

/* Refuse a potential or an interaction that has the field. */
static bool check_inputs(dvi__context *c, dvi__span span, dvi__node node)
{
  char *used = dvi__arena_take(&c->scene->arena, (size_t)c->input_count + 1, 1);
  if (used == NULL) return dvi__scene_no_memory(c->scene);
  dvi__inputs_used(c->graph, 1, &node, c->input_count, used);
  for (int i = 0; i < c->input_count; i++) {
    const dvi__kernel_input *input = c->input + i;
    if (used[i] && !input->is_data && input->block == DVI__COORDINATES &&
        dvi__input_number(input, 0) >= c->scene->jets->dimension)
      return dvi__scene_refuse(c->scene, span,
                               "of 'schroedinger' this is a function of position and time, "
                               "without the field");
  }
  return true;
}

/* Keep V or beta as a function of its own. */
static bool keep_function(dvi__context *c, dvi__node node, dvi__local **local)
{
  dvi__kernels list = {0};
  if (!dvi__kernels_add_node(c, node, &list) || !dvi__local_make(c->scene, &list, local))
    return false;
  if ((*local)->term != NULL) (*local)->term->role = DVI__ROLE_AUXILIARY;
  return true;
}

/* Read an expression of position and time, a number if it is left out. */
static bool read_function(dvi__context *c, const dvi__tree *section, const char *name, double usual,
                          dvi__node *node)
{
  const dvi__expression *e;
  const dvi__tree *tree = dvi__tree_find(section, name);
  *node = dvi__constant(c->graph, usual);
  return tree == NULL || (dvi__tree_expression(c->scene, tree, &e) &&
                          dvi__elaborate_number(c, e, node) && check_inputs(c, tree->span, *node));
}

static bool read_positive(dvi_scene *scene, const dvi__tree *section, const char *name,
                          double *number)
{
  const dvi__tree *tree = dvi__tree_find(section, name);
  *number = 1;
  if (tree == NULL) return true;
  return dvi__tree_number(scene, tree, name, number) &&
         (*number > 0 ||
          dvi__scene_refuse(scene, tree->span, "%s must be positive, and is %.17g", name, *number));
}

/* ---- the density ---- */

static dvi__node variable(dvi__context *c, int block, int component, int axis)
{
  int order[3] = {0};
  if (axis >= 0) order[axis] = 1;
  const int number = dvi__jet_number(c->scene->jets, component, order);
  return dvi__variable_node(c, block, (dvi__numbering){.base = number}, 0);
}

/* Return hbar (b a' - a b'). */
static dvi__node one_form(dvi__context *c, double hbar)
{
  dvi__graph *g = c->graph;
  const dvi__node a = variable(c, DVI__COORDINATES, 0, -1),
                  b = variable(c, DVI__COORDINATES, 1, -1),
                  rate_a = variable(c, DVI__VELOCITIES, 0, -1),
                  rate_b = variable(c, DVI__VELOCITIES, 1, -1);
  return dvi__scale(g, hbar,
                    dvi__subtract(g, dvi__multiply(g, b, rate_a), dvi__multiply(g, a, rate_b)));
}

/* Return |grad a|^2 + |grad b|^2, or |psi|^2 for axis -1 alone. */
static dvi__node squares(dvi__context *c, int from, int to)
{
  dvi__node sum = dvi__constant(c->graph, 0);
  for (int axis = from; axis < to; axis++)
    for (int k = 0; k < 2; k++)
      sum = dvi__add(c->graph, sum, dvi__square(c->graph, variable(c, DVI__COORDINATES, k, axis)));
  return sum;
}

bool dvi__schroedinger_node(dvi__context *c, const dvi__tree *section, dvi__node *node)
{
  static const char *const known[] = {"potential", "interaction", "hbar", "mass"};
  dvi__graph *g = c->graph;
  struct dvi__scene_density *s = c->scene->density;
  dvi__node V, beta;
  if (!dvi__want_mapping(c->scene, section, "schroedinger") ||
      !dvi__want_keys(c->scene, section, "schroedinger", 4, known) ||
      !read_positive(c->scene, section, "hbar", &s->hbar) ||
      !read_positive(c->scene, section, "mass", &s->mass) ||
      !read_function(c, section, "potential", 0, &V) ||
      !read_function(c, section, "interaction", 0, &beta) || !keep_function(c, V, &s->potential) ||
      !keep_function(c, beta, &s->interaction))
    return false;
  const dvi__node norm = squares(c, -1, 0),
                  kinetic = dvi__scale(g, s->hbar * s->hbar / (2 * s->mass),
                                       squares(c, 0, c->scene->jets->dimension)),
                  interaction = dvi__multiply(g, dvi__scale(g, 0.5, beta), dvi__square(g, norm));
  *node = dvi__subtract(g, one_form(c, s->hbar), kinetic);
  *node = dvi__subtract(g, *node, dvi__multiply(g, V, norm));
  *node = dvi__subtract(g, *node, interaction);
  return true;
}
