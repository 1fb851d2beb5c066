/* Parts of a density: their copies, and their variables as operators on coordinates. */
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/density/density.h"

/* ---- checks ---- */

static const char *const default_name[] = {"kinetic", "quadratic", "potential", "one-form",
                                           "general"};

static dvi_status check_variables(const dvi_density *density, const dvi_density_part *part,
                                  const char *name)
{
  for (int a = 0; a < part->variables; a++) {
    const dvi_jet *jet = part->variable + a;
    if (jet->component < 0 || jet->component >= density->components)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "density: variable %d of part '%s' has component %d, 0 to %d possible", a,
                       name, jet->component, density->components - 1);
    for (int d = 0; d < DVI_AXES_MAX; d++)
      if (jet->order[d] < 0 || (d >= density->dimension && jet->order[d] != 0))
        return dvi__fail(DVI_BAD_ARGUMENT,
                         "density: variable %d of part '%s' has %d derivatives along axis %d of %d",
                         a, name, jet->order[d], d, density->dimension);
    for (int b = 0; b < a; b++)
      if (part->variable[b].component == jet->component &&
          (part->variable[b].rate != 0) == (jet->rate != 0) &&
          memcmp(part->variable[b].order, jet->order, sizeof jet->order) == 0)
        return dvi__fail(DVI_BAD_ARGUMENT, "density: variables %d and %d of part '%s' are the same",
                         b, a, name);
  }
  return DVI_OK;
}

static dvi_status check_pairs(const dvi_density_part *part, const char *name)
{
  if (part->pairs < 0 || (part->pairs > 0 && part->pair == NULL))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "density: part '%s' has %d pairs: give them with their count, or none", name,
                     part->pairs);
  for (int e = 0; e < part->pairs; e++) {
    const int a = part->pair[e][0], b = part->pair[e][1];
    if (b < 0 || a < b || a >= part->variables)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "density: pair %d of part '%s' is (%d,%d), which should be variables "
                       "a >= b of %d",
                       e, name, a, b, part->variables);
    for (int f = 0; f < e; f++)
      if (part->pair[f][0] == a && part->pair[f][1] == b)
        return dvi__fail(DVI_BAD_ARGUMENT, "density: pairs %d and %d of part '%s' are the same", f,
                         e, name);
  }
  return DVI_OK;
}

/* Kinds allow some variables. */
static dvi_status check_rates(const dvi_density_part *part, const char *name)
{
  int rates = 0;
  for (int a = 0; a < part->variables; a++) rates += part->variable[a].rate != 0;
  if (part->kind == DVI_DENSITY_KINETIC && rates < part->variables)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "density: kinetic part '%s' has a variable that is no rate: a part whose "
                     "inertia depends on the field is general",
                     name);
  if (part->kind == DVI_DENSITY_ONE_FORM && rates == 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: one-form '%s' has no rate", name);
  if ((part->kind == DVI_DENSITY_QUADRATIC || part->kind == DVI_DENSITY_POTENTIAL) && rates > 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "density: %s part '%s' has a rate: such a part is general, a one-form, or "
                     "kinetic",
                     default_name[part->kind], name);
  if ((part->kind == DVI_DENSITY_KINETIC || part->kind == DVI_DENSITY_ONE_FORM) &&
      part->depends_on_time)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "density: %s part '%s' depends on time: such a part is general",
                     default_name[part->kind], name);
  return DVI_OK;
}

