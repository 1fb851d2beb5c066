#include "step/split/gyration.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"

enum { MOST = 3 };

/* Coordinates that mass and field couple. Absent ones, of -1, have mass 1 and stay at rest. */
typedef struct group {
  int size, at[MOST];
  double mass[MOST][MOST];
  int entry[MOST][MOST]; /* index of dA_b/dq_a in the gradients, or -1 */
} group;

struct dvi__gyration {
  const dvi_system *system;
  int count; /* of groups, 0 if the matrix is factored */
  group *groups;
  /* The sparse matrix, its places of the mass, and of the gradients and their transpose. */
  dvi__pattern pattern;
  int *of_mass, *of_gradients, *of_transpose;
  double *values, *point; /* [entries], [n] */
  dvi__linear *linear;
};

/* ---- groups ---- */

static int representative(const int *leader, int i)
{
  while (leader[i] != i) i = leader[i];
  return i;
}

static void couple(const dvi__pattern *pattern, int *leader)
{
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      const int a = representative(leader, j), b = representative(leader, pattern->row[e]);
      leader[a > b ? a : b] = a > b ? b : a;
    }
}

static double mass_entry(const dvi_system *s, int i, int j)
{
  const int e = dvi__pattern_find(&s->vv, i, j);
  if (e < 0) return 0;
  return s->mass_diagonal != NULL ? s->mass_diagonal[i] : s->mass_values[e];
}

static void fill_group(const dvi_system *s, group *g)
{
  for (int a = 0; a < MOST; a++)
    for (int b = 0; b < MOST; b++) {
      const int present = a < g->size && b < g->size;
      g->mass[a][b] = present ? mass_entry(s, g->at[a], g->at[b]) : a == b;
      g->entry[a][b] = present ? dvi__pattern_find(&s->qv, g->at[a], g->at[b]) : -1;
    }
}

/* Collect the groups. Their count stays 0 if one has more than three coordinates. */
static dvi_status find_groups(dvi__gyration *g)
{
  const dvi_system *s = g->system;
  int *leader = DVI_NEW(int, s->n), *number = DVI_NEW(int, s->n), count = 0, small = 1;
  g->groups = DVI_NEW(group, s->n);
  if (leader != NULL && number != NULL && g->groups != NULL) {
    for (int i = 0; i < s->n; i++) leader[i] = i;
    couple(&s->vv, leader);
    couple(&s->qv, leader);
    for (int i = 0; i < s->n && small; i++) {
      const int of = representative(leader, i);
      if (of == i) number[i] = count++;
      group *one = &g->groups[number[of]];
      small = one->size < MOST;
      if (small) one->at[one->size++] = i;
    }
  }
  const int complete = leader != NULL && number != NULL && g->groups != NULL;
  dvi__release(leader);
  dvi__release(number);
  if (!complete) return dvi__fail(DVI_NO_MEMORY, "gyration: no memory for its groups");
  g->count = small ? count : 0;
  for (int k = 0; k < g->count; k++) fill_group(s, &g->groups[k]);
  return DVI_OK;
}

/* ---- the sparse matrix ---- */

static dvi_status join_patterns(dvi__gyration *g, const dvi__pattern *transpose)
{
  dvi__pattern field;
  DVI_TRY(dvi__pattern_union(&g->system->qv, transpose, &field));
  const dvi_status status = dvi__pattern_union(&g->system->vv, &field, &g->pattern);
  dvi__pattern_clear(&field);
  return status;
}

static dvi_status allocate_matrix(dvi__gyration *g)
{
  const dvi_system *s = g->system;
  g->of_mass = DVI_NEW(int, dvi__pattern_entries(&s->vv));
  g->of_gradients = DVI_NEW(int, dvi__pattern_entries(&s->qv));
  g->of_transpose = DVI_NEW(int, dvi__pattern_entries(&s->qv));
  g->values = DVI_NEW(double, dvi__pattern_entries(&g->pattern));
  g->point = DVI_NEW(double, s->n);
  if (g->of_mass && g->of_gradients && g->of_transpose && g->values && g->point) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "gyration: no memory for its matrix");
}

static void matrix_assemble(dvi__gyration *g, int count, int k, double h, const double *A_q)
{
  const dvi_system *s = g->system;
  const double *M = s->mass_diagonal != NULL ? s->mass_diagonal : s->mass_values;
  memset(g->values, 0, (size_t)dvi__pattern_entries(&g->pattern) * sizeof(double));
  for (int e = 0; e < dvi__pattern_entries(&s->vv); e++) g->values[g->of_mass[e]] += M[e];
  for (int e = 0; A_q != NULL && e < dvi__pattern_entries(&s->qv); e++) {
    const double half = 0.5 * h * A_q[(size_t)e * (size_t)count + (size_t)k];
    g->values[g->of_gradients[e]] -= half;
    g->values[g->of_transpose[e]] += half;
  }
}

