/* The sections lagrangian and kinetic. A Lagrangian is a constant mass and potentials, perhaps with
 * a vector potential, or a one-form and a Hamiltonian, or neither.
 *
 * Each kernel's degree in the velocities is found by one pass over its graph. If all are
 * polynomials of degree 2 whose velocities have constant coefficients, the mass is their second
 * derivatives, and the rest at zero velocity is minus the potential. If only those of degree 2 have
 * constant coefficients, the part of degree 1 is A(t,q).v of a vector potential. If all are of
 * degree 1, they are alpha(q).v. */
#include <string.h>

#include "scene/elaborate/shape.h"
#include "scene/sections/motion.h"
#include "scene/sections/sections.h"
#include "scene/terms/callbacks.h"
#include "scene/terms/factors.h"
#include "scene/terms/fault.h"
#include "text/heap.h"

/* ---- the constant mass ---- */

/* Find the second derivatives by velocities, which are the same everywhere. */
static bool mass_values(dvi_scene *scene, dvi__scene_term *T, dvi_pattern *pattern, double **values)
{
  int full;
  if (!dvi__term_pattern(scene, T, DVI__PAIR_VV, pattern, &full)) return false;
  const size_t n = (size_t)scene->velocities, entries = full ? n * n : (size_t)pattern->start[n];
  *values = dvi__arena_take(&scene->arena, entries + 1, sizeof **values);
  if (*values == NULL) return dvi__scene_no_memory(scene);
  const double *x[DVI__BLOCKS] = {scene->zeros, scene->zeros, scene->zeros, scene->zeros};
  double *second[DVI__PAIRS] = {[DVI__PAIR_VV] = *values};
  return dvi__function_second(T->function, 1, x, second) == 0 ||
         dvi__scene_refuse(scene, DVI__NOWHERE, "the mass is not finite");
}

static int entry_row(const dvi_pattern *pattern, int n, int entry)
{
  return pattern->start == NULL ? entry % n : pattern->row[entry];
}

/* Find the diagonal. Returns false if there is anything beside it. */
static int diagonal_of(int n, const dvi_pattern *pattern, const double *values, double *diagonal)
{
  int alone = 1;
  for (int j = 0; j < n; j++) {
    const int first = pattern->start == NULL ? j * n : pattern->start[j],
              end = pattern->start == NULL ? first + n : pattern->start[j + 1];
    for (int e = first; e < end; e++) {
      if (entry_row(pattern, n, e) == j)
        diagonal[j] = values[e];
      else if (values[e] < 0 || values[e] > 0)
        alone = 0;
    }
  }
  return alone;
}

/* Set the mass in the plainest form that it has. */
static bool set_mass(dvi_scene *scene, const dvi_pattern *pattern, const double *values)
{
  double *diagonal = dvi__arena_take(&scene->arena, (size_t)scene->n, sizeof *diagonal);
  if (diagonal == NULL) return dvi__scene_no_memory(scene);
  if (!diagonal_of(scene->n, pattern, values, diagonal)) {
    scene->terms.mass = (dvi_mass){.values = values, .pattern = *pattern};
    scene->mass = "sparse";
    return true;
  }
  int same = 1;
  for (int i = 0; i < scene->n; i++) {
    same = same && !(diagonal[i] < diagonal[0]) && !(diagonal[i] > diagonal[0]);
    if (diagonal[i] < 0 || diagonal[i] > 0) continue;
    const dvi__coordinate *x = &scene->coordinate[dvi__coordinate_at(scene, i, 0)];
    return dvi__scene_refuse(scene, x->span, "the rate of %s has no mass: L has no square of it",
                             x->name);
  }
  scene->mass_diagonal = diagonal;
  scene->mass = !same ? "diagonal" : diagonal[0] < 1 || diagonal[0] > 1 ? "scalar" : "identity";
  if (same)
    scene->terms.mass.scalar = diagonal[0];
  else
    scene->terms.mass.diagonal = diagonal;
  return true;
}

/* Derive the second derivatives that give the mass. */
static bool derive_mass(dvi_scene *scene, dvi__scene_term *T)
{
  const dvi_status status = dvi__function_prepare(T->function, 0,
                                                  (const char[DVI__BLOCKS]){[DVI__VELOCITIES] = 1},
                                                  (const char[DVI__PAIRS]){[DVI__PAIR_VV] = 1});
  return status == DVI_OK || dvi__scene_too_large(scene, "the mass", status);
}

