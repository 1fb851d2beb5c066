#include "method/element/bordered.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"

/* ---- equations ---- */

static double bordered_length(const dvi__bordered *b, const double *x)
{
  return b->h0 + x[b->rows] / b->unit;
}

/* Find the path Y from x and place the action there. */
static dvi_status bordered_place(dvi__bordered *b, const double *x)
{
  const double h = bordered_length(b, x), moved = x[b->rows] / b->unit;
  if (!(h / b->h0 > 0) || !isnormal(h))
    return dvi__fail(DVI_NOT_CONVERGED, "the energy equation leads to a step of %g", h);
  for (int i = 0; i < b->rows; i++) b->Y[i] = x[i] + moved * b->tangent[i];
  dvi__action_place(b->action, b->state->t, h, b->state->q, b->state->p);
  return DVI_OK;
}

static dvi_status bordered_residual(void *of, const double *x, double *R)
{
  dvi__bordered *b = of;
  dvi__energies E;
  DVI_TRY(bordered_place(b, x));
  DVI_TRY(dvi__action_residual(b->action, b->Y, R));
  DVI_TRY(dvi__action_energies(b->action, &E));
  R[b->rows] = E.start - b->target;
  return DVI_OK;
}

/* Evaluate dR/dY, dR/dh and the gradient of E- at a path of the action. */
static dvi_status bordered_derivatives(dvi__bordered *b, const double *Y)
{
  DVI_TRY(dvi__action_jacobian(b->action, Y, b->values));
  DVI_TRY(dvi__action_energy_gradients(b->action, &b->start, &b->end));
  dvi__action_h_column(b->action, &b->end, b->column);
  return DVI_OK;
}

/* Evaluate the Jacobian. The row of the energy ends each column of dR/dY. The last column is that
 * of h along the tangent. */
static dvi_status bordered_jacobian(void *of, const double *x, double *values)
{
  dvi__bordered *b = of;
  const dvi__pattern *inner = dvi__action_pattern(b->action);
  double *at = values;
  DVI_TRY(bordered_place(b, x));
  DVI_TRY(bordered_derivatives(b, b->Y));
  double energy = b->start.h;
  for (int j = 0; j < b->rows; j++) {
    for (int e = inner->start[j]; e < inner->start[j + 1]; e++) {
      *at++ = b->values[e];
      b->column[inner->row[e]] += b->values[e] * b->tangent[j];
    }
    *at++ = b->start.Y[j];
    energy += b->start.Y[j] * b->tangent[j];
  }
  for (int i = 0; i < b->rows; i++) *at++ = b->column[i] / b->unit;
  *at = energy / b->unit;
  return DVI_OK;
}

static dvi_status bordered_prepare_chord(void *of, const double *x)
{
  dvi__bordered *b = of;
  DVI_TRY(bordered_place(b, x));
  return dvi__action_prepare_chord(b->action, b->Y);
}

static dvi_status bordered_row_scale(void *of, double *scale, int *unchanged)
{
  const dvi__bordered *b = of;
  (void)unchanged;
  (void)dvi__action_row_scale(b->action, scale);
  scale[b->rows] = b->row;
  return DVI_OK;
}

/* ---- create ---- */

static dvi_status add_border(const dvi__pattern *inner, dvi__pattern *pattern)
{
  const int n = inner->columns;
  const size_t entries = (size_t)dvi__pattern_entries(inner) + 2 * (size_t)n + 1;
  if (entries > 0x7fffffff)
    return dvi__fail(DVI_BAD_SIZE,
                     "sem: the Jacobian would have %zu entries; declare sparse Hessians", entries);
  *pattern = (dvi__pattern){n + 1, n + 1, DVI_NEW(int, (size_t)n + 2), DVI_NEW(int, entries)};
  if (pattern->start == NULL || pattern->row == NULL) {
    dvi__pattern_clear(pattern);
    return dvi__fail(DVI_NO_MEMORY, "sem: no memory for a Jacobian of %zu entries", entries);
  }
  int at = 0;
  for (int j = 0; j < n; j++) {
    for (int e = inner->start[j]; e < inner->start[j + 1]; e++) pattern->row[at++] = inner->row[e];
    pattern->row[at++] = n;
    pattern->start[j + 1] = at;
  }
  for (int i = 0; i <= n; i++) pattern->row[at++] = i;
  pattern->start[n + 1] = at;
  return DVI_OK;
}

static dvi_status bordered_allocate(dvi__bordered *b, size_t n)
{
  const size_t rows = (size_t)b->rows;
  b->x = DVI_NEW(double, rows + 1);
  b->direction = DVI_NEW(double, rows + 1);
  b->Y = DVI_NEW(double, rows);
  b->tangent = DVI_NEW(double, rows);
  b->column = DVI_NEW(double, rows);
  b->start = (dvi__energy_gradient){DVI_NEW(double, rows), DVI_NEW(double, n), 0};
  b->end = (dvi__energy_gradient){DVI_NEW(double, rows), DVI_NEW(double, n), 0};
  if (b->x && b->direction && b->Y && b->tangent && b->column && b->start.Y && b->start.q0 &&
      b->end.Y && b->end.q0)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "sem: no memory for %zu unknowns", rows);
}

/* Prepare the derivatives of the rows when they are first needed. */
static dvi_status bordered_prepare_derivatives(dvi__bordered *b)
{
  const dvi__pattern *inner = dvi__action_pattern(b->action);
  if (b->schur != NULL) return DVI_OK;
  DVI_TRY(dvi__action_prepare_jacobian(b->action));
  if (b->values == NULL) b->values = DVI_NEW(double, dvi__pattern_entries(inner));
  if (b->values == NULL)
    return dvi__fail(DVI_NO_MEMORY, "sem: no memory for a Jacobian of %d rows", b->rows);
  return dvi__linear_create(inner, DVI__LINEAR_AUTO, b->element.counters, &b->schur);
}