/* Analyse the pattern at once by the mass alone, so that no step does. */
static dvi_status create_matrix(dvi__gyration *g, dvi_counters *counters)
{
  const dvi_system *s = g->system;
  dvi__pattern transpose;
  DVI_TRY(dvi__pattern_transpose(&s->qv, &transpose));
  const dvi_status status = join_patterns(g, &transpose);
  dvi__pattern_clear(&transpose);
  DVI_TRY(status);
  DVI_TRY(allocate_matrix(g));
  dvi__pattern_embed(&s->vv, &g->pattern, g->of_mass);
  dvi__pattern_embed(&s->qv, &g->pattern, g->of_gradients);
  for (int j = 0; j < s->n; j++)
    for (int e = s->qv.start[j]; e < s->qv.start[j + 1]; e++)
      g->of_transpose[e] = dvi__pattern_find(&g->pattern, j, s->qv.row[e]);
  DVI_TRY(dvi__linear_create(&g->pattern, DVI__LINEAR_AUTO, counters, &g->linear));
  matrix_assemble(g, 1, 0, 0, NULL);
  return dvi__linear_factor(g->linear, g->values);
}

dvi_status dvi__gyration_create(const dvi_system *system, dvi_counters *counters,
                                dvi__gyration **gyration)
{
  dvi__gyration *g = *gyration = DVI_NEW(dvi__gyration, 1);
  if (g == NULL) return dvi__fail(DVI_NO_MEMORY, "gyration: no memory");
  g->system = system;
  dvi_status status = find_groups(g);
  if (status == DVI_OK && g->count == 0) status = create_matrix(g, counters);
  if (status != DVI_OK) dvi__gyration_destroy(gyration);
  return status;
}

void dvi__gyration_destroy(dvi__gyration **gyration)
{
  dvi__gyration *g = *gyration;
  if (g == NULL) return;
  dvi__linear_destroy(&g->linear);
  dvi__pattern_clear(&g->pattern);
  dvi__release(g->groups);
  dvi__release(g->of_mass);
  dvi__release(g->of_gradients);
  dvi__release(g->of_transpose);
  dvi__release(g->values);
  dvi__release(g->point);
  dvi__release(g);
  *gyration = NULL;
}

int dvi__gyration_groups(const dvi__gyration *g)
{
  return g->count;
}

/* ---- a batch ---- */

/* Entry dA_j/dq_i adds to (B w)_i its product with w_j, and takes from (B w)_j that with w_i. */
void dvi__gyration_times(const dvi__gyration *g, int count, double factor, const double *A_q,
                         const double *w, double *y)
{
  const dvi__pattern *qv = &g->system->qv;
  const size_t points = (size_t)count;
  memset(y, 0, (size_t)g->system->n * points * sizeof(double));
  for (size_t j = 0; j < (size_t)g->system->n; j++)
    for (int e = qv->start[j]; e < qv->start[j + 1]; e++) {
      const size_t i = (size_t)qv->row[e] * points, at = j * points;
      const double *value = A_q + (size_t)e * points;
      for (size_t k = 0; k < points; k++) {
        y[i + k] += factor * value[k] * w[at + k];
        y[at + k] -= factor * value[k] * w[i + k];
      }
    }
}

static double entry_at(const double *A_q, int entry, size_t points, size_t k)
{
  return entry >= 0 ? A_q[(size_t)entry * points + k] : 0.0;
}

/* Solve D x = r with three rows by cofactors. */
static void solve_by_cofactors(double D[MOST][MOST], const double *r, double *x)
{
  double C[MOST][MOST], determinant = 0;
  for (int a = 0; a < MOST; a++) {
    const int b = (a + 1) % MOST, c = (a + 2) % MOST;
    for (int i = 0; i < MOST; i++) {
      const int j = (i + 1) % MOST, k = (i + 2) % MOST;
      C[a][i] = D[j][b] * D[k][c] - D[j][c] * D[k][b];
    }
  }
  for (int i = 0; i < MOST; i++) determinant += D[i][0] * C[0][i];
  for (int a = 0; a < MOST; a++)
    x[a] = (C[a][0] * r[0] + C[a][1] * r[1] + C[a][2] * r[2]) / determinant;
}

static void solve_group(const group *g, size_t points, double h, const double *A_q, double *d)
{
  for (size_t k = 0; k < points; k++) {
    double D[MOST][MOST], r[MOST], x[MOST];
    for (int a = 0; a < MOST; a++) {
      r[a] = a < g->size ? d[(size_t)g->at[a] * points + k] : 0.0;
      for (int b = 0; b < MOST; b++)
        D[a][b] = g->mass[a][b] - 0.5 * h *
                                      (entry_at(A_q, g->entry[a][b], points, k) -
                                       entry_at(A_q, g->entry[b][a], points, k));
    }
    solve_by_cofactors(D, r, x);
    for (int a = 0; a < g->size; a++) d[(size_t)g->at[a] * points + k] = x[a];
  }
}

static dvi_status solve_matrix(dvi__gyration *g, int count, int k, double h, const double *A_q,
                               double *d)
{
  const size_t n = (size_t)g->system->n, points = (size_t)count;
  matrix_assemble(g, count, k, h, A_q);
  DVI_TRY(dvi__linear_factor(g->linear, g->values));
  for (size_t i = 0; i < n; i++) g->point[i] = d[i * points + (size_t)k];
  dvi__linear_solve(g->linear, g->point);
  for (size_t i = 0; i < n; i++) d[i * points + (size_t)k] = g->point[i];
  return DVI_OK;
}

dvi_status dvi__gyration_solve(dvi__gyration *g, int count, double h, const double *A_q, double *d)
{
  for (int i = 0; i < g->count; i++) solve_group(&g->groups[i], (size_t)count, h, A_q, d);
  for (int k = 0; g->count == 0 && k < count; k++) DVI_TRY(solve_matrix(g, count, k, h, A_q, d));
  return DVI_OK;
}
