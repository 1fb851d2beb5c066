/* Split steps of i hbar M psi' = (T + V + beta |psi|^2) psi.
 *
 * Each part's flow, or a variational step of it, is symplectic and keeps the norm:
 *     potential  psi(x) <- exp(-i h (V + beta |psi|^2)/hbar) psi(x) at each point, exactly, because
 *                |psi| stays;
 *     kinetic    psi_k <- exp(-i h T_k/hbar) psi_k of Fourier modes, exactly, or the midpoint rule
 *                (M + i h/(2 hbar) T) m = M psi, psi <- 2 m - psi (Cayley) on sparse spaces.
 * A step is half a potential step, a kinetic one and half a potential one, with V at both its ends.
 * Order 2, symmetric. Triple jumps S(g h) S((1 - 2 g) h) S(g h) with g = 1/(2 - 2^(1/(p+1))) raise
 * the order p by 2. Source: Strang 1968; Yoshida 1990; Stern and Grinspun 2009 for Cayley's part.
 */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/schroedinger/shifted.h"
#include "field/schroedinger/steps.h"
#include "num/compensated.h"

enum { JUMPS_MOST = 9, LENGTHS_MOST = 4 };

struct dvi__split {
  const dvi_schroedinger *s;
  double h;
  int jumps, lengths;
  double part[JUMPS_MOST];     /* of h, of each jump */
  int length_of[JUMPS_MOST];   /* its number among those that differ */
  double length[LENGTHS_MOST]; /* parts of h that differ */
  dvi__shifted *cayley;        /* NULL for fourier */
  double *turn;                /* [lengths][free][4] changes by phases, of fourier */
  dvi__schroedinger_room room;
  double *V;             /* [points] */
  double *next, *carry;  /* [2*free], and what rounding drops of it */
  double *rest;          /* [2*free] */
  double *change, *left; /* [2*free], [4*free] of Cayley's transform */
  double *at; /* [3*free] potential, interaction and mass of each function of a nodal space */
};

/* ---- jumps ---- */

static int find_length(dvi__split *p, double part)
{
  int i = 0;
  while (i < p->lengths && p->length[i] != part) i++;
  if (i == p->lengths) p->length[p->lengths++] = part;
  return i;
}

/* Append the jumps of a method of an order over a part of h. */
static void add_jumps(dvi__split *p, int order, double part)
{
  if (order == 2) {
    p->part[p->jumps] = part;
    p->length_of[p->jumps++] = find_length(p, part);
    return;
  }
  const double g = 1 / (2 - pow(2, 1.0 / (order - 1)));
  add_jumps(p, order - 2, g * part);
  add_jumps(p, order - 2, (1 - 2 * g) * part);
  add_jumps(p, order - 2, g * part);
}

/* ---- creation ---- */

static dvi_status check_points(const dvi_schroedinger *s)
{
  if (s->is_fourier && s->points != s->functions)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "schroedinger: split turns phases at points, of which fourier needs as many as "
        "functions, and has %lld for %lld; give each axis points=2K+1 with modes=K, or "
        "take midpoint or gauss",
        (long long)s->points, (long long)s->functions);
  if (s->is_fourier || dvi__space_is_nodal(s->space)) return DVI_OK;
  return dvi__fail(
      DVI_UNSUPPORTED,
      "schroedinger: split turns phases at points, and needs functions that are 1 at "
      "one point each: fem with lumped=yes, legendre, or fourier; midpoint and gauss go "
      "with every space");
}

/* Give each nodal function the mean of values at its points, of which ends of cells have two. */
static void average(dvi__split *p, const double *values, double *mean)
{
  const dvi_schroedinger *s = p->s;
  double *u = p->room.u;
  const double *mass = p->at + 2 * s->free;
  for (int64_t k = 0; k < s->points; k++) u[k] = s->weight[k] * values[k];
  memset(mean, 0, (size_t)s->free * sizeof *mean);
  dvi__schroedinger_add_points(s, u, mean, p->room.work);
  for (int64_t i = 0; i < s->free; i++) mean[i] /= mass[i];
}

/* Average what does not change in time. */
static void average_still(dvi__split *p)
{
  const dvi_schroedinger *s = p->s;
  dvi__schroedinger_add_points(s, s->weight, p->at + 2 * s->free, p->room.work);
  average(p, s->still, p->at);
  if (s->beta != NULL) average(p, s->beta, p->at + s->free);
}

