/* With T = dy/dxi and S = dy'/dxi (group/chart.h), the mass M constant, w = M y' and L_y = -V_y of the potentials' sum V:
 *
 *     L_xi    = S^T w + T^T L_y         L_xi'xi' = T^T M T         L_xixi' = S^T M T + w.d2y
 *     L_xi'   = T^T w                   L_xixi   = S^T M S + T^T L_yy T + (w.d3y) xi' + L_y.d2y
 *
 * Moving the centre turns a path in space. Let N = y x L_y + y' x w be the moment of what the Lagrangian does to a rotation or a direction, and mu its angular
 * momentum. Then mu1 = mu0 + h sum_j b_j N_j, and the chart's momentum at the end is p1 = W(xi1) mu1 (group/chart.h). So
 *     C = W(xi1) mu1 - p0 - h sum_j b_j L_xi_j.
 * Without it steps have the same order, but keep neither momenta nor the symplectic form: they would have a discrete Lagrangian of their own in every step.
 *
 * Points are taken in groups, whose size does not depend on the batch that is asked for. */
#include "system/charted.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/finite.h"

enum { GROUP = 8 };

/* Where the block of an entry of the stored coordinates' matrix stands: its first entry, and how long its columns are. */
typedef struct block {
  int first, column;
} block;

struct dvi__charted {
  const dvi_system *base;
  dvi_system *system;
  dvi__evaluator *evaluator; /* of base */
  dvi_counters *counters;
  dvi__chart *chart;         /* [cells] */
  int *cell;                 /* [nq] that a stored coordinate belongs to */
  dvi_status failure;
  double turned;                          /* how far a coordinate beyond its chart was */
  double *t, *y, *rate, *L_y, *w, *value; /* a group: [GROUP], [nq*GROUP] */
  double *L_yy;                           /* [entries*GROUP] */
  double *T, *S;                          /* [nq*3], of one point */
  double *curved, *mixed;                 /* [cells*9], of one point */
  dvi__pattern qq, qv, vv;                /* of the new system */
  /* Paths from the centre (place): not 0 for those; W [cells*9], xi1 [nx]; N [cells*3*capacity], at node j of a batch [(3 c + a)*capacity + j]. */
  int from_centre, capacity;
  double *W, *end, *moment;
  double *angular;              /* [cells*3] mu1 of the last path */
  double *turned_T, *turned_S;  /* [nq*3] y x and y' x, times W, of one point */
  double *C_q1, *C_qq, *C_qv;   /* [entries], [entries*capacity] */
  block *in_qq, *mass_in_qq, *mass_in_qv, *mass_in_vv;
};

static int turns(const dvi__cell *cell)
{
  return cell->kind == DVI__ROTATION || cell->kind == DVI__SPHERE;
}

/* ---- patterns ---- */

/* The cell of every stored coordinate. */
static int *cells_of(const dvi_system *base)
{
  int *cell = DVI_NEW(int, base->n);
  for (int c = 0; c < base->cell_count && cell != NULL; c++)
    for (int i = 0; i < dvi__chart_stored(base->cells[c].kind); i++) cell[base->cells[c].q + i] = c;
  return cell;
}

/* Mark the cells that meet those of column cell c: by two patterns, and c itself if it turns. */
static void mark(const dvi_system *base, const int *cell, int c, const dvi__pattern *const pattern[2], int own, int stamp, int *seen)
{
  const dvi__cell *at = &base->cells[c];
  if (own || at->kind != DVI__LINE) seen[c] = stamp;
  for (int k = 0; k < 2; k++)
    for (int j = at->q; pattern[k] != NULL && j < at->q + dvi__chart_stored(at->kind); j++)
      for (int e = pattern[k]->start[j]; e < pattern[k]->start[j + 1]; e++) seen[cell[pattern[k]->row[e]]] = stamp;
}

/* Rows of marked cells, for every chart coordinate of cell c. Only counts them if there is no room. */
static size_t put_columns(const dvi_system *base, int c, int stamp, const int *seen, size_t at, dvi__pattern *made)
{
  const dvi__cell *column = &base->cells[c];
  for (int j = 0; j < dvi__chart_size(column->kind); j++) {
    for (int r = 0; r < base->cell_count; r++)
      for (int i = 0; seen[r] == stamp && i < dvi__chart_size(base->cells[r].kind); i++, at++)
        if (made != NULL) made->row[at] = base->cells[r].x + i;
    if (made != NULL) made->start[column->x + j + 1] = (int)at;
  }
  return at;
}

