/* The sum of a part over its points for Fourier spaces, by transforms of all points at once,
 *
 *     z = B q,    sum_k w_k l(x_k, z_k),    B^T (w l_z),    B^T (w l_zz) B column by column. */
#include <string.h>

#include "field/density/density.h"
#include "num/simd/wide.h"

/* What the room of a part has. */
typedef struct spread {
  const dvi_density *density;
  const dvi__density_part *part;
  double sign;
  double *U;       /* [functions] of one component */
  double *z, *l_z; /* [variables*points] */
  double *l;       /* [points] */
  double *work;
  double *l_zz; /* [pairs*points] */
} spread;

/* ---- rooms ---- */

static int64_t room_of_part(const dvi_density *density, const dvi__density_part *part)
{
  const int64_t each = 2 * part->given.variables + 1 + part->given.pairs;
  return density->functions + each * part->points + dvi__operator_work(density->space);
}

int64_t dvi__density_room(const dvi_density *density)
{
  int64_t most = 3 * density->moving;
  for (int p = 0; p < density->parts && density->is_fourier; p++) {
    const int64_t count = room_of_part(density, density->part + p);
    if (count > most) most = count;
  }
  return most;
}

static spread furnish(const dvi__integral *integral, const dvi__density_part *part, double *room)
{
  const dvi_density *density = integral->density;
  spread s = {.density = density, .part = part, .sign = integral->sign, .U = room};
  s.z = s.U + density->functions;
  s.l_z = s.z + part->given.variables * part->points;
  s.l = s.l_z + part->given.variables * part->points;
  s.work = s.l + part->points;
  s.l_zz = s.work + dvi__operator_work(density->space);
  return s;
}

/* ---- transforms ---- */

/* Give the coefficients of a component. Missing coordinates are 0. */
static void lift(const spread *s, int component, const double *q)
{
  const int *number = s->density->number + component * s->density->functions;
  for (int64_t i = 0; i < s->density->functions; i++)
    s->U[i] = q != NULL && number[i] >= 0 ? q[number[i]] : 0;
}

static void find_variables(const spread *s, const dvi__density_point *at)
{
  for (int a = 0; a < s->part->given.variables; a++) {
    const dvi_jet *jet = s->part->given.variable + a;
    lift(s, jet->component, jet->rate ? at->v : at->q);
    dvi__operator_apply(s->part->transform + a, s->U, s->z + a * s->part->points, s->work);
  }
}

/* Add B^T of values at the points to the coordinates from `first` to `last`-1. */
static void add_transposed(const spread *s, int a, const double *values, int64_t first,
                           int64_t last, double *derivative)
{
  const int component = s->part->given.variable[a].component;
  const int *number = s->density->number + component * s->density->functions;
  memset(s->U, 0, (size_t)s->density->functions * sizeof *s->U);
  dvi__operator_add_transposed(s->part->transform + a, values, s->U, s->work);
  for (int64_t i = 0; i < s->density->functions; i++)
    if (number[i] >= first && number[i] < last) derivative[number[i] - first] += s->U[i];
}

WIDE static void weigh(int64_t points, double sign, const double *restrict weight,
                       double *restrict values)
{
  for (int64_t k = 0; k < points; k++) values[k] *= sign * weight[k];
}

static void add_first(const spread *s, const dvi__density_point *at, const dvi__density_sums *sums)
{
  const int64_t points = s->part->points;
  for (int a = 0; a < s->part->given.variables; a++) {
    double *const derivative = s->part->given.variable[a].rate ? sums->v : sums->q;
    double *l_z = s->l_z + a * points;
    if (derivative == NULL) continue;
    weigh(points, s->sign, s->part->weight, l_z);
    add_transposed(s, a, l_z, at->first, at->last, derivative);
  }
}

/* ---- second derivatives ---- */

/* Set z to the variables of coordinate j, as a rate or not. Others are 0. */
static void find_column(const spread *s, int64_t j, int is_rate)
{
  const int64_t place = s->density->unknown[j], points = s->part->points;
  const int component = (int)(place / s->density->functions);
  for (int a = 0; a < s->part->given.variables; a++) {
    const dvi_jet *jet = s->part->given.variable + a;
    memset(s->z + a * points, 0, (size_t)points * sizeof *s->z);
    if (jet->component != component || (jet->rate != 0) != is_rate) continue;
    memset(s->U, 0, (size_t)s->density->functions * sizeof *s->U);
    s->U[place - component * s->density->functions] = 1;
    dvi__operator_apply(s->part->transform + a, s->U, s->z + a * points, s->work);
  }
}

/* Add w l_zz times variable b to row a of the products. */
static void add_pair(const spread *s, int e, int a, int b)
{
  const int64_t points = s->part->points;
  const double *l_zz = s->l_zz + e * points, *z = s->z + b * points;
  double *product = s->l_z + a * points;
  for (int64_t k = 0; k < points; k++) product[k] += s->sign * s->part->weight[k] * l_zz[k] * z[k];
}

/* Add the second derivatives by rows and columns that are rates or not. */
static void add_second(const spread *s, int row_is_rate, int column_is_rate, double *values)
{
  const int64_t n = s->density->unknowns, points = s->part->points;
  const dvi_density_part *given = &s->part->given;
  for (int64_t j = 0; j < n; j++) {
    find_column(s, j, column_is_rate);
    memset(s->l_z, 0, (size_t)(given->variables * points) * sizeof *s->l_z);
    for (int e = 0; e < given->pairs; e++) {
      add_pair(s, e, given->pair[e][0], given->pair[e][1]);
      if (given->pair[e][0] != given->pair[e][1])
        add_pair(s, e, given->pair[e][1], given->pair[e][0]);
    }
    for (int a = 0; a < given->variables; a++)
      if ((given->variable[a].rate != 0) == row_is_rate)
        add_transposed(s, a, s->l_z + a * points, 0, n, values + j * n);
  }
}

/* ---- all ---- */

static int add_rate(const spread *s, double t, double *rate)
{
  const dvi_density_part *given = &s->part->given;
  if (given->time_derivative == NULL) return 0;
  const int failed = given->time_derivative((int)s->part->points, t, s->part->x, s->z, s->l,
                                            given->user);
  for (int64_t k = 0; k < s->part->points && failed == 0; k++)
    *rate += s->sign * s->part->weight[k] * s->l[k];
  return failed;
}

int dvi__part_sum_by_transforms(const dvi__integral *integral, const dvi__density_part *part,
                                const dvi__density_point *at, double *room,
                                const dvi__density_sums *sums)
{
  const spread s = furnish(integral, part, room);
  const int has_first = sums->q != NULL || sums->v != NULL,
            has_second = sums->qq != NULL || sums->qv != NULL || sums->vv != NULL;
  find_variables(&s, at);
  const int failed = part->given.density((int)part->points, at->t, part->x, s.z,
                                         sums->value != NULL ? s.l : NULL, has_first ? s.l_z : NULL,
                                         has_second ? s.l_zz : NULL, part->given.user);
  if (failed != 0) return failed;
  for (int64_t k = 0; k < part->points && sums->value != NULL; k++)
    *sums->value += s.sign * part->weight[k] * s.l[k];
  if (has_first) add_first(&s, at, sums);
  const int late = sums->rate != NULL ? add_rate(&s, at->t, sums->rate) : 0;
  if (sums->qq != NULL) add_second(&s, 0, 0, sums->qq);
  if (sums->qv != NULL) add_second(&s, 0, 1, sums->qv);
  if (sums->vv != NULL) add_second(&s, 1, 1, sums->vv);
  return late;
}