/* Find if no velocity stands alone, so that the momenta at rest are zero. */
static bool find_momentum_at_rest(dvi_scene *scene, dvi__scene_term *T, int *at_rest)
{
  const double *x[DVI__BLOCKS] = {scene->zeros, scene->zeros, scene->zeros, scene->zeros};
  double *momentum = dvi__heap_take((size_t)scene->velocities, sizeof *momentum);
  double *gradient[DVI__BLOCKS] = {[DVI__VELOCITIES] = momentum};
  if (momentum == NULL) return dvi__scene_no_memory(scene);
  *at_rest = dvi__function_gradient(T->function, 1, x, gradient) == 0;
  for (int i = 0; i < scene->velocities && *at_rest; i++)
    *at_rest = !(momentum[i] < 0) && !(momentum[i] > 0);
  dvi__heap_free(momentum);
  return true;
}

/* ---- the forms ---- */

/* Refuse a Lagrangian without a constant mass beside rotations, directions or angles. Names the
 * first term of another form. */
static bool refuse_moving(dvi_scene *scene, const dvi__kernels *L)
{
  for (int k = 0; k < L->count; k++) {
    dvi__span span;
    int found;
    if (!dvi__kernel_other_term(scene, &L->kernel[k], DVI__VELOCITIES, &span, &found)) return false;
    if (found)
      return dvi__scene_refuse(scene, span,
                               "this term is of another form: beside rotations, motions, "
                               "directions and angles velocities stand in L "
                               "as squares and products with constant coefficients, of rates of "
                               "what is stored, or of omega(R) and "
                               "rate(u)");
  }
  const dvi__kernel *first = &L->kernel[0];
  return dvi__scene_refuse(scene, first->graph->node[first->root].span,
                           "beside rotations, motions, directions and angles no velocity stands "
                           "alone in L, but in squares and products");
}

static bool make_general(dvi_scene *scene, dvi__kernels *L)
{
  dvi__scene_term *term;
  if (dvi__has_factors(scene)) return refuse_moving(scene, L);
  if (!dvi__kernels_function(scene, L, 0, &term) ||
      !dvi__make_lagrangian(scene, term, &scene->lagrangian))
    return false;
  scene->terms.lagrangian = &scene->lagrangian;
  scene->form = "general Lagrangian";
  return true;
}

/* Test if each coordinate has a mass of its own. */
static int has_masses(int n, const dvi_pattern *pattern, const double *values)
{
  int count = 0;
  for (int j = 0; j < n; j++) {
    const int first = pattern->start == NULL ? j * n : pattern->start[j],
              end = pattern->start == NULL ? first + n : pattern->start[j + 1];
    for (int e = first; e < end; e++)
      count += entry_row(pattern, n, e) == j && (values[e] < 0 || values[e] > 0);
  }
  return count == n;
}

/* Make the term A(t,q).w. Velocities are not p/m then, so that no invariant may have them. */
static bool make_vector_potential(dvi_scene *scene, const dvi__kernels *L)
{
  dvi__kernels A = {0};
  dvi__scene_term *term = NULL;
  const bool good = dvi__kernels_linear(scene, L, DVI__VELOCITIES, DVI__MULTIPLIERS, &A) &&
                    dvi__kernels_function(scene, &A, scene->n, &term) &&
                    dvi__make_vector_potential(scene, term, &scene->vector_potential);
  dvi__kernels_free(&A);
  scene->terms.vector_potential = &scene->vector_potential;
  scene->mass_diagonal = NULL;
  scene->form = "separable with a vector potential";
  return good;
}

/* Make the mass and the potential, of a Lagrangian with a vector potential unless it is `plain`. */
static bool make_parts(dvi_scene *scene, dvi__kernels *L, const char *rest, int plain,
                       const dvi_pattern *pattern, const double *values)
{
  dvi__kernels V = {0};
  const bool good = (dvi__has_factors(scene) ? dvi__make_factors(scene, pattern, values)
                                             : set_mass(scene, pattern, values)) &&
                    dvi__kernels_at_rest(scene, L, DVI__VELOCITIES, 1, &V) &&
                    dvi__potential_add(scene, rest, 0, &V);
  dvi__kernels_free(&V);
  scene->form = "separable";
  return good && (plain || make_vector_potential(scene, L));
}

/* Vector potentials do not stand beside constraints, but general Lagrangians do. */
static bool has_constraints(const dvi_scene *scene)
{
  return dvi__tree_find(scene->tree, "constraints") != NULL ||
         dvi__tree_find(scene->tree, "nonholonomic") != NULL;
}

