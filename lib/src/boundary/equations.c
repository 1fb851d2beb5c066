/* The stationarity of the whole action, its Hessian, and what borders them. */
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

/* Say in which step it failed. */
static dvi_status at_step(const dvi_path *path, const double *x, int k, dvi_status status)
{
  if (status == DVI_OK) return DVI_OK;
  const double t = path->start + k * (dvi__path_span(path, x) / path->steps);
  return dvi__fail_in(status, "step %d of %d, from t = %.6g", k + 1, path->steps, t);
}

/* |L| that is so much larger between the quadrature's nodes than at any of them is a singularity,
 * not a path. */
static const double overlooked = 1e3;

/* ---- the gradient ---- */

/* Add what an element gives: in_ends and in_Z of step k. */
static void add_rows(dvi_path *path, int k, double *rows)
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

/* -dS/dq0 of the first step is p_0. */
static void add_given_momentum(const dvi_path *path, double *rows)
{
  dvi__places places;
  for (int i = 0; path->p0 != NULL && i < path->n; i++) {
    dvi__path_places(path, 0, 0, i, 1, &places);
    rows[places.single] += path->p0[i];
  }
}

/* rows [core]; p [(steps+1)*n]; the mean energy, for autonomous systems. The last two may be
 * NULL. */
static dvi_status gradient(dvi_path *path, const double *x, double *rows, double *p, double *energy)
{
  const size_t n = (size_t)path->n, bytes = n * sizeof(double);
  if (energy != NULL) *energy = 0;
  memset(rows, 0, (size_t)path->core * sizeof(double));
  for (int k = 0; k < path->steps; k++) {
    DVI_TRY(at_step(path, x, k, element_gradient(path, x, k)));
    add_rows(path, k, rows);
    if (energy != NULL) {
      dvi__energies E;
      DVI_TRY(at_step(path, x, k, dvi__action_energies(path->action, &E)));
      *energy += E.end / path->steps;
    }
    if (p == NULL) continue;
    memcpy(p + (size_t)(k + 1) * n, path->in_ends[1], bytes);
    for (size_t i = 0; i < n && k == 0; i++) p[i] = -path->in_ends[0][i];
  }
  add_given_momentum(path, rows);
  return DVI_OK;
}

dvi_status dvi__path_gradient(dvi_path *path, const double *x, double *p, double *largest)
{
  DVI_TRY(gradient(path, x, path->rows, p, NULL));
  *largest = dvi__largest((size_t)path->core, path->rows);
  return DVI_OK;
}

