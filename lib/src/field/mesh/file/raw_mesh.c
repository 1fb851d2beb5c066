/* A mesh from what a file has: its cells by the order of their tags, the points that they use, and
 * parts of the groups. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/mesh/file/raw.h"

/* The name of a group that has none. */
typedef struct number_name {
  char text[48];
} number_name;

/* The terms of the mesh while they are made. */
typedef struct build {
  dvi__raw *raw;
  dvi_mesh_terms terms;
  dvi__shape top;
  int *cell_of;   /* [elements of the top shape] */
  int *vertex_of; /* [points] or -1 */
  double *point, metric[DVI_MESH_SPACE_MAX], period[DVI_MESH_SPACE_MAX];
  int *vertex;
  dvi_mesh_part *part;      /* [groups with elements] */
  number_name *number_name; /* the same */
  int *member[DVI__SHAPES]; /* cells' numbers of the top shape, vertices of the others */
} build;

static const dvi__raw_element *element_of(const build *b, int64_t i)
{
  return dvi__raw_element_at(b->raw, b->top, i);
}

static dvi_status no_memory(const build *b)
{
  return dvi__fail(DVI_NO_MEMORY, "%.300s: no memory for the mesh", b->raw->reader->path);
}

/* ---- which elements are the cells ---- */

static dvi_status refuse_mixture(const build *b, dvi__shape one, dvi__shape other)
{
  return dvi__reject(b->raw->reader, dvi__raw_element_at(b->raw, other, 0)->place,
                     "the file has %s and %s: a mesh has cells of one kind only",
                     dvi__shape_facts_of[one].names, dvi__shape_facts_of[other].names);
}

static dvi_status choose_top(build *b)
{
  int top = DVI__HEXAHEDRON;
  while (top > DVI__POINT && b->raw->elements[top].count == 0) top--;
  const dvi__shape_facts *facts = dvi__shape_facts_of + top;
  if (top == DVI__POINT)
    return dvi__reject(b->raw->reader, b->raw->reader->size,
                       "the file has no cells: it needs lines, triangles, quadrangles, tetrahedra "
                       "or hexahedra");
  if (facts->kind == DVI_BOXES && b->raw->elements[top - 1].count > 0)
    return refuse_mixture(b, (dvi__shape)(top - 1), (dvi__shape)top);
  b->top = (dvi__shape)top;
  b->terms.kind = top == DVI__LINE ? b->raw->lines : facts->kind;
  b->terms.dimension = facts->dimension;
  return DVI_OK;
}

/* An element as it is sorted to number the cells, or to find repeated ones. */
typedef struct sorted {
  int corner[DVI__SHAPE_CORNERS]; /* ascending, or zeros */
  int64_t tag, element;
} sorted;

static int compare_sorted(const void *left, const void *right)
{
  const sorted *a = left, *b = right;
  for (int c = 0; c < DVI__SHAPE_CORNERS; c++)
    if (a->corner[c] != b->corner[c]) return a->corner[c] < b->corner[c] ? -1 : 1;
  if (a->tag != b->tag) return a->tag < b->tag ? -1 : 1;
  return (a->element > b->element) - (a->element < b->element);
}

static int compare_numbers(const void *left, const void *right)
{
  const int a = *(const int *)left, b = *(const int *)right;
  return (a > b) - (a < b);
}

static void sort_corners(const build *b, sorted *list, int64_t count)
{
  for (int64_t i = 0; i < count; i++) {
    list[i] = (sorted){.tag = element_of(b, i)->tag, .element = i};
    memcpy(list[i].corner, element_of(b, i)->corner, sizeof list[i].corner);
    qsort(list[i].corner, (size_t)dvi__shape_facts_of[b->top].corners, sizeof *list[i].corner,
          compare_numbers);
  }
  qsort(list, (size_t)count, sizeof *list, compare_sorted);
}

/* Note for each element the first one with the same corners, if that is another one, else -1. */
static void find_repeated(const build *b, sorted *list, int64_t count, int *first)
{
  sort_corners(b, list, count);
  for (int64_t i = 0, head = 0; i < count; i++) {
    if (memcmp(list[i].corner, list[head].corner, sizeof list[i].corner) != 0) head = i;
    first[list[i].element] = head == i ? -1 : (int)list[head].element;
  }
}

/* Number the cells by their tags. Of repeated ones all have the number of the first. */
static void number_cells(build *b, sorted *list, int64_t count, const int *first)
{
  for (int64_t i = 0; i < count; i++)
    list[i] = (sorted){.tag = element_of(b, i)->tag, .element = i};
  qsort(list, (size_t)count, sizeof *list, compare_sorted);
  for (int64_t i = 0; i < count; i++) {
    const int64_t e = list[i].element;
    b->cell_of[e] = first != NULL && first[e] >= 0 ? b->cell_of[first[e]] : (int)b->terms.cells++;
  }
}