static dvi_status check_part(const dvi_density *density, const dvi_density_part *part, int i)
{
  if ((int)part->kind < 0 || (int)part->kind > DVI_DENSITY_GENERAL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: part %d has no kind %d", i, (int)part->kind);
  const char *name = part->name != NULL ? part->name : default_name[part->kind];
  if (part->density == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: part '%s' has no callback `density`", name);
  if (part->variables < 1 || part->variables > DVI_JETS_MAX || part->variable == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: part '%s' has %d variables, 1 to %d possible",
                     name, part->variable != NULL ? part->variables : 0, (int)DVI_JETS_MAX);
  if (part->time_derivative != NULL && !part->depends_on_time)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "density: part '%s' has a derivative in time, and does not depend on time",
                     name);
  DVI_TRY(check_variables(density, part, name));
  DVI_TRY(check_pairs(part, name));
  return check_rates(part, name);
}

/* ---- copies ---- */

static dvi_status no_memory(const char *what)
{
  return dvi__fail(DVI_NO_MEMORY, "density: no memory for %s", what);
}

/* All pairs, row by row of the lower triangle. */
static void fill_pairs(int variables, int (*pair)[2])
{
  for (int a = 0, e = 0; a < variables; a++)
    for (int b = 0; b <= a; b++, e++) pair[e][0] = a, pair[e][1] = b;
}

static dvi_status copy_arrays(dvi__density_part *part)
{
  dvi_density_part *given = &part->given;
  const int *declared = given->pair != NULL ? given->pair[0] : NULL;
  if (declared == NULL) given->pairs = given->variables * (given->variables + 1) / 2;
  int(*pair)[2] = dvi__allocate((size_t)given->pairs, sizeof *pair);
  given->variable = dvi__duplicate(given->variable, (size_t)given->variables,
                                   sizeof *given->variable);
  given->pair = (const int(*)[2])pair;
  part->name = dvi__duplicate(given->name, strlen(given->name) + 1, 1);
  given->name = part->name;
  if (given->variable == NULL || pair == NULL || part->name == NULL) return no_memory("a part");
  if (declared != NULL)
    memcpy(pair, declared, (size_t)given->pairs * sizeof *pair);
  else
    fill_pairs(given->variables, pair);
  return DVI_OK;
}

static dvi_status make_transforms(const dvi_density *density, dvi__density_part *part)
{
  const int variables = part->given.variables;
  part->transform = DVI_NEW(dvi__space_operator, variables);
  if (part->transform == NULL) return no_memory("operators");
  for (int a = 0; a < variables; a++) {
    const dvi_status status = dvi__operator_make(density->space, part->given.variable[a].order,
                                                 part->transform + a);
    if (status != DVI_OK)
      return dvi__fail_in(status, "density: variable %d of part '%s'", a, part->name);
  }
  return DVI_OK;
}

dvi_status dvi__density_copy_parts(dvi_density *density, const dvi_density_terms *terms)
{
  if (terms->parts < 1 || terms->part == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "density: there is no part");
  for (int i = 0; i < terms->parts; i++) DVI_TRY(check_part(density, terms->part + i, i));
  density->part = DVI_NEW(dvi__density_part, terms->parts + terms->conditions * terms->components);
  if (density->part == NULL) return no_memory("parts");
  for (int i = 0; i < terms->parts; i++) {
    dvi__density_part *part = density->part + density->parts++;
    part->given = terms->part[i];
    if (part->given.name == NULL) part->given.name = default_name[part->given.kind];
    DVI_TRY(copy_arrays(part));
    part->points = dvi_space_points(density->space, &part->x, &part->weight);
    DVI_TRY(make_transforms(density, part));
    density->count[part->given.kind]++;
  }
  density->declared = density->parts;
  return DVI_OK;
}

/* ---- rows ---- */

static dvi_status allocate_rows(dvi__density_part *part, const dvi__csr *B, dvi__jet_rows *rows)
{
  rows->start = DVI_NEW(int64_t, part->points + 1);
  rows->local = DVI_NEW(int, B->start[B->rows]);
  rows->value = DVI_NEW(double, B->start[B->rows]);
  return rows->start != NULL && rows->local != NULL && rows->value != NULL ? DVI_OK
                                                                           : no_memory("rows");
}

/* Add what the fixed values of a row give. Most variables have none. */
static dvi_status add_fixed(int64_t points, int64_t k, double value, dvi__jet_rows *rows)
{
  if (value == 0) return DVI_OK;
  if (rows->fixed == NULL) rows->fixed = DVI_NEW(double, points);
  if (rows->fixed == NULL) return no_memory("fixed values");
  rows->fixed[k] += value;
  return DVI_OK;
}

/* Take the rows of a component apart into coordinates, values that move, and values that do not.
 * Rates have no part of the latter. */
static dvi_status split_rows(const dvi_density *density, dvi__density_part *part, int a,
                             const int64_t *row)
{
  const dvi__csr *B = dvi__part_operator(part, a);
  const dvi_jet *jet = part->given.variable + a;
  const int64_t shift = jet->component * density->functions;
  dvi__jet_rows *rows = part->rows + a;
  int64_t entries = 0, moving = 0;
  DVI_TRY(allocate_rows(part, B, rows));
  for (int64_t e = 0; e < B->start[B->rows]; e++)
    moving += density->number[shift + B->column[e]] < -1;
  if (moving > 0) DVI_TRY(dvi__csr_allocate(part->points, density->moving, moving, &rows->moving));
  moving = 0;
  for (int64_t k = 0; k < part->points; k++) {
    const int64_t r = row != NULL ? row[k] : k;
    for (int64_t e = B->start[r]; e < B->start[r + 1]; e++) {
      const int64_t place = shift + B->column[e];
      const int number = density->number[place];
      if (B->value[e] == 0) continue;
      if (number >= 0) {
        rows->local[entries] = number;
        rows->value[entries++] = B->value[e];
      } else if (number < -1) {
        rows->moving.column[moving] = -2 - number;
        rows->moving.value[moving++] = B->value[e];
      } else if (!jet->rate) {
        DVI_TRY(add_fixed(part->points, k, B->value[e] * density->fixed[place], rows));
      }
    }
    rows->start[k + 1] = entries;
    if (rows->moving.rows > 0) rows->moving.start[k + 1] = moving;
  }
  return DVI_OK;
}

/* Find the last points that are coordinates, while rows still have the coordinates' numbers. Where
 * most of them have one weight, those before that have another one are left out. */
static void find_own_points(dvi__density_part *part)
{
  const dvi__jet_rows *rows = part->rows;
  dvi__own_points *own = &part->own_points;
  *own = (dvi__own_points){.first = part->points};
  if (part->given.variables != 1 || rows->moving.rows > 0) return;
  if (rows->start[part->points] > part->points) return; /* not in the order of the coordinates */
  for (int64_t k = part->points - 1; k >= 0; k--) {
    const int64_t e = rows->start[k];
    if (rows->start[k + 1] - e != 1 || rows->value[e] != 1) return;
    if (rows->fixed != NULL && rows->fixed[k] != 0) return;
    if (k < part->points - 1 && rows->local[e] != k - own->shift) return;
    if (k == part->points - 1) own->weight = part->weight[k];
    if (own->weight != 0 && part->weight[k] != own->weight) {
      if (k < part->points / 2) return;
      own->weight = 0;
    }
    own->shift = k - rows->local[e];
    own->first = k;
  }
}

/* ---- groups ---- */

enum { LIST_MOST = 8192 /* coordinates of a point */ };

static void insert(int *list, int *count, int coordinate)
{
  int at = *count;
  while (at > 0 && list[at - 1] > coordinate) at--;
  if (at > 0 && list[at - 1] == coordinate) return;
  memmove(list + at + 1, list + at, (size_t)(*count - at) * sizeof *list);
  list[at] = coordinate;
  ++*count;
}

/* Give the coordinates of a point, ascending. Returns their number, or -1 if they are too many. */
static int list_point(const dvi__density_part *part, int64_t k, int *list)
{
  int count = 0;
  for (int a = 0; a < part->given.variables; a++) {
    const dvi__jet_rows *rows = part->rows + a;
    if (count + rows->start[k + 1] - rows->start[k] > LIST_MOST) return -1;
    for (int64_t e = rows->start[k]; e < rows->start[k + 1]; e++)
      insert(list, &count, rows->local[e]);
  }
  return count;
}

static int find_local(const int *list, int count, int coordinate)
{
  int low = 0, high = count;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (list[middle] <= coordinate)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Groups by their lists, in a table of open addresses. */
typedef struct group_table {
  uint64_t size; /* a power of 2 */
  int *group;    /* [size] number + 1, or 0 */
} group_table;

/* Lists of neighbours stand near each other in the table, so that memory is read in order. */
static uint64_t hash_list(const int *list, int count)
{
  uint64_t hash = 0;
  for (int i = 0; i < count; i++) hash += (uint64_t)list[i];
  return hash;
}

static int is_list_of(const dvi__point_groups *g, int group, const int *list, int count)
{
  const int64_t first = g->start[group];
  return g->start[group + 1] - first == count &&
         memcmp(g->list + first, list, (size_t)count * sizeof *list) == 0;
}

/* Give the group with a list, which is a new one if there is none. */
static int find_group(dvi__point_groups *g, const group_table *table, const int *list, int count)
{
  uint64_t at = hash_list(list, count) & (table->size - 1);
  for (; table->group[at] != 0; at = (at + 1) & (table->size - 1))
    if (is_list_of(g, table->group[at] - 1, list, count)) return table->group[at] - 1;
  memcpy(g->list + g->start[g->groups], list, (size_t)count * sizeof *list);
  g->square[g->groups + 1] = g->square[g->groups] + (int64_t)count * count;
  g->start[g->groups + 1] = g->start[g->groups] + count;
  table->group[at] = (int)++g->groups;
  return (int)g->groups - 1;
}

static dvi_status find_groups(dvi__density_part *part, const group_table *table, int *list)
{
  for (int64_t k = 0; k < part->points; k++) {
    const int count = list_point(part, k, list);
    if (count < 0)
      return dvi__fail(DVI_BAD_SIZE,
                       "density: a point of part '%s' depends on more than %d coordinates: take "
                       "more cells of a lower degree",
                       part->name, (int)LIST_MOST);
    part->group.of[k] = find_group(&part->group, table, list, count);
    for (int a = 0; a < part->given.variables; a++)
      for (int64_t e = part->rows[a].start[k]; e < part->rows[a].start[k + 1]; e++)
        part->rows[a].local[e] = find_local(list, count, part->rows[a].local[e]);
  }
  return DVI_OK;
}

/* The lists were given room for all points apart. */
static dvi_status shrink_lists(dvi__point_groups *g)
{
  int *list = dvi__duplicate(g->list, (size_t)g->start[g->groups], sizeof *list);
  if (list == NULL) return no_memory("points");
  dvi__release(g->list);
  g->list = list;
  return DVI_OK;
}

static dvi_status make_groups(dvi__density_part *part)
{
  dvi__point_groups *g = &part->group;
  int64_t entries = 0;
  for (int a = 0; a < part->given.variables; a++) entries += part->rows[a].start[part->points];
  group_table table = {.size = 2};
  while (table.size < 2 * (uint64_t)part->points) table.size *= 2;
  table.group = DVI_NEW(int, table.size);
  int *list = DVI_NEW(int, LIST_MOST + 1);
  g->of = DVI_NEW(int, part->points);
  g->start = DVI_NEW(int64_t, part->points + 1);
  g->square = DVI_NEW(int64_t, part->points + 1);
  g->list = DVI_NEW(int, entries);
  dvi_status status = table.group && list && g->of && g->start && g->square && g->list
                          ? find_groups(part, &table, list)
                          : no_memory("points");
  if (status == DVI_OK) status = shrink_lists(g);
  dvi__release(table.group);
  dvi__release(list);
  return status;
}

/* ---- ranges ---- */

/* Find the points that coordinates touch: from low[i] on for i and later ones, and below high[i]
 * for i and earlier ones. */
static dvi_status find_points_of_ranges(const dvi_density *density, dvi__density_part *part)
{
  const int64_t n = density->unknowns;
  const dvi__point_groups *g = &part->group;
  part->low = DVI_NEW(int64_t, n + 1);
  part->high = DVI_NEW(int64_t, n + 1);
  if (part->low == NULL || part->high == NULL) return no_memory("ranges");
  for (int64_t i = 0; i <= n; i++) part->low[i] = part->points;
  for (int64_t k = part->points - 1; k >= 0; k--)
    for (int64_t e = g->start[g->of[k]]; e < g->start[g->of[k] + 1]; e++) {
      part->low[g->list[e]] = k;
      if (part->high[g->list[e]] == 0) part->high[g->list[e]] = k + 1;
    }
  for (int64_t i = n - 1; i >= 0; i--)
    if (part->low[i + 1] < part->low[i]) part->low[i] = part->low[i + 1];
  for (int64_t i = 1; i <= n; i++)
    if (part->high[i - 1] > part->high[i]) part->high[i] = part->high[i - 1];
  return DVI_OK;
}

dvi_status dvi__density_bind(dvi_density *density, dvi__density_part *part)
{
  int64_t *row = NULL;
  if (density->is_fourier) return DVI_OK;
  part->rows = DVI_NEW(dvi__jet_rows, part->given.variables);
  if (part->rows == NULL) return no_memory("rows");
  dvi_status status = dvi__density_order_points(density, part, &row);
  for (int a = 0; a < part->given.variables && status == DVI_OK; a++)
    status = split_rows(density, part, a, row);
  dvi__release(row);
  DVI_TRY(status);
  find_own_points(part);
  DVI_TRY(make_groups(part));
  return find_points_of_ranges(density, part);
}

void dvi__density_unbind(dvi__density_part *part)
{
  for (int a = 0; a < part->given.variables && part->rows != NULL; a++) {
    dvi__jet_rows *rows = part->rows + a;
    dvi__release(rows->start);
    dvi__release(rows->local);
    dvi__release(rows->value);
    dvi__release(rows->fixed);
    dvi__csr_clear(&rows->moving);
  }
  dvi__release(part->rows);
  void *const arrays[] = {part->group.of,     part->group.start, part->group.list,
                          part->group.square, part->slots.qq,    part->slots.qv,
                          part->slots.vv,     part->low,         part->high};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) dvi__release(arrays[i]);
  part->rows = NULL;
  part->group = (dvi__point_groups){0};
  part->slots = (dvi__slots){0};
  part->low = part->high = NULL;
}

void dvi__density_part_clear(dvi__density_part *part)
{
  dvi__density_unbind(part);
  for (int a = 0; a < part->given.variables && part->transform != NULL; a++)
    dvi__operator_clear(part->transform + a);
  dvi__release(part->transform);
  dvi__release((void *)part->given.variable);
  dvi__release((void *)part->given.pair);
  dvi__release(part->name);
  dvi__release(part->boundary);
  dvi__release(part->own);
  dvi__csr_clear(&part->trace);
}
