#include "varied/fit.h"

#include <dvi/number.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

enum { ITERATIONS = 100, SETTING_SIZE = 64 + DVI_NUMBER_SIZE };

/* Numbers of one evaluation, and those of the normal equations. */
typedef struct normal {
  double *difference, *jacobian;  /* [m], [m*count] row after row */
  double *matrix, *slope, *trial; /* [count*count], [count], [count] */
  double *factor, *step;          /* [count*count], [count] */
} normal;

int fit_differences(const fit *f)
{
  return f->data->rows * f->data->columns;
}

/* ---- one run ---- */

/* Take the run to time t in equal steps of at most the scene's. */
static dvi_status advance(const varied *v, double t)
{
  const double from = dvi_sensitivity_time(v->run), span = t - from;
  const double steps = ceil(span / v->scene->h * (1 - 1e-9));
  dvi_status status = DVI_OK;
  for (double k = 0; k < steps && status == DVI_OK; k++)
    status = dvi_sensitivity_step(v->run, span / steps);
  return status;
}

/* Compute the differences of a row, and their derivatives. room is [2n]. */
static void compare_row(const fit *f, const varied *v, int row, double *room, normal *to)
{
  const fit_data *data = f->data;
  for (int c = 0; c < data->columns; c++) {
    const int at = row * data->columns + c, state = data->state[c];
    const double found = state < v->n ? dvi_sensitivity_q(v->run)[state]
                                      : dvi_sensitivity_p(v->run)[state - v->n];
    to->difference[at] = found - data->value[at];
  }
  for (int j = 0; j < f->count; j++) {
    varied_tangent(v, f->quantity[j].index, room);
    for (int c = 0; c < data->columns; c++)
      to->jacobian[(row * data->columns + c) * f->count + j] = room[data->state[c]];
  }
}

static dvi_status run_and_compare(const fit *f, const varied *v, double *room, normal *to)
{
  dvi_status status = dvi_sensitivity_start(v->run, 0, v->scene->q, v->scene->p);
  for (int row = 0; row < f->data->rows && status == DVI_OK; row++) {
    status = advance(v, f->data->t[row]);
    if (status == DVI_OK) compare_row(f, v, row, room, to);
  }
  return status;
}

/* Open the scene with these values of the quantities. */
static int open_with(const fit *f, const double *value, varied *v)
{
  words settings = f->settings;
  char text[WORDS_MAX][SETTING_SIZE];
  int code;
  for (int j = 0; j < f->count; j++) {
    const fit_quantity *q = &f->quantity[j];
    if (q->index < 2 * f->n) continue;
    char number[DVI_NUMBER_SIZE];
    dvi_number_write(value[j], number);
    (void)snprintf(text[j], SETTING_SIZE, "%s=%s", q->name, number);
    settings.word[settings.count++] = text[j];
  }
  code = varied_open("fit", f->path, f->text, &settings, f->method, v);
  for (int j = 0; j < f->count && code == DONE; j++) {
    const int index = f->quantity[j].index;
    if (index < f->n) v->scene->q[index] = value[j];
    if (index >= f->n && index < 2 * f->n) v->scene->p[index - f->n] = value[j];
  }
  return code;
}

/* Compute differences, Jacobian and the sum of squares, which is Inf where the run fails. */
static int evaluate(const fit *f, const double *value, normal *to, double *squares)
{
  varied v = {.scene = NULL};
  double *room = calloc(2 * (size_t)f->n, sizeof *room);
  int code = room != NULL ? open_with(f, value, &v) : (complain("out of memory"), FAILED);
  *squares = HUGE_VAL;
  if (code == DONE && run_and_compare(f, &v, room, to) == DVI_OK) {
    *squares = 0;
    for (int k = 0; k < fit_differences(f); k++) *squares += to->difference[k] * to->difference[k];
  }
  varied_close(&v);
  free(room);
  return code;
}

/* ---- linear algebra ---- */

/* Factor a symmetric matrix [n*n] as L L^T in place. Returns the first row without a positive pivot
 * beside `least` of its diagonal, or -1. */
static int factor_positive(int n, double *A, double least)
{
  for (int j = 0; j < n; j++) {
    const double diagonal = A[j * n + j];
    for (int k = 0; k < j; k++) A[j * n + j] -= A[j * n + k] * A[j * n + k];
    if (!(A[j * n + j] > least * diagonal)) return j;
    const double pivot = A[j * n + j] = sqrt(A[j * n + j]);
    for (int i = j + 1; i < n; i++) {
      for (int k = 0; k < j; k++) A[i * n + j] -= A[i * n + k] * A[j * n + k];
      A[i * n + j] /= pivot;
    }
  }
  return -1;
}

static void solve_factored(int n, const double *L, double *b)
{
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < i; k++) b[i] -= L[i * n + k] * b[k];
    b[i] /= L[i * n + i];
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int k = i + 1; k < n; k++) b[i] -= L[k * n + i] * b[k];
    b[i] /= L[i * n + i];
  }
}

static void form_normal(const fit *f, normal *to)
{
  const int n = f->count, m = fit_differences(f);
  memset(to->matrix, 0, (size_t)n * (size_t)n * sizeof(double));
  memset(to->slope, 0, (size_t)n * sizeof(double));
  for (int k = 0; k < m; k++)
    for (int i = 0; i < n; i++) {
      const double of = to->jacobian[k * n + i];
      to->slope[i] += of * to->difference[k];
      for (int j = 0; j < n; j++) to->matrix[i * n + j] += of * to->jacobian[k * n + j];
    }
}