/* The blocks of cells that meet in one of two patterns of stored coordinates. `own`: with all the diagonal blocks. */
static dvi_status make_pattern(const dvi_system *base, const int *cell, const dvi__pattern *a, const dvi__pattern *b, int own,
                               dvi__pattern *made)
{
  const dvi__pattern *const pattern[] = {a, b};
  int *seen = DVI_NEW(int, base->cell_count);
  dvi_status status = seen != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "charts: no memory");
  for (int pass = 0; pass < 2 && status == DVI_OK; pass++) {
    size_t at = 0;
    for (int c = 0; c < base->cell_count; c++) {
      const int stamp = 1 + c + pass * base->cell_count;
      mark(base, cell, c, pattern, own, stamp, seen);
      at = put_columns(base, c, stamp, seen, at, pass == 1 ? made : NULL);
    }
    if (pass == 1) break;
    *made = (dvi__pattern){base->nx, base->nx, DVI_NEW(int, (size_t)base->nx + 1), DVI_NEW(int, at)};
    if (at > 0x7fffffff || made->start == NULL || made->row == NULL) status = dvi__fail(DVI_NO_MEMORY, "charts: no memory");
  }
  dvi__release(seen);
  return status;
}

/* Where the block of every entry of `part` stands in `made`. */
static dvi_status place(const dvi_system *base, const int *cell, const dvi__pattern *part, const dvi__pattern *made, block **blocks)
{
  block *b = *blocks = DVI_NEW(block, dvi__pattern_entries(part));
  if (b == NULL) return dvi__fail(DVI_NO_MEMORY, "charts: no memory");
  for (int j = 0; j < part->columns; j++)
    for (int e = part->start[j]; e < part->start[j + 1]; e++) {
      const int column = base->cells[cell[j]].x, row = base->cells[cell[part->row[e]]].x;
      b[e] = (block){dvi__pattern_find(made, row, column), made->start[column + 1] - made->start[column]};
    }
  return DVI_OK;
}

static dvi_status make_patterns(dvi__charted *x)
{
  const dvi_system *base = x->base;
  const int *cell = x->cell = cells_of(base);
  if (cell == NULL) return dvi__fail(DVI_NO_MEMORY, "charts: no memory");
  DVI_TRY(make_pattern(base, cell, &base->qq, &base->vv, 0, &x->qq));
  DVI_TRY(make_pattern(base, cell, &base->vv, NULL, 0, &x->qv));
  DVI_TRY(make_pattern(base, cell, &base->vv, NULL, 1, &x->vv));
  DVI_TRY(place(base, cell, &base->qq, &x->qq, &x->in_qq));
  DVI_TRY(place(base, cell, &base->vv, &x->qq, &x->mass_in_qq));
  DVI_TRY(place(base, cell, &base->vv, &x->qv, &x->mass_in_qv));
  return place(base, cell, &base->vv, &x->vv, &x->mass_in_vv);
}

/* ---- create, destroy ---- */

static int value(int count, const double *t, const double *xi, const double *rate, double *L, void *user);
static int gradient(int count, const double *t, const double *xi, const double *rate, double *L_xi, double *L_rate, void *user);
static int hessian(int count, const double *t, const double *xi, const double *rate, double *L_qq, double *L_qv, double *L_vv,
                   void *user);

static dvi_status make_system(dvi__charted *x)
{
  const dvi_lagrangian lagrangian = {.value_batch = value,
                                     .gradient_batch = gradient,
                                     .hessian_batch = hessian,
                                     .qq = {x->qq.start, x->qq.row},
                                     .qv = {x->qv.start, x->qv.row},
                                     .vv = {x->vv.start, x->vv.row},
                                     .user = x};
  return dvi_system_create(&(dvi_system_terms){.dimension = x->base->nx, .lagrangian = &lagrangian}, &x->system);
}

static dvi_status allocate(dvi__charted *x)
{
  const size_t group = (size_t)x->base->n * GROUP, cells = (size_t)x->base->cell_count;
  x->chart = DVI_NEW(dvi__chart, cells);
  x->t = DVI_NEW(double, GROUP);
  x->value = DVI_NEW(double, GROUP);
  x->y = DVI_NEW(double, group);
  x->rate = DVI_NEW(double, group);
  x->L_y = DVI_NEW(double, group);
  x->w = DVI_NEW(double, group);
  x->L_yy = DVI_NEW(double, (size_t)dvi__pattern_entries(&x->base->qq) * GROUP);
  x->T = DVI_NEW(double, 3 * (size_t)x->base->n);
  x->S = DVI_NEW(double, 3 * (size_t)x->base->n);
  x->curved = DVI_NEW(double, 9 * cells);
  x->mixed = DVI_NEW(double, 9 * cells);
  if (x->chart && x->t && x->value && x->y && x->rate && x->L_y && x->w && x->L_yy && x->T && x->S && x->curved && x->mixed)
    return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %zu factors", cells);
}

