/* Solution of the stages of Gauss collocation,
 *
 *     R_i = M Z_i + i h/hbar sum_j a_ij H(t_j, psi0 + Z_j)(psi0 + Z_j) = 0.
 *
 * Their linear part with H_0, which the factors invert, gives the iteration Z <- Z - P^-1 R. It
 * converges while h/hbar times the energies that H_0 leaves out is below 1 or so. Beyond that
 * Newton's method takes over for P^-1 R = 0. Its Jacobian is that of complex numbers and of their
 * conjugates, because |psi|^2 has both:
 *
 *     (H(psi) psi)' v = H(psi) v + 2 beta Re(psi* v) psi.
 *
 * Both keep the norm, which is a matter of the equations alone, to the roundings that they
 * leave. */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/schroedinger/gauss.h"
#include "num/compensated.h"
#include "num/finite.h"

enum { ITERATIONS = 200, WINDOW = 4 };

static const double *potential_of(const dvi__gauss *g, int stage)
{
  return g->s->depends_on_time ? g->V + stage * g->s->points : g->s->still;
}

/* HZ_j = H(t_j,Psi_j) Psi_j. A potential that stands still is evaluated once. */
static void act(dvi__gauss *g, const double *Z)
{
  const int64_t n = 2 * g->s->free;
  for (int j = 0; j < g->stages; j++) {
    for (int64_t i = 0; i < n; i++) g->stage[i] = g->z[i] + Z[j * n + i];
    dvi__schroedinger_act(g->s, potential_of(g, j), 1, 2, g->stage, g->HZ + j * n, &g->room);
  }
}

/* y += i a x, with i (x + iy) = -y + ix. */
static void add_turned(int64_t n, double a, const double *x, double *y)
{
  for (int64_t k = 0; k < n; k++) {
    y[k] -= a * x[n + k];
    y[n + k] += a * x[k];
  }
}

/* R_i = M Z_i + i h/hbar sum_j a_ij HZ_j. What is missing of the coefficients comes last, when
 * their large parts have cancelled. */
static void find_residual(dvi__gauss *g, const double *Z)
{
  const int64_t n = g->s->free;
  const double step = g->h / g->s->hbar;
  for (int i = 0; i < g->stages; i++) {
    double *R = g->R + 2 * i * n, *rest = g->mixed;
    memset(rest, 0, (size_t)(2 * n) * sizeof *rest);
    for (int c = 0; c < 2; c++) dvi__schroedinger_mass(g->s, Z + (2 * i + c) * n, R + c * n);
    for (int j = 0; j < g->stages; j++) {
      const dvi__twofold by = dvi__exact_product(step, g->A[i][j]);
      const double missing = by.tail + step * g->A_rest[i][j];
      add_turned(n, by.head, g->HZ + 2 * j * n, R);
      if (missing != 0) add_turned(n, missing, g->HZ + 2 * j * n, rest);
    }
    for (int64_t k = 0; k < 2 * n; k++) R[k] += rest[k];
  }
}

/* to_i += sum_j C_ij from_j of complex vectors. */
static void mix(const dvi__gauss *g, double complex (*C)[DVI__STAGES_MAX], const double *from,
                double *to)
{
  const int64_t n = g->s->free;
  memset(to, 0, (size_t)(2 * g->stages * n) * sizeof *to);
  for (int i = 0; i < g->stages; i++)
    for (int j = 0; j < g->stages; j++) {
      const double a = creal(C[i][j]), b = cimag(C[i][j]), *x = from + 2 * j * n;
      double *y = to + 2 * i * n;
      for (int64_t k = 0; k < n; k++) {
        y[k] += a * x[k] - b * x[n + k];
        y[n + k] += a * x[n + k] + b * x[k];
      }
    }
}

/* Replace R by P^-1 R, the correction of Z. */
static void precondition(dvi__gauss *g, double *R)
{
  const int64_t n = 2 * g->s->free;
  mix(g, g->inverse, g->R, g->mixed);
  for (int j = 0; j < g->stages; j++) dvi__shifted_solve(g->solver, j, g->mixed + j * n);
  mix(g, g->X, g->mixed, R);
}

/* Find the preconditioned residual f of Z. */
static void residual(void *of, const double *Z, double *f)
{
  dvi__gauss *g = of;
  act(g, Z);
  find_residual(g, Z);
  precondition(g, f);
}

/* ---- the iteration ---- */

/* Apply a correction, and return its largest component. */
static double correct(dvi__gauss *g)
{
  const int64_t all = 2 * g->stages * g->s->free;
  residual(g, g->Z, g->R);
  for (int64_t i = 0; i < all; i++) g->Z[i] -= g->R[i];
  return dvi__largest((size_t)all, g->R);
}

/* Tell if the next correction would be below a rounding of z, or if corrections are roundings that
 * no longer shrink. */
