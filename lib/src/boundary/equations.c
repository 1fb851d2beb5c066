/* The stationarity conditions of the whole action, their Hessian, and the border of both. */
#include <math.h>
#include <string.h>

#include "step/element/energy.h"
#include "core/status.h"
#include "num/finite.h"
#include "boundary/layout.h"

double dvi__path_span(const dvi_path *path, const double *x)
{
  return path->free_span ? x[path->core] * path->span : path->span;
}

void dvi__path_place(dvi_path *path, const double *x, int k)
{
  const double h = dvi__path_span(path, x) / path->steps;
  dvi__action_place(path->action, path->start + k * h, h, dvi__path_at(path, x, k), path->rest);
  dvi__action_two_point(path->action, dvi__path_at(path, x, k + 1), x + dvi__path_bubbles(path, k),
                        path->Y);
}

/* Name the step in a failure's sentence. */
static dvi_status at_step(const dvi_path *path, const double *x, int k, dvi_status status)
{
  if (status == DVI_OK) return DVI_OK;
  const double t = path->start + k * (dvi__path_span(path, x) / path->steps);
  return dvi__fail_in(status, "step %d of %d, from t = %.6g", k + 1, path->steps, t);
}

/* If |L| between the quadrature's nodes exceeds its largest value at the nodes by this factor, the
 * path leads through a singularity. */
static const double overlooked = 1e3;

/* ---- the gradient ---- */

/* Add the rows of an element, in_ends and in_Z of step k. */
static void add_element_rows(dvi_path *path, int k, double *rows)
{
  dvi__places places;
  for (int a = 0; a < 2; a++)
    for (int i = 0; i < path->n; i++) {
      dvi__path_places(path, k, a, i, 1, &places);
      for (int c = 0; c < places.count; c++)
        rows[places.at[c]] += places.factor[c] * path->in_ends[a][i];
    }
  for (int m = 0, first = dvi__path_bubbles(path, k); m < path->n * (path->s - 1); m++)
    rows[first + m] += path->in_Z[m];
}

static dvi_status element_gradient(dvi_path *path, const double *x, int k)
{
  dvi__path_place(path, x, k);
  return dvi__action_two_point_gradient(path->action, path->Y, path->in_ends[0], path->in_ends[1],
                                        path->in_Z);
}

/* Add the given momenta, since -dS/dq0 of the first step is p_0, and dS/dq1 of the last one p_N.
 * Their rows are free of momenta where mixed ends give the coordinate. */
static void add_given_momenta(const dvi_path *path, double *rows)
{
  dvi__places places;
  for (int i = 0; path->p0 != NULL && i < path->n; i++) {
    dvi__path_places(path, 0, 0, i, 1, &places);
    if (places.count > 0 || path->ends == DVI_ENDS_INITIAL) rows[places.single] += path->p0[i];
  }
  for (int i = 0; path->p1 != NULL && i < path->n; i++) {
    dvi__path_places(path, path->steps - 1, 1, i, 1, &places);
    if (places.count > 0) rows[places.single] -= path->p1[i];
  }
}

/* Set the rows of the coordinates that mixed ends give. */
static void set_given_rows(const dvi_path *path, const double *x, double *rows)
{
  for (int i = 0; i < 2 * path->n; i++) {
    const int at = dvi__path_given(path, i % 2, i / 2);
    if (at >= 0) rows[at] = x[at] - (i % 2 == 0 ? path->q0 : path->q1)[i / 2];
  }
}

/* Compute the rows [core], the momenta p [(steps+1)*n], and for autonomous systems the mean energy.
 * The last two may be NULL. */
static dvi_status path_gradient_rows(dvi_path *path, const double *x, double *rows, double *p,
                                     double *energy)
{
  const size_t n = (size_t)path->n, bytes = n * sizeof(double);
  if (energy != NULL) *energy = 0;
  memset(rows, 0, (size_t)path->core * sizeof(double));
  for (int k = 0; k < path->steps; k++) {
    DVI_TRY(at_step(path, x, k, element_gradient(path, x, k)));
    add_element_rows(path, k, rows);
    if (energy != NULL) {
      dvi__energies E;
      DVI_TRY(at_step(path, x, k, dvi__action_energies(path->action, &E)));
      *energy += E.end / path->steps;
    }
    if (p == NULL) continue;
    memcpy(p + (size_t)(k + 1) * n, path->in_ends[1], bytes);
    for (size_t i = 0; i < n && k == 0; i++) p[i] = -path->in_ends[0][i];
  }
  add_given_momenta(path, rows);
  set_given_rows(path, x, rows);
  return DVI_OK;
}