static dvi_status fill(dvi__charted *x, const dvi_system *system, dvi_counters *counters)
{
  x->base = system;
  x->counters = counters;
  DVI_TRY(dvi__system_prepare_hessian(system));
  DVI_TRY(allocate(x));
  DVI_TRY(dvi__evaluator_create(system, GROUP, DVI__HESSIANS, counters, &x->evaluator));
  DVI_TRY(make_patterns(x));
  return make_system(x);
}

dvi_status dvi__charted_create(const dvi_system *system, dvi_counters *counters, dvi__charted **charted)
{
  dvi__charted *x = *charted = DVI_NEW(dvi__charted, 1);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "charts: no memory");
  const dvi_status status = fill(x, system, counters);
  if (status != DVI_OK) dvi__charted_destroy(charted);
  return status;
}

void dvi__charted_destroy(dvi__charted **charted)
{
  dvi__charted *x = *charted;
  if (x == NULL) return;
  dvi_system_destroy(&x->system);
  dvi__evaluator_destroy(&x->evaluator);
  dvi__pattern_clear(&x->qq);
  dvi__pattern_clear(&x->qv);
  dvi__pattern_clear(&x->vv);
  void *const own[] = {x->chart, x->t, x->value, x->cell, x->y,      x->rate,  x->L_y,   x->w,          x->L_yy,
                       x->T,     x->S, x->curved, x->mixed, x->in_qq, x->mass_in_qq, x->mass_in_qv, x->mass_in_vv,
                       x->angular, x->W, x->end, x->moment, x->turned_T, x->turned_S, x->C_q1, x->C_qq, x->C_qv};
  for (size_t i = 0; i < sizeof own / sizeof *own; i++) dvi__release(own[i]);
  dvi__release(x);
  *charted = NULL;
}

const dvi_system *dvi__charted_system(const dvi__charted *x)
{
  return x->system;
}

/* ---- between the charts and the space ---- */

void dvi__charted_centre(dvi__charted *x, const double *q)
{
  for (int c = 0; c < x->base->cell_count; c++)
    dvi__chart_centre(x->base->cells[c].kind, q + x->base->cells[c].q, &x->chart[c]);
  x->failure = DVI_OK;
}

void dvi__charted_enter(const dvi__charted *x, const double *stored, double *local)
{
  for (int c = 0; c < x->base->cell_count; c++)
    dvi__chart_enter(&x->chart[c], stored + x->base->cells[c].v, local + x->base->cells[c].x);
}

void dvi__charted_store(const dvi__charted *x, const double *local, double *stored)
{
  for (int c = 0; c < x->base->cell_count; c++)
    dvi__chart_store(&x->chart[c], local + x->base->cells[c].x, stored + x->base->cells[c].v);
}

void dvi__charted_arrive(const dvi__charted *x, const double *xi, const double *p, double *q, double *stored)
{
  for (int c = 0; c < x->base->cell_count; c++) {
    const dvi__cell *at = &x->base->cells[c];
    dvi__chart_point(&x->chart[c], xi + at->x, NULL, q + at->q, NULL);
    if (turns(at))
      dvi__chart_stored_momentum(&x->chart[c], xi + at->x, x->angular + 3 * c, stored + at->v);
    else
      stored[at->v] = p[at->x];
  }
}

void dvi__charted_point(const dvi__charted *x, const double *xi, const double *rate, double *q, double *v)
{
  for (int c = 0; c < x->base->cell_count; c++) {
    const dvi__cell *at = &x->base->cells[c];
    if (q != NULL) dvi__chart_point(&x->chart[c], xi + at->x, NULL, q + at->q, NULL);
    if (v != NULL) dvi__chart_leave_velocity(&x->chart[c], xi + at->x, rate + at->x, v + at->v);
  }
}

void dvi__charted_inverse(const dvi__charted *x, const double *q, double *xi)
{
  for (int c = 0; c < x->base->cell_count; c++)
    dvi__chart_inverse(&x->chart[c], q + x->base->cells[c].q, xi + x->base->cells[c].x);
}