static dvi_status make_room(dvi__split *p)
{
  const dvi_schroedinger *s = p->s;
  DVI_TRY(dvi__schroedinger_make_room(s, &p->room));
  p->V = DVI_NEW(double, s->points);
  p->next = DVI_NEW(double, 15 * s->free);
  p->turn = DVI_NEW(double, s->is_fourier ? 4 * s->free * p->lengths : 1);
  if (p->V == NULL || p->next == NULL || p->turn == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld functions",
                     (long long)s->free);
  p->carry = p->next + 2 * s->free;
  p->rest = p->carry + 2 * s->free;
  p->change = p->rest + 2 * s->free;
  p->left = p->change + 2 * s->free;
  p->at = p->left + 4 * s->free;
  if (!s->depends_on_time) memcpy(p->V, s->still, (size_t)s->points * sizeof *p->V);
  if (s->is_fourier) return DVI_OK;
  average_still(p);
  return dvi__shifted_create(s, p->lengths, &p->cayley);
}

dvi_status dvi__split_create(const dvi_schroedinger *s, int order, dvi__split **made)
{
  *made = NULL;
  DVI_TRY(check_points(s));
  dvi__split *p = DVI_NEW(dvi__split, 1);
  if (p == NULL) return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for a step");
  p->s = s;
  add_jumps(p, order, 1);
  const dvi_status status = make_room(p);
  if (status == DVI_OK)
    *made = p;
  else
    dvi__split_destroy(&p);
  return status;
}

void dvi__split_destroy(dvi__split **split)
{
  if (split == NULL || *split == NULL) return;
  dvi__split *p = *split;
  dvi__shifted_destroy(&p->cayley);
  dvi__schroedinger_clear_room(&p->room);
  dvi__release(p->V);
  dvi__release(p->next);
  dvi__release(p->turn);
  dvi__release(p);
  *split = NULL;
}

/* Half of |1 + x + iy|^2 - 1, which is a rounding of x and y. It is the same in each step and would
 * add up. */
static double excess(double x, double y)
{
  const dvi__twofold a = dvi__exact_product(x, x), b = dvi__exact_product(y, y),
                     sum = dvi__exact_sum(2 * x, a.head);
  return 0.5 * ((sum.head + b.head) + (sum.tail + a.tail + b.tail));
}

/* exp(-i angle) - 1 of each mode, and what is missing for an exact phase. */
static void find_turns(dvi__split *p)
{
  const int64_t n = p->s->free;
  for (int j = 0; j < p->lengths; j++)
    for (int64_t i = 0; i < n; i++) {
      const double half = 0.5 * p->h * p->length[j] * p->s->diagonal[i] / p->s->hbar, s = sin(half),
                   real = -2 * s * s, minus = 2 * s * cos(half), over = excess(real, minus);
      const double turn[] = {real, minus, -over * (1 + real), -over * minus};
      memcpy(p->turn + 4 * (j * n + i), turn, sizeof turn);
    }
}

dvi_status dvi__split_prepare(dvi__split *p, double h)
{
  double complex c[LENGTHS_MOST];
  if (p->h == h) return DVI_OK;
  p->h = h;
  if (p->s->is_fourier) {
    find_turns(p);
    return DVI_OK;
  }
  for (int j = 0; j < p->lengths; j++) c[j] = dvi__of_parts(0, 0.5 * h * p->length[j] / p->s->hbar);
  const dvi_status status = dvi__shifted_factor(p->cayley, c, NULL);
  if (status != DVI_OK) p->h = 0;
  return status;
}

/* ---- flows ---- */

/* Give the change (exp(-i angle) - 1)(u + iv) of numbers by the phases of potentials V and
 * interactions beta during a time. Half angles let changes of the norm be roundings of the change,
 * while roundings of cosines would add up from step to step. */
static void turn_phases(int64_t count, double time, const double *V, const double *beta,
                        const double *u, const double *v, double *du, double *dv)
{
  for (int64_t k = 0; k < count; k++) {
    const double x = u[k], y = v[k], density = x * x + y * y,
                 angle = time * (V[k] + (beta != NULL ? beta[k] * density : 0)),
                 c = cos(0.5 * angle), s = sin(0.5 * angle), real = -2 * s * s, minus = 2 * s * c;
    du[k] = real * x + minus * y;
    dv[k] = real * y - minus * x;
  }
}

static void add_rest(dvi__split *p)
{
  for (int64_t i = 0; i < 2 * p->s->free; i++)
    dvi__add_compensated(p->next + i, p->carry + i, p->rest[i]);
}

