/* Version 4.1 of Gmsh's files: points and elements in blocks, each of which belongs to an entity of
 * the geometry, which in turn belongs to some groups. Text and binary files have the same numbers
 * in the same order. */
#include "field/mesh/file/msh.h"

#include <stdlib.h>

/* Counts and numbers of points and elements have eight bytes, all other integers four. */
enum { LONG = 8, SHORT = 4 };

/* A file of few bytes could else ask for as many parts as elements, each with all elements. */
enum { MOST_GROUPS = 64 };

static dvi_status read_long(dvi__reader *r, const char *what, int64_t *value)
{
  return dvi__read_integer(r, what, LONG, 0, INT64_MAX, value);
}

/* ---- entities ---- */

static dvi_status read_physical(dvi__reader *r, dvi__msh_entities *entities)
{
  int64_t tag, *physical = NULL;
  DVI_TRY(dvi__read_integer(r, "a group of an entity", SHORT, -INT32_MAX, INT32_MAX, &tag));
  physical = dvi__list_add(&entities->physical, sizeof *physical);
  if (physical == NULL) return DVI_NO_MEMORY;
  *physical = tag < 0 ? -tag : tag;
  return DVI_OK;
}

static int is_repeated(const int64_t *list, int64_t count)
{
  for (int64_t i = 0; i < count; i++)
    for (int64_t j = 0; j < i; j++)
      if (list[i] == list[j]) return 1;
  return 0;
}

static dvi_status read_groups(dvi__reader *r, dvi__msh_entities *entities, dvi__msh_entity *entity)
{
  const char *what = "the number of groups of an entity";
  DVI_TRY(dvi__read_integer(r, what, LONG, 0, MOST_GROUPS, &entity->count));
  entity->first = entities->physical.count;
  for (int64_t i = 0; i < entity->count; i++) DVI_TRY(read_physical(r, entities));
  if (entity->count == 0) return DVI_OK;
  if (is_repeated((const int64_t *)entities->physical.at + entity->first, entity->count))
    return dvi__reject(r, entity->place, "the entity %lld of dimension %lld is in a group twice",
                       (long long)entity->tag, (long long)entity->dimension);
  return DVI_OK;
}

/* A point has one place, another entity has the corners of a box around it, and a boundary. */
static dvi_status read_entity(dvi__reader *r, dvi__msh_entities *entities, int dimension)
{
  dvi__msh_entity entity = {.dimension = dimension};
  double ignored;
  int64_t bounds = 0, bound;
  DVI_TRY(
      dvi__read_integer(r, "the number of an entity", SHORT, INT32_MIN, INT32_MAX, &entity.tag));
  entity.place = r->mark;
  for (int i = 0; i < (dimension == 0 ? 3 : 6); i++)
    DVI_TRY(dvi__read_real(r, "a coordinate of an entity", &ignored));
  DVI_TRY(read_groups(r, entities, &entity));
  if (dimension > 0) {
    DVI_TRY(read_long(r, "the number of an entity's boundaries", &bounds));
    DVI_TRY(dvi__claim(r, "boundaries", bounds, 2, SHORT));
  }
  for (int64_t i = 0; i < bounds; i++)
    DVI_TRY(dvi__read_integer(r, "a boundary of an entity", SHORT, INT32_MIN, INT32_MAX, &bound));
  dvi__msh_entity *kept = dvi__list_add(&entities->entity, sizeof *kept);
  if (kept == NULL) return DVI_NO_MEMORY;
  *kept = entity;
  return DVI_OK;
}

static int compare_keys(const dvi__msh_entity *a, const dvi__msh_entity *b)
{
  if (a->dimension != b->dimension) return a->dimension < b->dimension ? -1 : 1;
  return (a->tag > b->tag) - (a->tag < b->tag);
}

static int compare_entities(const void *left, const void *right)
{
  const dvi__msh_entity *a = left, *b = right;
  const int order = compare_keys(a, b);
  return order != 0 ? order : (a->place > b->place) - (a->place < b->place);
}

