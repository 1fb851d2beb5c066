/* The static states of a field: K u = b with b = W f + the flux, and with a potential
 * K u + w V_u(u) = b.
 *
 * In a component of the mesh where no value is fixed, K has constants as its kernel. There the sum
 * of b has to vanish. A factor needs one unknown of the component held while the others are solved
 * for, and an iteration does not. The mean of the component, by M_0, is chosen afterwards. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/definite.h"
#include "field/mesh/share.h"
#include "field/model/field.h"
#include "field/model/newton.h"
#include "field/model/on_all.h"

static const double default_imbalance = 1e-8;

/* What is known of each free component. */
typedef struct statics {
  const dvi_field *field;
  const dvi_field_solve_options *options;
  double *b, *x, *mass; /* [unknowns] the right side, the solution, and the sums of M_0's rows */
  double *sum, *size, *weight; /* [components] sums of b, |b| and mass */
  dvi_field_solve_report report;
} statics;

/* ---- components ---- */

static dvi_status allocate(statics *s)
{
  const int64_t n = s->field->unknowns, components = s->field->components;
  const dvi_matrix M = dvi__csr_view(&s->field->mass, 1);
  s->b = DVI_NEW(double, 3 * n + 3 * components);
  if (s->b == NULL)
    return dvi__fail(DVI_NO_MEMORY, "field: no memory for %lld unknowns", (long long)n);
  s->x = s->b + n;
  s->mass = s->x + n;
  s->sum = s->mass + n;
  s->size = s->sum + components;
  s->weight = s->size + components;
  for (int64_t i = 0; i < n; i++) s->x[i] = 1;
  dvi_matrix_multiply(&M, 0, s->x, s->mass);
  memcpy(s->b, s->field->load, (size_t)n * sizeof *s->b);
  return DVI_OK;
}

static dvi_status refuse_imbalance(const statics *s, double sum, double imbalance)
{
  return dvi__fail(
      DVI_BAD_ARGUMENT,
      "field: no value is fixed, and source and flux sum to %.3g, %.2g of their size, "
      "where no solution exists unless they sum to 0: fix a value, change the data, or "
      "set `imbalance` above it to have the sum taken away (it is %.2g)",
      sum, imbalance, s->options->imbalance != 0 ? s->options->imbalance : default_imbalance);
}

/* Terms of the sums of components. */
static double right_side(const statics *s, int64_t i)
{
  return s->b[i];
}
static double size_of_right_side(const statics *s, int64_t i)
{
  return fabs(s->b[i]);
}
static double mass_of(const statics *s, int64_t i)
{
  return s->mass[i];
}
static double moment(const statics *s, int64_t i)
{
  return s->mass[i] * s->x[i];
}

/* Sum the terms of own unknowns of a component, exactly, over all processes. */
static dvi_status sum_share(const statics *s, double (*term)(const statics *s, int64_t i), int c,
                            double *sum)
{
  const dvi_field *f = s->field;
  dvi__accumulator exact = {.terms = 0};
  for (int64_t i = 0; i < f->unknowns; i++)
    if (f->component[i] == c && dvi__owns(f->mesh, 0, f->unknown[i]))
      dvi__accumulate(&exact, term(s, i));
  return dvi__sum_of_all(f->mesh, &exact, sum);
}

/* Set sum [components] to the sums of terms. */
static dvi_status sum_up(const statics *s, double (*term)(const statics *s, int64_t i), double *sum)
{
  const dvi_field *f = s->field;
  for (int64_t c = 0; c < f->components; c++) {
    sum[c] = 0;
    if (f->mesh->share != NULL) DVI_TRY(sum_share(s, term, (int)c, sum + c));
  }
  for (int64_t i = 0; i < f->unknowns && f->mesh->share == NULL; i++)
    if (f->component[i] >= 0) sum[f->component[i]] += term(s, i);
  return DVI_OK;
}

static dvi_status take_sums_away(statics *s)
{
  const dvi_field *f = s->field;
  DVI_TRY(sum_up(s, right_side, s->sum));
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->component[i];
    if (c >= 0) s->b[i] -= s->sum[c] * s->mass[i] / s->weight[c];
  }
  return DVI_OK;
}

/* Take the sums of b away, in proportion to the mass, twice because of roundings. */
static dvi_status balance(statics *s)
{
  const dvi_field *f = s->field;
  const double most = s->options->imbalance != 0 ? s->options->imbalance : default_imbalance;
  DVI_TRY(sum_up(s, right_side, s->sum));
  DVI_TRY(sum_up(s, size_of_right_side, s->size));
  DVI_TRY(sum_up(s, mass_of, s->weight));
  for (int64_t c = 0; c < f->components; c++) {
    const double imbalance = s->size[c] > 0 ? fabs(s->sum[c]) / s->size[c] : 0;
    s->report.imbalance = fmax(s->report.imbalance, imbalance);
    if (imbalance > most) return refuse_imbalance(s, s->sum[c], imbalance);
  }
  for (int pass = 0; pass < 2; pass++) DVI_TRY(take_sums_away(s));
  return DVI_OK;
}