static double angle_of(const dvi__cell *cell, const double *xi)
{
  double sum = 0;
  for (int i = 0; i < dvi__chart_size(cell->kind); i++) sum += xi[cell->x + i] * xi[cell->x + i];
  return sqrt(sum);
}

static dvi_status too_large(double turned)
{
  return dvi__fail(DVI_STEP_TOO_LARGE, "a step too large: a rotation by %.3g is beyond the chart, whose bound is half a turn, %.3g",
                   turned, dvi__chart_bound(DVI__ROTATION));
}

dvi_status dvi__charted_check(const dvi__charted *x, const double *xi)
{
  for (int c = 0; c < x->base->cell_count; c++) {
    const dvi__cell *cell = &x->base->cells[c];
    const double angle = angle_of(cell, xi);
    if (!(angle < dvi__chart_bound(cell->kind))) return too_large(angle);
  }
  return DVI_OK;
}

dvi_status dvi__charted_failure(const dvi__charted *x)
{
  return x->failure == DVI_STEP_TOO_LARGE ? too_large(x->turned) : x->failure;
}

/* ---- evaluation ---- */

/* A callback of the new system says it by a number; the status itself is kept. */
static int verdict(dvi__charted *x, dvi_status status)
{
  x->failure = status;
  return status == DVI_OK ? 0 : status > 0 ? 1 : -1;
}

/* xi and rate of point k of a batch of `count`, for a cell. */
static void gather(const dvi__cell *cell, int count, int k, const double *batch, double *one)
{
  for (int i = 0; i < dvi__chart_size(cell->kind); i++) one[i] = batch[(size_t)(cell->x + i) * (size_t)count + (size_t)k];
}

/* t, y and rate of the group that begins at point `first`. */
static dvi_status points(dvi__charted *x, int count, int first, int group, const double *t, const double *xi, const double *rate)
{
  for (int c = 0; c < x->base->cell_count; c++) {
    const dvi__cell *cell = &x->base->cells[c];
    const int stored = dvi__chart_stored(cell->kind);
    for (int k = 0; k < group; k++) {
      double a[DVI__CHART_SIZE], b[DVI__CHART_SIZE], y[DVI__CHART_POINT], v[DVI__CHART_POINT];
      gather(cell, count, first + k, xi, a);
      gather(cell, count, first + k, rate, b);
      const double angle = sqrt(a[0] * a[0] + (cell->kind >= DVI__SPHERE ? a[1] * a[1] : 0) + (cell->kind == DVI__ROTATION ? a[2] * a[2] : 0));
      if (!(angle < dvi__chart_bound(cell->kind))) {
        x->turned = angle;
        return too_large(angle);
      }
      dvi__chart_point(&x->chart[c], a, b, y, v);
      for (int i = 0; i < stored; i++) {
        x->y[(cell->q + i) * group + k] = y[i];
        x->rate[(cell->q + i) * group + k] = v[i];
      }
    }
  }
  memcpy(x->t, t + first, (size_t)group * sizeof *t);
  return DVI_OK;
}

static int smaller(int a, int b)
{
  return a < b ? a : b;
}

static int value(int count, const double *t, const double *xi, const double *rate, double *L, void *user)
{
  dvi__charted *x = user;
  dvi_status status = DVI_OK;
  x->counters->values -= count; /* what asks counts the same points */
  for (int first = 0; first < count && status == DVI_OK; first += GROUP) {
    const int group = smaller(GROUP, count - first);
    status = points(x, count, first, group, t, xi, rate);
    if (status == DVI_OK) status = dvi__lagrangian_value(x->evaluator, group, x->t, x->y, x->rate, L + first);
  }
  return verdict(x, status);
}

/* -L_y and w = M y' of a group. */
static dvi_status forces(dvi__charted *x, int count, int first, int group, const double *t, const double *xi, const double *rate)
{
  DVI_TRY(points(x, count, first, group, t, xi, rate));
  return dvi__lagrangian_gradient(x->evaluator, group, x->t, x->y, x->rate, x->L_y, x->w);
}

/* A cell's covectors at point k of a group. */
static void covectors(const dvi__charted *x, const dvi__cell *cell, int group, int k, double *a, double *b)
{
  for (int i = 0; i < dvi__chart_stored(cell->kind); i++) {
    a[i] = x->L_y[(cell->q + i) * group + k];
    b[i] = x->w[(cell->q + i) * group + k];
  }
}

