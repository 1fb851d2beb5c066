#include "support/solid/quad_avi.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBERS = 12 };

static void *room_for(size_t count, size_t size)
{
  void *room = calloc(count > 0 ? count : 1, size);
  ck_assert_ptr_nonnull(room);
  return room;
}

/* ---- steps ---- */

/* The stiffness of a cell at rest over its mass, [NUMBERS*NUMBERS] with `count` free components. */
static int scaled_stiffness(const quad_solid *s, int cell, double *K)
{
  const int n = s->n, *vertex = s->vertex + cell * (n + 1);
  const quad mass = s->material[cell].rho * s->volume[cell] / (n + 1);
  int free_one[NUMBERS], count = 0;
  for (int i = 0; i < (n + 1) * n; i++)
    if (!s->given[vertex[i / n] * n + i % n]) free_one[count++] = i;
  for (int c = 0; c < count; c++) {
    quad u[NUMBERS] = {0}, f[NUMBERS];
    u[free_one[c]] = 1;
    (void)quad_solid_cell(s, cell, 1, u, f);
    for (int r = 0; r < count; r++) K[r * NUMBERS + c] = (double)(-f[free_one[r]] / mass);
  }
  return count;
}

/* Jacobi's rotations (Golub and Van Loan 2013, sec. 8.5). */
static double largest_eigenvalue(int count, double *K)
{
  for (int round = 0; round < 30; round++)
    for (int p = 0; p < count; p++)
      for (int q = p + 1; q < count; q++) {
        const double angle = 0.5 *
                             atan2(2 * K[p * NUMBERS + q], K[q * NUMBERS + q] - K[p * NUMBERS + p]);
        const double c = cos(angle), e = sin(angle);
        for (int i = 0; i < count; i++) {
          const double a = K[i * NUMBERS + p], b = K[i * NUMBERS + q];
          K[i * NUMBERS + p] = c * a - e * b;
          K[i * NUMBERS + q] = e * a + c * b;
        }
        for (int i = 0; i < count; i++) {
          const double a = K[p * NUMBERS + i], b = K[q * NUMBERS + i];
          K[p * NUMBERS + i] = c * a - e * b;
          K[q * NUMBERS + i] = e * a + c * b;
        }
      }
  double most = 0;
  for (int i = 0; i < count; i++) most = fmax(most, K[i * NUMBERS + i]);
  return most;
}

double quad_solid_bound(const quad_solid *s, int cell)
{
  double K[NUMBERS * NUMBERS];
  const int count = scaled_stiffness(s, cell, K);
  return 2 / sqrt(largest_eigenvalue(count, K));
}

static double fitted(double step, double span)
{
  return span > 0 ? span / ceil(span / step * (1 - 1e-12)) : step;
}

void quad_avi_steps(const quad_solid *s, double fraction, int has_classes, double span,
                    double *step)
{
  double shortest = INFINITY;
  for (int cell = 0; cell < s->cells; cell++) {
    step[cell] = fraction * quad_solid_bound(s, cell);
    shortest = fmin(shortest, step[cell]);
  }
  shortest = fitted(shortest, span);
  for (int cell = 0; cell < s->cells; cell++) {
    if (isinf(step[cell])) continue;
    step[cell] = has_classes ? ldexp(shortest, ilogb(step[cell] / shortest * (1 + 1e-12)))
                             : fitted(step[cell], span);
  }
}

/* ---- events ---- */

quad_avi quad_avi_of(const quad_solid *s, const double *step, quad t, const quad *u, const quad *v)
{
  quad_avi avi = {.s = s, .start = t};
  const size_t size = (size_t)s->size, cells = (size_t)s->cells;
  avi.step = room_for(cells, sizeof *avi.step);
  avi.count = room_for(cells, sizeof *avi.count);
  avi.u = room_for(size, sizeof *avi.u);
  avi.v = room_for(size, sizeof *avi.v);
  avi.clock = room_for((size_t)s->vertices, sizeof *avi.clock);
  memcpy(avi.step, step, cells * sizeof *step);
  memcpy(avi.u, u, size * sizeof *u);
  memcpy(avi.v, v, size * sizeof *v);
  for (int a = 0; a < s->vertices; a++) avi.clock[a] = t;
  quad_solid_give(s, t, avi.u, avi.v);
  return avi;
}