static dvi_status bordered_prepare(void *of, dvi__equations *equations)
{
  dvi__bordered *b = of;
  DVI_TRY(bordered_prepare_derivatives(b));
  equations->pattern = &b->pattern;
  return b->pattern.start != NULL ? DVI_OK
                                  : add_border(dvi__action_pattern(b->action), &b->pattern);
}

dvi_status dvi__bordered_create(const dvi__stepper *self, const dvi__action_space *space,
                                dvi__bordered *b)
{
  b->element = (dvi__stepper){
      .method = self->method, .system = self->system, .counters = self->counters};
  DVI_TRY(dvi__system_has_hessians(self->system));
  DVI_TRY(dvi__element_create(&b->element, space, DVI__SOLVER_AUTO));
  b->action = dvi__element_action(&b->element);
  b->rows = dvi__action_unknowns(b->action);
  DVI_TRY(dvi__action_prepare_energy(b->action));
  DVI_TRY(bordered_allocate(b, (size_t)self->system->n));
  const dvi__equations equations = {.unknowns = b->rows + 1,
                                    .of = b,
                                    .prepare = bordered_prepare,
                                    .residual = bordered_residual,
                                    .jacobian = bordered_jacobian,
                                    .prepare_chord = bordered_prepare_chord,
                                    .row_scale = bordered_row_scale,
                                    .renewed = 1};
  return dvi__solver_create(&equations, self->counters, &b->solver);
}

void dvi__bordered_clear(dvi__bordered *b)
{
  double *const owned[] = {b->x,      b->Y,       b->tangent,  b->direction, b->column,
                           b->values, b->start.Y, b->start.q0, b->end.Y,     b->end.q0};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__solver_destroy(&b->solver);
  dvi__linear_destroy(&b->schur);
  dvi__pattern_clear(&b->pattern);
  dvi__element_destroy(&b->element);
}

/* ---- solve ---- */

/* Allow some roundings of the summands, and of the path. */
double dvi__energy_floor(const dvi__energies *E)
{
  return 16 * DBL_EPSILON * E->size;
}

dvi_status dvi__bordered_energies(dvi__bordered *b, const dvi__state *state, double h,
                                  const double *Y, dvi__energies *E)
{
  dvi__action_place(b->action, state->t, h, state->q, state->p);
  DVI_TRY(dvi__action_residual(b->action, Y, b->direction));
  return dvi__action_energies(b->action, E);
}

dvi_status dvi__bordered_slope(dvi__bordered *b, const double *Y, double *slope)
{
  DVI_TRY(bordered_prepare_derivatives(b));
  DVI_TRY(bordered_derivatives(b, Y));
  const dvi_status factored = dvi__linear_factor(b->schur, b->values);
  if (factored == DVI_NO_MEMORY) return factored;
  if (factored != DVI_OK)
    return dvi__fail_in(DVI_NOT_CONVERGED,
                        "the Jacobian of the step's equations cannot be factored");
  dvi__linear_solve(b->schur, b->column);
  *slope = b->start.h;
  for (int i = 0; i < b->rows; i++) *slope -= b->start.Y[i] * b->column[i];
  return DVI_OK;
}

/* The last column of the inverse ends with 1 / (dD/d(h unit)). */
static double bordered_slope_of_factor(dvi__bordered *b)
{
  memset(b->direction, 0, (size_t)b->rows * sizeof(double));
  b->direction[b->rows] = 1;
  dvi__solver_apply_factor(b->solver, b->direction);
  return b->unit / b->direction[b->rows];
}

/* Choose the unit of h. A rounding of the energies moves h by their size over the slope. In these
 * units that is a thousand roundings of the numbers that y is added to. Newton's method takes that
 * for noise, and larger changes for corrections. */
static double unit_of_length(double size, const dvi__mismatch *at)
{
  const double certain = fabs(at->h * at->slope) / at->E.size,
               part = fmin(1, 1024 * fmax(1e-12, certain));
  int exponent;
  (void)frexp(part * size / fabs(at->h), &exponent);
  return ldexp(1.0, exponent);
}

/* Set the unknowns and their scales around the point that *found describes. size is that of q0. */
static dvi_status bordered_begin(dvi__bordered *b, double size, const double *Y,
                                 dvi__mismatch *found)
{
  DVI_TRY(dvi__bordered_slope(b, Y, &found->slope));
  const double largest = dvi__largest((size_t)b->rows, Y), whole = largest > 0 ? largest : 1;
  for (int i = 0; i < b->rows; i++) b->tangent[i] = -b->column[i];
  memcpy(b->x, Y, (size_t)b->rows * sizeof(double));
  b->x[b->rows] = 0;
  b->h0 = found->h;
  b->unit = unit_of_length(fmax(whole, size), found);
  b->row = found->E.size / whole;
  return DVI_OK;
}

dvi_status dvi__bordered_solve(dvi__bordered *b, const dvi__state *state, double target,
                               dvi__rung rung, const double *Y, dvi__mismatch *found)
{
  const double size = dvi__largest((size_t)b->element.system->n, state->q);
  dvi__solve_report report;
  b->state = state;
  b->target = target;
  DVI_TRY(bordered_begin(b, size, Y, found));
  const dvi_status status = dvi__solve(b->solver, rung, size, 0, 0, b->x, &report);
  found->h = bordered_length(b, b->x);
  if (status != DVI_OK) return status;
  found->slope = bordered_slope_of_factor(b);
  if (!isfinite(found->slope))
    return dvi__fail(DVI_NOT_CONVERGED, "the energy equation is degenerate at a step of %g",
                     found->h);
  return DVI_OK;
}