dvi_status dvi__path_gradient(dvi_path *path, const double *x, double *p, double *largest)
{
  DVI_TRY(path_gradient_rows(path, x, path->rows, p, NULL));
  *largest = dvi__largest((size_t)path->core, path->rows);
  return DVI_OK;
}

dvi_status dvi__path_action(dvi_path *path, const double *x, double *action, double *energy)
{
  double S, seen, unseen, most_seen = 0, most_unseen = 0;
  *action = 0;
  *energy = (double)NAN;
  if (path->system->autonomous) DVI_TRY(path_gradient_rows(path, x, path->rows, NULL, energy));
  for (int k = 0; k < path->steps; k++) {
    dvi__path_place(path, x, k);
    DVI_TRY(at_step(path, x, k, dvi__action_value(path->action, path->Y, &S, &seen)));
    const dvi_status status = dvi__action_unseen(path->action, path->Y, &unseen);
    if (status < 0) return at_step(path, x, k, status);
    *action += S;
    most_seen = fmax(most_seen, seen);
    most_unseen = fmax(most_unseen, status == DVI_OK ? unseen : HUGE_VAL);
  }
  if (!(most_unseen > overlooked * most_seen)) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "the path that was found goes through a singularity that the quadrature does "
                   "not see (|L| of %.1e between its "
                   "nodes, %.1e at them); the path is unchanged; try a guess that passes it, more "
                   "steps or a longer span",
                   most_unseen, most_seen);
}

/* ---- the border ---- */

/* The arrays for the gauges' part of the residual. Rows get the multipliers' part, and multipliers'
 * rows the distance from the origin. */
typedef struct gauge_rows {
  const dvi_path *path;
  const double *x;
  double *rows;
} gauge_rows;

static void add_gauge_rows(void *of, int unknown, int multiplier, size_t from)
{
  const gauge_rows *m = of;
  const double factor = m->path->gauge[from];
  m->rows[unknown] += factor * m->x[multiplier];
  m->rows[multiplier] += factor *
                         (m->x[unknown] -
                          m->path->origin[from % ((size_t)m->path->steps * (size_t)m->path->n)]);
}

static void border_rows(const dvi_path *path, const double *x, double *rows)
{
  const int first = path->unknowns - path->gauges;
  gauge_rows m = {.path = path, .x = x, .rows = rows};
  for (int g = 0; g < path->gauges; g++) rows[first + g] = g < path->in_use ? 0 : x[first + g];
  dvi__path_each_gauge(path, add_gauge_rows, &m);
}

static dvi_status path_residual(void *of, const double *x, double *rows)
{
  dvi_path *path = of;
  double energy = 0;
  DVI_TRY(path_gradient_rows(path, x, rows, NULL, path->free_span ? &energy : NULL));
  if (path->free_span) rows[path->core] = path->span * (path->energy - energy);
  border_rows(path, x, rows);
  return DVI_OK;
}

/* ---- the Hessian ---- */

/* The values of the Hessian during assembly. The next entry is often the one after the last. */
typedef struct assembly {
  const dvi_path *path;
  double *values;
  int last;
} assembly;

static int assembly_entry(assembly *to, int row, int column)
{
  const dvi__pattern *pattern = &to->path->pattern;
  const int next = to->last + 1;
  const int follows = next >= pattern->start[column] && next < pattern->start[column + 1] &&
                      pattern->row[next] == row;
  return to->last = follows ? next : dvi__pattern_find(pattern, row, column);
}

static void assembly_add(assembly *to, int row, int column, double value)
{
  to->values[assembly_entry(to, row, column)] += value;
}

static void assembly_add_element(void *of, int row, int column, double factor, size_t from)
{
  assembly *to = of;
  assembly_add(to, row, column, factor * to->path->block[from]);
}

static void assembly_add_gauge(void *of, int unknown, int multiplier, size_t from)
{
  assembly *to = of;
  assembly_add(to, multiplier, unknown, to->path->gauge[from]);
  assembly_add(to, unknown, multiplier, to->path->gauge[from]);
}