/* Tell whether a quantity stays at its bound, because the squares fall beyond it. */
static bool is_held(const fit_quantity *q, double value, double slope)
{
  return (value <= q->least && slope > 0) || (value >= q->most && slope < 0);
}

/* ---- Levenberg and Marquardt ---- */

/* Compute the step with this damping, and the trial within the bounds. Returns the largest relative
 * change, or -1 if the matrix is not positive definite. */
static double damped_step(const fit *f, normal *a, double damping)
{
  const int n = f->count;
  double largest = 0;
  memcpy(a->factor, a->matrix, (size_t)n * (size_t)n * sizeof(double));
  for (int i = 0; i < n; i++) {
    a->step[i] = -a->slope[i];
    a->factor[i * n + i] *= 1 + damping;
    if (!is_held(&f->quantity[i], f->quantity[i].value, a->slope[i])) continue;
    for (int j = 0; j < n; j++) a->factor[i * n + j] = a->factor[j * n + i] = 0;
    a->factor[i * n + i] = 1;
    a->step[i] = 0;
  }
  if (factor_positive(n, a->factor, 0) >= 0) return -1;
  solve_factored(n, a->factor, a->step);
  for (int i = 0; i < n; i++) {
    const fit_quantity *q = &f->quantity[i];
    a->trial[i] = fmin(fmax(q->value + a->step[i], q->least), q->most);
    largest = fmax(largest, fabs(a->trial[i] - q->value) / fmax(1e-8, fabs(q->value)));
  }
  return largest;
}

static void take_trial(fit *f, const normal *a, double squares)
{
  for (int i = 0; i < f->count; i++) f->quantity[i].value = a->trial[i];
  f->squares = squares;
}

/* Go downhill until steps, or gains, are roundings. `current` is at the present values. */
static int descend(fit *f, normal *current, normal *next)
{
  double damping = 1e-3;
  for (f->iterations = 0; f->iterations < ITERATIONS; f->iterations++) {
    double squares = HUGE_VAL;
    form_normal(f, current);
    const double change = damped_step(f, current, damping);
    if (change >= 0 && change < 1e-12) return DONE;
    if (change >= 0) {
      const int code = evaluate(f, current->trial, next, &squares);
      if (code != DONE) return code;
    }
    if (change < 0 || !(squares < f->squares)) {
      if (change >= 0 && change < 1e-9) return DONE;
      damping = fmax(1e-6, 10 * damping);
      if (damping > 1e12) return DONE;
      continue;
    }
    const double gain = f->squares - squares;
    take_trial(f, current, squares);
    const normal other = *current;
    *current = *next;
    *next = other;
    damping *= 0.1;
    if (gain <= 1e-15 * f->squares) return DONE;
  }
  complain("fit: no least sum of squares after %d iterations; begin nearer to it by --set",
           ITERATIONS);
  return FAILED;
}

/* ---- errors ---- */

/* Standard errors are the roots of the diagonal of s^2 (J^T J)^-1, s^2 the squares over the degrees
 * of freedom. */
static int find_errors(fit *f, normal *a)
{
  const int n = f->count;
  int held = 0;
  form_normal(f, a);
  memcpy(a->factor, a->matrix, (size_t)n * (size_t)n * sizeof(double));
  for (int i = 0; i < n; i++) {
    if (!is_held(&f->quantity[i], f->quantity[i].value, a->slope[i])) continue;
    for (int j = 0; j < n; j++) a->factor[i * n + j] = a->factor[j * n + i] = 0;
    a->factor[i * n + i] = 1;
    f->quantity[i].error = (double)NAN;
    held++;
  }
  const int bad = factor_positive(n, a->factor, 1e-13);
  if (bad >= 0) {
    complain("fit: the data do not determine %s beside the others", f->quantity[bad].name);
    return FAILED;
  }
  const int free_numbers = fit_differences(f) - (n - held);
  for (int i = 0; i < n; i++) {
    memset(a->step, 0, (size_t)n * sizeof(double));
    a->step[i] = 1;
    solve_factored(n, a->factor, a->step);
    if (!isnan(f->quantity[i].error))
      f->quantity[i].error = free_numbers > 0 ? sqrt(f->squares / free_numbers * a->step[i])
                                              : (double)NAN;
  }
  return DONE;
}

static size_t numbers_of(const fit *f)
{
  const size_t n = (size_t)f->count, m = (size_t)fit_differences(f);
  return m + m * n + 2 * n * n + 3 * n;
}

static void lay_out(const fit *f, double *room, normal *a)
{
  const size_t n = (size_t)f->count, m = (size_t)fit_differences(f);
  a->difference = room;
  a->jacobian = a->difference + m;
  a->matrix = a->jacobian + m * n;
  a->factor = a->matrix + n * n;
  a->slope = a->factor + n * n;
  a->trial = a->slope + n;
  a->step = a->trial + n;
}

int fit_solve(fit *f)
{
  normal current, next;
  double *room = calloc(2 * numbers_of(f), sizeof *room);
  int code = DONE;
  if (room == NULL) return complain("out of memory"), FAILED;
  lay_out(f, room, &current);
  lay_out(f, room + numbers_of(f), &next);
  for (int i = 0; i < f->count && code == DONE; i++) current.trial[i] = f->quantity[i].value;
  if (code == DONE) code = evaluate(f, current.trial, &current, &f->squares);
  if (code == DONE && !isfinite(f->squares)) {
    complain("fit: the run from the first values fails: %s", dvi_last_error());
    code = FAILED;
  }
  if (code == DONE) code = descend(f, &current, &next);
  if (code == DONE) code = find_errors(f, &current);
  free(room);
  return code;
}
