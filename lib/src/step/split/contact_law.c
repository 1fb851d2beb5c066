#include "step/split/contact_law.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/dense.h"

/* Newton's method is tried after so many sweeps, which double each time it fails. */
enum { FIRST_SWEEPS = 20, MOST_SWEEPS = 2000, NEWTON_ITERATIONS = 30, MOST_HALVINGS = 8 };

/* The proximal iteration: parts of the diagonal that are added, and how often. */
static const double shift = 1e-2;
enum { MOST_PROXIMAL = 10 };

/* The largest residual that is accepted where the contacts jam. */
static const double accepted = 1e-3;

/* Residuals below this part of the largest impulse are roundoff. */
static const double roundoff = 16 * DBL_EPSILON;

/* Part of the diagonal by which a singular matrix of redundant contacts becomes regular. */
static const double regularisation = 1e-8;

dvi_status dvi__contact_law_create(int most, int tangents, dvi_counters *counters,
                                   dvi__contact_law *law)
{
  const size_t rows = (size_t)most * (1 + (size_t)tangents);
  *law = (dvi__contact_law){.most = most, .rows_most = (int)rows, .counters = counters};
  law->closed = DVI_NEW(dvi__closed, most);
  law->W = DVI_NEW(double, rows *rows);
  law->matrix = DVI_NEW(double, rows *rows);
  law->b = DVI_NEW(double, 7 * rows);
  law->pivot = DVI_NEW(int, rows);
  if (law->closed == NULL || law->W == NULL || law->matrix == NULL || law->b == NULL ||
      law->pivot == NULL)
    return dvi__fail(DVI_NO_MEMORY, "moreau-jean: no memory for %d closed contacts", most);
  law->P = law->b + rows;
  law->u = law->P + rows;
  law->F = law->u + rows;
  law->kept = law->F + rows;
  law->correction = law->kept + rows;
  law->centre = law->correction + rows;
  return DVI_OK;
}

void dvi__contact_law_clear(dvi__contact_law *law)
{
  dvi__release(law->closed);
  dvi__release(law->W);
  dvi__release(law->matrix);
  dvi__release(law->b);
  dvi__release(law->pivot);
  *law = (dvi__contact_law){0};
}

static const double *row_of(const dvi__contact_law *law, int i)
{
  return law->W + (size_t)i * (size_t)law->rows;
}

static double velocity_of(const dvi__contact_law *law, int i)
{
  const double *W = row_of(law, i);
  double u = law->b[i] + law->shift * W[i] * (law->P[i] - law->centre[i]);
  for (int j = 0; j < law->rows; j++) u += W[j] * law->P[j];
  return u;
}

/* Project y_T [tangents] on the disk of radius r. Return 1 if it was outside. */
static int project_on_disk(int tangents, double r, double *y)
{
  const double length = tangents == 2 ? hypot(y[0], y[1]) : fabs(y[0]);
  if (length <= r) return 0;
  for (int a = 0; a < tangents; a++) y[a] *= r / length;
  return 1;
}

/* ---- projected Gauss-Seidel iteration ---- */

static void sweep_contact(dvi__contact_law *law, const dvi__closed *c)
{
  double *P = law->P + c->row, y[2] = {0};
  P[0] = fmax(0, P[0] - c->rho_N * velocity_of(law, c->row));
  for (int a = 0; a < c->tangents; a++)
    y[a] = P[1 + a] - c->rho_T * velocity_of(law, c->row + 1 + a);
  if (c->tangents > 0) (void)project_on_disk(c->tangents, c->mu * P[0], y);
  for (int a = 0; a < c->tangents; a++) P[1 + a] = y[a];
}

/* ---- residuals, and Newton's method ---- */

/* Evaluate the residuals F = P - projection(P - rho u). Return the largest, relative to the largest
 * impulse that acts, or would stop a contact. */
