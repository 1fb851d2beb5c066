/* Functions with a phi' constant in each cell of an interval.
 *
 * Space: s(x) = int 1/a from the cell's start to x, over that of the cell, and 1 - s. Between them
 * the Lagrangian L = -sum over cells of 1/2 (u_right - u_left)^2 / int 1/a has the exact solutions
 * of (a u')' = 0, so that u of (a u')' = f is exact at the nodes: Green's function of a node is in
 * the space. Quadrature: 1/a is replaced in each part by its interpolant at Gauss points, whose
 * integral is that of the Gauss rule. The integrals of f phi at the same points are then those of a
 * collocation method, exact to the order 2 points (Hairer, Lubich and Wanner 2006, sec. II.1).
 * Source: Hou and Wu 1997; Leok 2004, sec. 5.7.1. */
#include "field/multiscale/rise.h"

#include <dvi/quadrature.h>

#include "core/memory.h"
#include "core/status.h"

enum { MOST = DVI__RISE_POINTS_MAX };

/* A larger change of an integral by twice as many parts is more than a jump of the coefficient in
 * one of ten parts makes. The parts do not see it then. */
static const double unresolved = .1;

/* A Gauss rule and Legendre's polynomials at its nodes. */
typedef struct rule {
  int points;
  double node[MOST], weight[MOST];
  long double polynomial[MOST][MOST]; /* P_k at node i: [k][i] */
} rule;

/* Set P [count] to Legendre's polynomials at 2y - 1. */
static void legendre(int count, long double y, long double *P)
{
  const long double z = 2 * y - 1;
  P[0] = 1;
  if (count > 1) P[1] = z;
  for (int k = 1; k + 1 < count; k++) P[k + 1] = ((2 * k + 1) * z * P[k] - k * P[k - 1]) / (k + 1);
}

static dvi_status make_rule(int points, rule *r)
{
  r->points = points;
  DVI_TRY(dvi_quadrature(DVI_GAUSS, points, r->node, r->weight));
  for (int i = 0; i < points; i++) {
    long double P[MOST];
    legendre(points, r->node[i], P);
    for (int k = 0; k < points; k++) r->polynomial[k][i] = P[k];
  }
  return DVI_OK;
}

/* Set `a` [points] to the coefficient in the piece from x with a length. */
static dvi_status sample(const dvi__coefficient *coefficient, const rule *r, double x,
                         double length, double *a)
{
  double place[MOST];
  for (int i = 0; i < r->points; i++) place[i] = x + length * r->node[i];
  return dvi__coefficient_sample(coefficient, r->points, place, a);
}

static long double resistance(const rule *r, double length, const double *a)
{
  long double sum = 0;
  for (int i = 0; i < r->points; i++) sum += r->weight[i] / (long double)a[i];
  return length * sum;
}

/* Give the integral of 1/a over a part, by its halves. */
static dvi_status halves(const dvi__fine_axis *axis, const dvi__coefficient *coefficient,
                         const rule *r, int part, long double *integral)
{
  const double half = dvi__fine_axis_length(axis, part) / 2;
  double a[MOST];
  for (int i = 0; i < 2; i++) {
    DVI_TRY(sample(coefficient, r, axis->end[part] + i * half, half, a));
    *integral += resistance(r, half, a);
  }
  return DVI_OK;
}

/* Set the moments of 1/a in a part. */
static void set_moments(const rule *r, double length, const double *a, double *moment)
{
  for (int k = 0; k < r->points; k++) {
    long double sum = 0;
    for (int i = 0; i < r->points; i++) sum += r->weight[i] * r->polynomial[k][i] / a[i];
    moment[k] = (double)(length * sum);
  }
}