static dvi_status set_means(statics *s)
{
  const dvi_field *f = s->field;
  DVI_TRY(sum_up(s, moment, s->sum));
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int c = f->component[i];
    if (c >= 0) s->x[i] += s->options->mean - s->sum[c] / s->weight[c];
  }
  return DVI_OK;
}

/* ---- linear problems ---- */

/* Number all unknowns but the first of each free component. Returns how many there are. */
static int64_t number_unheld(const dvi_field *f, int *number)
{
  int count = 0;
  int64_t held = 0; /* components are numbered in the order of their first unknowns */
  for (int64_t i = 0; i < f->unknowns; i++) {
    const int is_first = f->component[i] >= 0 && f->component[i] == held;
    held += is_first;
    number[i] = is_first ? -1 : count++;
  }
  return count;
}

static dvi_status solve_unheld(statics *s, const int *number, int64_t count, double *room)
{
  const dvi_field *f = s->field;
  const dvi__selection unheld = {.row = number, .column = number, .rows = count, .columns = count};
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  double *b = room, *x = room + count;
  dvi__csr part = {0};
  dvi__definite solver = {0};
  dvi__iteration_report iteration = {0};
  DVI_TRY(dvi__csr_select(&K, &unheld, &part));
  const dvi_matrix view = dvi__csr_view(&part, 1);
  for (int64_t i = 0; i < f->unknowns; i++)
    if (number[i] >= 0) b[number[i]] = s->b[i];
  dvi_status status = dvi__definite_create(&view, f->mesh->n, &solver);
  dvi__csr_clear(&part);
  if (status == DVI_OK) status = dvi__definite_solve(&solver, b, x, &iteration);
  dvi__definite_clear(&solver);
  for (int64_t i = 0; i < f->unknowns; i++) s->x[i] = number[i] >= 0 ? x[number[i]] : 0;
  s->report.iterations = iteration.iterations;
  return status;
}

static dvi_status solve_with_factor(statics *s)
{
  const int64_t n = s->field->unknowns;
  int *number = DVI_NEW(int, n);
  double *room = DVI_NEW(double, 2 * n);
  dvi_status status = number != NULL && room != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "field: no memory for a solution");
  const int64_t count = status == DVI_OK ? number_unheld(s->field, number) : 0;
  if (status == DVI_OK && count > 0) status = solve_unheld(s, number, count, room);
  if (status == DVI_OK && count == 0) s->x[0] = 0;
  dvi__release(number);
  dvi__release(room);
  return status;
}

/* ---- linear problems by iteration ---- */

static dvi_status times_stiffness(void *of, const double *x, double *y)
{
  const dvi_matrix K = dvi__csr_view(&((statics *)of)->field->stiffness, 1);
  dvi_matrix_multiply(&K, 0, x, y);
  return DVI_OK;
}

/* Directions have no part in the kernel of K, the constants on free components. */
static void precondition(void *of, const double *r, double *z)
{
  statics *s = of;
  const dvi_field *f = s->field;
  const dvi_matrix K = dvi__csr_view(&f->stiffness, 1);
  dvi__gauss_seidel(&K, r, z);
  for (int64_t c = 0; c < f->components; c++) s->sum[c] = s->size[c] = 0;
  for (int64_t i = 0; i < f->unknowns; i++) {
    if (f->component[i] < 0) continue;
    s->sum[f->component[i]] += z[i];
    s->size[f->component[i]]++;
  }
  for (int64_t i = 0; i < f->unknowns; i++)
    if (f->component[i] >= 0) z[i] -= s->sum[f->component[i]] / s->size[f->component[i]];
}

static dvi_status solve_by_iteration(statics *s)
{
  const dvi__products products = {
      .size = s->field->unknowns, .times = times_stiffness, .precondition = precondition, .of = s};
  dvi__iteration_report iteration;
  DVI_TRY(dvi__conjugate_gradients(&products, 1e-14, s->b, s->x, &iteration));
  s->report.iterations = iteration.iterations;
  return DVI_OK;
}

static dvi_status residual(void *of, const double *x, double *r)
{
  const statics *s = of;
  const dvi_matrix K = dvi__csr_view(&s->field->stiffness, 1);
  dvi_matrix_multiply(&K, 0, x, r);
  for (int64_t i = 0; i < s->field->unknowns; i++) r[i] -= s->b[i];
  return DVI_OK;
}