static double evaluate_residual(dvi__contact_law *law)
{
  double largest = 0, size = 0;
  for (int i = 0; i < law->rows; i++) law->u[i] = velocity_of(law, i);
  for (int k = 0; k < law->count; k++) {
    const dvi__closed *c = &law->closed[k];
    const double *P = law->P + c->row, *u = law->u + c->row;
    double *F = law->F + c->row, y[2] = {0}, y_N = P[0] - c->rho_N * u[0];
    y_N = fmax(0, y_N);
    F[0] = P[0] - y_N;
    for (int a = 0; a < c->tangents; a++) y[a] = P[1 + a] - c->rho_T * u[1 + a];
    if (c->tangents > 0) (void)project_on_disk(c->tangents, c->mu * y_N, y);
    for (int a = 0; a < c->tangents; a++) F[1 + a] = P[1 + a] - y[a];
    for (int a = 0; a <= c->tangents; a++) {
      const double stop = (a == 0 ? c->rho_N : c->rho_T) * law->b[c->row + a];
      largest = fmax(largest, fabs(F[a]));
      size = fmax(size, fmax(fabs(P[a]), fabs(stop)));
    }
  }
  law->residual = size > 0 ? largest / size : 0;
  return law->residual;
}

/* Write row i of the matrix, stored column by column, as scale W_i. */
static void write_row(dvi__contact_law *law, int i, double scale)
{
  const double *W = row_of(law, i);
  for (int j = 0; j < law->rows; j++)
    law->matrix[(size_t)j * (size_t)law->rows + (size_t)i] =
        scale * (W[j] + (i == j ? law->shift * W[j] : 0));
}

static void add_to(dvi__contact_law *law, int i, int j, double value)
{
  law->matrix[(size_t)j * (size_t)law->rows + (size_t)i] += value;
}

/* Write the rows of a contact that slips, F_T = P_T - mu y_N d with d = y_T/|y_T|. */
static void write_slip(dvi__contact_law *law, const dvi__closed *c, double y_N, const double *y,
                       double length)
{
  const double *W_N = row_of(law, c->row);
  for (int a = 0; a < c->tangents; a++) {
    const int i = c->row + 1 + a;
    const double d = y[a] / length;
    for (int j = 0; j < law->rows; j++) {
      double value = c->mu * d * c->rho_N * (W_N[j] + (j == c->row ? law->shift * W_N[j] : 0));
      for (int b = 0; b < c->tangents; b++) {
        const double turn = c->mu * y_N / length * ((a == b) - d * y[b] / length);
        const double w = row_of(law, c->row + 1 + b)[j];
        value += turn * c->rho_T * (w + (j == c->row + 1 + b ? law->shift * w : 0));
      }
      law->matrix[(size_t)j * (size_t)law->rows + (size_t)i] = value;
    }
    add_to(law, i, c->row, -c->mu * d);
    add_to(law, i, i, 1);
    for (int b = 0; b < c->tangents; b++)
      add_to(law, i, c->row + 1 + b, -c->mu * y_N / length * ((a == b) - d * y[b] / length));
  }
}

/* Write the rows of one contact of the derivative of F. */
static void write_contact(dvi__contact_law *law, const dvi__closed *c)
{
  const double *P = law->P + c->row, *u = law->u + c->row, y_N = P[0] - c->rho_N * u[0];
  double y[2] = {0}, length = 0;
  for (int a = 0; a < c->tangents; a++) {
    y[a] = P[1 + a] - c->rho_T * u[1 + a];
    length = hypot(length, y[a]);
  }
  const int opens = y_N <= 0, sticks = length <= c->mu * y_N;
  write_row(law, c->row, opens ? 0 : c->rho_N);
  add_to(law, c->row, c->row, opens ? 1 : regularisation);
  if (!opens && !sticks) {
    write_slip(law, c, y_N, y, length);
    return;
  }
  for (int a = 1; a <= c->tangents; a++) {
    write_row(law, c->row + a, opens ? 0 : c->rho_T);
    add_to(law, c->row + a, c->row + a, opens ? 1 : regularisation);
  }
}

