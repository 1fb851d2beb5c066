/* The space of a density: how many points it has, and the coefficient of msfem. */
#include <stdlib.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

/* ---- points of Fourier axes ---- */

/* Return the smallest number of points from `least` on that has no prime factors but 2, 3, 5. */
static int good_points(int least)
{
  for (int points = least;; points++) {
    int rest = points;
    for (int prime = 2; prime <= 5; prime++)
      while (rest % prime == 0) rest /= prime;
    if (rest == 1) return points;
  }
}

/* Tell if the scene's own method turns phases at points, of which there are as many as
 * functions. */
static bool is_split(const dvi_scene *scene)
{
  const char *method = scene->plan.method;
  const size_t length = method != NULL ? strcspn(method, ":") : 0;
  return scene->density->equation != NULL && length == strlen("split") &&
         strncmp(method, "split", length) == 0;
}

/* Give a Fourier axis more points than the degree of a polynomial density times its modes, so that
 * its integrals are exact. Its own choice does so up to the degree 4. For split steps there are as
 * many as functions. */
static void choose_points(const dvi_scene *scene, int d)
{
  struct dvi__scene_density *s = scene->density;
  static const char start[] = "fourier:modes=";
  const char *kind = s->axis[d].kind;
  char *rest;
  if (strncmp(kind, start, sizeof start - 1) != 0 || (s->degree <= 4 && !is_split(scene))) return;
  const long modes = strtol(kind + sizeof start - 1, &rest, 10);
  if (*rest != '\0' || modes < 1 || modes > 1000000 / (s->degree > 2 ? s->degree : 2)) return;
  const int points = is_split(scene) ? 2 * (int)modes + 1 : good_points(s->degree * (int)modes + 1);
  (void)dvi__print(s->chosen[d], sizeof s->chosen[d], "%s%ld,points=%d", start, modes, points);
  s->axis[d].kind = s->chosen[d];
}

static bool is_fourier(const char *kind)
{
  return strncmp(kind, "fourier", strlen("fourier")) == 0;
}

static bool check_periods(dvi_scene *scene)
{
  const struct dvi__scene_density *s = scene->density;
  for (int d = 0; d < s->jets.dimension; d++)
    if (is_fourier(s->axis[d].kind) && !s->axis[d].periodic)
      return dvi__scene_refuse(scene, dvi__tree_find(scene->tree, "space")->span,
                               "fourier is periodic, and the axis %s is not; say "
                               "'boundary: periodic', or '{%s: periodic}'",
                               s->jets.axis[d], s->jets.axis[d]);
  return true;
}

/* ---- the coefficient of msfem ---- */

/* Return the pair of d(u,x) with itself in the quadratic part, u the first component, or -1. */
static int find_coefficient(const dvi__local *part)
{
  for (int e = 0; part != NULL && e < part->pairs; e++) {
    const dvi_jet *jet = part->variable + part->pair[e][0];
    if (part->pair[e][0] == part->pair[e][1] && jet->component == 0 && jet->order[0] == 1 &&
        jet->order[1] == 0 && jet->order[2] == 0)
      return e;
  }
  return -1;
}

/* Give the a(x) of the summand -a d(u,x)^2/2. The second derivatives depend on x alone. */
static int coefficient(int64_t count, const double *x, double *a, void *user)
{
  dvi__local *part = user;
  const size_t points = (size_t)count;
  double *z = dvi__heap_take(points * (size_t)(part->variables + part->pairs), sizeof *z);
  if (z == NULL) return DVI_NO_MEMORY;
  double *const l_zz = z + points * (size_t)part->variables;
  const int failed = dvi__local_density((int)count, 0, x, z, NULL, NULL, l_zz, part);
  const double *const of = l_zz + find_coefficient(part) * count;
  for (int64_t k = 0; k < count && failed == 0; k++) a[k] = -of[k];
  dvi__heap_free(z);
  return failed;
}

static bool is_msfem(const char *kind)
{
  return kind != NULL && strncmp(kind, "msfem", strlen("msfem")) == 0;
}

/* Find the part that has the coefficient, NULL where there is no msfem. */
static bool choose_coefficient(dvi_scene *scene, dvi__local **part)
{
  const struct dvi__scene_density *s = scene->density;
  bool is_wanted = is_msfem(s->kind);
  for (int d = 0; d < s->jets.dimension; d++) is_wanted = is_wanted || is_msfem(s->axis[d].kind);
  *part = is_wanted ? s->part[DVI_DENSITY_QUADRATIC] : NULL;
  return !is_wanted || find_coefficient(*part) >= 0 ||
         dvi__scene_refuse(scene, s->section->span,
                           "msfem has the coefficient a of the summand -a*d(%s,%s)^2/2, and there "
                           "is none",
                           s->field->name, s->jets.axis[0]);
}

/* ---- all ---- */

bool dvi__density_make_space(dvi_scene *scene)
{
  struct dvi__scene_density *s = scene->density;
  dvi__local *part;
  const dvi__tree *section = dvi__tree_find(scene->tree, "space");
  if (s->mesh == NULL && section == NULL)
    return dvi__scene_refuse(scene, s->place->span,
                             "beside 'domain' the section 'space' is missing, as in "
                             "'space: fem:degree=2,cells=100'");
  if (s->mesh == NULL && !check_periods(scene)) return false;
  for (int d = 0; d < s->jets.dimension && s->mesh == NULL; d++) choose_points(scene, d);
  if (!choose_coefficient(scene, &part)) return false;
  const dvi_space_options options = {.size = sizeof options,
                                     .kind = s->mesh == NULL   ? NULL
                                             : s->kind != NULL ? s->kind
                                                               : "fem:degree=1",
                                     .axis = s->axis,
                                     .axes = s->mesh == NULL ? s->jets.dimension : 0,
                                     .mesh = s->mesh,
                                     .coefficient = part != NULL ? coefficient : NULL,
                                     .user = part};
  const dvi_status status = dvi_space_create(&options, &s->space);
  if (status == DVI_OK) s->functions = dvi_space_functions(s->space);
  return status == DVI_OK ||
         dvi__density_complain(scene, section != NULL ? section : s->place, status);
}