/* A repeated element and the first one of its kind are in groups, or one of them is in vain. */
static dvi_status check_repeated(const build *b, const int *first, char *is_grouped)
{
  const dvi__raw *raw = b->raw;
  for (int64_t i = 0; i < raw->members[b->top].count; i++)
    is_grouped[dvi__raw_member_at(raw, b->top, i)->element] = 1;
  for (int64_t e = 0; e < raw->elements[b->top].count; e++)
    if (first[e] >= 0 && !(is_grouped[e] && is_grouped[first[e]]))
      return dvi__reject(raw->reader, element_of(b, e)->place,
                         "the %s %lld has the same points as the %s %lld",
                         dvi__shape_facts_of[b->top].name, (long long)element_of(b, e)->tag,
                         dvi__shape_facts_of[b->top].name, (long long)element_of(b, first[e])->tag);
  return DVI_OK;
}

static dvi_status take_order(build *b)
{
  const int64_t count = b->raw->elements[b->top].count;
  b->cell_of = DVI_NEW(int, count);
  sorted *list = DVI_NEW(sorted, count);
  int *first = DVI_NEW(int, b->raw->may_repeat ? count : 0);
  char *is_grouped = DVI_NEW(char, count);
  dvi_status status = no_memory(b);
  if (b->cell_of != NULL && list != NULL && first != NULL && is_grouped != NULL) {
    status = DVI_OK;
    if (b->raw->may_repeat) {
      find_repeated(b, list, count, first);
      status = check_repeated(b, first, is_grouped);
    }
    number_cells(b, list, count, b->raw->may_repeat ? first : NULL);
  }
  dvi__release(list);
  dvi__release(first);
  dvi__release(is_grouped);
  return status;
}

/* ---- points and cells ---- */

/* Number the points of cells, and the others not. */
static dvi_status number_vertices(build *b)
{
  const int64_t points = b->raw->points.count, elements = b->raw->elements[b->top].count;
  b->vertex_of = DVI_NEW(int, points);
  if (b->vertex_of == NULL) return no_memory(b);
  for (int64_t e = 0; e < elements; e++)
    for (int c = 0; c < dvi__shape_facts_of[b->top].corners; c++)
      b->vertex_of[element_of(b, e)->corner[c]] = 1;
  for (int64_t i = 0; i < points; i++)
    b->vertex_of[i] = b->vertex_of[i] ? (int)b->terms.points++ : -1;
  return DVI_OK;
}

/* Give the fewest coordinates, from n on, that hold the points: those behind them are zero. */
static int fewest_coordinates(const build *b)
{
  int space = b->terms.dimension;
  for (int64_t i = 0; i < b->raw->points.count; i++)
    for (int axis = space; axis < 3 && b->vertex_of[i] >= 0; axis++)
      if (dvi__raw_point_at(b->raw, i)->x[axis] != 0) space = axis + 1;
  return space;
}

/* Take the number of coordinates, and the properties of the axes, from the options, from the file,
 * or from the points. */
static void take_axes(build *b, const dvi_mesh_read_options *options)
{
  const dvi__raw *raw = b->raw;
  dvi_mesh_terms *terms = &b->terms;
  terms->space = options->space > 0 ? options->space
                 : raw->space > 0   ? raw->space
                                    : fewest_coordinates(b);
  for (int i = 0; i < terms->space; i++) {
    b->metric[i] = i < raw->space ? raw->metric[i] : 1;
    b->period[i] = i < raw->space ? raw->period[i] : 0;
  }
  terms->metric = options->metric != NULL ? options->metric : b->metric;
  terms->period = options->period != NULL ? options->period : b->period;
}

static dvi_status take_points(build *b)
{
  const int space = b->terms.space;
  b->point = DVI_NEW(double, b->terms.points *space);
  if (b->point == NULL) return no_memory(b);
  for (int64_t i = 0; i < b->raw->points.count; i++) {
    const dvi__raw_point *point = dvi__raw_point_at(b->raw, i);
    if (b->vertex_of[i] < 0) continue;
    for (int axis = space; axis < 3; axis++)
      if (point->x[axis] != 0)
        return dvi__reject(b->raw->reader, point->place,
                           "the coordinate %c of the point %lld is %g, but %d coordinates are "
                           "wanted",
                           "xyz"[axis], (long long)point -> tag, point -> x[axis], space);
    for (int axis = 0; axis < space && axis < 3; axis++)
      b->point[(int64_t)b->vertex_of[i] * space + axis] = point->x[axis];
  }
  b->terms.point = b->point;
  return DVI_OK;
}

