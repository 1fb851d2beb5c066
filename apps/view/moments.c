#include "view/moments.h"

#include "view/factors.h"

/* Return an entry of a system's constant mass in the numbers of its coordinates. */
static double mass_entry(const problem *scene, int row, int column)
{
  const dvi_mass *mass = &scene->terms->mass;
  const int n = scene->nq;
  if (mass->values == NULL)
    return row != column ? 0 : mass->diagonal != NULL ? mass->diagonal[row] : mass->scalar;
  if (mass->pattern.start == NULL) return mass->values[(size_t)column * (size_t)n + (size_t)row];
  for (int e = mass->pattern.start[column]; e < mass->pattern.start[column + 1]; e++)
    if (mass->pattern.row[e] == row) return mass->values[e];
  return 0;
}

/* Add the factor's own moments: with an inertia J those are tr(J)/2 I - J. */
static void add_factor(const dvi_factor *factor, double *mass, double first[3], double second[9])
{
  *mass += factor->kind == DVI_SE3 ? factor->mass : 0;
  for (int a = 0; a < 3; a++)
    if (factor->kind == DVI_SE3 && factor->centre != NULL)
      first[a] += factor->mass * factor->centre[a];
  const double *J = factor->inertia;
  for (int k = 0; k < 9 && J != NULL; k++)
    second[k] += (k % 4 == 0 ? (J[0] + J[4] + J[8]) / 2 : 0) - J[k];
}

static void find_moments(const problem *scene, const view_layout *layout, view_body *body)
{
  static const int entry[] = {0, 1, 2, 4, 5, 8};
  const int R = body->rotation;
  const dvi_factor *factor = factor_of(scene, R);
  double first[3] = {0}, second[9];
  for (int k = 0; k < 9; k++) second[k] = mass_entry(scene, R + k / 3, R + k % 3);
  const int x = body->point != VIEW_NONE ? layout->point[body->point].from[0] : VIEW_NONE;
  if (x != VIEW_NONE) {
    body->mass = mass_entry(scene, x, x);
    for (int a = 0; a < 3; a++) first[a] = mass_entry(scene, x, R + a);
  }
  if (factor != NULL) add_factor(factor, &body->mass, first, second);
  for (int a = 0; a < 3 && body->mass > 0; a++) body->centre[a] = first[a] / body->mass;
  for (int k = 0; k < 6; k++)
    body->second[k] = second[entry[k]] -
                      body->mass * body->centre[entry[k] / 3] * body->centre[entry[k] % 3];
}

void moments_find(const problem *scene, view_layout *layout)
{
  for (int k = 0; k < layout->bodies; k++) find_moments(scene, layout, &layout->body[k]);
}
