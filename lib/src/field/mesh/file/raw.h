/* A mesh as a file has it: points with tags, elements of any dimension, groups of them. The readers
 * of all formats fill it. */
#ifndef DVI_FIELD_MESH_FILE_RAW_H
#define DVI_FIELD_MESH_FILE_RAW_H
#include "field/mesh/file/list.h"
#include "field/mesh/file/reader.h"
#include "field/mesh/file/shapes.h"

/* A point, with the number by which the file calls it and the place where it does. */
typedef struct dvi__raw_point {
  int64_t tag;
  size_t place;
  double x[3];
} dvi__raw_point;

/* An element. Its corners are numbers of points in the order of their tags. */
typedef struct dvi__raw_element {
  int64_t tag;
  size_t place;
  int corner[DVI__SHAPE_CORNERS];
} dvi__raw_element;

/* The fact that an element belongs to a group of its dimension. */
typedef struct dvi__raw_member {
  int64_t group, element;
} dvi__raw_member;

/* The name of a group. */
typedef struct dvi__raw_group {
  int64_t dimension, tag;
  size_t place;
  char *name;
  int is_used; /* by an element */
} dvi__raw_group;

/* The mesh of a file. */
typedef struct dvi__raw {
  const dvi__reader *reader; /* for messages */
  dvi__list points;          /* of dvi__raw_point, by tag after dvi__raw_sort_points */
  dvi__list elements[DVI__SHAPES];
  dvi__list members[DVI__SHAPES];
  dvi__list groups; /* of dvi__raw_group, by dimension and tag after dvi__raw_sort_groups */
  int may_repeat;   /* an element in two groups stands in the file twice */
  int space;        /* 0 if the file does not tell, else with metric and period */
  double metric[3], period[3];
  dvi_cell_kind lines; /* what lines are */
} dvi__raw;

static inline dvi__raw_point *dvi__raw_point_at(const dvi__raw *raw, int64_t i)
{
  return (dvi__raw_point *)raw->points.at + i;
}

static inline dvi__raw_element *dvi__raw_element_at(const dvi__raw *raw, dvi__shape shape,
                                                    int64_t i)
{
  return (dvi__raw_element *)raw->elements[shape].at + i;
}

static inline dvi__raw_member *dvi__raw_member_at(const dvi__raw *raw, dvi__shape shape, int64_t i)
{
  return (dvi__raw_member *)raw->members[shape].at + i;
}

static inline dvi__raw_group *dvi__raw_group_at(const dvi__raw *raw, int64_t i)
{
  return (dvi__raw_group *)raw->groups.at + i;
}

/* Add a point. */
dvi_status dvi__raw_add_point(dvi__raw *raw, int64_t tag, size_t place, const double *x);

/* Sort all points by their tags, which must differ. */
dvi_status dvi__raw_sort_points(dvi__raw *raw);

/* Add an element by the tags of its corners. The points are sorted. */
dvi_status dvi__raw_add_element(dvi__raw *raw, dvi__shape shape, int64_t tag, size_t place,
                                const int64_t *corner);

/* Put the newest element of the shape into a group. */
dvi_status dvi__raw_add_member(dvi__raw *raw, dvi__shape shape, int64_t group);

/* Name a group. The name is given by its bytes. */
dvi_status dvi__raw_name_group(dvi__raw *raw, int64_t dimension, int64_t tag, size_t place,
                               const unsigned char *name, size_t length);

/* Sort the groups by dimension and tag, of which no two are equal. */
dvi_status dvi__raw_sort_groups(dvi__raw *raw);

/* Refuse two elements with the same tag. */
dvi_status dvi__raw_check_tags(const dvi__raw *raw);

/* Make the mesh of the cells of highest dimension, and parts of the groups. The points are sorted
 * and the groups, too. */
dvi_status dvi__raw_mesh(dvi__raw *raw, const dvi_mesh_read_options *options, dvi_mesh **mesh);

void dvi__raw_clear(dvi__raw *raw);

#endif
