#include "field/yee/average.h"

#include <math.h>

#include "core/status.h"

/* Integrals of materials are right to the first part of their values, and integrals over these to
 * the second. A surface then is in its place to this part of a box. */
static const double fine = 1e-4, coarse = 1e-3;

enum { DEEPEST = 14, POINTS = 5 };
/* An integral over some axes, the first one outermost. */
typedef struct integral {
  const dvi__average *eps, *sigma; /* eps may be mu. sigma may be NULL */
  const dvi__average_box *box;
  int axis;    /* that of the edge or face */
  double x[3]; /* the place */
  dvi_status status;
} integral;

typedef double integrand(integral *of);

/* ---- integrals along an axis ---- */

static double value_at(integral *of, integrand *f, int axis, double x)
{
  of->x[axis] = x;
  return f(of);
}

/* Points of Lobatto's rule with four points, and the middle, which Simpson's rule has. Points at
 * the ends are a little inside, because surfaces are often there. */
static void place_points(double a, double b, double *x)
{
  const double length = b - a, middle = 0.5 * (a + b), inner = 0.5 * length / sqrt(5);
  x[0] = a + 1e-9 * length;
  x[1] = middle - inner;
  x[2] = middle;
  x[3] = middle + inner;
  x[4] = b - 1e-9 * length;
}

/* Tell if f has one value at the first points and another one at the rest. Give the number of the
 * first ones. */
static int has_two_values(const double *f, int *before)
{
  *before = 1;
  while (*before < POINTS && f[*before] == f[0]) (*before)++;
  for (int i = *before; i < POINTS; i++)
    if (f[i] != f[POINTS - 1]) return 0;
  return *before < POINTS;
}

/* Integrate a function with one jump, which lies between two points. */
static double integrate_jump(integral *of, integrand *f, int axis, double a, double b,
                             const double *x, const double *values, int before)
{
  double low = x[before - 1], high = x[before];
  for (int i = 0; i < DEEPEST; i++) {
    const double middle = 0.5 * (low + high);
    if (value_at(of, f, axis, middle) == values[0])
      low = middle;
    else
      high = middle;
  }
  const double at = 0.5 * (low + high);
  return values[0] * (at - a) + values[POINTS - 1] * (b - at);
}

/* Halve where Lobatto's and Simpson's rule differ, as they do for a jump anywhere. */
static double refine(integral *of, integrand *f, int axis, double a, double b, double tolerance,
                     double allowed, int depth)
{
  double x[POINTS], v[POINTS];
  int before;
  place_points(a, b, x);
  for (int i = 0; i < POINTS; i++) v[i] = value_at(of, f, axis, x[i]);
  const double lobatto = (b - a) * (v[0] + v[4] + 5 * (v[1] + v[3])) / 12,
               simpson = (b - a) * (v[0] + v[4] + 4 * v[2]) / 6, middle = 0.5 * (a + b);
  if (depth == 0) allowed = tolerance * fabs(lobatto);
  if (depth == DEEPEST || fabs(lobatto - simpson) <= allowed || of->status != DVI_OK)
    return lobatto;
  if (has_two_values(v, &before)) return integrate_jump(of, f, axis, a, b, x, v, before);
  return refine(of, f, axis, a, middle, tolerance, allowed, depth + 1) +
         refine(of, f, axis, middle, b, tolerance, allowed, depth + 1);
}

/* Integrate along an axis, if the space has it. */
static double along(integral *of, integrand *f, int axis, double tolerance)
{
  if (axis >= of->box->space) return f(of);
  return refine(of, f, axis, of->box->lower[axis], of->box->upper[axis], tolerance, 0, 0);
}

/* ---- material ---- */

static double material_at(integral *of, const dvi__average *medium, double least)
{
  double value = 1;
  if (medium->function == NULL || of->status != DVI_OK) return 1;
  const int failed = medium->function(of->x, &value, medium->user);
  if (failed == 0 && isfinite(value) && value >= least) return value;
  of->status = failed != 0       ? DVI_CALLBACK_FAILED
               : isfinite(value) ? DVI_BAD_ARGUMENT
                                 : DVI_NOT_FINITE;
  (void)dvi__fail(of->status,
                  failed != 0 ? "yee: the function of %s returned %g at (%g, %g, %g)"
                              : "yee: %s = %g at (%g, %g, %g); it must be finite, and positive "
                                "(sigma: not negative)",
                  medium->name, failed != 0 ? failed : value, of->x[0], of->x[1], of->x[2]);
  return 1;
}

