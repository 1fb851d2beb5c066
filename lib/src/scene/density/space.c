/* The space of a density: how many points it has, and the coefficient of msfem. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/density/scene_density.h"
#include "scene/sections/sections.h"
#include "text/heap.h"

/* ---- kinds of axes ---- */

long dvi__axis_option(const char *kind, const char *name, long usual)
{
  const char *found = strstr(kind, name);
  return found != NULL ? strtol(found + strlen(name), NULL, 10) : usual;
}

bool dvi__axis_is_linear(const char *kind)
{
  const size_t length = strcspn(kind, ":");
  return length == strlen("fem") && strncmp(kind, "fem", length) == 0 &&
         dvi__axis_option(kind, "degree=", 1) == 1;
}

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

/* Return the pair of the derivative of a component along an axis with itself in the quadratic part,
 * or -1. */
static int find_square(const dvi__local *part, int component, int axis)
{
  for (int e = 0; part != NULL && e < part->pairs; e++) {
    const dvi_jet *jet = part->variable + part->pair[e][0];
    const int total = jet->order[0] + jet->order[1] + jet->order[2];
    if (part->pair[e][0] == part->pair[e][1] && jet->component == component && total == 1 &&
        jet->order[axis] == 1)
      return e;
  }
  return -1;
}

static int find_coefficient(const dvi__local *part)
{
  return find_square(part, 0, 0);
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

/* Tell if the second derivatives by two derivatives in space are those of one coefficient, at a
 * point. */
static bool is_one(const dvi_scene *scene, const dvi__local *part, const double *l_zz)
{
  const struct dvi__scene_density *s = scene->density;
  const double a = l_zz[find_coefficient(part)];
  for (int c = 0; c < s->jets.components; c++)
    for (int d = 0; d < s->jets.dimension; d++) {
      const int e = find_square(part, c, d);
      if (e < 0 || fabs(l_zz[e] - a) > 1e-12 * fabs(a)) return false;
    }
  for (int e = 0; e < part->pairs; e++) {
    const dvi_jet *i = part->variable + part->pair[e][0], *k = part->variable + part->pair[e][1];
    if (i != k && i->order[0] + i->order[1] + i->order[2] > 0 &&
        k->order[0] + k->order[1] + k->order[2] > 0 && fabs(l_zz[e]) > 1e-12 * fabs(a))
      return false;
  }
  return true;
}

/* Tell if all components and axes have one coefficient, at some points. */
static bool is_isotropic(const dvi_scene *scene, const dvi__local *part)
{
  enum { POINTS = 16 };
  const struct dvi__scene_density *s = scene->density;
  const double z[DVI_JETS_MAX] = {0};
  double *l_zz = dvi__heap_take((size_t)part->pairs + 1, sizeof *l_zz);
  bool is = l_zz != NULL;
  for (int k = 0; k < POINTS && is; k++) {
    double x[DVI_AXES_MAX];
    for (int d = 0; d < s->jets.dimension; d++) {
      const double at = 0.618034 * (k + 1) * (d + 1);
      x[d] = s->axis[d].from + (at - floor(at)) * (s->axis[d].to - s->axis[d].from);
    }
    is = dvi__local_density(1, 0, x, z, NULL, NULL, l_zz, (void *)part) != 0 ||
         is_one(scene, part, l_zz);
  }
  dvi__heap_free(l_zz);
  return is;
}

/* Find the part that has the coefficient, NULL where there is no msfem. */
static bool choose_coefficient(dvi_scene *scene, dvi__local **part)
{
  const struct dvi__scene_density *s = scene->density;
  bool is_wanted = is_msfem(s->kind);
  for (int d = 0; d < s->jets.dimension; d++) is_wanted = is_wanted || is_msfem(s->axis[d].kind);
  *part = is_wanted ? s->part[DVI_DENSITY_QUADRATIC] : NULL;
  if (!is_wanted) return true;
  if (find_coefficient(*part) < 0)
    return dvi__scene_refuse(scene, s->section->span,
                             "msfem has the coefficient a of the summand -a*d(%s,%s)^2/2, and "
                             "there is none",
                             s->field->name, s->jets.axis[0]);
  return is_isotropic(scene, *part) ||
         dvi__scene_refuse(scene, s->section->span,
                           "msfem has one coefficient for all components and axes, the a of "
                           "-a*dot(grad(%s),grad(%s))/2, and here they differ",
                           s->field->name, s->field->name);
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
