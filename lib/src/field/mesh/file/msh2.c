/* Version 2.2 of Gmsh's files: a number of points, then each with its number and place; a number of
 * elements, then each with its number, its type, its tags and its points. The first tag is the
 * group. An element in two groups stands in the file twice. */
#include "field/mesh/file/msh.h"

/* Counts are text in binary files, too. */
static dvi_status read_count(dvi__reader *r, const char *what, const char *things, int64_t *count)
{
  DVI_TRY(dvi__read_text_integer(r, what, 0, INT32_MAX, count));
  if (r->is_binary) DVI_TRY(dvi__end_line(r, what));
  return dvi__claim(r, things, *count, 8, 8);
}

static dvi_status read_node(dvi__reader *r, dvi__raw *raw)
{
  int64_t tag;
  double x[3];
  DVI_TRY(dvi__read_integer(r, "the number of a point", 4, 1, INT64_MAX, &tag));
  const size_t place = r->mark;
  for (int i = 0; i < 3; i++) DVI_TRY(dvi__read_real(r, "a coordinate", x + i));
  return dvi__raw_add_point(raw, tag, place, x);
}

dvi_status dvi__msh2_nodes(dvi__reader *r, dvi__raw *raw)
{
  int64_t count;
  DVI_TRY(read_count(r, "the number of points", "points", &count));
  for (int64_t i = 0; i < count; i++) DVI_TRY(read_node(r, raw));
  return DVI_OK;
}

/* Read the tags, of which the first is the group. Gmsh makes it negative for the other
 * orientation, and zero for no group. */
static dvi_status read_tags(dvi__reader *r, int64_t count, int64_t *group)
{
  *group = 0;
  for (int64_t i = 0; i < count; i++) {
    int64_t tag;
    DVI_TRY(dvi__read_integer(r, "a tag of an element", 4, -INT32_MAX, INT32_MAX, &tag));
    if (i == 0) *group = tag < 0 ? -tag : tag;
  }
  return DVI_OK;
}

/* Read what follows an element's number and type. */
static dvi_status read_rest(dvi__reader *r, dvi__raw *raw, dvi__shape shape, int64_t tag,
                            size_t place, int64_t tags)
{
  int64_t corner[DVI__SHAPE_CORNERS], group;
  DVI_TRY(read_tags(r, tags, &group));
  for (int c = 0; c < dvi__shape_facts_of[shape].corners; c++)
    DVI_TRY(dvi__read_integer(r, "a point of an element", 4, 1, INT64_MAX, corner + c));
  DVI_TRY(dvi__raw_add_element(raw, shape, tag, place, corner));
  return group != 0 ? dvi__raw_add_member(raw, shape, group) : DVI_OK;
}

static dvi_status read_element(dvi__reader *r, dvi__raw *raw)
{
  int64_t tag, type, tags;
  dvi__shape shape = DVI__POINT;
  DVI_TRY(dvi__read_integer(r, "the number of an element", 4, 1, INT64_MAX, &tag));
  const size_t place = r->mark;
  DVI_TRY(dvi__read_integer(r, "the type of an element", 4, INT64_MIN, INT64_MAX, &type));
  DVI_TRY(dvi__msh_shape(r, type, &shape));
  DVI_TRY(dvi__read_integer(r, "the number of tags", 4, 0, INT32_MAX, &tags));
  return read_rest(r, raw, shape, tag, place, tags);
}

/* Binary elements come in blocks of one type. Returns their number in *block. */
static dvi_status read_block(dvi__reader *r, dvi__raw *raw, int64_t most, int64_t *block)
{
  int64_t type, tags, tag;
  dvi__shape shape = DVI__POINT;
  DVI_TRY(dvi__read_integer(r, "the type of elements", 4, INT64_MIN, INT64_MAX, &type));
  DVI_TRY(dvi__msh_shape(r, type, &shape));
  DVI_TRY(dvi__read_integer(r, "the number of elements in a block", 4, 1, most, block));
  DVI_TRY(dvi__read_integer(r, "the number of tags", 4, 0, INT32_MAX, &tags));
  for (int64_t i = 0; i < *block; i++) {
    DVI_TRY(dvi__read_integer(r, "the number of an element", 4, 1, INT64_MAX, &tag));
    DVI_TRY(read_rest(r, raw, shape, tag, r->mark, tags));
  }
  return DVI_OK;
}

dvi_status dvi__msh2_elements(dvi__reader *r, dvi__raw *raw)
{
  int64_t count, block = 1;
  raw->may_repeat = 1;
  DVI_TRY(read_count(r, "the number of elements", "elements", &count));
  for (int64_t done = 0; done < count; done += block)
    DVI_TRY(r->is_binary ? read_block(r, raw, count - done, &block) : read_element(r, raw));
  return DVI_OK;
}