/* Subtract the correction in F, or a part of it that decreases the residual. Return 0 if none
 * does. */
static int correct_impulses(dvi__contact_law *law)
{
  const double before = law->residual;
  double *correction = law->correction;
  memcpy(correction, law->F, (size_t)law->rows * sizeof(double));
  double part = 1;
  for (int j = 0; j < law->rows; j++) law->P[j] -= correction[j];
  for (int halvings = 0; !(evaluate_residual(law) < before); halvings++) {
    if (halvings == MOST_HALVINGS) return 0;
    part /= 2;
    for (int j = 0; j < law->rows; j++) law->P[j] += part * correction[j];
  }
  return 1;
}

/* Iterate until the residual is roundoff, or does not decrease any more. Return 1 if it is
 * roundoff. If not, the impulses are those before. */
static int newton_succeeds(dvi__contact_law *law)
{
  const size_t bytes = (size_t)law->rows * sizeof(double);
  memcpy(law->kept, law->P, bytes);
  for (int i = 0; i < NEWTON_ITERATIONS && law->residual > roundoff; i++) {
    for (int k = 0; k < law->count; k++) write_contact(law, &law->closed[k]);
    law->counters->factorizations++;
    if (!dvi__dense_solve(law->rows, law->matrix, law->pivot, law->F)) break;
    if (!correct_impulses(law)) break;
  }
  if (law->residual <= roundoff) {
    law->counters->newtons++;
    return 1;
  }
  memcpy(law->P, law->kept, bytes);
  (void)evaluate_residual(law);
  return 0;
}

static void prepare_contacts(dvi__contact_law *law)
{
  for (int k = 0; k < law->count; k++) {
    dvi__closed *c = &law->closed[k];
    double largest = 0;
    for (int a = 0; a <= c->tangents; a++) {
      const double diagonal = row_of(law, c->row + a)[c->row + a];
      if (a == 0) c->rho_N = diagonal > 0 ? 1 / diagonal : 0;
      if (a > 0) largest = fmax(largest, diagonal);
    }
    c->rho_T = largest > 0 ? 1 / largest : 0;
  }
}

/* Iterate by sweeps and Newton's method. Return 1 if the residual is roundoff. */
static int iterate(dvi__contact_law *law, int most)
{
  int sweeps = FIRST_SWEEPS, done = 0;
  if (evaluate_residual(law) <= roundoff) return 1;
  while (done < most) {
    for (int i = 0; i < sweeps; i++, done++)
      for (int k = 0; k < law->count; k++) sweep_contact(law, &law->closed[k]);
    law->counters->sweeps += sweeps;
    if (evaluate_residual(law) <= roundoff || newton_succeeds(law)) return 1;
    sweeps *= 2;
  }
  return 0;
}

/* Solve problems with a part of the diagonal added at an impulse P', W P + shift D (P - P'), again
 * and again. They have solutions where the contacts jam, and the laws have none. */
static int iterate_proximally(dvi__contact_law *law)
{
  for (int k = 0; k < MOST_PROXIMAL; k++) {
    memcpy(law->centre, law->P, (size_t)law->rows * sizeof(double));
    law->shift = shift;
    (void)iterate(law, MOST_SWEEPS);
    law->shift = 0;
    if (evaluate_residual(law) <= roundoff || newton_succeeds(law)) return 1;
  }
  return law->residual <= accepted;
}

dvi_status dvi__contact_law_solve(dvi__contact_law *law)
{
  prepare_contacts(law);
  law->shift = 0;
  memset(law->centre, 0, (size_t)law->rows * sizeof(double));
  const int found = iterate(law, MOST_SWEEPS) || iterate_proximally(law);
  law->worst = fmax(law->worst, law->residual);
  if (found) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "the impulses of %d closed contacts were not found: by sweeps and Newton's "
                   "method a residual of %.2g of the largest impulse remains",
                   law->count, law->residual);
}