static const double least_positive = 1e-300;

static double permeability(integral *of)
{
  return material_at(of, of->eps, least_positive);
}

static double impermittivity(integral *of)
{
  return 1 / material_at(of, of->eps, least_positive);
}

static double loss_density(integral *of)
{
  const double eps = material_at(of, of->eps, least_positive);
  return material_at(of, of->sigma, 0) / (eps * eps);
}

/* ---- along edges and across faces ---- */

static double edge_star(integral *of)
{
  return 1 / along(of, impermittivity, of->axis, fine);
}

static double edge_loss(integral *of)
{
  const double resistance = along(of, impermittivity, of->axis, fine);
  return along(of, loss_density, of->axis, fine) / (resistance * resistance);
}

static double face_row(integral *of)
{
  return along(of, permeability, (of->axis + 2) % 3, fine);
}

static double face_star(integral *of)
{
  return 1 / along(of, face_row, (of->axis + 1) % 3, coarse);
}

static double edge_row(integral *of)
{
  return along(of, of->sigma != NULL ? edge_loss : edge_star, (of->axis + 2) % 3, coarse);
}

/* ---- boxes ---- */

/* Tell if the material has one value at the middle and near the corners, and give it. */
static int is_uniform(integral *of, const dvi__average *medium, double least, double *value)
{
  const dvi__average_box *box = of->box;
  const double part[2] = {1e-6, 1 - 1e-6};
  for (int l = 0; l < box->space; l++) of->x[l] = 0.5 * (box->lower[l] + box->upper[l]);
  *value = material_at(of, medium, least);
  for (int corner = 0; corner < 1 << box->space; corner++) {
    for (int l = 0; l < box->space; l++)
      of->x[l] = box->lower[l] + part[corner >> l & 1] * (box->upper[l] - box->lower[l]);
    if (material_at(of, medium, least) != *value) return 0;
  }
  return 1;
}

/* Give the length along the axis, and the area across it. */
static void measure(const dvi__average_box *box, int axis, double *length, double *area)
{
  *length = *area = 1;
  for (int l = 0; l < box->space; l++)
    *(l == axis ? length : area) *= box->upper[l] - box->lower[l];
}

dvi_status dvi__average_edge(const dvi__average *eps, const dvi__average_box *box, int axis,
                             double *star)
{
  integral of = {.eps = eps, .box = box, .axis = axis, .status = DVI_OK};
  double value, length, area;
  measure(box, axis, &length, &area);
  *star += is_uniform(&of, eps, least_positive, &value)
               ? value * area / length
               : along(&of, edge_row, (axis + 1) % 3, coarse);
  return of.status;
}

dvi_status dvi__average_face(const dvi__average *mu, const dvi__average_box *box, int axis,
                             double *star)
{
  integral of = {.eps = mu, .box = box, .axis = axis, .status = DVI_OK};
  double value, length, area;
  measure(box, axis, &length, &area);
  *star += is_uniform(&of, mu, least_positive, &value) ? length / (value * area)
                                                       : along(&of, face_star, axis, coarse);
  return of.status;
}

dvi_status dvi__average_loss(const dvi__average *eps, const dvi__average *sigma,
                             const dvi__average_box *box, int axis, double *star)
{
  integral of = {.eps = eps, .sigma = sigma, .box = box, .axis = axis, .status = DVI_OK};
  double value, unused, length, area;
  measure(box, axis, &length, &area);
  const int is_plain = is_uniform(&of, sigma, 0, &value) &&
                       (value == 0 || is_uniform(&of, eps, least_positive, &unused));
  *star += is_plain ? value * area / length : along(&of, edge_row, (axis + 1) % 3, coarse);
  return of.status;
}