static void pull_back(const dvi__charted *x, int count, int first, int group, const double *xi, const double *rate, double *L_xi,
                      double *L_rate)
{
  for (int c = 0; c < x->base->cell_count; c++) {
    const dvi__cell *cell = &x->base->cells[c];
    for (int k = 0; k < group; k++) {
      double at[3], u[3], a[DVI__CHART_POINT], b[DVI__CHART_POINT], in_xi[3], in_rate[3];
      gather(cell, count, first + k, xi, at);
      gather(cell, count, first + k, rate, u);
      covectors(x, cell, group, k, a, b);
      dvi__chart_gradient(&x->chart[c], at, u, a, b, in_xi, in_rate);
      for (int i = 0; i < dvi__chart_size(cell->kind); i++) {
        const size_t to = (size_t)(cell->x + i) * (size_t)count + (size_t)(first + k);
        L_xi[to] = in_xi[i];
        L_rate[to] = in_rate[i];
      }
    }
  }
}

/* N at the nodes of a group. */
static void find_moments(dvi__charted *x, int first, int group)
{
  for (int c = 0; c < x->base->cell_count; c++) {
    const dvi__cell *cell = &x->base->cells[c];
    for (int k = 0; k < group && turns(cell); k++) {
      double y[DVI__CHART_POINT], v[DVI__CHART_POINT], a[DVI__CHART_POINT], b[DVI__CHART_POINT], N[3] = {0};
      for (int i = 0; i < dvi__chart_stored(cell->kind); i++) {
        y[i] = x->y[(cell->q + i) * group + k];
        v[i] = x->rate[(cell->q + i) * group + k];
      }
      covectors(x, cell, group, k, a, b);
      dvi__chart_add_moment(cell->kind, y, a, N);
      dvi__chart_add_moment(cell->kind, v, b, N);
      for (int i = 0; i < 3; i++) x->moment[(3 * c + i) * x->capacity + first + k] = N[i];
    }
  }
}

static int gradient(int count, const double *t, const double *xi, const double *rate, double *L_xi, double *L_rate, void *user)
{
  dvi__charted *x = user;
  dvi_status status = DVI_OK;
  x->counters->gradients -= count;
  for (int first = 0; first < count && status == DVI_OK; first += GROUP) {
    const int group = smaller(GROUP, count - first);
    status = forces(x, count, first, group, t, xi, rate);
    if (status == DVI_OK) pull_back(x, count, first, group, xi, rate, L_xi, L_rate);
    if (status == DVI_OK && x->from_centre && count <= x->capacity) find_moments(x, first, group);
  }
  return verdict(x, status);
}

/* ---- second derivatives ---- */

/* T, S and the curvatures of point k of a group. */
static void bend(dvi__charted *x, int count, int first, int group, int k, const double *xi, const double *rate)
{
  for (int c = 0; c < x->base->cell_count; c++) {
    const dvi__cell *cell = &x->base->cells[c];
    double at[3], u[3], a[DVI__CHART_POINT], b[DVI__CHART_POINT];
    gather(cell, count, first + k, xi, at);
    gather(cell, count, first + k, rate, u);
    covectors(x, cell, group, k, a, b);
    dvi__chart_tangents(&x->chart[c], at, u, x->T + 3 * (size_t)cell->q, x->S + 3 * (size_t)cell->q);
    dvi__chart_curvature(&x->chart[c], at, u, a, b, x->curved + 9 * (size_t)c, x->mixed + 9 * (size_t)c);
  }
}

/* The tangents of stored coordinate i. */
static const double *row_of(const dvi__cell *cell, const double *tangents, int i)
{
  return tangents + 3 * (size_t)cell->q + (size_t)(i - cell->q) * (size_t)dvi__chart_size(cell->kind);
}

/* values += left^T (entry) right, in the block of an entry (i,j), for point k of `count`. */
static void add_product(const block *at, int rows, int columns, double entry, const double *left, const double *right, size_t count,
                        size_t k, double *values)
{
  for (int b = 0; b < columns; b++)
    for (int a = 0; a < rows; a++)
      values[(size_t)(at->first + b * at->column + a) * count + k] += left[a] * entry * right[b];
}

/* left^T M right in the blocks of `in`. */
static void add_mass_product(const dvi__charted *x, const block *in, const double *left, const double *right, size_t count, size_t k,
                             double *values)
{
  const dvi__pattern *vv = &x->base->vv;
  for (int j = 0; j < x->base->n; j++)
    for (int e = vv->start[j]; e < vv->start[j + 1]; e++) {
      const int i = vv->row[e];
      const dvi__cell *row = &x->base->cells[x->cell[i]], *column = &x->base->cells[x->cell[j]];
      add_product(&in[e], dvi__chart_size(row->kind), dvi__chart_size(column->kind), x->base->mass_values[e], row_of(row, left, i),
                  row_of(column, right, j), count, k, values);
    }
}

