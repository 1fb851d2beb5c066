/* Functions of the field at points, and their integrals, by Gauss's rule or that of triangles. */
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/moving/moving.h"

enum { GAUSS = 8, OF_TRIANGLE = 6 };

/* The variables of a function at some points of a cell. */
typedef struct sample {
  int count;
  double x[DVI_MOVING_AXES_MAX * GAUSS], z[DVI__MOVING_VARIABLES * GAUSS], f[GAUSS];
} sample;

/* A rule of a cell, in barycentric coordinates. */
typedef struct rule {
  int count;
  double place[GAUSS][DVI__CELL_NODES], weight[GAUSS];
} rule;

static void put(const dvi__moving_element *e, const dvi_density_part *function, int at,
                const double *place, sample *s)
{
  for (int i = 0; i < e->m->dimension; i++)
    s->x[i * s->count + at] = dvi__moving_between(e, place, i);
  for (int j = 0; j < function->variables; j++)
    s->z[j * s->count + at] = dvi__moving_variable(e, place, function->variable + j);
}

static int evaluate(const dvi_density_part *function, double t, sample *s)
{
  return function->density(s->count, t, s->x, s->z, s->f, NULL, NULL, function->user);
}

/* ---- a point ---- */

/* Values grow by the jump over each period between the point and its image in the cell. */
static void add_jumps(const dvi_moving *m, const dvi_density_part *function, const double *turn,
                      double *z)
{
  for (int j = 0; j < function->variables; j++) {
    const dvi_jet *jet = function->variable + j;
    for (int i = 0; i < m->dimension && !jet->rate && jet->order[0] + jet->order[1] == 0; i++)
      z[j] += turn[i] * m->jump[i * m->components + jet->component];
  }
}

static dvi_status measure_in(const dvi_moving *m, const dvi__moving_state *state, int cell,
                             const dvi_density_part *function, const double *x, double *value)
{
  dvi__moving_element e;
  sample s = {.count = 1};
  double place[DVI__CELL_NODES], turn[DVI_MOVING_AXES_MAX];
  int returned = dvi__moving_element_at(m, state, cell, &e);
  if (returned != 0) return dvi__moving_refuse(DVI_BAD_ARGUMENT, returned);
  dvi__moving_place(&e, 1, x, place, turn);
  put(&e, function, 0, place, &s);
  add_jumps(m, function, turn, s.z);
  memcpy(s.x, x, (size_t)m->dimension * sizeof *x);
  returned = evaluate(function, state->t, &s);
  *value = s.f[0];
  return returned == 0 ? DVI_OK : dvi__moving_refuse(DVI_CALLBACK_FAILED, returned);
}

static dvi_status measure_point(const dvi_moving *m, const dvi__moving_state *state,
                                const dvi_density_part *function, const double *x, double *value)
{
  int cell = -1;
  double *node = DVI_NEW(double, (size_t)m->dimension *(size_t)m->listed);
  if (node == NULL) return dvi__fail(DVI_NO_MEMORY, "moving: no memory for nodes");
  dvi_status status = dvi_moving_lift(m, state->t, state->q, node, NULL);
  if (status == DVI_OK) status = dvi__moving_find_cells(m, node, 1, x, &cell);
  if (status == DVI_OK && cell < 0) status = dvi__moving_refuse_point(m, node, x, 1);
  dvi__release(node);
  return status == DVI_OK ? measure_in(m, state, cell, function, x, value) : status;
}

/* ---- an integral ---- */

static int add_cell(const dvi_moving *m, const dvi__moving_state *state, int cell, const rule *r,
                    const dvi_density_part *function, double *sum)
{
  dvi__moving_element e;
  sample s = {.count = r->count};
  int returned = dvi__moving_element_at(m, state, cell, &e);
  if (returned != 0) return returned;
  for (int k = 0; k < r->count; k++) put(&e, function, k, r->place[k], &s);
  returned = evaluate(function, state->t, &s);
  for (int k = 0; k < r->count; k++) *sum += r->weight[k] * e.simplex.volume * s.f[k];
  return returned;
}

static dvi_status integrate(const dvi_moving *m, const dvi__moving_state *state,
                            const dvi_density_part *function, double *value)
{
  rule r;
  double sum = 0;
  r.count = m->dimension == 1 ? GAUSS : OF_TRIANGLE;
  DVI_TRY(dvi__moving_rule(m->dimension, r.count, r.place, r.weight));
  for (int cell = 0; cell < m->cells; cell++) {
    const int returned = add_cell(m, state, cell, &r, function, &sum);
    if (returned != 0) return dvi__moving_refuse(DVI_CALLBACK_FAILED, returned);
  }
  *value = sum;
  return DVI_OK;
}

/* ---- both ---- */

static dvi_status check(const dvi_moving *m, const double *v, const dvi_density_part *function)
{
  if (function->variables < 0 || function->variables > DVI__MOVING_VARIABLES ||
      function->density == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "moving: a function of 0 to %d variables is needed",
                     (int)DVI__MOVING_VARIABLES);
  for (int j = 0; j < function->variables; j++) {
    const dvi_jet *jet = function->variable + j;
    const int order = jet->order[0] + jet->order[1] + jet->order[2] + (jet->rate != 0);
    if (jet->component < 0 || jet->component >= m->components || order > 1 || jet->order[2] != 0 ||
        (m->dimension == 1 && jet->order[1] != 0))
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "moving: variable %d of the function is not a value, a rate or a first "
                       "derivative of a component",
                       j);
    if (jet->rate && v == NULL)
      return dvi__fail(DVI_BAD_ARGUMENT, "moving: the function has a rate: give velocities");
  }
  return DVI_OK;
}

dvi_status dvi_moving_measure(const dvi_moving *moving, double t, const double *q, const double *v,
                              const dvi_density_part *function, const double *x, double *value)
{
  if (moving == NULL || q == NULL || function == NULL || value == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "moving: a field, coordinates, a function and a place for it are needed");
  const dvi__moving_state state = {.t = t, .q = q, .v = v};
  DVI_TRY(check(moving, v, function));
  DVI_TRY(dvi__moving_check(moving, &state));
  return x != NULL ? measure_point(moving, &state, function, x, value)
                   : integrate(moving, &state, function, value);
}