/* Add the derivative of step k's rows by the span's unknown, and the row of that unknown. */
static dvi_status assembly_add_span(assembly *to, dvi_path *path, int k)
{
  const double part = -path->span / path->steps;
  dvi__energy_gradient gradient = {.Y = path->energy_Y, .q0 = path->energy_q0};
  dvi__places places;
  DVI_TRY(dvi__action_energy_gradients(path->action, &gradient, &gradient));
  dvi__action_two_point_ends(path->action, gradient.Y, gradient.q0, path->in_ends[0],
                             path->in_ends[1], path->in_Z);
  for (int a = 0; a <= path->s; a++)
    for (int i = 0; i < path->n; i++) {
      dvi__path_places(path, k, a, i, 0, &places);
      const double value = part *
                           (a < 2 ? path->in_ends[a][i] : path->in_Z[i * (path->s - 1) + a - 2]);
      for (int c = 0; c < places.count; c++) {
        assembly_add(to, path->core, places.at[c], places.factor[c] * value);
        assembly_add(to, places.at[c], path->core, places.factor[c] * value);
      }
    }
  assembly_add(to, path->core, path->core, part * path->span / path->steps * gradient.h);
  return DVI_OK;
}

dvi_status dvi__path_jacobian(dvi_path *path, const double *x, double *values)
{
  assembly to = {.path = path, .values = values, .last = -1};
  memset(values, 0, (size_t)dvi__pattern_entries(&path->pattern) * sizeof(double));
  for (int k = 0; k < path->steps; k++) {
    dvi__path_place(path, x, k);
    DVI_TRY(at_step(path, x, k, dvi__action_two_point_hessian(path->action, path->Y, path->block)));
    dvi__path_each_entry(path, k, assembly_add_element, &to);
    if (path->free_span) DVI_TRY(at_step(path, x, k, assembly_add_span(&to, path, k)));
  }
  dvi__path_each_gauge(path, assembly_add_gauge, &to);
  for (int i = 0; i < 2 * path->n; i++) {
    const int given = dvi__path_given(path, i % 2, i / 2);
    if (given >= 0) assembly_add(&to, given, given, 1);
  }
  /* Multipliers that are not in use are unknowns of their own. */
  for (int c = path->unknowns - path->gauges + path->in_use; c < path->unknowns; c++)
    assembly_add(&to, c, c, 1);
  return DVI_OK;
}

static dvi_status path_jacobian(void *of, const double *x, double *values)
{
  return dvi__path_jacobian(of, x, values);
}

/* ---- scales ---- */

/* Set the scales of rows by the kinetic part at the middle of the path. */
dvi_status dvi__path_scale(dvi_path *path, const double *x)
{
  dvi__path_place(path, x, path->steps / 2);
  DVI_TRY(at_step(path, x, path->steps / 2, dvi__action_prepare_chord(path->action, path->Y)));
  (void)dvi__action_row_scale(path->action, path->row_scale); /* 0 if the scales are unchanged */
  const double h = dvi__path_span(path, x) / path->steps;
  for (int i = 0; i < path->n; i++) path->kinetic[i] = path->row_scale[i * path->s] * h;
  return DVI_OK;
}

static dvi_status path_prepare_chord(void *of, const double *x)
{
  return dvi__path_scale(of, x);
}

static dvi_status path_row_scale(void *of, double *scale, int *unchanged)
{
  (void)unchanged;
  const dvi_path *path = of;
  const double kinetic = dvi__largest((size_t)path->n, path->kinetic);
  dvi__places places;
  for (int k = 0; k < path->steps; k++)
    for (int i = 0; i < path->n; i++)
      for (int a = 0; a <= path->s; a++) {
        dvi__path_places(path, k, a, i, 1, &places);
        if (places.count == 1) scale[places.at[0]] = path->row_scale[i * path->s];
      }
  for (int c = path->core; c < path->unknowns; c++) scale[c] = kinetic > 0 ? kinetic : 1;
  for (int i = 0; i < 2 * path->n; i++) {
    const int given = dvi__path_given(path, i % 2, i / 2);
    if (given >= 0) scale[given] = 1;
  }
  return DVI_OK;
}

dvi_status dvi__path_make_solver(dvi_path *path)
{
  const dvi__equations equations = {.unknowns = path->unknowns,
                                    .pattern = &path->pattern,
                                    .linear = DVI__LINEAR_SPARSE,
                                    .border = path->unknowns - path->core,
                                    .of = path,
                                    .residual = path_residual,
                                    .jacobian = path_jacobian,
                                    .prepare_chord = path_prepare_chord,
                                    .row_scale = path_row_scale};
  return dvi__solver_create(&equations, &path->counters, &path->solver);
}