static int is_settled(double change, double before, double size)
{
  return change * change <= 1e-17 * size * before || (change <= 1e-13 * size && change >= before);
}

/* Tell if corrections shrink by less than a fifth in each of some iterations. */
static int is_slow(int i, double change, const double *last, double size)
{
  return i >= WINDOW && change > 1e-13 * size && !(change <= 0.4 * last[i % WINDOW]);
}

/* Iterate until corrections have settled. What the iteration has not reached yet has the same sign
 * in each step, and adds up in the norm: some more corrections make it small against roundings.
 * Tells if it has converged. */
static int iterate(dvi__gauss *g, double size)
{
  double before = size, last[WINDOW] = {0};
  int settled = 0;
  for (int i = 0; i < ITERATIONS || settled > 0; i++) {
    const double change = correct(g);
    if (i > 0 && settled == 0 && is_settled(change, before, size)) settled = i;
    if (settled > 0 && i >= settled + settled / 6) return 1;
    if (settled == 0 && is_slow(i, change, last, size)) return 0;
    last[i % WINDOW] = before = change;
  }
  return 0;
}

/* ---- Newton's method ---- */

static void newton_stand_at(void *of, const double *Z)
{
  dvi__gauss *g = of;
  const dvi_schroedinger *s = g->s;
  const int64_t n = 2 * s->free;
  for (int j = 0; j < g->stages && s->beta != NULL; j++) {
    for (int64_t i = 0; i < n; i++) g->stage[i] = g->z[i] + Z[j * n + i];
    for (int c = 0; c < 2; c++)
      dvi__schroedinger_to_points(s, g->stage + c * s->free, g->psi + (2 * j + c) * s->points,
                                  g->room.work);
  }
}

static void newton_times(void *of, const double *v, double *y)
{
  dvi__gauss *g = of;
  const int64_t n = 2 * g->s->free;
  for (int j = 0; j < g->stages; j++)
    dvi__schroedinger_act_beside(g->s, potential_of(g, j), g->psi + 2 * j * g->s->points, v + j * n,
                                 g->HZ + j * n, &g->room);
  find_residual(g, v);
  precondition(g, y);
}

dvi_status dvi__gauss_create_newton(dvi__gauss *g)
{
  const dvi_schroedinger *s = g->s;
  const int64_t unknowns = 2 * g->stages * s->free;
  const dvi__smooth_equations equations = {.unknowns = (int)unknowns,
                                           .of = g,
                                           .residual = residual,
                                           .stand_at = newton_stand_at,
                                           .times = newton_times};
  if (s->beta == NULL && !s->depends_on_time && !s->is_fourier) return DVI_OK;
  if (unknowns > INT_MAX)
    return dvi__fail(DVI_BAD_SIZE, "schroedinger: %d stages of %lld functions are too many",
                     g->stages, (long long)s->free);
  return dvi__krylov_create(&equations, &g->newton);
}

/* The energies that H_0 leaves out, at the start of the step. */
static double left_out(dvi__gauss *g)
{
  const dvi_schroedinger *s = g->s;
  double least = INFINITY, most = -INFINITY, interaction = 0;
  newton_stand_at(g, g->Z);
  for (int64_t k = 0; k < s->points; k++) {
    least = fmin(least, s->still[k]);
    most = fmax(most, s->still[k]);
    if (s->beta == NULL) continue;
    const double u = g->psi[k], v = g->psi[s->points + k];
    interaction = fmax(interaction, fabs(s->beta[k]) * (u * u + v * v));
  }
  return 3 * interaction + (s->is_fourier || s->depends_on_time ? 0.5 * (most - least) : 0);
}

static dvi_status refuse_step(dvi__gauss *g, double t, double residual)
{
  memset(g->Z, 0, (size_t)(2 * g->stages * g->s->free) * sizeof *g->Z);
  return dvi__fail(DVI_NOT_CONVERGED,
                   "schroedinger: the step of %g at t = %g does not converge, because potential or "
                   "interaction turn phases by too much in it: Newton's method leaves an error of "
                   "%.1e of psi; take a step of %.2g, or the method split",
                   g->h, t, residual, fmin(0.5 * g->h, g->s->hbar / left_out(g)));
}

dvi_status dvi__gauss_solve_stages(dvi__gauss *g, double t, const double *z)
{
  const int64_t n = 2 * g->s->free;
  const size_t bytes = (size_t)(g->stages * n) * sizeof *g->Z;
  const double size = dvi__largest((size_t)n, z);
  double residual = 0;
  g->z = z;
  memset(g->Z, 0, bytes);
  if (size == 0 || iterate(g, size)) return DVI_OK;
  memset(g->Z, 0, bytes);
  if (g->newton != NULL && dvi__krylov_solve(g->newton, size, g->Z, &residual) == DVI_OK)
    return DVI_OK;
  return refuse_step(g, t, residual);
}
