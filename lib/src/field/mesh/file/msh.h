/* Gmsh's files, versions 2.2 and 4.1, as text or binary. */
#ifndef DVI_FIELD_MESH_FILE_MSH_H
#define DVI_FIELD_MESH_FILE_MSH_H
#include "field/mesh/file/raw.h"

/* Read what stands in the sections of these names, between their first and last lines. */
dvi_status dvi__msh2_nodes(dvi__reader *r, dvi__raw *raw);
dvi_status dvi__msh2_elements(dvi__reader *r, dvi__raw *raw);

/* Entities of version 4.1 with the groups to which they belong. */
typedef struct dvi__msh_entity {
  int64_t dimension, tag;
  size_t place;
  int64_t first, count; /* in `physical` */
} dvi__msh_entity;
typedef struct dvi__msh_entities {
  dvi__list entity;   /* of dvi__msh_entity, by dimension and tag */
  dvi__list physical; /* of int64_t */
  int are_given;
} dvi__msh_entities;

/* The same for version 4.1. */
dvi_status dvi__msh4_entities(dvi__reader *r, dvi__msh_entities *entities);
dvi_status dvi__msh4_nodes(dvi__reader *r, dvi__raw *raw);
dvi_status dvi__msh4_elements(dvi__reader *r, dvi__raw *raw, const dvi__msh_entities *entities);

/* Give the shape of an element's type, or refuse the type by its name. */
dvi_status dvi__msh_shape(const dvi__reader *r, int64_t type, dvi__shape *shape);

#endif