/* left^T L_yy T in the blocks of qq. */
static void add_potentials(const dvi__charted *x, int group, int in_group, const double *left, size_t count, size_t k, double *L_qq)
{
  const dvi__pattern *qq = &x->base->qq;
  for (int j = 0; j < x->base->n; j++)
    for (int e = qq->start[j]; e < qq->start[j + 1]; e++) {
      const dvi__cell *row = &x->base->cells[x->cell[qq->row[e]]], *column = &x->base->cells[x->cell[j]];
      add_product(&x->in_qq[e], dvi__chart_size(row->kind), dvi__chart_size(column->kind), x->L_yy[e * group + in_group],
                  row_of(row, left, qq->row[e]), row_of(column, x->T, j), count, k, L_qq);
    }
}

/* The diagonal blocks of qq and qv of cell c. */
static void add_own_blocks(const dvi__charted *x, int c, const double *in_qq, const double *in_qv, size_t count, size_t k, double *qq,
                           double *qv)
{
  const dvi__cell *cell = &x->base->cells[c];
  const int size = dvi__chart_size(cell->kind), first_qq = dvi__pattern_find(&x->qq, cell->x, cell->x),
            first_qv = dvi__pattern_find(&x->qv, cell->x, cell->x);
  for (int b = 0; b < size; b++) {
    const int at_qq = first_qq + b * (x->qq.start[cell->x + 1] - x->qq.start[cell->x]),
              at_qv = first_qv + b * (x->qv.start[cell->x + 1] - x->qv.start[cell->x]);
    for (int a = 0; a < size; a++) {
      qq[(size_t)(at_qq + a) * count + k] += in_qq[a * size + b];
      qv[(size_t)(at_qv + a) * count + k] += in_qv[a * size + b];
    }
  }
}

static void add_curvature(const dvi__charted *x, size_t count, size_t k, double *L_qq, double *L_qv)
{
  for (int c = 0; c < x->base->cell_count; c++)
    if (x->base->cells[c].kind != DVI__LINE) add_own_blocks(x, c, x->curved + 9 * c, x->mixed + 9 * c, count, k, L_qq, L_qv);
}

/* ---- paths from the centre ---- */

/* values [stored*size] = rows y x times W^T. */
static void turn_rows(const dvi__cell *cell, const double *y, const double *W, double *values)
{
  const int size = dvi__chart_size(cell->kind);
  double rows[3 * DVI__CHART_POINT];
  dvi__chart_turns(cell->kind, y, rows);
  for (int i = 0; i < dvi__chart_stored(cell->kind); i++)
    for (int b = 0; b < size; b++)
      values[i * size + b] = rows[3 * i] * W[3 * b] + rows[3 * i + 1] * W[3 * b + 1] + rows[3 * i + 2] * W[3 * b + 2];
}

static void times_W(int size, const double *W, const double *columns, double *product)
{
  for (int a = 0; a < size; a++)
    for (int b = 0; b < size; b++)
      product[a * size + b] = W[3 * a] * columns[3 * b] + W[3 * a + 1] * columns[3 * b + 1] + W[3 * a + 2] * columns[3 * b + 2];
}

/* W times what the moment N of fixed covectors a, b changes by with xi and its rate: T_j x a + S_j x b, T_j x b. */
static void moment_change(const dvi__charted *x, const dvi__cell *cell, const double *W, const double *a, const double *b,
                          double *in_xi, double *in_rate)
{
  const int size = dvi__chart_size(cell->kind);
  double by_xi[9] = {0}, by_rate[9] = {0};
  for (int j = 0; j < size; j++) {
    double T[DVI__CHART_POINT], S[DVI__CHART_POINT];
    for (int i = 0; i < dvi__chart_stored(cell->kind); i++) {
      T[i] = x->T[3 * cell->q + i * size + j];
      S[i] = x->S[3 * cell->q + i * size + j];
    }
    dvi__chart_add_moment(cell->kind, T, a, by_xi + 3 * j);
    dvi__chart_add_moment(cell->kind, S, b, by_xi + 3 * j);
    dvi__chart_add_moment(cell->kind, T, b, by_rate + 3 * j);
  }
  times_W(size, W, by_xi, in_xi);
  times_W(size, W, by_rate, in_rate);
}

