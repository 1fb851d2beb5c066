/* Effective tensors by the periodic problem of a cell.
 *
 * Space: linear functions plus periodic bilinear elements on fine cells. Quadrature: exact, with a
 * constant in each fine cell. u_i = x_i + w_i is the stationary point of
 *     L = -1/2 int a |grad u_i|^2
 * among periodic w_i, and A_ij the mean of a grad u_i . grad u_j. On one axis a u' is constant, and
 * A is the harmonic mean. Source: Bensoussan, Lions and Papanicolaou 1978, ch. 1. */
#include <dvi/multiscale.h>
#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/multiscale/patch.h"
#include "field/multiscale/rise.h"
#include "field/multiscale/sample.h"

enum { FINE = 64, FINE_MOST = 512, POINTS = 8 };

static dvi_status check_axis(const dvi_axis *axis, int d)
{
  if (isfinite(axis->from) && isfinite(axis->to) && axis->from < axis->to) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, "effective tensor: axis %d goes from %g to %g; it must ascend",
                   d, axis->from, axis->to);
}

static dvi_status check(const dvi_effective_options *options, const double *tensor)
{
  if (options == NULL || options->axis == NULL || options->coefficient == NULL || tensor == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "effective tensor: the axes, the coefficient or the result is missing");
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "effective tensor: set options.size to sizeof(dvi_effective_options)");
  if (options->axes < 1 || options->axes > 2)
    return dvi__fail(DVI_BAD_SIZE, "effective tensor: %d axes, but 1 or 2 are possible",
                     options->axes);
  if (options->fine < 0 || options->fine > FINE_MOST)
    return dvi__fail(DVI_BAD_SIZE, "effective tensor: fine is %d, but 1 to %d parts are possible",
                     options->fine, FINE_MOST);
  for (int d = 0; d < options->axes; d++) DVI_TRY(check_axis(&options->axis[d], d));
  return DVI_OK;
}

static dvi_status harmonic_mean(const dvi__fine_axis *axis, const dvi__coefficient *coefficient,
                                double *mean)
{
  dvi__rise rise;
  DVI_TRY(dvi__rise_create(axis, coefficient, POINTS, &rise));
  *mean = (axis->end[axis->parts] - axis->end[0]) / rise.whole[0];
  dvi__rise_clear(&rise);
  return DVI_OK;
}

/* ---- two axes ---- */

typedef struct cell_problem {
  const dvi__fine_axis *axis;
  dvi__patch patch;
  double *h[2], *a;
  double *u[2]; /* at the nodes */
} cell_problem;

static dvi_status solve(const dvi__coefficient *coefficient, cell_problem *p)
{
  const int n = p->axis[0].parts;
  double defect;
  for (int d = 0; d < 2; d++)
    for (int i = 0; i < n; i++) p->h[d][i] = dvi__fine_axis_length(&p->axis[d], i);
  DVI_TRY(dvi__coefficient_of_cells(p->axis, coefficient, p->a, &defect));
  DVI_TRY(dvi__patch_factor(&p->patch, p->h[0], p->h[1], p->a));
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= n; j++) {
      p->u[0][i * (n + 1) + j] = p->axis[0].end[i] - p->axis[0].end[0];
      p->u[1][i * (n + 1) + j] = p->axis[1].end[j] - p->axis[1].end[0];
    }
  for (int d = 0; d < 2; d++) DVI_TRY(dvi__patch_solve(&p->patch, p->u[d]));
  return DVI_OK;
}

static void set_tensor(const cell_problem *p, double *tensor)
{
  const int n = p->axis[0].parts;
  const double area = (p->axis[0].end[n] - p->axis[0].end[0]) *
                      (p->axis[1].end[n] - p->axis[1].end[0]);
  tensor[0] = dvi__patch_product(&p->patch, p->u[0], p->u[0]) / area;
  tensor[1] = tensor[2] = dvi__patch_product(&p->patch, p->u[0], p->u[1]) / area;
  tensor[3] = dvi__patch_product(&p->patch, p->u[1], p->u[1]) / area;
}

static dvi_status allocate(cell_problem *p)
{
  const size_t n = (size_t)p->axis[0].parts;
  p->a = DVI_NEW(double, n *n);
  int has_memory = p->a != NULL;
  for (int d = 0; d < 2; d++) {
    p->h[d] = DVI_NEW(double, n);
    p->u[d] = DVI_NEW(double, (n + 1) * (n + 1));
    has_memory = has_memory && p->h[d] != NULL && p->u[d] != NULL;
  }
  if (!has_memory)
    return dvi__fail(DVI_NO_MEMORY, "effective tensor: no memory for %zu x %zu parts", n, n);
  return dvi__patch_create((int)n, (int)n, DVI__PATCH_PERIODIC, &p->patch);
}

static dvi_status plane_tensor(const dvi__fine_axis *axis, const dvi__coefficient *coefficient,
                               double *tensor)
{
  cell_problem p = {.axis = axis};
  dvi_status status = allocate(&p);
  if (status == DVI_OK) status = solve(coefficient, &p);
  if (status == DVI_OK) set_tensor(&p, tensor);
  dvi__patch_clear(&p.patch);
  dvi__release(p.a);
  for (int d = 0; d < 2; d++) {
    dvi__release(p.h[d]);
    dvi__release(p.u[d]);
  }
  return status;
}

dvi_status dvi_effective_tensor(const dvi_effective_options *options, double *tensor)
{
  DVI_TRY(check(options, tensor));
  const dvi__coefficient coefficient = {"effective tensor", options->axes, options->coefficient,
                                        options->user};
  dvi__fine_axis axis[2] = {{0}};
  dvi_status status = DVI_OK;
  for (int d = 0; d < options->axes && status == DVI_OK; d++) {
    const double end[2] = {options->axis[d].from, options->axis[d].to};
    status = dvi__fine_axis_create(end, 1, options->fine > 0 ? options->fine : FINE, 1, &axis[d]);
  }
  if (status == DVI_OK)
    status = options->axes == 1 ? harmonic_mean(axis, &coefficient, tensor)
                                : plane_tensor(axis, &coefficient, tensor);
  for (int d = 0; d < 2; d++) dvi__fine_axis_clear(&axis[d]);
  return status;
}