dvi_status dvi__path_action(dvi_path *path, const double *x, double *action, double *energy)
{
  double S, seen, unseen, most_seen = 0, most_unseen = 0;
  *action = 0;
  *energy = (double)NAN;
  if (path->system->autonomous) DVI_TRY(gradient(path, x, path->rows, NULL, energy));
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

/* What the gauge is measured by: rows get the multipliers' part, multipliers' rows the distance
 * from the origin. */
typedef struct measure {
  const dvi_path *path;
  const double *x;
  double *rows;
} measure;

static void add_gauge(void *of, int unknown, int multiplier, size_t from)
{
  const measure *m = of;
  const double factor = m->path->gauge[from];
  m->rows[unknown] += factor * m->x[multiplier];
  m->rows[multiplier] += factor *
                         (m->x[unknown] -
                          m->path->origin[from % ((size_t)m->path->steps * (size_t)m->path->n)]);
}

static void border_rows(const dvi_path *path, const double *x, double *rows)
{
  const int first = path->unknowns - path->gauges;
  measure m = {path, x, rows};
  for (int g = 0; g < path->gauges; g++) rows[first + g] = g < path->in_use ? 0 : x[first + g];
  dvi__path_each_gauge(path, add_gauge, &m);
}

static dvi_status residual(void *of, const double *x, double *rows)
{
  dvi_path *path = of;
  double energy = 0;
  DVI_TRY(gradient(path, x, rows, NULL, path->free_span ? &energy : NULL));
  if (path->free_span) rows[path->core] = path->span * (path->energy - energy);
  border_rows(path, x, rows);
  return DVI_OK;
}

/* ---- the Hessian ---- */

/* Values being added up; the next entry is often the one after the last. */
typedef struct assembly {
  const dvi_path *path;
  double *values;
  int last;
} assembly;

static int entry(assembly *to, int row, int column)
{
  const dvi__pattern *pattern = &to->path->pattern;
  const int next = to->last + 1;
  const int follows = next >= pattern->start[column] && next < pattern->start[column + 1] &&
                      pattern->row[next] == row;
  return to->last = follows ? next : dvi__pattern_find(pattern, row, column);
}

static void add_at(assembly *to, int row, int column, double value)
{
  to->values[entry(to, row, column)] += value;
}

static void add_entry(void *of, int row, int column, double factor, size_t from)
{
  assembly *to = of;
  add_at(to, row, column, factor * to->path->block[from]);
}

static void add_gauge_entry(void *of, int unknown, int multiplier, size_t from)
{
  assembly *to = of;
  add_at(to, multiplier, unknown, to->path->gauge[from]);
  add_at(to, unknown, multiplier, to->path->gauge[from]);
}

/* What the rows of step k change by with the span's unknown, and the row of that unknown with
 * them. */
static dvi_status add_span(assembly *to, dvi_path *path, int k)
{
  const double part = -path->span / path->steps;
  dvi__energy_gradient gradient = {path->energy_Y, path->energy_q0, 0};
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
        add_at(to, path->core, places.at[c], places.factor[c] * value);
        add_at(to, places.at[c], path->core, places.factor[c] * value);
      }
    }
  add_at(to, path->core, path->core, part * path->span / path->steps * gradient.h);
  return DVI_OK;
}

dvi_status dvi__path_jacobian(dvi_path *path, const double *x, double *values)
{
  assembly to = {path, values, -1};
  memset(values, 0, (size_t)dvi__pattern_entries(&path->pattern) * sizeof(double));
  for (int k = 0; k < path->steps; k++) {
    dvi__path_place(path, x, k);
    DVI_TRY(at_step(path, x, k, dvi__action_two_point_hessian(path->action, path->Y, path->block)));
    dvi__path_each_entry(path, k, add_entry, &to);
    if (path->free_span) DVI_TRY(at_step(path, x, k, add_span(&to, path, k)));
  }
  dvi__path_each_gauge(path, add_gauge_entry, &to);
  /* Multipliers that are not in use are unknowns of their own. */
  for (int c = path->unknowns - path->gauges + path->in_use; c < path->unknowns; c++)
    add_at(&to, c, c, 1);
  return DVI_OK;
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  return dvi__path_jacobian(of, x, values);
}

/* ---- scales ---- */

/* The kinetic part at the middle of the path tells how large rows are. */
dvi_status dvi__path_scale(dvi_path *path, const double *x)
{
  dvi__path_place(path, x, path->steps / 2);
  DVI_TRY(at_step(path, x, path->steps / 2, dvi__action_prepare_chord(path->action, path->Y)));
  (void)dvi__action_row_scale(path->action, path->row_scale); /* 0: as it was */
  const double h = dvi__path_span(path, x) / path->steps;
  for (int i = 0; i < path->n; i++) path->kinetic[i] = path->row_scale[i * path->s] * h;
  return DVI_OK;
}

static dvi_status prepare(void *of, const double *x)
{
  return dvi__path_scale(of, x);
}

static dvi_status row_scale(void *of, double *scale, int *unchanged)
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
  return DVI_OK;
}

dvi_status dvi__path_make_solver(dvi_path *path)
{
  const dvi__equations equations = {.unknowns = path->unknowns,
                                    .pattern = &path->pattern,
                                    .linear = DVI__LINEAR_SPARSE,
                                    .border = path->unknowns - path->core,
                                    .of = path,
                                    .residual = residual,
                                    .jacobian = jacobian,
                                    .prepare_chord = prepare,
                                    .row_scale = row_scale};
  return dvi__solver_create(&equations, &path->counters, &path->solver);
}
