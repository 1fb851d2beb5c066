#include "field/mesh/file/raw.h"

#include <stdlib.h>
#include <string.h>

#include "core/memory.h"

void dvi__raw_clear(dvi__raw *raw)
{
  for (int64_t i = 0; i < raw->groups.count; i++) dvi__release(dvi__raw_group_at(raw, i)->name);
  dvi__release(raw->groups.at);
  dvi__release(raw->points.at);
  for (int s = 0; s < DVI__SHAPES; s++) {
    dvi__release(raw->elements[s].at);
    dvi__release(raw->members[s].at);
  }
}

/* ---- points ---- */

dvi_status dvi__raw_add_point(dvi__raw *raw, int64_t tag, size_t place, const double *x)
{
  dvi__raw_point *point = dvi__list_add(&raw->points, sizeof *point);
  if (point == NULL) return DVI_NO_MEMORY;
  *point = (dvi__raw_point){.tag = tag, .place = place, .x = {x[0], x[1], x[2]}};
  return DVI_OK;
}

/* By the tag, and equal ones by their places. */
static int compare_points(const void *left, const void *right)
{
  const dvi__raw_point *a = left, *b = right;
  if (a->tag != b->tag) return a->tag < b->tag ? -1 : 1;
  return (a->place > b->place) - (a->place < b->place);
}

dvi_status dvi__raw_sort_points(dvi__raw *raw)
{
  const int64_t count = raw->points.count;
  int is_sorted = 1;
  for (int64_t i = 1; i < count && is_sorted; i++)
    is_sorted = dvi__raw_point_at(raw, i - 1)->tag < dvi__raw_point_at(raw, i)->tag;
  if (is_sorted) return DVI_OK;
  qsort(raw->points.at, (size_t)count, sizeof(dvi__raw_point), compare_points);
  for (int64_t i = 1; i < count; i++) {
    const dvi__raw_point *point = dvi__raw_point_at(raw, i);
    if (point->tag == point[-1].tag)
      return dvi__reject(raw->reader, point->place, "a second point has the tag %lld",
                         (long long)point->tag);
  }
  return DVI_OK;
}

/* Find a point by its tag. Most files number points without gaps. Returns -1 if there is none. */
static int64_t find_point(const dvi__raw *raw, int64_t tag)
{
  int64_t low = 0, high = raw->points.count;
  if (high == 0) return -1;
  const int64_t first = dvi__raw_point_at(raw, 0)->tag;
  if (tag < first || tag > dvi__raw_point_at(raw, high - 1)->tag) return -1;
  const uint64_t guess = (uint64_t)tag - (uint64_t)first;
  if (guess < (uint64_t)high && dvi__raw_point_at(raw, (int64_t)guess)->tag == tag)
    return (int64_t)guess;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2, found = dvi__raw_point_at(raw, middle)->tag;
    if (found == tag) return middle;
    if (found < tag)
      low = middle + 1;
    else
      high = middle;
  }
  return -1;
}

/* ---- elements ---- */

dvi_status dvi__raw_add_element(dvi__raw *raw, dvi__shape shape, int64_t tag, size_t place,
                                const int64_t *corner)
{
  dvi__raw_element *element = dvi__list_add(raw->elements + shape, sizeof *element);
  if (element == NULL) return DVI_NO_MEMORY;
  element->tag = tag;
  element->place = place;
  for (int c = 0; c < dvi__shape_facts_of[shape].corners; c++) {
    const int64_t point = find_point(raw, corner[c]);
    if (point < 0)
      return dvi__reject(raw->reader, place, "a %s has the point %lld, and there is no such point",
                         dvi__shape_facts_of[shape].name, (long long)corner[c]);
    element->corner[c] = (int)point;
  }
  return DVI_OK;
}

dvi_status dvi__raw_add_member(dvi__raw *raw, dvi__shape shape, int64_t group)
{
  dvi__raw_member *member = dvi__list_add(raw->members + shape, sizeof *member);
  if (member == NULL) return DVI_NO_MEMORY;
  *member = (dvi__raw_member){group, raw->elements[shape].count - 1};
  return DVI_OK;
}

