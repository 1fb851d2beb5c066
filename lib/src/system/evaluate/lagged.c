#include "system/evaluate/lagged.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/lanes.h"
#include "num/simd/members.h"
#include "num/simd/wide.h"
#include "system/evaluate/untested.h"

/* The state of one problem. */
typedef struct lag {
  double fast, slow; /* c and g, 0 if not known */
  double last;       /* last change */
  double since;      /* |x - y|, bounded by the sum of changes */
  int evaluations;   /* of the slow forces in this step */
  int due;           /* this iteration evaluates them */
} lag;

struct dvi__lagged {
  const dvi_system *system;
  size_t rows, nodes; /* numbers of one problem, n*nodes */
  size_t width;
  lag *lag;                      /* [capacity] */
  int *lane;                     /* [capacity] lanes that are due */
  double *slow, *next;           /* [rows*capacity] slow forces in use, and new ones */
  double *places, *times, *work; /* points of the lanes that are due, and differences of forces */
  double *effect;                /* [capacity] how far new slow forces move the places */
};

/* Changes below this part of the places may be rounding, and tell no contraction. */
static const double measurable = 1e-10;

int dvi__can_lag(const dvi_system *system)
{
  int fast = 0;
  for (int k = 0; k < system->potential_count; k++)
    fast += system->potentials[k].callbacks.fast != 0;
  return fast > 0 && fast < system->potential_count && system->force_count == 0;
}

dvi_status dvi__lagged_create(const dvi_system *system, int nodes, int capacity,
                              dvi__lagged **lagged)
{
  dvi__lagged *made = *lagged = DVI_NEW(dvi__lagged, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "system: no memory for slow forces");
  const size_t lanes = (size_t)capacity;
  made->system = system;
  made->nodes = (size_t)nodes;
  made->rows = (size_t)system->n * made->nodes;
  made->lag = DVI_NEW(lag, lanes);
  made->lane = DVI_NEW(int, lanes);
  made->slow = DVI_NEW(double, made->rows *lanes);
  made->next = DVI_NEW(double, made->rows *lanes);
  made->work = DVI_NEW(double, made->rows *lanes);
  made->places = DVI_NEW(double, made->rows *lanes);
  made->times = DVI_NEW(double, made->nodes *lanes);
  made->effect = DVI_NEW(double, lanes);
  if (made->lag && made->lane && made->slow && made->next && made->work && made->places &&
      made->times && made->effect)
    return DVI_OK;
  dvi__lagged_destroy(lagged);
  return dvi__fail(DVI_NO_MEMORY, "system: no memory for slow forces of %d x %zu numbers", capacity,
                   made->rows);
}

void dvi__lagged_destroy(dvi__lagged **lagged)
{
  dvi__lagged *l = *lagged;
  if (l == NULL) return;
  double *const owned[] = {l->slow, l->next, l->work, l->places, l->times, l->effect};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__release(l->lag);
  dvi__release(l->lane);
  dvi__release(l);
  *lagged = NULL;
}

/* The factors of an iteration on places are of the order of h^2. */
void dvi__lagged_begin(dvi__lagged *l, int width, double ratio, const double *factors)
{
  const double scale = ratio * ratio;
  l->width = (size_t)width;
  memset(l->lag, 0, l->width * sizeof *l->lag);
  for (size_t k = 0; k < l->width && factors != NULL; k++) {
    l->lag[k].fast = scale * factors[k];
    l->lag[k].slow = scale * factors[l->width + k];
  }
}

void dvi__lagged_renew(dvi__lagged *l)
{
  for (size_t k = 0; k < l->width; k++) l->lag[k].evaluations = 0;
}

void dvi__lagged_factors(const dvi__lagged *l, int lane, size_t stride, double *factors)
{
  factors[0] = l->lag[lane].fast;
  factors[stride] = l->lag[lane].slow;
}

void dvi__lagged_close_up(dvi__lagged *l, int width, const int *going)
{
  const size_t before = l->width, after = (size_t)width;
  for (size_t k = 0; k < after; k++) l->lag[k] = l->lag[going[k]];
  for (size_t i = 0; i < l->rows; i++)
    for (size_t k = 0; k < after; k++)
      l->slow[i * after + k] = l->slow[i * before + (size_t)going[k]];
  l->width = after;
}

/* ---- slow forces ---- */

/* List the lanes whose slow forces are to be evaluated. Every comparison with NaN is false. */
static size_t list_due(const dvi__lagged *l)
{
  size_t due = 0;
  for (size_t k = 0; k < l->width; k++) {
    lag *own = &l->lag[k];
    own->due = own->evaluations == 0 || own->fast == 0 || own->slow == 0 ||
               !(own->slow * own->since < own->fast * own->fast * own->last);
    l->lane[due] = (int)k;
    due += own->due != 0;
  }
  return due;
}

/* Copy rows of the lanes that are due, packed from all, or all from packed. */
static void pack(const dvi__lagged *l, size_t rows, size_t due, const double *all, double *packed)
{
  for (size_t i = 0; i < rows; i++)
    for (size_t k = 0; k < due; k++) packed[i * due + k] = all[i * l->width + (size_t)l->lane[k]];
}