static dvi_status solve_on_all(statics *s)
{
  const dvi__field_equations equations = {.field = s->field, .residual = residual, .of = s};
  dvi__elliptic_report report;
  memset(s->x, 0, (size_t)s->field->unknowns * sizeof *s->x);
  DVI_TRY(dvi__field_solve_on_all(&equations, s->x, &report));
  s->report.iterations = (int)report.iterations;
  return DVI_OK;
}

static dvi_status solve_linear(statics *s)
{
  const dvi_field *f = s->field;
  DVI_TRY(balance(s));
  if (f->mesh->share != NULL)
    DVI_TRY(solve_on_all(s));
  else
    DVI_TRY(dvi__definite_iterates(f->unknowns, f->mesh->n) ? solve_by_iteration(s)
                                                            : solve_with_factor(s));
  return set_means(s);
}

/* Give the length of a vector of unknowns. Numbers are scaled, so that their squares do not
 * overflow. */
static dvi_status measure_length(const dvi_field *f, const double *x, double *length)
{
  double sum = 0, most = 0;
  dvi__accumulator exact = {.terms = 0};
  for (int64_t i = 0; i < f->unknowns; i++)
    if (dvi__owns(f->mesh, 0, f->unknown[i])) most = fmax(most, fabs(x[i]));
  DVI_TRY(dvi__largest_of_all(f->mesh, 1, &most));
  for (int64_t i = 0; i < f->unknowns && most > 0; i++) {
    const double square = x[i] / most * (x[i] / most);
    sum += square;
    if (f->mesh->share != NULL && dvi__owns(f->mesh, 0, f->unknown[i]))
      dvi__accumulate(&exact, square);
  }
  if (f->mesh->share != NULL) DVI_TRY(dvi__sum_of_all(f->mesh, &exact, &sum));
  *length = most * sqrt(sum);
  return DVI_OK;
}

static dvi_status check_finite(const statics *s)
{
  for (int64_t i = 0; i < s->field->unknowns; i++)
    DVI_TRY(dvi__field_check_datum(s->field, "solution", 0, s->x[i], 0, s->field->unknown[i]));
  return isfinite(s->report.residual)
             ? DVI_OK
             : dvi__fail(DVI_NOT_FINITE, "field: the residual of the solution is %g",
                         s->report.residual);
}

/* Set the residual beside b. With a potential it is the one that Newton's method left. */
static dvi_status measure(statics *s)
{
  double size, left;
  (void)residual(s, s->x, s->mass);
  DVI_TRY(measure_length(s->field, s->b, &size));
  DVI_TRY(measure_length(s->field, s->mass, &left));
  s->report.residual = size > 0 ? left / size : left;
  return DVI_OK;
}

/* ---- both ---- */

static dvi_status solve(statics *s, double *u)
{
  const dvi_field *f = s->field;
  const dvi_status allocated = dvi__agree(f->mesh, allocate(s));
  if (allocated != DVI_OK || s->b == NULL) return allocated;
  s->report.unknowns = f->whole_unknowns;
  if (f->potential.density != NULL) {
    for (int64_t i = 0; i < f->unknowns; i++) s->x[i] = u[f->unknown[i]];
    DVI_TRY(dvi__field_newton(f, s->x, &s->report));
  } else {
    DVI_TRY(solve_linear(s));
    DVI_TRY(measure(s));
  }
  DVI_TRY(dvi__agree(f->mesh, check_finite(s)));
  return dvi_field_lift(f, s->x, u);
}

dvi_status dvi_field_solve(const dvi_field *field, const dvi_field_solve_options *options,
                           double *u, dvi_field_solve_report *report)
{
  const dvi_field_solve_options defaults = {.size = sizeof defaults};
  statics s = {.field = field, .options = options != NULL ? options : &defaults};
  if (field == NULL || u == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "field: a field and its values are needed");
  if (!field->is_wave)
    return dvi__fail(DVI_UNSUPPORTED,
                     "field: static states are those of waves, 'field: wave', and this field is "
                     "Maxwell's");
  if (s.options->size != sizeof defaults)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "field: set options.size to sizeof(dvi_field_solve_options)");
  if (!isfinite(s.options->mean) || !(s.options->imbalance >= 0))
    return dvi__fail(DVI_BAD_ARGUMENT, "field: the mean %g or the imbalance %g cannot be",
                     s.options->mean, s.options->imbalance);
  const dvi_status status = solve(&s, u);
  dvi__release(s.b);
  if (status == DVI_OK && report != NULL) *report = s.report;
  return status;
}