static dvi_status sort_entities(const dvi__reader *r, dvi__msh_entities *entities)
{
  dvi__msh_entity *entity = entities->entity.at;
  if (entities->entity.count == 0) return DVI_OK;
  qsort(entity, (size_t)entities->entity.count, sizeof *entity, compare_entities);
  for (int64_t i = 1; i < entities->entity.count; i++)
    if (compare_keys(entity + i - 1, entity + i) == 0)
      return dvi__reject(r, entity[i].place,
                         "a second entity of dimension %lld has the number %lld",
                         (long long)entity[i].dimension, (long long)entity[i].tag);
  return DVI_OK;
}

dvi_status dvi__msh4_entities(dvi__reader *r, dvi__msh_entities *entities)
{
  int64_t count[4];
  for (int d = 0; d < 4; d++) {
    DVI_TRY(read_long(r, "the number of entities", count + d));
    DVI_TRY(dvi__claim(r, "entities", count[d], 10, 28));
  }
  for (int d = 0; d < 4; d++)
    for (int64_t i = 0; i < count[d]; i++) DVI_TRY(read_entity(r, entities, d));
  entities->are_given = 1;
  return sort_entities(r, entities);
}

/* Find an entity. A file without the section has no groups, and gives NULL. */
static dvi_status find_entity(const dvi__reader *r, const dvi__msh_entities *entities,
                              int64_t dimension, int64_t tag, const dvi__msh_entity **found)
{
  const dvi__msh_entity key = {.dimension = dimension, .tag = tag}, *entity = entities->entity.at;
  int64_t low = 0, high = entities->entity.count;
  *found = NULL;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    const int order = compare_keys(entity + middle, &key);
    if (order == 0) {
      *found = entity + middle;
      return DVI_OK;
    }
    if (order < 0)
      low = middle + 1;
    else
      high = middle;
  }
  if (!entities->are_given) return DVI_OK;
  return dvi__reject(r, r->mark, "$Entities has no entity %lld of dimension %lld", (long long)tag,
                     (long long)dimension);
}

/* ---- blocks ---- */

/* The heads of the sections of points and elements. */
typedef struct head {
  int64_t blocks, total, least, most;
} head;

static dvi_status read_head(dvi__reader *r, const char *what, const char *things, head *h)
{
  DVI_TRY(read_long(r, "the number of blocks", &h->blocks));
  DVI_TRY(dvi__claim(r, "blocks", h->blocks, 8, 20));
  DVI_TRY(read_long(r, what, &h->total));
  DVI_TRY(dvi__claim(r, things, h->total, 4, 16));
  DVI_TRY(read_long(r, "the smallest number", &h->least));
  return read_long(r, "the largest number", &h->most);
}

/* Count what the blocks have against what the section announces. */
static dvi_status check_total(const dvi__reader *r, const char *things, const head *h,
                              int64_t total)
{
  if (total == h->total) return DVI_OK;
  return dvi__reject(r, r->at, "%lld %s are announced, and the blocks have %lld",
                     (long long)h->total, things, (long long)total);
}

/* ---- points ---- */

