/* Trigonometric polynomials on periodic axes, orthonormal in L2,
 *
 *     1/sqrt(L),  sqrt(2/L) cos(2 pi k (x - a)/L),  sqrt(2/L) sin(2 pi k (x - a)/L),  k = 1 .. K,
 *
 * in the order 0, c1, s1, c2, s2 and so on, with M equal weights at equally spaced points. Sums of
 * products of p functions are exact for M > p K, so that the mass is the identity from M = 2K+1 on.
 * The default M, from 4K+2 on, is right for potentials of the fourth degree. Derivatives turn the
 * pairs (c, s) and multiply them by powers of the wave number. Boxes are transformed axis by axis.
 * Source: Leok 2004, sec. 5.8. */
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/space/kind.h"
#include "num/fft/fft.h"

enum { MODES, POINTS, MODES_MOST = 1 << 24 };

static const double pi = 3.14159265358979323846;

/* ---- one axis ---- */

static dvi_status place_equally(dvi__line *line, int points)
{
  line->cell_points = points;
  line->place = DVI_NEW(double, points);
  line->weight = DVI_NEW(double, points);
  if (line->place == NULL || line->weight == NULL)
    return dvi__fail(DVI_NO_MEMORY, "space: no memory for %d points", points);
  for (int j = 0; j < points; j++) {
    line->place[j] = (double)j / points;
    line->weight[j] = 1.0 / points;
  }
  return DVI_OK;
}

static dvi_status check_fourier(const dvi_axis *axis, const dvi__line *line)
{
  const int modes = line->value[MODES], points = line->value[POINTS];
  if (modes == 0)
    return dvi__fail(DVI_BAD_OPTION, "space: fourier has no modes; give modes=1 to %d", MODES_MOST);
  if (!line->periodic)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: fourier on axis %s, which is not periodic",
                     line->name);
  if (axis->nodes != 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "space: axis %s has nodes, but fourier has no cells",
                     line->name);
  if (points != 0 && points < 2 * modes + 1)
    return dvi__fail(DVI_BAD_OPTION, "space: fourier: points=%d with modes=%d; %d or more possible",
                     points, modes, 2 * modes + 1);
  return DVI_OK;
}

static void destroy_plan(void *own)
{
  dvi__fft *plan = own;
  dvi__fft_destroy(&plan);
}

static dvi_status fourier_create(const dvi_space_options *options, const dvi_axis *axis,
                                 dvi__line *line)
{
  (void)options;
  const int modes = line->value[MODES];
  dvi__fft *plan = NULL;
  DVI_TRY(check_fourier(axis, line));
  DVI_TRY(dvi__line_divide(axis, 1, line));
  line->locals = 2 * modes + 1;
  line->functions = line->locals;
  line->smoothness = DVI__ORDER_MOST;
  DVI_TRY(place_equally(line, line->value[POINTS] != 0 ? line->value[POINTS]
                                                       : dvi__fft_length(4 * modes + 2)));
  DVI_TRY(dvi__fft_create(line->cell_points, &plan));
  line->own = plan;
  return DVI_OK;
}

static void fourier_explain(const dvi__line *line, dvi__note *note)
{
  dvi__note_add(note, "%d points, exact for products of %d functions", line->cell_points,
                (line->cell_points - 1) / line->value[MODES]);
}

/* The derivative of function i of an axis. */
static dvi__fourier_image differentiate(const dvi__line *line, int order, int64_t i)
{
  static const double sign_of_cosine[4] = {1, -1, -1, 1}, sign_of_sine[4] = {1, 1, -1, -1};
  if (i == 0) return (dvi__fourier_image){0, order == 0 ? 1 : 0};
  const int is_sine = i % 2 == 0;
  const int64_t partner = is_sine ? i - 1 : i + 1;
  const int64_t k = (i + 1) / 2;
  const double wave = 2 * pi * (double)k / (line->to - line->from);
  double factor = (is_sine ? sign_of_sine : sign_of_cosine)[order % 4];
  for (int r = 0; r < order; r++) factor *= wave;
  return (dvi__fourier_image){order % 2 == 0 ? i : partner, factor};
}

dvi__fourier_image dvi__fourier_derivative(const dvi_space *space, const int *order, int64_t i)
{
  dvi__fourier_image image = {0, 1};
  int64_t stride = 1;
  for (int d = space->dimension - 1; d >= 0; d--) {
    const int64_t own = space->line[d].functions;
    const dvi__fourier_image part = differentiate(&space->line[d], order[d], i % own);
    image.other += stride * part.other;
    image.factor *= part.factor;
    stride *= own;
    i /= own;
  }
  return image;
}