void quad_avi_clear(quad_avi *avi)
{
  free(avi->step), free(avi->count);
  free(avi->u), free(avi->v), free(avi->clock);
  *avi = (quad_avi){0};
}

static quad time_of(const quad_avi *avi, int cell)
{
  return avi->start + avi->count[cell] * (quad)avi->step[cell];
}

/* A cell whose components are all given has an infinite step, and no events. */
static int next_cell(const quad_avi *avi)
{
  int next = -1;
  for (int cell = 0; cell < avi->s->cells; cell++)
    if (isfinite(avi->step[cell]) && (next < 0 || time_of(avi, cell) < time_of(avi, next)))
      next = cell;
  ck_assert_int_ge(next, 0);
  return next;
}

quad quad_avi_next(const quad_avi *avi)
{
  return time_of(avi, next_cell(avi));
}

/* Let the free components of a node pass to t, and give the others. */
static void pass(const quad_avi *avi, int node, quad t, quad *u, quad *v)
{
  const quad_solid *s = avi->s;
  for (int j = 0; j < s->n; j++) {
    const int i = node * s->n + j;
    quad given[3], rate[3];
    u[i] = avi->u[i] + (t - avi->clock[node]) * avi->v[i];
    v[i] = avi->v[i];
    if (!s->given[i]) continue;
    s->given[i](t, s->point + (i - j), given, rate);
    u[i] = given[j];
    v[i] = rate[j];
  }
}

static void add_loads(const quad_avi *avi, int cell, quad t, quad *f)
{
  const quad_solid *s = avi->s;
  for (int i = 0; i < s->loads; i++) {
    quad force[3];
    if (s->load[i].cell != cell) continue;
    s->load[i].force(t, s->load[i].at, s->load[i].normal, force);
    for (int a = 0; a <= s->n; a++)
      for (int j = 0; j < s->n && s->load[i].nodes >> a & 1; j++)
        f[a * s->n + j] += s->load[i].weight * force[j];
  }
}

static void kick(const quad_avi *avi, int cell, const quad *f, quad span, quad *v)
{
  const quad_solid *s = avi->s;
  for (int a = 0; a <= s->n; a++) {
    const int node = s->vertex[cell * (s->n + 1) + a];
    for (int j = 0; j < s->n; j++)
      if (!s->given[node * s->n + j]) v[node * s->n + j] += span * f[a * s->n + j] / s->mass[node];
  }
}

/* Set f to the forces of a cell at displacements u of all nodes, with its loads. */
static void pull(const quad_avi *avi, int cell, quad t, const quad *u, quad *f)
{
  const quad_solid *s = avi->s;
  quad own[NUMBERS] = {0};
  for (int k = 0; k < (s->n + 1) * s->n; k++)
    own[k] = u[s->vertex[cell * (s->n + 1) + k / s->n] * s->n + k % s->n];
  (void)quad_solid_cell(s, cell, 0, own, f);
  add_loads(avi, cell, t, f);
}

static void act(quad_avi *avi, int cell)
{
  const quad_solid *s = avi->s;
  const quad t = time_of(avi, cell);
  quad f[NUMBERS] = {0};
  for (int a = 0; a <= s->n; a++) {
    const int node = s->vertex[cell * (s->n + 1) + a];
    pass(avi, node, t, avi->u, avi->v);
    avi->clock[node] = t;
  }
  pull(avi, cell, t, avi->u, f);
  kick(avi, cell, f, (quad)avi->step[cell] / (avi->count[cell] == 0 ? 2 : 1), avi->v);
  avi->count[cell]++;
  avi->events++;
}

void quad_avi_event(quad_avi *avi)
{
  const quad t = quad_avi_next(avi);
  for (int cell = next_cell(avi); !(time_of(avi, cell) > t); cell = next_cell(avi)) act(avi, cell);
}

/* A kick belongs to the time of half a step before and after its event. */
void quad_avi_advance(quad_avi *avi, quad t, quad *u, quad *v)
{
  while (!(quad_avi_next(avi) > t)) quad_avi_event(avi);
  for (int node = 0; node < avi->s->vertices; node++) pass(avi, node, t, u, v);
  for (int cell = 0; cell < avi->s->cells; cell++) {
    quad f[NUMBERS] = {0};
    if (isinf(avi->step[cell])) continue;
    const quad step = avi->step[cell], since = t - (time_of(avi, cell) - step);
    pull(avi, cell, t, u, f);
    kick(avi, cell, f, since - step / 2, v);
  }
}