/* W N_xi and W N_xi' at point k of a group, into C_qq and C_qv. */
static void add_moment_changes(dvi__charted *x, int count, int first, int group, int k)
{
  const size_t to = (size_t)(first + k);
  memset(x->turned_T, 0, 3 * (size_t)x->base->n * sizeof(double));
  memset(x->turned_S, 0, 3 * (size_t)x->base->n * sizeof(double));
  for (int c = 0; c < x->base->cell_count; c++) {
    const dvi__cell *cell = &x->base->cells[c];
    double y[DVI__CHART_POINT], v[DVI__CHART_POINT], a[DVI__CHART_POINT], b[DVI__CHART_POINT], in_xi[9], in_rate[9];
    if (!turns(cell)) continue;
    for (int i = 0; i < dvi__chart_stored(cell->kind); i++) {
      y[i] = x->y[(cell->q + i) * group + k];
      v[i] = x->rate[(cell->q + i) * group + k];
    }
    covectors(x, cell, group, k, a, b);
    turn_rows(cell, y, x->W + 9 * c, x->turned_T + 3 * (size_t)cell->q);
    turn_rows(cell, v, x->W + 9 * c, x->turned_S + 3 * (size_t)cell->q);
    moment_change(x, cell, x->W + 9 * c, a, b, in_xi, in_rate);
    add_own_blocks(x, c, in_xi, in_rate, (size_t)count, to, x->C_qq, x->C_qv);
  }
  add_potentials(x, group, k, x->turned_T, (size_t)count, to, x->C_qq);
  add_mass_product(x, x->mass_in_qq, x->turned_S, x->S, (size_t)count, to, x->C_qq);
  add_mass_product(x, x->mass_in_qv, x->turned_S, x->T, (size_t)count, to, x->C_qv);
}

/* C -= H in the rows of what turns. */
static void subtract_rows(const dvi__charted *x, const dvi__pattern *pattern, size_t count, const double *H, double *C)
{
  for (int c = 0, e = 0; e < dvi__pattern_entries(pattern); e++) {
    if (e == 0 || pattern->row[e] < pattern->row[e - 1]) c = 0;
    while (c + 1 < x->base->cell_count && x->base->cells[c + 1].x <= pattern->row[e]) c++;
    for (size_t k = (size_t)e * count; k < ((size_t)e + 1) * count && turns(&x->base->cells[c]); k++) C[k] -= H[k];
  }
}

static void place_path(void *of, const double *q0, const double *q1)
{
  dvi__charted *x = of;
  x->from_centre = 1;
  for (int i = 0; i < x->base->nx; i++) x->from_centre &= q0[i] == 0;
  memcpy(x->end, q1, (size_t)x->base->nx * sizeof *q1);
  for (int c = 0; c < x->base->cell_count && x->from_centre; c++)
    if (turns(&x->base->cells[c])) dvi__chart_moments(&x->chart[c], q1 + x->base->cells[c].x, x->W + 9 * c);
}

/* mu1 = mu0 + h sum_j b_j N_j of cell c. */
static void angular_momentum(const dvi__charted *x, int c, int nodes, double h, const double *weight, const double *p0, double *mu)
{
  double impulse[3] = {0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < nodes; j++) impulse[i] += h * weight[j] * x->moment[(3 * c + i) * x->capacity + j];
  dvi__chart_angular_momentum(&x->chart[c], p0 + x->base->cells[c].x, mu);
  dvi__chart_add_impulse(&x->chart[c], impulse, mu);
}

static void correct_path(void *of, int nodes, double h, const double *weight, const double *p0, const double *dp, double *C)
{
  dvi__charted *x = of;
  memset(C, 0, (size_t)x->base->nx * sizeof *C);
  for (int c = 0; c < x->base->cell_count && x->from_centre; c++) {
    const dvi__cell *cell = &x->base->cells[c];
    double *mu = x->angular + 3 * c, p1[DVI__CHART_SIZE];
    if (!turns(cell)) continue;
    angular_momentum(x, c, nodes, h, weight, p0, mu);
    dvi__chart_momentum(&x->chart[c], x->end + cell->x, mu, p1);
    for (int i = 0; i < dvi__chart_size(cell->kind); i++) C[cell->x + i] = p1[i] - p0[cell->x + i] - dp[cell->x + i];
  }
}