static double norm_of(const dvi__line *line, int64_t i)
{
  return sqrt((i == 0 ? 1 : 2) / (line->to - line->from));
}

/* Add the coefficients of one side to those of the other without a derivative, where all but the
 * first have one factor. */
static void scale(const dvi__line *line, const double *restrict from, int64_t from_stride,
                  double *restrict to, int64_t to_stride)
{
  const double norm = norm_of(line, 1);
  const int64_t functions = line->functions;
  to[0] += norm_of(line, 0) * from[0];
  if (from_stride == 1 && to_stride == 1)
    for (int64_t i = 1; i < functions; i++) to[i] += norm * from[i];
  else
    for (int64_t i = 1; i < functions; i++) to[i * to_stride] += norm * from[i * from_stride];
}

/* Neighbouring lines of an array, whose numbers along the axis are `stride` apart. Up to 8 at a
 * time fill lines of the cache. */
enum { LINES = 8 };

typedef struct bundle {
  int lines;
  int64_t stride;
} bundle;

/* Set values [lines][points] to a derivative of the coefficients. */
static void synthesise(const dvi__line *line, int order, const double *U, bundle b, double *values,
                       double *work)
{
  const int64_t points = line->cell_points;
  const double norm = norm_of(line, 1); /* the constant has no derivative */
  memset(values, 0, (size_t)(b.lines * points) * sizeof *values);
  for (int q = 0; q < b.lines && order == 0; q++)
    scale(line, U + q, b.stride, values + q * points, 1);
  for (int64_t i = 1; i < line->functions && order > 0; i++) {
    const dvi__fourier_image image = differentiate(line, order, i);
    const double factor = image.factor * norm;
    for (int q = 0; q < b.lines; q++)
      values[q * points + image.other] += factor * U[i * b.stride + q];
  }
  for (int q = 0; q < b.lines; q++) dvi__fft_synthesise(line->own, values + q * points, work);
}

/* The transposed sum, with an array `copy` [lines][points] of the values. */
static void add_analysis(const dvi__line *line, int order, const double *values, bundle b,
                         double *copy, double *U, double *work)
{
  const int64_t points = line->cell_points;
  const double norm = norm_of(line, 1);
  if (b.stride == 1)
    memcpy(copy, values, (size_t)points * sizeof *copy);
  else
    for (int64_t j = 0; j < points; j++)
      for (int q = 0; q < b.lines; q++) copy[q * points + j] = values[j * b.stride + q];
  for (int q = 0; q < b.lines; q++) dvi__fft_analyse(line->own, copy + q * points, work);
  for (int q = 0; q < b.lines && order == 0; q++)
    scale(line, copy + q * points, 1, U + q, b.stride);
  for (int64_t i = 1; i < line->functions && order > 0; i++) {
    const dvi__fourier_image image = differentiate(line, order, i);
    const double factor = image.factor * norm;
    for (int q = 0; q < b.lines; q++)
      U[i * b.stride + q] += factor * copy[q * points + image.other];
  }
}

/* ---- products of axes ---- */

/* Numbers in an array that has coefficients along the first `axes` axes, and values along others.
 * */
static int64_t mixed_size(const dvi_space *space, int axes)
{
  int64_t size = 1;
  for (int d = 0; d < space->dimension; d++)
    size *= d < axes ? space->line[d].functions : dvi__line_points(&space->line[d]);
  return size;
}

/* Work is an array for the values on some lines, the work of a transform, and two arrays for what
 * stands between two axes. */
enum { LINE, TRANSFORM, BETWEEN, WORKPLACES = BETWEEN + DVI_AXES_MAX - 1 };

