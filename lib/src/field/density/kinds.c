/* Tests that parts are of their kinds: quadratic ones have constant second derivatives, and
 * one-forms are linear in rates. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

enum { PLACES = 3 /* points that are tried */ };

/* Rounding errors of l beside its size. */
static const double roundoff = 1e-9;

/* A part at one of its points, with room for one call each at 0, z and 2 z. */
typedef struct trial {
  const dvi_density *density;
  const dvi__density_part *part;
  int64_t point;
  double x[DVI_AXES_MAX], z[3][DVI_JETS_MAX];
  double l[3], l_z[3][DVI_JETS_MAX];
  double *l_zz[3]; /* [pairs] each */
} trial;

static dvi_status refuse(const trial *s, const char *why)
{
  return dvi__fail(DVI_BAD_ARGUMENT, "density: part '%s' %s", s->part->name, why);
}

/* A number at random near 1, so that no difference cancels. */
static double some_number(int a, int i)
{
  const double x = sin(12.9898 * (a + 1) + 78.233 * i) * 43758.5453;
  return 0.4 + (x - floor(x));
}

static dvi_status call(trial *s, int i)
{
  const dvi_density_part *given = &s->part->given;
  const int failed = given->density(1, given->depends_on_time ? 0.3 * i : 0, s->x, s->z[i],
                                    s->l + i, s->l_z[i], s->l_zz[i], given->user);
  if (failed != 0)
    return dvi__fail(DVI_CALLBACK_FAILED, "density: part '%s' returned %d", s->part->name, failed);
  double sum = s->l[i];
  for (int a = 0; a < given->variables; a++) sum += s->l_z[i][a];
  for (int e = 0; e < given->pairs; e++) sum += s->l_zz[i][e];
  if (isfinite(sum)) return DVI_OK;
  return dvi__fail(DVI_NOT_FINITE, "density: part '%s' is not finite at %s = %.6g", s->part->name,
                   dvi_space_axis(s->density->space, 0), s->x[0]);
}

/* Give the product of the second derivatives and z. */
static void multiply(const trial *s, int i, double *product)
{
  const dvi_density_part *given = &s->part->given;
  memset(product, 0, (size_t)given->variables * sizeof *product);
  for (int e = 0; e < given->pairs; e++) {
    const int a = given->pair[e][0], b = given->pair[e][1];
    product[a] += s->l_zz[i][e] * s->z[i][b];
    if (a != b) product[b] += s->l_zz[i][e] * s->z[i][a];
  }
}

static double size_of(const trial *s, int i)
{
  double most = fabs(s->l[i]);
  for (int a = 0; a < s->part->given.variables; a++) most = fmax(most, fabs(s->l_z[i][a]));
  for (int e = 0; e < s->part->given.pairs; e++) most = fmax(most, fabs(s->l_zz[i][e]));
  return most;
}

/* l_zz does not change, and l_z is linear. At another time the linear terms may be others. */
static dvi_status check_quadratic(const trial *s)
{
  const dvi_density_part *given = &s->part->given;
  const double least = roundoff * fmax(size_of(s, 1), size_of(s, 2));
  double product[DVI_JETS_MAX];
  for (int i = 1; i < 3; i++) {
    for (int e = 0; e < given->pairs; e++)
      if (fabs(s->l_zz[i][e] - s->l_zz[0][e]) > least)
        return refuse(s, given->kind == DVI_DENSITY_KINETIC
                             ? "is not a quadratic form of rates: its kind is general"
                             : "is not quadratic: its kind is potential");
    multiply(s, i, product);
    for (int a = 0; a < given->variables && !given->depends_on_time; a++)
      if (fabs(s->l_z[i][a] - s->l_z[0][a] - product[a]) > least)
        return refuse(s, given->kind == DVI_DENSITY_KINETIC
                             ? "has derivatives that are not those of a quadratic form of its pairs"
                             : "has derivatives that are not linear with its second ones: its kind "
                               "is potential, or a pair is missing");
  }
  for (int a = 0; a < given->variables && given->kind == DVI_DENSITY_KINETIC; a++)
    if (fabs(s->l_z[0][a]) > least || fabs(s->l[0]) > least)
      return refuse(s, "does not vanish with its rates: its kind is general");
  return DVI_OK;
}

/* Tell if l_zz does not change. */
static int has_constant_second(const trial *s)
{
  const double least = roundoff * fmax(size_of(s, 1), size_of(s, 2));
  for (int e = 0; e < s->part->given.pairs; e++)
    if (fabs(s->l_zz[2][e] - s->l_zz[1][e]) > least) return 0;
  return 1;
}

/* l is the sum of rates times derivatives, and no rate is multiplied with one. */
static dvi_status check_one_form(const trial *s)
{
  const dvi_density_part *given = &s->part->given;
  const double least = roundoff * fmax(size_of(s, 1), size_of(s, 2));
  for (int i = 1; i < 3; i++) {
    double sum = 0;
    for (int a = 0; a < given->variables; a++)
      if (given->variable[a].rate) sum += s->l_z[i][a] * s->z[i][a];
    if (fabs(sum - s->l[i]) > least)
      return refuse(s, "is not linear in its rates: terms without rates are a potential part");
    for (int e = 0; e < given->pairs; e++)
      if (given->variable[given->pair[e][0]].rate && given->variable[given->pair[e][1]].rate &&
          fabs(s->l_zz[i][e]) > least)
        return refuse(s, "is not linear in its rates: its kind is general");
  }
  return DVI_OK;
}

static dvi_status try_point(trial *s)
{
  const dvi_density_part *given = &s->part->given;
  for (int d = 0; d < s->density->dimension; d++)
    s->x[d] = s->part->x[d * s->part->points + s->point];
  for (int i = 1; i < 3; i++)
    for (int a = 0; a < given->variables; a++) s->z[i][a] = some_number(a, i);
  for (int i = given->kind == DVI_DENSITY_ONE_FORM; i < 3; i++) DVI_TRY(call(s, i));
  return given->kind == DVI_DENSITY_ONE_FORM ? check_one_form(s) : check_quadratic(s);
}

static dvi_status check_part(const dvi_density *density, dvi__density_part *part)
{
  const int pairs = part->given.pairs;
  trial s = {.density = density, .part = part};
  double *room = DVI_NEW(double, 3 * pairs + 1);
  if (room == NULL) return dvi__fail(DVI_NO_MEMORY, "density: no memory for a test");
  for (int i = 0; i < 3; i++) s.l_zz[i] = room + i * pairs;
  dvi_status status = DVI_OK;
  part->is_constant = 1;
  for (int i = 0; i < PLACES && status == DVI_OK; i++) {
    s.point = i * (part->points - 1) / (PLACES - 1);
    status = try_point(&s);
    if (status == DVI_OK && !has_constant_second(&s)) part->is_constant = 0;
  }
  dvi__release(room);
  return status;
}

dvi_status dvi__density_check_kinds(dvi_density *density)
{
  for (int p = 0; p < density->declared; p++) {
    const dvi_density_kind kind = density->part[p].given.kind;
    if (kind == DVI_DENSITY_POTENTIAL || kind == DVI_DENSITY_GENERAL) continue;
    DVI_TRY(check_part(density, density->part + p));
  }
  return DVI_OK;
}
