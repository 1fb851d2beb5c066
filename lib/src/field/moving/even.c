/* A start on arcs of one length, for DVI_MOVING_EQUAL. Newton's method finds positions x_1, x_2 ..
 * on a wave u(x) with l_{a+1} = l_a. Its matrix J, of three diagonals, gives the velocities, too:
 * J x' takes away what u_t and the velocity of the first node change of the constraints. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

enum { ITERATIONS = 100 };

/* Rows a = 0 .. cells-2 of J for nodes a, a+1 and a+2, and a right side. */
typedef struct rows {
  double *before, *at, *after, *side;
} rows;

/* A length, its derivatives by the positions of both ends along the wave, and its rate. */
typedef struct arc {
  double length, left, right, rate;
} arc;

static arc measure(const dvi_moving *m, const dvi__wave_values *w, int cell)
{
  const double h = w->x[cell + 1] - w->x[cell], square = m->stretch * m->stretch;
  arc l = {.length = h * h, .left = -h, .right = h};
  for (int c = 0; c < m->components; c++) {
    const int k = c * (m->cells + 1) + cell;
    const double Du = square * (w->u[k + 1] - w->u[k]);
    l.length += Du * (w->u[k + 1] - w->u[k]);
    l.left -= Du * w->u_x[k];
    l.right += Du * w->u_x[k + 1];
    l.rate += Du * (w->u_t[k + 1] - w->u_t[k]);
  }
  l.length = sqrt(l.length);
  l.left /= l.length;
  l.right /= l.length;
  l.rate /= l.length;
  return l;
}

/* Set the rows. The right side is -phi, or -phi' without velocities of the nodes. Return the
 * largest |phi| beside a length. */
static double fill(const dvi_moving *m, const dvi__wave_values *w, int rates, rows *r)
{
  double worst = 0;
  arc left = measure(m, w, 0);
  for (int a = 0; a + 1 < m->cells; a++) {
    const arc right = measure(m, w, a + 1);
    r->before[a] = -left.left;
    r->at[a] = right.left - left.right;
    r->after[a] = right.right;
    r->side[a] = rates ? left.rate - right.rate : left.length - right.length;
    worst = fmax(worst, fabs(right.length - left.length) / left.length);
    left = right;
  }
  return worst;
}

/* Solve for the inner nodes, with those at the ends given, by elimination. The diagonal dominates
 * where u_x changes little over a cell. */
static void solve(int count, rows *r)
{
  for (int a = 1; a < count; a++) {
    const double factor = r->before[a] / r->at[a - 1];
    r->at[a] -= factor * r->after[a - 1];
    r->side[a] -= factor * r->side[a - 1];
  }
  for (int a = count - 1; a >= 0; a--)
    r->side[a] = (r->side[a] - (a + 1 < count ? r->after[a] * r->side[a + 1] : 0)) / r->at[a];
}

/* Give the largest part, 1 or less, of a change of the nodes that leaves half of each length. */
static double allowed(const dvi_moving *m, const double *x, const double *change)
{
  double part = 1;
  for (int e = 0; e < m->cells; e++) {
    const double left = e > 0 ? change[e - 1] : 0, right = e + 1 < m->cells ? change[e] : 0;
    if (left - right > 0) part = fmin(part, 0.5 * (x[e + 1] - x[e]) / (left - right));
  }
  return part;
}

/* Set the values at the ends to those of the field, where the wave has no say. */
static void fix_ends(const dvi_moving *m, dvi__wave_values *w)
{
  for (int c = 0; c < m->components; c++)
    for (int side = 0; side < 2; side++) {
      const int first = c * (m->cells + 1), at = first + side * m->cells;
      const int number = (side ? m->nodes - 1 : 0) * m->numbers + 1 + c;
      if (m->periodic) {
        w->u[at] = w->u[first] + side * m->jump[c];
        w->u_x[at] = w->u_x[first];
        w->u_t[at] = w->u_t[first];
      } else if (m->unknown[number] < 0) {
        w->u[at] = m->known[number];
        w->u_t[at] = 0;
      }
    }
}

static dvi_status evaluate(const dvi_moving *m, dvi_moving_wave *wave, void *user,
                           dvi__wave_values *w, double *unread)
{
  const size_t values = (size_t)m->components * ((size_t)m->cells + 1);
  memset(w->u, 0, values * sizeof *w->u);
  memset(w->u_x, 0, values * sizeof *w->u_x);
  memset(w->u_t, 0, values * sizeof *w->u_t);
  const int returned = wave(m->cells + 1, w->x, w->u, w->u_x, w->u_t, unread, user);
  fix_ends(m, w);
  if (returned == 0) return DVI_OK;
  return dvi__fail(DVI_CALLBACK_FAILED, "moving: the wave returned %d", returned);
}

/* Iterate until the lengths differ by roundings. */
static dvi_status place(const dvi_moving *m, dvi_moving_wave *wave, void *user, dvi__wave_values *w,
                        rows *r)
{
  double worst = 0, last = INFINITY;
  fix_ends(m, w);
  for (int i = 0; i < ITERATIONS; i++) {
    worst = fill(m, w, 0, r);
    if (worst < 1e-12 && worst >= 0.5 * last) return DVI_OK;
    last = worst;
    solve(m->cells - 1, r);
    const double part = allowed(m, w->x, r->side);
    if (!(part > DBL_EPSILON)) break;
    for (int a = 1; a < m->cells; a++) w->x[a] += part * r->side[a - 1];
    memset(r->before, 0, (size_t)(m->cells + 1) * sizeof *r->before);
    DVI_TRY(evaluate(m, wave, user, w, r->before));
  }
  return dvi__fail(DVI_NOT_CONVERGED,
                   "moving: arcs on the wave still differ by %.3g of their length after %d steps: "
                   "give a monitor with cells of nearly equal arcs, more cells, or less stretch",
                   worst, ITERATIONS);
}

static void find_velocities(const dvi_moving *m, dvi__wave_values *w, rows *r)
{
  const int count = m->cells - 1;
  (void)fill(m, w, 1, r);
  if (m->periodic) w->velocity[m->cells] = w->velocity[0];
  r->side[0] -= r->before[0] * w->velocity[0];
  r->side[count - 1] -= r->after[count - 1] * w->velocity[m->cells];
  solve(count, r);
  memcpy(w->velocity + 1, r->side, (size_t)count * sizeof *r->side);
}

dvi_status dvi__moving_even_out(const dvi_moving *m, dvi_moving_wave *wave, void *user,
                                dvi__wave_values *w)
{
  const size_t n = (size_t)m->cells + 1;
  double *work = DVI_NEW(double, 4 * n);
  if (work == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for arcs");
  rows r = {.before = work, .at = work + n, .after = work + 2 * n, .side = work + 3 * n};
  const dvi_status status = place(m, wave, user, w, &r);
  if (status == DVI_OK) find_velocities(m, w, &r);
  dvi__release(work);
  return status;
}