/* Divide the integrals of a cell by that of the whole cell. */
static void normalise(dvi__rise *rise, const dvi__fine_axis *axis, int cell, long double whole)
{
  const int first = cell * axis->fine;
  for (int part = first; part < first + axis->fine; part++) {
    rise->start[part] = (double)(rise->start[part] / whole);
    for (int k = 0; k < rise->points; k++)
      rise->moment[part * rise->points + k] = (double)(rise->moment[part * rise->points + k] /
                                                       whole);
  }
  rise->whole[cell] = (double)whole;
}

static dvi_status check_cell(dvi__rise *rise, const dvi__fine_axis *axis,
                             const dvi__coefficient *coefficient, int cell, double finer)
{
  const double defect = dvi__coefficient_defect(rise->whole[cell], finer);
  if (defect > unresolved)
    return dvi__fail(DVI_BAD_OPTION,
                     "%s: fine=%d does not resolve the coefficient: the integral of 1/a from %.10g "
                     "to %.10g is %g, and %g with twice as many parts; take more parts",
                     coefficient->name, axis->fine, axis->end[cell * axis->fine],
                     axis->end[(cell + 1) * axis->fine], rise->whole[cell], finer);
  if (defect > rise->defect) rise->defect = defect;
  return DVI_OK;
}

static dvi_status solve_cell(dvi__rise *rise, const dvi__fine_axis *axis,
                             const dvi__coefficient *coefficient, const rule *r, int cell)
{
  const int first = cell * axis->fine;
  long double whole = 0, finer = 0;
  for (int part = first; part < first + axis->fine; part++) {
    const double length = dvi__fine_axis_length(axis, part);
    double a[MOST];
    DVI_TRY(sample(coefficient, r, axis->end[part], length, a));
    DVI_TRY(halves(axis, coefficient, r, part, &finer));
    rise->start[part] = (double)whole;
    set_moments(r, length, a, rise->moment + (size_t)part * (size_t)r->points);
    whole += resistance(r, length, a);
  }
  normalise(rise, axis, cell, whole);
  return check_cell(rise, axis, coefficient, cell, (double)finer);
}

static dvi_status solve(dvi__rise *rise, const dvi__fine_axis *axis,
                        const dvi__coefficient *coefficient)
{
  rule r;
  if (!rise->start || !rise->moment || !rise->whole)
    return dvi__fail(DVI_NO_MEMORY, "%s: no memory for %d parts of cells", coefficient->name,
                     axis->parts);
  DVI_TRY(make_rule(rise->points, &r));
  for (int cell = 0; cell < axis->cells; cell++)
    DVI_TRY(solve_cell(rise, axis, coefficient, &r, cell));
  return DVI_OK;
}

dvi_status dvi__rise_create(const dvi__fine_axis *axis, const dvi__coefficient *coefficient,
                            int points, dvi__rise *rise)
{
  *rise = (dvi__rise){.points = points,
                      .start = DVI_NEW(double, axis->parts),
                      .moment = DVI_NEW(double, (size_t)axis->parts *(size_t)points),
                      .whole = DVI_NEW(double, axis->cells)};
  const dvi_status status = solve(rise, axis, coefficient);
  if (status != DVI_OK) dvi__rise_clear(rise);
  return status;
}

void dvi__rise_clear(dvi__rise *rise)
{
  dvi__release(rise->start);
  dvi__release(rise->moment);
  dvi__release(rise->whole);
  *rise = (dvi__rise){0};
}

double dvi__rise_value(const dvi__rise *rise, const dvi__fine_axis *axis, int order, int part,
                       double place)
{
  const double *moment = rise->moment + (size_t)part * (size_t)rise->points;
  long double P[MOST + 1] = {0}, sum = order == 0
                                           ? rise->start[part] + moment[0] * (long double)place
                                           : (long double)moment[0];
  legendre(rise->points + 1, place, P);
  for (int k = 1; k < rise->points; k++)
    sum += moment[k] * (order == 0 ? (P[k + 1] - P[k - 1]) / 2 : (2 * k + 1) * P[k]);
  return (double)(order == 0 ? sum : sum / dvi__fine_axis_length(axis, part));
}
