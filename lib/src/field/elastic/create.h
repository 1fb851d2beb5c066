/* The steps that make a solid. Each takes what the solid keeps of its terms. */
#ifndef DVI_FIELD_ELASTIC_CREATE_H
#define DVI_FIELD_ELASTIC_CREATE_H
#include "field/elastic/elastic.h"

dvi_status dvi__solid_take_mesh(dvi_elastic *e, const dvi_mesh *mesh);
dvi_status dvi__solid_take_materials(dvi_elastic *e, const dvi_elastic_terms *terms);
dvi_status dvi__solid_take_conditions(dvi_elastic *e, const dvi_elastic_terms *terms);
dvi_status dvi__solid_take_loads(dvi_elastic *e, const dvi_elastic_terms *terms);
dvi_status dvi__solid_take_obstacles(dvi_elastic *e, const dvi_elastic_terms *terms);

/* Called on all processes: refuse a solid without unknowns, and loads that move nothing. */
dvi_status dvi__solid_count_unknowns(dvi_elastic *e);
dvi_status dvi__solid_check_loads(const dvi_elastic *e);

/* Copy a name of terms, which is a term's first member. */
dvi_status dvi__solid_copy_name(const char *name, const char **copy);

#endif