static void derive_path(void *of, int nodes, double h, const double *weight, const double *p0, const double **C_q1, const double **C_qq,
                        const double **C_qv)
{
  dvi__charted *x = of;
  memset(x->C_q1, 0, (size_t)dvi__pattern_entries(&x->qq) * sizeof(double));
  for (int c = 0; c < x->base->cell_count && x->from_centre; c++) {
    const dvi__cell *cell = &x->base->cells[c];
    const int size = dvi__chart_size(cell->kind), first = dvi__pattern_find(&x->qq, cell->x, cell->x),
              column = x->qq.start[cell->x + 1] - x->qq.start[cell->x];
    double mu[3], derivative[9];
    if (!turns(cell)) continue;
    angular_momentum(x, c, nodes, h, weight, p0, mu);
    dvi__chart_momentum_derivative(&x->chart[c], x->end + cell->x, mu, derivative);
    for (int a = 0; a < size; a++)
      for (int b = 0; b < size; b++) x->C_q1[first + b * column + a] = derivative[a * size + b];
  }
  *C_q1 = x->C_q1;
  *C_qq = x->C_qq;
  *C_qv = x->C_qv;
}

dvi_status dvi__charted_reserve(dvi__charted *x, int nodes)
{
  const size_t cells = (size_t)x->base->cell_count, n = (size_t)x->base->n, qq = (size_t)dvi__pattern_entries(&x->qq);
  x->capacity = nodes;
  x->W = DVI_NEW(double, 9 * cells);
  x->end = DVI_NEW(double, x->base->nx);
  x->angular = DVI_NEW(double, 3 * cells);
  x->moment = DVI_NEW(double, 3 * cells * (size_t)nodes);
  x->turned_T = DVI_NEW(double, 3 * n);
  x->turned_S = DVI_NEW(double, 3 * n);
  x->C_q1 = DVI_NEW(double, qq);
  x->C_qq = DVI_NEW(double, qq * (size_t)nodes);
  x->C_qv = DVI_NEW(double, (size_t)dvi__pattern_entries(&x->qv) * (size_t)nodes);
  if (x->W && x->end && x->angular && x->moment && x->turned_T && x->turned_S && x->C_q1 && x->C_qq && x->C_qv) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "charts: no memory for %d nodes", nodes);
}

void dvi__charted_centring(dvi__charted_path *path)
{
  *path = (dvi__charted_path){place_path, correct_path, derive_path};
}

/* ---- the Hessian ---- */

static dvi_status hessian_group(dvi__charted *x, int count, int first, int group, const double *t, const double *xi,
                                const double *rate, double *L_qq, double *L_qv, double *L_vv)
{
  const int centred = x->from_centre && count <= x->capacity;
  DVI_TRY(forces(x, count, first, group, t, xi, rate));
  DVI_TRY(dvi__lagrangian_hessian(x->evaluator, group, x->t, x->y, x->rate, x->L_yy, NULL, NULL));
  for (int k = 0; k < group; k++) {
    const size_t to = (size_t)(first + k);
    bend(x, count, first, group, k, xi, rate);
    add_mass_product(x, x->mass_in_qq, x->S, x->S, (size_t)count, to, L_qq);
    add_mass_product(x, x->mass_in_qv, x->S, x->T, (size_t)count, to, L_qv);
    add_mass_product(x, x->mass_in_vv, x->T, x->T, (size_t)count, to, L_vv);
    add_potentials(x, group, k, x->T, (size_t)count, to, L_qq);
    add_curvature(x, (size_t)count, to, L_qq, L_qv);
    if (centred) add_moment_changes(x, count, first, group, k);
  }
  if (centred) find_moments(x, first, group);
  return DVI_OK;
}

static int hessian(int count, const double *t, const double *xi, const double *rate, double *L_qq, double *L_qv, double *L_vv,
                   void *user)
{
  dvi__charted *x = user;
  const size_t points = (size_t)count * sizeof(double), qq = (size_t)dvi__pattern_entries(&x->qq) * points,
               qv = (size_t)dvi__pattern_entries(&x->qv) * points;
  dvi_status status = DVI_OK;
  x->counters->hessians -= count;
  memset(L_qq, 0, qq);
  memset(L_qv, 0, qv);
  memset(L_vv, 0, (size_t)dvi__pattern_entries(&x->vv) * points);
  if (count <= x->capacity) {
    memset(x->C_qq, 0, qq);
    memset(x->C_qv, 0, qv);
  }
  for (int first = 0; first < count && status == DVI_OK; first += GROUP)
    status = hessian_group(x, count, first, smaller(GROUP, count - first), t, xi, rate, L_qq, L_qv, L_vv);
  if (x->from_centre && count <= x->capacity) {
    subtract_rows(x, &x->qq, (size_t)count, L_qq, x->C_qq);
    subtract_rows(x, &x->qv, (size_t)count, L_qv, x->C_qv);
  }
  return verdict(x, status);
}