static dvi_status take_cells(build *b)
{
  const int corners = dvi__shape_facts_of[b->top].corners;
  b->vertex = DVI_NEW(int, b->terms.cells *corners);
  if (b->vertex == NULL) return no_memory(b);
  for (int64_t e = b->raw->elements[b->top].count - 1; e >= 0; e--)
    for (int c = 0; c < corners; c++)
      b->vertex[(int64_t)b->cell_of[e] * corners + dvi__corner_in_file(b->top, c)] =
          b->vertex_of[element_of(b, e)->corner[c]];
  b->terms.vertex = b->vertex;
  return DVI_OK;
}

/* ---- parts ---- */

/* By the group, then by the element. */
static int compare_members(const void *left, const void *right)
{
  const dvi__raw_member *a = left, *b = right;
  if (a->group != b->group) return a->group < b->group ? -1 : 1;
  return (a->element > b->element) - (a->element < b->element);
}

/* Tell whether the member i begins a group. */
static int begins_group(const build *b, dvi__shape shape, int64_t i)
{
  const dvi__raw_member *member = dvi__raw_member_at(b->raw, shape, i);
  return i == 0 || member->group != member[-1].group;
}

/* Sort the groups of each shape, and count those of all shapes. */
static int64_t sort_members(build *b)
{
  int64_t groups = 0;
  for (int s = 0; s < DVI__SHAPES; s++) {
    const dvi__list *list = b->raw->members + s;
    if (list->count == 0) continue;
    qsort(list->at, (size_t)list->count, sizeof(dvi__raw_member), compare_members);
    for (int64_t i = 0; i < list->count; i++) groups += begins_group(b, (dvi__shape)s, i);
  }
  return groups;
}

/* Find the name of a group, which is sorted by dimension and tag. NULL if it has none. */
static dvi__raw_group *find_group(const build *b, int dimension, int64_t tag)
{
  int64_t low = 0, high = b->raw->groups.count;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    dvi__raw_group *group = dvi__raw_group_at(b->raw, middle);
    if (group->dimension == dimension && group->tag == tag) return group;
    if (group->dimension < dimension || (group->dimension == dimension && group->tag < tag))
      low = middle + 1;
    else
      high = middle;
  }
  return NULL;
}

/* Two groups without names may have one number in different dimensions. The second one to come is
 * the lower one, and its name tells so. */
static const char *name_part(build *b, int degree, int64_t tag)
{
  dvi__raw_group *group = find_group(b, degree, tag);
  if (group != NULL) {
    group->is_used = 1;
    return group->name;
  }
  number_name *name = b->number_name + b->terms.parts;
  (void)snprintf(name->text, sizeof name->text, "group %lld", (long long)tag);
  for (int p = 0; p < b->terms.parts; p++)
    if (strcmp(b->part[p].name, name->text) == 0)
      (void)snprintf(name->text, sizeof name->text, "group %lld of degree %d", (long long)tag,
                     degree);
  return name->text;
}

/* Take the vertices of a face of cells. */
static dvi_status take_face(const build *b, dvi__shape shape, int64_t e, int *vertex)
{
  const dvi__raw_element *element = dvi__raw_element_at(b->raw, shape, e);
  for (int c = 0; c < dvi__shape_facts_of[shape].corners; c++) {
    const int at = b->vertex_of[element->corner[c]];
    if (at < 0)
      return dvi__reject(b->raw->reader, element->place,
                         "a %s in a group has the point %lld, which no %s has",
                         dvi__shape_facts_of[shape].name,
                         (long long)dvi__raw_point_at(b->raw, element->corner[c])->tag,
                         dvi__shape_facts_of[b->top].name);
    vertex[dvi__corner_in_file(shape, c)] = at;
  }
  return DVI_OK;
}

/* Take the members of all groups of a shape: the numbers of cells, or vertices of their faces. */
static dvi_status take_members(build *b, dvi__shape shape)
{
  const int64_t count = b->raw->members[shape].count;
  const int width = shape == b->top ? 1 : dvi__shape_facts_of[shape].corners;
  int *member = b->member[shape] = DVI_NEW(int, count *width);
  if (member == NULL) return no_memory(b);
  for (int64_t i = 0; i < count; i++) {
    const int64_t e = dvi__raw_member_at(b->raw, shape, i)->element;
    if (shape == b->top)
      member[i] = b->cell_of[e];
    else
      DVI_TRY(take_face(b, shape, e, member + i * width));
  }
  return DVI_OK;
}