/* Give the ends of these arrays, which begin on cache lines. */
static void measure_work(const dvi_space *space, int64_t end[WORKPLACES])
{
  enum { CACHE_LINE = 8 };
  int64_t size[WORKPLACES] = {0}, sum = 0;
  for (int d = 0; d < space->dimension; d++) {
    const int64_t points = space->line[d].cell_points, own = dvi__fft_work(space->line[d].own);
    const int64_t lines = d + 1 < space->dimension ? LINES : 1;
    if (lines * points > size[LINE]) size[LINE] = lines * points;
    if (own > size[TRANSFORM]) size[TRANSFORM] = own;
    if (d > 0) size[BETWEEN + d - 1] = mixed_size(space, d);
  }
  for (int i = 0; i < WORKPLACES; i++)
    end[i] = sum += (size[i] + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
}

typedef struct workplace {
  double *line, *transform, *between[DVI_AXES_MAX - 1];
} workplace;

static workplace lay_out_work(const dvi_space *space, double *work)
{
  int64_t end[WORKPLACES];
  measure_work(space, end);
  return (workplace){.line = work,
                     .transform = work + end[LINE],
                     .between = {work + end[TRANSFORM], work + end[BETWEEN]}};
}

/* The lines along axis d: `before` bundles of `after` neighbours. */
static void count_lines(const dvi_space *space, int d, int64_t *before, int64_t *after)
{
  *before = *after = 1;
  for (int e = 0; e < d; e++) *before *= space->line[e].functions;
  for (int e = d + 1; e < space->dimension; e++) *after *= space->line[e].cell_points;
}

static bundle take_lines(int64_t first, int64_t after)
{
  return (bundle){after - first < LINES ? (int)(after - first) : LINES, after};
}

/* Transform the lines along axis d. Those of the last axis need no copies. */
static void synthesise_axis(const dvi__space_operator *B, int d, const double *from, double *to,
                            workplace w)
{
  const dvi__line *line = &B->space->line[d];
  const int64_t points = line->cell_points;
  int64_t before, after;
  count_lines(B->space, d, &before, &after);
  for (int64_t i = 0; i < before; i++)
    for (int64_t a = 0; a < after; a += LINES) {
      const bundle b = take_lines(a, after);
      double *at = to + i * points * after + a, *values = after > 1 ? w.line : at;
      synthesise(line, B->order[d], from + i * line->functions * after + a, b, values, w.transform);
      for (int64_t j = 0; j < points && after > 1; j++)
        for (int q = 0; q < b.lines; q++) at[j * after + q] = values[q * points + j];
    }
}

static void analyse_axis(const dvi__space_operator *B, int d, const double *from, double *to,
                         workplace w)
{
  const dvi__line *line = &B->space->line[d];
  int64_t before, after;
  count_lines(B->space, d, &before, &after);
  for (int64_t i = 0; i < before; i++)
    for (int64_t a = 0; a < after; a += LINES)
      add_analysis(line, B->order[d], from + i * line->cell_points * after + a,
                   take_lines(a, after), w.line, to + i * line->functions * after + a, w.transform);
}

static void torus_apply(const dvi__space_operator *B, const double *U, double *values, double *work)
{
  const workplace w = lay_out_work(B->space, work);
  const double *from = U;
  for (int d = B->space->dimension - 1; d >= 0; d--) {
    double *to = d > 0 ? w.between[d - 1] : values;
    synthesise_axis(B, d, from, to, w);
    from = to;
  }
}

static void torus_add_transposed(const dvi__space_operator *B, const double *values, double *U,
                                 double *work)
{
  const dvi_space *space = B->space;
  const workplace w = lay_out_work(space, work);
  const double *from = values;
  for (int d = 0; d + 1 < space->dimension; d++) {
    memset(w.between[d], 0, (size_t)mixed_size(space, d + 1) * sizeof(double));
    analyse_axis(B, d, from, w.between[d], w);
    from = w.between[d];
  }
  analyse_axis(B, space->dimension - 1, from, U, w);
}

static dvi_status torus_create(const dvi_space_options *options, dvi_space *space)
{
  (void)options;
  DVI_TRY(dvi__box_place(space));
  int64_t end[WORKPLACES];
  measure_work(space, end);
  space->work = end[WORKPLACES - 1];
  return DVI_OK;
}

/* ---- points anywhere ---- */

static double value_at(const dvi__line *line, int order, int64_t i, double x)
{
  const dvi__fourier_image image = differentiate(line, order, i);
  const int64_t k = (image.other + 1) / 2;
  const double turns = (x - line->from) / (line->to - line->from),
               angle = 2 * pi * remainder((double)k * remainder(turns, 1), 1);
  return image.factor * norm_of(line, i) *
         (image.other % 2 == 0 && k > 0 ? sin(angle) : cos(angle));
}

static dvi_status torus_row(const dvi_space *space, const int *order, const double *x, int *column,
                            double *value, int64_t *count)
{
  int64_t before = 1;
  *count = 0;
  for (int d = 0; d < space->dimension; d++)
    if (!isfinite(x[d])) return DVI_OK;
  value[0] = 1;
  for (int d = space->dimension - 1; d >= 0; d--) {
    const int64_t own = space->line[d].functions;
    for (int64_t j = own - 1; j >= 0; j--) { /* backwards, because the row grows in place */
      const double factor = value_at(&space->line[d], order[d], j, x[d]);
      for (int64_t i = before - 1; i >= 0; i--) value[j * before + i] = value[i] * factor;
    }
    before *= own;
  }
  *count = space->functions;
  for (int64_t i = 0; i < space->functions; i++) column[i] = (int)i;
  return DVI_OK;
}

/* Sum over the functions of axis d at x: from [own][after] to [after]. */
static void sum_over_axis(const dvi__line *line, int order, double x, int64_t after,
                          const double *from, double *to)
{
  memset(to, 0, (size_t)after * sizeof *to);
  for (int64_t j = 0; j < line->functions; j++) {
    const double factor = value_at(line, order, j, x);
    for (int64_t i = 0; i < after; i++) to[i] += factor * from[j * after + i];
  }
}

/* Points of a grid have the first coordinates of those before, and share the sums over these axes.
 * sum[d] has those over the axes 0 to d. */
static dvi_status sum_at_points(const dvi_space *space, const int *order, const double *U,
                                int64_t count, const double *x, double *const *sum, double *values)
{
  const int axes = space->dimension;
  double place[DVI_AXES_MAX] = {0};
  for (int64_t i = 0; i < count; i++) {
    bool is_known = i > 0;
    int64_t after = space->functions;
    for (int d = 0; d < axes; d++) {
      const double at = x[d * count + i];
      is_known = is_known && place[d] == at;
      place[d] = at;
      after /= space->line[d].functions;
      if (!isfinite(at)) return dvi__space_outside(space, place);
      if (!is_known)
        sum_over_axis(&space->line[d], order[d], at, after, d > 0 ? sum[d - 1] : U, sum[d]);
    }
    values[i] = sum[axes - 1][0];
  }
  return DVI_OK;
}

static dvi_status torus_evaluate(const dvi_space *space, const int *order, const double *U,
                                 int64_t count, const double *x, double *values)
{
  double *room = DVI_NEW(double, 2 * space->functions), *sum[DVI_AXES_MAX] = {room};
  if (room == NULL) return dvi__fail(DVI_NO_MEMORY, "space: no memory");
  int64_t after = space->functions;
  for (int d = 0; d + 1 < space->dimension; d++) {
    after /= space->line[d].functions;
    sum[d + 1] = sum[d] + after;
  }
  const dvi_status status = sum_at_points(space, order, U, count, x, sum, values);
  dvi__release(room);
  return status;
}

/* The mass is the identity. */
static dvi_status torus_interpolate(const dvi_space *space, const dvi__sampled *f, double *U)
{
  const dvi__space_operator B = {.space = space};
  double *values = DVI_NEW(double, space->points), *work = DVI_NEW(double, space->work);
  dvi_status status = values != NULL && work != NULL
                          ? dvi__space_sample(space->dimension, f, space->points, space->x, values)
                          : dvi__fail(DVI_NO_MEMORY, "space: no memory for a transform");
  if (status == DVI_OK) {
    for (int64_t i = 0; i < space->points; i++) values[i] *= space->weight[i];
    memset(U, 0, (size_t)space->functions * sizeof *U);
    dvi__operator_add_transposed(&B, values, U, work);
  }
  dvi__release(values);
  dvi__release(work);
  return status;
}

static void torus_explain(const dvi_space *space, dvi__note *note)
{
  for (int d = 0; d < space->dimension; d++) {
    const dvi__line *line = &space->line[d];
    dvi__note_add(note, "axis %s, %g to %g, periodic: fourier, modes to %d: %lld functions, ",
                  line->name, line->from, line->to, line->value[MODES], (long long)line->functions);
    fourier_explain(line, note);
    dvi__note_add(note, "\n");
  }
  dvi__explain_product(space, note);
}

const dvi__domain dvi__torus = {
    .create = torus_create,
    .apply = torus_apply,
    .add_transposed = torus_add_transposed,
    .row = torus_row,
    .evaluate = torus_evaluate,
    .interpolate = torus_interpolate,
    .explain = torus_explain,
};

const dvi__kind dvi__fourier = {
    .form = {.name = "fourier",
             .key = {[MODES] = {"modes", 1, MODES_MOST - 1, 0, NULL},
                     [POINTS] = {"points", 1, DVI__FFT_MAX, 0, NULL}}},
    .create = fourier_create,
    .destroy = destroy_plan,
    .explain = fourier_explain,
    .domain = &dvi__torus,
    .domain_axes = 1,
};