/* Modes are orthonormal at the points, so that B^T w leads back. */
static void turn_at_points(dvi__split *p, double time)
{
  const dvi_schroedinger *s = p->s;
  double *u = p->room.u, *v = u + s->points;
  for (int c = 0; c < 2; c++)
    dvi__schroedinger_to_points(s, p->next + c * s->free, u + c * s->points, p->room.work);
  turn_phases(s->points, time, p->V, s->beta, u, v, u, v);
  for (int64_t k = 0; k < s->points; k++) {
    u[k] *= s->weight[k];
    v[k] *= s->weight[k];
  }
  memset(p->rest, 0, (size_t)(2 * s->free) * sizeof *p->rest);
  for (int c = 0; c < 2; c++)
    dvi__schroedinger_add_points(s, u + c * s->points, p->rest + c * s->free, p->room.work);
  add_rest(p);
}

static void turn_at_nodes(dvi__split *p, double time)
{
  const dvi_schroedinger *s = p->s;
  if (s->depends_on_time) average(p, p->V, p->at);
  turn_phases(s->free, time, p->at, s->beta != NULL ? p->at + s->free : NULL, p->next,
              p->next + s->free, p->rest, p->rest + s->free);
  add_rest(p);
}

static dvi_status turn_potential(dvi__split *p, double t, double time)
{
  if (p->s->depends_on_time) DVI_TRY(dvi__schroedinger_potential(p->s, t, p->V));
  if (p->s->is_fourier)
    turn_at_points(p, time / p->s->hbar);
  else
    turn_at_nodes(p, time / p->s->hbar);
  return DVI_OK;
}

/* Large changes and small ones are added one after the other, so that small ones are not lost. */
static void turn_modes(dvi__split *p, int length)
{
  const int64_t n = p->s->free;
  double *x = p->next, *y = x + n, *cx = p->carry, *cy = cx + n;
  for (int64_t i = 0; i < n; i++) {
    const double *turn = p->turn + 4 * (length * n + i), dx = turn[0] * x[i] + turn[1] * y[i],
                 dy = turn[0] * y[i] - turn[1] * x[i],
                 rest_x = turn[2] * x[i] + turn[3] * y[i] - (turn[0] * cx[i] + turn[1] * cy[i]),
                 rest_y = turn[2] * y[i] - turn[3] * x[i] - (turn[0] * cy[i] - turn[1] * cx[i]);
    dvi__add_compensated(x + i, cx + i, dx);
    dvi__add_compensated(x + i, cx + i, rest_x);
    dvi__add_compensated(y + i, cy + i, dy);
    dvi__add_compensated(y + i, cy + i, rest_y);
  }
}

/* r = ic T z - (M + ic T) d. */
static void find_residual(dvi__split *p, double c, const double *z, const double *d, double *r)
{
  const int64_t n = p->s->free;
  double *left = p->left, *T = p->left + 2 * n;
  for (int64_t i = 0; i < 2 * n; i++) left[i] = z[i] - d[i];
  for (int part = 0; part < 2; part++) {
    dvi__schroedinger_mass(p->s, d + part * n, r + part * n);
    dvi__schroedinger_kinetic(p->s, left + part * n, T + part * n);
  }
  for (int64_t i = 0; i < n; i++) {
    r[i] = -c * T[n + i] - r[i];
    r[n + i] = c * T[i] - r[n + i];
  }
}

/* d = psi - m solves (M + ic T) d = ic T psi. The second correction takes away the roundings of the
 * factor, which would add up from step to step. */
static void take_cayley(dvi__split *p, int length)
{
  const int64_t n = p->s->free;
  const double c = 0.5 * p->h * p->length[length] / p->s->hbar;
  memset(p->change, 0, (size_t)(2 * n) * sizeof *p->change);
  for (int twice = 0; twice < 2; twice++) {
    find_residual(p, c, p->next, p->change, p->rest);
    dvi__shifted_solve(p->cayley, length, p->rest);
    for (int64_t i = 0; i < 2 * n; i++) p->change[i] += p->rest[i];
  }
  for (int64_t i = 0; i < 2 * n; i++)
    dvi__add_compensated(p->next + i, p->carry + i, -2 * p->change[i]);
}

/* ---- the step ---- */

static dvi_status jump(dvi__split *p, int j, double *t)
{
  const double time = p->h * p->part[j];
  DVI_TRY(turn_potential(p, *t, 0.5 * time));
  if (p->s->is_fourier)
    turn_modes(p, p->length_of[j]);
  else
    take_cayley(p, p->length_of[j]);
  *t += time;
  return turn_potential(p, *t, 0.5 * time);
}

dvi_status dvi__split_step(dvi__split *p, double t, double *z, double *compensation)
{
  const size_t size = (size_t)(2 * p->s->free) * sizeof *z;
  memcpy(p->next, z, size);
  memcpy(p->carry, compensation, size);
  for (int j = 0; j < p->jumps; j++) DVI_TRY(jump(p, j, &t));
  memcpy(z, p->next, size);
  memcpy(compensation, p->carry, size);
  return DVI_OK;
}