static void take_groups(build *b, dvi__shape shape)
{
  const int degree = dvi__shape_facts_of[shape].dimension,
            width = shape == b->top ? 1 : dvi__shape_facts_of[shape].corners;
  for (int64_t i = 0; i < b->raw->members[shape].count; i++) {
    if (begins_group(b, shape, i)) {
      dvi_mesh_part *part = b->part + b->terms.parts;
      const int *first = b->member[shape] + i * width;
      *part = (dvi_mesh_part){.degree = degree};
      *(shape == b->top ? &part->cell : &part->vertex) = first;
      part->name = name_part(b, degree, dvi__raw_member_at(b->raw, shape, i)->group);
      b->terms.parts++;
    }
    b->part[b->terms.parts - 1].count++;
  }
}

/* An element that was repeated for its groups must not be twice in one of them. */
static dvi_status check_members(const build *b)
{
  char *marked = DVI_NEW(char, b->terms.cells);
  dvi_status status = marked != NULL ? DVI_OK : no_memory(b);
  for (int64_t i = 0, j = 0; i < b->raw->members[b->top].count && status == DVI_OK; i++) {
    const dvi__raw_member *member = dvi__raw_member_at(b->raw, b->top, i);
    if (begins_group(b, b->top, i))
      for (; j < i; j++) marked[b->member[b->top][j]] = 0;
    if (marked[b->member[b->top][i]])
      status = dvi__reject(b->raw->reader, element_of(b, member->element)->place,
                           "a %s is given twice in the group %lld",
                           dvi__shape_facts_of[b->top].name, (long long)member->group);
    marked[b->member[b->top][i]] = 1;
  }
  dvi__release(marked);
  return status;
}

/* The faces of cells of one kind have that kind, too. */
static dvi_status check_kinds(const build *b)
{
  const dvi__raw *raw = b->raw;
  for (int s = 0; s < DVI__SHAPES; s++) {
    const dvi__shape_facts *facts = dvi__shape_facts_of + s;
    if (raw->members[s].count == 0 || (int)dvi__shape_of(b->terms.kind, facts->dimension) == s)
      continue;
    const int64_t e = dvi__raw_member_at(raw, (dvi__shape)s, 0)->element;
    return dvi__reject(raw->reader, dvi__raw_element_at(raw, (dvi__shape)s, e)->place,
                       "a %s is in a group, but the cells of the mesh are %s", facts->name,
                       dvi__shape_facts_of[b->top].names);
  }
  return DVI_OK;
}

static dvi_status check_groups(const build *b)
{
  for (int64_t i = 0; i < b->raw->groups.count; i++) {
    const dvi__raw_group *group = dvi__raw_group_at(b->raw, i);
    if (!group->is_used)
      return dvi__reject(b->raw->reader, group->place,
                         "the group %lld of dimension %lld, \"%.64s\", has no elements",
                         (long long)group->tag, (long long)group->dimension, group->name);
  }
  return DVI_OK;
}

/* From the highest degree down, as `name_part` expects. */
static dvi_status take_parts(build *b)
{
  const int64_t groups = sort_members(b);
  DVI_TRY(check_kinds(b));
  b->part = DVI_NEW(dvi_mesh_part, groups);
  b->number_name = DVI_NEW(number_name, groups);
  if (b->part == NULL || b->number_name == NULL) return no_memory(b);
  for (int degree = b->terms.dimension; degree >= 0; degree--) {
    const dvi__shape shape = dvi__shape_of(b->terms.kind, degree);
    DVI_TRY(take_members(b, shape));
    take_groups(b, shape);
  }
  b->terms.part = b->part;
  DVI_TRY(check_members(b));
  return check_groups(b);
}

/* ---- the mesh ---- */

static dvi_status make(build *b, const dvi_mesh_read_options *options, dvi_mesh **mesh)
{
  DVI_TRY(choose_top(b));
  DVI_TRY(take_order(b));
  DVI_TRY(number_vertices(b));
  take_axes(b, options);
  DVI_TRY(take_points(b));
  DVI_TRY(take_cells(b));
  DVI_TRY(take_parts(b));
  const dvi_status status = dvi_mesh_create(&b->terms, mesh);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "%.300s", b->raw->reader->path);
}

dvi_status dvi__raw_mesh(dvi__raw *raw, const dvi_mesh_read_options *options, dvi_mesh **mesh)
{
  build b = {.raw = raw, .terms = {.size = sizeof b.terms}};
  const dvi_status status = make(&b, options, mesh);
  dvi__release(b.cell_of);
  dvi__release(b.vertex_of);
  dvi__release(b.point);
  dvi__release(b.vertex);
  dvi__release(b.part);
  dvi__release(b.number_name);
  for (int s = 0; s < DVI__SHAPES; s++) dvi__release(b.member[s]);
  return status;
}
