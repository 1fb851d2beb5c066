/* Cells are stored in the order in which they act. With classes the cells that are due in a slot
 * are the first ones, and those of a class have their turns (slabs.c). Else they keep the mesh's
 * order, and with it what that has of locality. */
#include "field/elastic_avi/layout.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/elastic_avi/borders.h"
#include "field/mesh/share.h"

enum { TURNS = 3 };

static dvi_status no_memory(const dvi__solid_avi *avi)
{
  return dvi__fail(DVI_NO_MEMORY, "%s: no memory for %lld cells", avi->method,
                   (long long)avi->cells);
}

/* ---- cells ---- */

/* Copy a cell of the mesh. */
static void take_cell(const dvi__solid_plan *plan, int64_t name, int64_t c, dvi__solid_avi *avi)
{
  const dvi_elastic *e = avi->solid;
  const int n = avi->n;
  dvi__solid_cell *cell = avi->cell + c;
  *cell = (dvi__solid_cell){.step = plan->step[name],
                            .volume = e->volume[name],
                            .name = (int)name,
                            .material = e->material[name],
                            .edge = -1};
  for (int a = 0; a <= n; a++) cell->corner[a] = e->vertex[name * (n + 1) + a];
  for (int k = 0; k < n * n; k++) cell->gradient[k] = e->gradient[(name * (n + 1) + 1) * n + k];
  avi->step[c] = cell->step;
}

static int group_of(const dvi_elastic *solid, const dvi__solid_plan *plan, int64_t name)
{
  const int acts = isfinite(plan->step[name]) && dvi__solid_acts_here(solid, name),
            class = acts ? plan->class[name] : plan->classes;
  return class * TURNS + plan->turn[name];
}

/* Number cells by classes and turns. Those without events here come last. */
static void number_cells(const dvi__solid_plan *plan, dvi__solid_avi *avi)
{
  int64_t begin[(DVI__SOLID_CLASSES + 1) * TURNS + 1] = {0};
  const int64_t *class_begin = begin;
  for (int64_t c = 0; c < avi->cells; c++) begin[1 + group_of(avi->solid, plan, c)]++;
  for (int k = 0; k < (plan->classes + 1) * TURNS; k++) begin[k + 1] += begin[k];
  for (int k = 0; k < plan->classes; k++) avi->class_end[k] = *(class_begin += TURNS);
  avi->active = *class_begin;
  for (int64_t c = 0; c < avi->cells; c++)
    take_cell(plan, c, begin[group_of(avi->solid, plan, c)]++, avi);
}

/* Count the events of slots on all processes. */
static dvi_status count_events(dvi__solid_avi *avi)
{
  const dvi_mesh *mesh = avi->solid->mesh;
  for (int j = 0; j < avi->classes; j++) {
    const int64_t first = j > 0 ? avi->class_end[j - 1] : 0;
    if (j > 0) avi->class_events[j] = avi->class_events[j - 1];
    for (int64_t c = first; c < avi->class_end[j]; c++)
      avi->class_events[j] += dvi__owns(mesh, avi->n, avi->cell[c].name);
  }
  return dvi__count_all(mesh, avi->classes, avi->class_events);
}

static void list_cells(dvi__solid_avi *avi)
{
  const int width = avi->n + 1;
  int64_t *const start = avi->cell_start;
  for (int64_t i = 0; i < avi->active * width; i++)
    start[avi->cell[i / width].corner[i % width] + 1]++;
  for (int64_t v = 0; v < avi->vertices; v++) start[v + 1] += start[v];
  for (int64_t i = 0; i < avi->active * width; i++)
    avi->cell_of[start[avi->cell[i / width].corner[i % width]]++] = (int)(i / width);
  for (int64_t v = avi->vertices; v > 0; v--) start[v] = start[v - 1];
  start[0] = 0;
}

/* ---- kinds ---- */

/* Give the components that are given, and whether one of them depends on time. */
static int conditions_of(const dvi_elastic *e, int64_t vertex)
{
  int kind = 0;
  for (int i = 0; i < e->n; i++) {
    const int64_t at = vertex * e->n + i;
    if (e->unknown[at] >= 0) continue;
    kind |= 1 << i;
    const dvi_elastic_condition *condition = e->conditions + e->condition[at];
    if (condition->displacement != NULL && !condition->is_steady) kind |= DVI__NODE_DRIVEN;
  }
  return kind;
}