static void unpack(const dvi__lagged *l, size_t rows, size_t due, const double *packed, double *all)
{
  for (size_t i = 0; i < rows; i++)
    for (size_t k = 0; k < due; k++) all[i * l->width + (size_t)l->lane[k]] = packed[i * due + k];
}

WIDE static void subtract_forces(size_t count, double scale, const double *restrict x,
                                 const double *restrict y, double *restrict difference)
{
  for (size_t k = 0; k < count; k++) difference[k] = scale * (x[k] - y[k]);
}

WIDE static void add_forces(size_t count, const double *restrict term, double *restrict sum)
{
  for (size_t k = 0; k < count; k++) sum[k] += term[k];
}

/* Find how far the new slow forces move the places. */
static void find_effects(dvi__lagged *l, const dvi__place_table *table)
{
  const int n = l->system->n, nodes = (int)l->nodes, width = (int)l->width;
  const size_t row = l->nodes * l->width;
  double *moved = l->places;
  for (size_t i = 0; i < (size_t)n; i++)
    subtract_forces(row, table->factor[i], l->next + i * row, l->slow + i * row, l->work + i * row);
  if (width == 1) {
    dvi__lanes_weigh(n, nodes, table->weight, l->work);
    dvi__lanes_product(n, nodes, table->lanes, nodes, table->matrix, l->work, moved);
    l->effect[0] = dvi__lanes_largest(l->rows, moved);
    return;
  }
  for (size_t i = 0; i < l->rows; i++)
    for (size_t k = 0; k < l->width; k++) l->work[i * l->width + k] *= table->weight[i % l->nodes];
  dvi__members_product(n, nodes, table->lanes, nodes, table->matrix, width, l->work, moved);
  memset(l->effect, 0, l->width * sizeof(double));
  for (size_t i = 0; i < l->rows; i++)
    for (size_t k = 0; k < l->width; k++) {
      const double size = fabs(moved[i * l->width + k]);
      l->effect[k] = size > l->effect[k] ? size : l->effect[k];
    }
}

/* Measure g by the second slow forces of a step, before they take the place of the first ones. */
static void measure(dvi__lagged *l, const dvi__place_table *table)
{
  int measured = 0;
  for (size_t k = 0; k < l->width; k++)
    measured |= l->lag[k].due && l->lag[k].evaluations == 1 && l->lag[k].since > 0;
  if (!measured) return;
  find_effects(l, table);
  for (size_t k = 0; k < l->width; k++) {
    lag *own = &l->lag[k];
    if (own->due && own->evaluations == 1 && own->since > 0)
      own->slow = fmax(l->effect[k] / own->since, DBL_EPSILON);
  }
}

static dvi_status evaluate_slow(dvi__lagged *l, dvi__evaluator *evaluator, size_t due,
                                const double *t, const double *q, const dvi__place_table *table)
{
  const int points = (int)(due * l->nodes);
  if (due == l->width) {
    DVI_TRY(dvi__some_gradients_untested(evaluator, 0, points, t, q, l->next));
  } else {
    pack(l, l->nodes, due, t, l->times);
    pack(l, l->rows, due, q, l->places);
    DVI_TRY(dvi__some_gradients_untested(evaluator, 0, points, l->times, l->places, l->work));
    memcpy(l->next, l->slow, l->rows * l->width * sizeof(double));
    unpack(l, l->rows, due, l->work, l->next);
  }
  measure(l, table);
  double *const last = l->slow;
  l->slow = l->next;
  l->next = last;
  for (size_t k = 0; k < l->width; k++) {
    if (!l->lag[k].due) continue;
    l->lag[k].evaluations++;
    l->lag[k].since = 0;
  }
  return DVI_OK;
}

dvi_status dvi__lagged_gradient(dvi__lagged *l, dvi__evaluator *evaluator, const double *t,
                                const double *q, const dvi__place_table *table, double *V_q)
{
  const size_t due = list_due(l);
  if (due > 0) DVI_TRY(evaluate_slow(l, evaluator, due, t, q, table));
  DVI_TRY(dvi__some_gradients_untested(evaluator, 1, (int)(l->width * l->nodes), t, q, V_q));
  add_forces(l->rows * l->width, l->slow, V_q);
  return DVI_OK;
}

/* ---- changes ---- */

/* Where the slow forces lag, the part of their error is at most the change that was expected. */
void dvi__lagged_change(dvi__lagged *l, const double *largest, double *change)
{
  for (size_t k = 0; k < l->width; k++) {
    lag *own = &l->lag[k];
    const double changed = change[k], fast = own->fast;
    own->since += changed;
    if (!own->due && own->slow * own->since > fast * changed)
      change[k] = own->slow * own->since / fast;
    if (own->last > measurable * largest[k] && changed > 0)
      own->fast = changed < own->last ? changed / own->last : 1;
    own->last = changed;
  }
}