/* Take a Lagrangian apart whose squares of velocities have constant coefficients. `pure` says that
 * those of single velocities are constant, too, as in a drift that cancels. */
static bool make_separable(dvi_scene *scene, dvi__kernels *L, const char *rest, int pure)
{
  dvi__kernels moving = {0};
  dvi__scene_term *T = NULL;
  dvi_pattern pattern;
  double *values;
  int plain = 0;
  const bool good = dvi__kernels_moving(scene, L, DVI__VELOCITIES, DVI__VELOCITIES, &moving) &&
                    dvi__kernels_function(scene, &moving, 0, &T) && derive_mass(scene, T) &&
                    (!pure || find_momentum_at_rest(scene, T, &plain)) &&
                    mass_values(scene, T, &pattern, &values);
  dvi__kernels_free(&moving);
  if (T != NULL) T->role = DVI__ROLE_AUXILIARY;
  if (!good) return false;
  if (!plain && (dvi__has_factors(scene) || has_constraints(scene) ||
                 !has_masses(scene->n, &pattern, values)))
    return make_general(scene, L);
  scene->kinetic = T;
  return make_parts(scene, L, rest, plain, &pattern, values);
}

static int kernels_have_time(const dvi__kernels *list)
{
  for (int k = 0; k < list->count; k++)
    for (int i = 0; i < list->kernel[k].input_count; i++) {
      const dvi__kernel_input *input = &list->kernel[k].input[i];
      if (!input->is_data && input->block == DVI__TIME) return 1;
    }
  return 0;
}

/* Make the terms alpha(q).w and H. */
static bool make_degenerate(dvi_scene *scene, const dvi__expression *e, dvi__kernels *L,
                            const char *rest)
{
  dvi__kernels alpha = {0}, H = {0};
  dvi__scene_term *term = NULL;
  bool good = dvi__kernels_moving(scene, L, DVI__VELOCITIES, DVI__MULTIPLIERS, &alpha);
  if (good && kernels_have_time(&alpha))
    good = dvi__scene_refuse(scene, e->span,
                             "of first degree in the velocities this is a one-form, alpha(q).q' - "
                             "H(t,q); beside the velocities the "
                             "time cannot stand");
  good = good && dvi__kernels_function(scene, &alpha, scene->n, &term) &&
         dvi__make_one_form(scene, term, &scene->one_form) &&
         dvi__kernels_at_rest(scene, L, DVI__VELOCITIES, 1, &H) &&
         dvi__potential_add(scene, rest, 0, &H);
  dvi__kernels_free(&alpha);
  dvi__kernels_free(&H);
  scene->terms.one_form = &scene->one_form;
  scene->form = "one-form";
  return good;
}

static bool make_form(dvi_scene *scene, const dvi__expression *e, dvi__kernels *L, const char *rest)
{
  dvi__degree degree;
  if (!dvi__kernels_degree(scene, L, DVI__VELOCITIES, &degree)) return false;
  if (degree.degree == 0)
    return dvi__scene_refuse(scene, e->span, "there is no velocity in it, so nothing would move");
  if (degree.degree == 1 && dvi__has_factors(scene)) return refuse_moving(scene, L);
  if (degree.degree == 1) return make_degenerate(scene, e, L, rest);
  return degree.degree == 2 && degree.squares ? make_separable(scene, L, rest, degree.pure)
                                              : make_general(scene, L);
}

static bool read_moving(dvi_scene *scene, const dvi__tree *section, const char *where,
                        const char *rest)
{
  const dvi__expression *e;
  dvi__kernels L = {0};
  const bool good = dvi__tree_expression(scene, section, &e) &&
                    dvi__kernels_add(scene, DVI__MENTIONS_Q | DVI__MENTIONS_V | DVI__MENTIONS_T,
                                     where, e, 0, &L) &&
                    make_form(scene, e, &L, rest);
  dvi__kernels_free(&L);
  return good;
}

bool dvi__read_lagrangian(dvi_scene *scene, const dvi__tree *section)
{
  return dvi__potentials_reserve(scene, 0) &&
         read_moving(scene, section, "a Lagrangian", "potential");
}

bool dvi__read_kinetic(dvi_scene *scene, const dvi__tree *section)
{
  return (scene->terms.potentials != NULL || dvi__potentials_reserve(scene, 0)) &&
         read_moving(scene, section, "a kinetic energy", "kinetic at rest");
}
