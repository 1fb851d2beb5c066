#include "field/yee/average.h"

#include <math.h>

#include "core/status.h"

/* Integrals of materials are right to the first part of their values, and integrals over these to
 * the second. A surface then is in its place to this part of a box. */
static const double fine = 1e-4, coarse = 1e-3;

/* Films between two surfaces are sought in 2^HALVINGS parts of a box along each axis. */
enum { DEEPEST = 14, POINTS = 5, HALVINGS = 3, PARTS = 1 << HALVINGS };

/* An integral over some axes, the first one outermost. */
typedef struct integral {
  const dvi__average *eps, *sigma; /* eps may be mu. sigma may be NULL */
  const dvi__average_box *box;
  int axis;     /* that of the edge or face */
  double x[3];  /* the place */
  int least[3]; /* halvings along an axis that are done, whatever the values are */
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
  if (depth == DEEPEST || of->status != DVI_OK) return lobatto;
  if (depth >= of->least[axis]) {
    if (fabs(lobatto - simpson) <= allowed) return lobatto;
    if (has_two_values(v, &before)) return integrate_jump(of, f, axis, a, b, x, v, before);
  }
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

/* Go to a part of the box along an axis, from 0 to PARTS. Surfaces are often at its ends, and
 * points there are a little inside. */
static void go_to(integral *of, int axis, int part)
{
  const dvi__average_box *box = of->box;
  const double at = part == 0 ? 1e-6 : part == PARTS ? 1 - 1e-6 : (double)part / PARTS;
  of->x[axis] = box->lower[axis] + at * (box->upper[axis] - box->lower[axis]);
}

static double value_at_middle(integral *of, const dvi__average *medium, double least)
{
  for (int l = 0; l < of->box->space; l++) go_to(of, l, PARTS / 2);
  return material_at(of, medium, least);
}

/* Tell if the material has this value at all places at `count` parts along each axis. */
static int is_same_on_grid(integral *of, const dvi__average *medium, double least, int count,
                           const int *part, double value)
{
  int places = 1;
  for (int l = 0; l < of->box->space; l++) places *= count;
  for (int n = 0; n < places; n++) {
    for (int l = 0, rest = n; l < of->box->space; l++, rest /= count)
      go_to(of, l, part[rest % count]);
    if (material_at(of, medium, least) != value) return 0;
  }
  return 1;
}

/* Tell it for places at which each axis has another part, so that a few are at every part of every
 * axis. A film across an axis is at one of them if it is thicker than a part. */
static int is_same_inside(integral *of, const dvi__average *medium, double least, int next,
                          double value)
{
  for (int i = 1; i < PARTS; i += next) {
    for (int l = 0; l < of->box->space; l++) go_to(of, l, i * (2 * l + 1) % PARTS);
    if (material_at(of, medium, least) != value) return 0;
  }
  return 1;
}

/* Tell if the material has one value in the box, and give it. */
static int is_uniform(integral *of, const dvi__average *medium, double least, double *value)
{
  static const int ends[] = {0, PARTS};
  const double *known = of->box->value;
  *value = known != NULL ? *known : value_at_middle(of, medium, least);
  return known != NULL || (is_same_on_grid(of, medium, least, 2, ends, *value) &&
                           is_same_inside(of, medium, least, 1, *value));
}

/* Tell it for a whole box at all corners and middles of its halves. */
static int is_uniform_by_halves(integral *of, const dvi__average *medium, double least,
                                double *value)
{
  static const int ends[] = {0, PARTS / 2, PARTS},
                   middles[] = {PARTS / 4, PARTS / 2, 3 * PARTS / 4};
  *value = value_at_middle(of, medium, least);
  return is_same_on_grid(of, medium, least, 3, ends, *value) &&
         is_same_on_grid(of, medium, least, 3, middles, *value) &&
         is_same_inside(of, medium, least, 2, *value);
}

/* Tell if the line through the middle along an axis has more than one surface: equal values side by
 * side, and two changes. First values that all differ are those of a smooth material. */
static int has_films(integral *of, const dvi__average *medium, double least, int axis)
{
  int changes = 0;
  double last = 0;
  if (medium->function == NULL) return 0;
  for (int l = 0; l < of->box->space; l++) go_to(of, l, PARTS / 2);
  for (int i = 0; i <= PARTS; i++) {
    go_to(of, axis, i);
    const double value = material_at(of, medium, least);
    changes += i > 0 && value != last;
    last = value;
    if (i == 3 && changes == 3) return 0;
  }
  return changes > 1;
}

/* Integrate over the box, in parts along axes that have films, which rules with few points miss. */
static double integrate(integral *of, integrand *f, int axis)
{
  for (int l = 0; l < of->box->space; l++)
    if (has_films(of, of->eps, least_positive, l) ||
        (of->sigma != NULL && has_films(of, of->sigma, 0, l)))
      of->least[l] = HALVINGS;
  return along(of, f, axis, coarse);
}

dvi_status dvi__average_value(const dvi__average *medium, const dvi__average *sigma,
                              const dvi__average_box *box, double *value)
{
  integral of = {.box = box, .status = DVI_OK};
  double eps;
  const int is_plain = sigma == NULL
                           ? is_uniform_by_halves(&of, medium, least_positive, value)
                           : is_uniform_by_halves(&of, sigma, 0, value) &&
                                 (*value == 0 ||
                                  is_uniform_by_halves(&of, medium, least_positive, &eps));
  if (!is_plain) *value = (double)NAN;
  return of.status;
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
                                                        : integrate(&of, edge_row, (axis + 1) % 3);
  return of.status;
}

dvi_status dvi__average_face(const dvi__average *mu, const dvi__average_box *box, int axis,
                             double *star)
{
  integral of = {.eps = mu, .box = box, .axis = axis, .status = DVI_OK};
  double value, length, area;
  measure(box, axis, &length, &area);
  *star += is_uniform(&of, mu, least_positive, &value) ? length / (value * area)
                                                       : integrate(&of, face_star, axis);
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
  *star += is_plain ? value * area / length : integrate(&of, edge_row, (axis + 1) % 3);
  return of.status;
}
