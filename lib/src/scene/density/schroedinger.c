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

/* Keep a function of position and time for the equation. */
static bool keep_function(dvi__context *c, dvi__node node, dvi__local **local)
{
  dvi__kernels list = {0};
  if (!dvi__kernels_add_node(c, node, &list) || !dvi__local_make(c->scene, &list, local))
    return false;
  if ((*local)->term != NULL) (*local)->term->role = DVI__ROLE_AUXILIARY;
  return true;
}

/* Read the dimension in which x is the distance from the origin. */
static bool read_radial(dvi_scene *scene, const dvi__tree *section, int *radial)
{
  const dvi__tree *tree = dvi__tree_find(section, "radial");
  const struct dvi__scene_density *s = scene->density;
  *radial = 0;
  if (tree == NULL) return true;
  return dvi__tree_whole(scene, tree, "radial", 2, radial) &&
         ((*radial <= 3 && s->mesh == NULL && s->jets.dimension == 1 && !(s->axis[0].from < 0) &&
           !s->axis[0].periodic) ||
          dvi__scene_refuse(scene, tree->span,
                            "radial is the dimension 2 or 3 of a space in which the one axis, from "
                            "0 on and not periodic, is the distance from the origin"));
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

/* Multiply by the measure 2 pi x or 4 pi x^2. */
static dvi__node with_measure(dvi__graph *g, dvi__node x, int radial, dvi__node l)
{
  static const double pi = 3.14159265358979323846;
  if (radial == 0) return l;
  const dvi__node measure = radial == 2 ? dvi__scale(g, 2 * pi, x)
                                        : dvi__scale(g, 4 * pi, dvi__square(g, x));
  return dvi__multiply(g, measure, l);
}

static bool read_equation(dvi__context *c, const dvi__tree *section, struct dvi__equation *e,
                          dvi__node *V, dvi__node *beta)
{
  static const char *const known[] = {"potential", "interaction", "hbar", "mass", "radial"};
  return dvi__want_mapping(c->scene, section, "schroedinger") &&
         dvi__want_keys(c->scene, section, "schroedinger", 5, known) &&
         read_positive(c->scene, section, "hbar", &e->hbar) &&
         read_positive(c->scene, section, "mass", &e->mass) &&
         read_radial(c->scene, section, &e->radial) &&
         read_function(c, section, "potential", 0, V) &&
         read_function(c, section, "interaction", 0, beta) && keep_function(c, *V, &e->potential) &&
         keep_function(c, *beta, &e->interaction);
}

bool dvi__schroedinger_node(dvi__context *c, const dvi__tree *section, dvi__node *node)
{
  dvi_scene *scene = c->scene;
  dvi__graph *g = c->graph;
  dvi__node V, beta;
  struct dvi__equation *e = dvi__arena_take(&scene->arena, 1, sizeof *e);
  if (e == NULL) return dvi__scene_no_memory(scene);
  if (!read_equation(c, section, e, &V, &beta)) return false;
  scene->density->equation = e;
  const dvi__node norm = squares(c, -1, 0),
                  kinetic = dvi__scale(g, e->hbar * e->hbar / (2 * e->mass),
                                       squares(c, 0, scene->jets->dimension)),
                  interaction = dvi__multiply(g, dvi__scale(g, 0.5, beta), dvi__square(g, norm)),
                  x = dvi__variable_node(c, DVI__COORDINATES, (dvi__numbering){.base = 0}, 0);
  *node = dvi__subtract(g, one_form(c, e->hbar), kinetic);
  *node = dvi__subtract(g, *node, dvi__multiply(g, V, norm));
  *node = with_measure(g, x, e->radial, dvi__subtract(g, *node, interaction));
  return true;
}