static void find_decay(dvi__solid_avi *avi)
{
  const dvi_elastic *e = avi->solid;
  for (int64_t i = 0; i < e->cells * (e->n + 1); i++) {
    const dvi__solid_material *m = e->materials + e->material[i / (e->n + 1)];
    avi->decay[e->vertex[i]] += m->alpha * m->rho * e->volume[i / (e->n + 1)] / (e->n + 1);
  }
  for (int64_t v = 0; v < e->vertices; v++) avi->decay[v] /= e->mass[v];
}

static void find_node_kinds(dvi__solid_avi *avi)
{
  const dvi_elastic *e = avi->solid;
  const int all = (1 << e->n) - 1;
  for (int64_t v = 0; v < e->vertices; v++) {
    int kind = conditions_of(e, v);
    if (avi->is_linear) kind &= DVI__NODE_GIVEN;
    if (avi->decay != NULL && avi->decay[v] > 0) kind |= DVI__NODE_DECAYS;
    if (e->obstacles > 0 && e->is_outer[v] && (kind & all) != all && !avi->is_linear)
      kind |= DVI__NODE_MEETS;
    avi->node_kind[v] = (uint8_t)kind;
  }
}

static void find_cell_kinds(dvi__solid_avi *avi)
{
  const dvi_elastic *e = avi->solid;
  for (int64_t c = 0; c < avi->cells; c++) {
    const int64_t cell = avi->cell[c].name;
    int kind = 0;
    for (int a = 0; a <= avi->n; a++) {
      const int of_node = avi->node_kind[avi->cell[c].corner[a]];
      if (of_node != 0) kind |= DVI__CELL_GUARDED;
      if (of_node & DVI__NODE_MEETS) kind |= DVI__CELL_MEETS;
    }
    if (kind & DVI__CELL_MEETS) avi->cell[c].meeting = (int)avi->pushes++;
    if (e->load_start != NULL && e->load_start[cell + 1] > e->load_start[cell] && !avi->is_linear)
      kind |= DVI__CELL_LOADED;
    if (e->materials[e->material[cell]].beta > 0) {
      kind |= DVI__CELL_VISCOUS;
      avi->cell[c].viscous = (int)avi->viscous_count++;
    }
    avi->cell[c].kind = kind;
  }
}

/* ---- the state ---- */

typedef struct part {
  void **place;
  size_t size;
} part;

static dvi_status lay_out_state(dvi__solid_avi *avi)
{
  dvi__solid_state *s = &avi->state;
  const size_t vertices = (size_t)avi->vertices, cells = (size_t)avi->cells;
  const int is_worked = !avi->is_linear && (avi->solid->load_count > 0 || avi->solid->is_driven),
            meets = !avi->is_linear && avi->solid->obstacles > 0;
  const part parts[] = {
      {(void **)&s->node, vertices * sizeof *s->node},
      {(void **)&s->count, avi->is_free ? cells * sizeof *s->count : 0},
      {(void **)&s->worked, is_worked ? vertices * sizeof *s->worked : 0},
      {(void **)&s->stretch, (size_t)avi->viscous_count * DVI__SOLID_NUMBERS * sizeof *s->stretch},
      {(void **)&s->touch, meets ? vertices * sizeof *s->touch : 0},
      {(void **)&s->push, (size_t)avi->pushes * sizeof *s->push}};
  avi->size = 0;
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) avi->size += parts[i].size;
  avi->block = DVI_NEW(char, avi->size);
  avi->kept = DVI_NEW(char, avi->size);
  if (avi->block == NULL || avi->kept == NULL) return no_memory(avi);
  char *next = avi->block;
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    *parts[i].place = parts[i].size > 0 ? next : NULL;
    next += parts[i].size;
  }
  return DVI_OK;
}

dvi_status dvi__solid_lay_out(const dvi__solid_plan *plan, dvi__solid_avi *avi)
{
  number_cells(plan, avi);
  list_cells(avi);
  DVI_TRY(count_events(avi));
  DVI_TRY(dvi__solid_borders_create(avi));
  if (avi->decay != NULL) {
    find_decay(avi);
    DVI_TRY(dvi__refresh(avi->solid->mesh, 0, avi->decay));
  }
  find_node_kinds(avi);
  find_cell_kinds(avi);
  const dvi_status status = dvi__agree(avi->solid->mesh, lay_out_state(avi));
  for (int64_t v = 0; v < avi->vertices && status == DVI_OK; v++)
    avi->state.node[v].inverse = 1 / avi->solid->mass[v];
  return status;
}