/* The tags of a block come before all places, which are kept until then in the points' own list. */
static dvi_status read_node_block(dvi__reader *r, dvi__raw *raw, int64_t *count)
{
  static const double nowhere[3];
  int64_t dimension, entity, is_parametric, tag;
  double parameter;
  DVI_TRY(dvi__read_integer(r, "the dimension of an entity", SHORT, 0, 3, &dimension));
  DVI_TRY(dvi__read_integer(r, "the number of an entity", SHORT, INT32_MIN, INT32_MAX, &entity));
  DVI_TRY(dvi__read_integer(r, "0, or 1 for parameters", SHORT, 0, 1, &is_parametric));
  DVI_TRY(read_long(r, "the number of points in a block", count));
  DVI_TRY(dvi__claim(r, "points", *count, 8, 32));
  const int64_t first = raw->points.count;
  for (int64_t i = 0; i < *count; i++) {
    DVI_TRY(dvi__read_integer(r, "the number of a point", LONG, 1, INT64_MAX, &tag));
    DVI_TRY(dvi__raw_add_point(raw, tag, r->mark, nowhere));
  }
  for (int64_t i = 0; i < *count; i++) {
    for (int axis = 0; axis < 3; axis++)
      DVI_TRY(dvi__read_real(r, "a coordinate", dvi__raw_point_at(raw, first + i)->x + axis));
    for (int64_t p = 0; p < dimension && is_parametric; p++)
      DVI_TRY(dvi__read_real(r, "a parameter of a point", &parameter));
  }
  return DVI_OK;
}

dvi_status dvi__msh4_nodes(dvi__reader *r, dvi__raw *raw)
{
  head h;
  int64_t count = 0, total = 0;
  DVI_TRY(read_head(r, "the number of points", "points", &h));
  for (int64_t b = 0; b < h.blocks; b++, total += count) DVI_TRY(read_node_block(r, raw, &count));
  return check_total(r, "points", &h, total);
}

/* ---- elements ---- */

static dvi_status read_element(dvi__reader *r, dvi__raw *raw, dvi__shape shape,
                               const dvi__msh_entities *entities, const dvi__msh_entity *entity)
{
  int64_t tag, corner[DVI__SHAPE_CORNERS];
  DVI_TRY(dvi__read_integer(r, "the number of an element", LONG, 1, INT64_MAX, &tag));
  const size_t place = r->mark;
  for (int c = 0; c < dvi__shape_facts_of[shape].corners; c++)
    DVI_TRY(dvi__read_integer(r, "a point of an element", LONG, 1, INT64_MAX, corner + c));
  DVI_TRY(dvi__raw_add_element(raw, shape, tag, place, corner));
  for (int64_t i = 0; entity != NULL && i < entity->count; i++)
    DVI_TRY(dvi__raw_add_member(raw, shape,
                                ((const int64_t *)entities->physical.at)[entity->first + i]));
  return DVI_OK;
}

static dvi_status read_element_block(dvi__reader *r, dvi__raw *raw,
                                     const dvi__msh_entities *entities, int64_t *count)
{
  int64_t dimension, tag, type;
  const dvi__msh_entity *entity = NULL;
  dvi__shape shape = DVI__POINT;
  DVI_TRY(dvi__read_integer(r, "the dimension of an entity", SHORT, 0, 3, &dimension));
  DVI_TRY(dvi__read_integer(r, "the number of an entity", SHORT, INT32_MIN, INT32_MAX, &tag));
  DVI_TRY(find_entity(r, entities, dimension, tag, &entity));
  DVI_TRY(dvi__read_integer(r, "the type of elements", SHORT, INT64_MIN, INT64_MAX, &type));
  DVI_TRY(dvi__msh_shape(r, type, &shape));
  if (dvi__shape_facts_of[shape].dimension != dimension)
    return dvi__reject(r, r->mark, "an entity of dimension %lld has %s", (long long)dimension,
                       dvi__shape_facts_of[shape].names);
  DVI_TRY(read_long(r, "the number of elements in a block", count));
  DVI_TRY(dvi__claim(r, "elements", *count, 4, 16));
  for (int64_t i = 0; i < *count; i++) DVI_TRY(read_element(r, raw, shape, entities, entity));
  return DVI_OK;
}

dvi_status dvi__msh4_elements(dvi__reader *r, dvi__raw *raw, const dvi__msh_entities *entities)
{
  head h;
  int64_t count = 0, total = 0;
  DVI_TRY(read_head(r, "the number of elements", "elements", &h));
  for (int64_t b = 0; b < h.blocks; b++, total += count)
    DVI_TRY(read_element_block(r, raw, entities, &count));
  return check_total(r, "elements", &h, total);
}