/* The tag of an element and its place in the file. */
typedef struct tagged {
  int64_t tag;
  size_t place;
} tagged;

static int compare_tags(const void *left, const void *right)
{
  const tagged *a = left, *b = right;
  if (a->tag != b->tag) return a->tag < b->tag ? -1 : 1;
  return (a->place > b->place) - (a->place < b->place);
}

static dvi_status check_sorted(const dvi__raw *raw, tagged *tags, int64_t count)
{
  qsort(tags, (size_t)count, sizeof *tags, compare_tags);
  for (int64_t i = 1; i < count; i++)
    if (tags[i].tag == tags[i - 1].tag)
      return dvi__reject(raw->reader, tags[i].place, "a second element has the tag %lld",
                         (long long)tags[i].tag);
  return DVI_OK;
}

dvi_status dvi__raw_check_tags(const dvi__raw *raw)
{
  int64_t count = 0, at = 0;
  for (int s = 0; s < DVI__SHAPES; s++) count += raw->elements[s].count;
  tagged *tags = DVI_NEW(tagged, count);
  if (tags == NULL)
    return dvi__fail(DVI_NO_MEMORY, "mesh file: no memory for %lld tags", (long long)count);
  for (int s = 0; s < DVI__SHAPES; s++)
    for (int64_t i = 0; i < raw->elements[s].count; i++, at++) {
      const dvi__raw_element *element = dvi__raw_element_at(raw, (dvi__shape)s, i);
      tags[at] = (tagged){element->tag, element->place};
    }
  const dvi_status status = check_sorted(raw, tags, count);
  dvi__release(tags);
  return status;
}

/* ---- groups ---- */

static dvi_status check_name(const dvi__raw *raw, size_t place, const unsigned char *name,
                             size_t length)
{
  static const char *const taken[] = {"all", "boundary"};
  if (length == 0) return dvi__reject(raw->reader, place, "a group has an empty name");
  for (size_t i = 0; i < length; i++)
    if (name[i] < ' ')
      return dvi__reject(raw->reader, place, "a group's name has the control character %d",
                         name[i]);
  for (int i = 0; i < 2; i++)
    if (strlen(taken[i]) == length && memcmp(taken[i], name, length) == 0)
      return dvi__reject(raw->reader, place,
                         "a group has the name \"%s\", which every mesh gives to a part of its "
                         "own: rename it",
                         taken[i]);
  return DVI_OK;
}

dvi_status dvi__raw_name_group(dvi__raw *raw, int64_t dimension, int64_t tag, size_t place,
                               const unsigned char *name, size_t length)
{
  DVI_TRY(check_name(raw, place, name, length));
  dvi__raw_group *group = dvi__list_add(&raw->groups, sizeof *group);
  if (group == NULL) return DVI_NO_MEMORY;
  *group = (dvi__raw_group){.dimension = dimension, .tag = tag, .place = place};
  group->name = DVI_NEW(char, length + 1);
  if (group->name == NULL) return dvi__fail(DVI_NO_MEMORY, "mesh file: no memory for a name");
  memcpy(group->name, name, length);
  return DVI_OK;
}

static int compare_groups(const void *left, const void *right)
{
  const dvi__raw_group *a = left, *b = right;
  if (a->dimension != b->dimension) return a->dimension < b->dimension ? -1 : 1;
  if (a->tag != b->tag) return a->tag < b->tag ? -1 : 1;
  return (a->place > b->place) - (a->place < b->place);
}

dvi_status dvi__raw_sort_groups(dvi__raw *raw)
{
  if (raw->groups.count == 0) return DVI_OK;
  qsort(raw->groups.at, (size_t)raw->groups.count, sizeof(dvi__raw_group), compare_groups);
  for (int64_t i = 1; i < raw->groups.count; i++) {
    const dvi__raw_group *group = dvi__raw_group_at(raw, i);
    if (group->dimension == group[-1].dimension && group->tag == group[-1].tag)
      return dvi__reject(raw->reader, group->place,
                         "the group %lld of dimension %lld has a second name",
                         (long long)group->tag, (long long)group->dimension);
  }
  return DVI_OK;
}
