#include "field/yee/average.h"

#include <math.h>

#include "core/status.h"

/* An integral is right to this part of its value. A surface then is in its place to this part of a
 * box, which bisections find. */
static const double tolerance = 1e-4;

enum { DEEPEST = 16 };

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

/* Lobatto's rule with four points. *apart is how far Simpson's rule is from it. Each place of a
 * jump tells them apart. Points at the ends are a little inside, because surfaces are often
 * there. */
static double panel(integral *of, integrand *f, int axis, double a, double b, double *apart)
{
  static const double inside = 1e-9;
  const double length = b - a, middle = 0.5 * (a + b), inner = 0.5 * length / sqrt(5),
               ends = value_at(of, f, axis, a + inside * length) +
                      value_at(of, f, axis, b - inside * length),
               others = value_at(of, f, axis, middle - inner) +
                        value_at(of, f, axis, middle + inner),
               lobatto = length * (ends + 5 * others) / 12,
               simpson = length * (ends + 4 * value_at(of, f, axis, middle)) / 6;
  *apart = fabs(lobatto - simpson);
  return lobatto;
}

/* Halve where the rules differ. Of a panel with a jump one half goes on. */
static double refine(integral *of, integrand *f, int axis, double a, double b, double allowed,
                     int depth)
{
  const double middle = 0.5 * (a + b);
  double apart;
  const double sum = panel(of, f, axis, a, b, &apart);
  if (allowed == 0) allowed = tolerance * fabs(sum);
  if (depth == DEEPEST || apart <= allowed || of->status != DVI_OK) return sum;
  return refine(of, f, axis, a, middle, allowed, depth + 1) +
         refine(of, f, axis, middle, b, allowed, depth + 1);
}

/* Integrate along an axis, if the space has it. */
static double along(integral *of, integrand *f, int axis)
{
  if (axis >= of->box->space) return f(of);
  return refine(of, f, axis, of->box->lower[axis], of->box->upper[axis], 0, 0);
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
  return 1 / along(of, impermittivity, of->axis);
}

static double edge_loss(integral *of)
{
  const double resistance = along(of, impermittivity, of->axis);
  return along(of, loss_density, of->axis) / (resistance * resistance);
}

static double face_row(integral *of)
{
  return along(of, permeability, (of->axis + 2) % 3);
}

static double face_star(integral *of)
{
  return 1 / along(of, face_row, (of->axis + 1) % 3);
}

static double edge_row(integral *of)
{
  return along(of, of->sigma != NULL ? edge_loss : edge_star, (of->axis + 2) % 3);
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
  *star += is_uniform(&of, eps, least_positive, &value) ? value * area / length
                                                        : along(&of, edge_row, (axis + 1) % 3);
  return of.status;
}

dvi_status dvi__average_face(const dvi__average *mu, const dvi__average_box *box, int axis,
                             double *star)
{
  integral of = {.eps = mu, .box = box, .axis = axis, .status = DVI_OK};
  double value, length, area;
  measure(box, axis, &length, &area);
  *star += is_uniform(&of, mu, least_positive, &value) ? length / (value * area)
                                                       : along(&of, face_star, axis);
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
  *star += is_plain ? value * area / length : along(&of, edge_row, (axis + 1) % 3);
  return of.status;
}
