/* The arrangement of nodes and cells. */
#ifndef DVI_FIELD_ELASTIC_AVI_LAYOUT_H
#define DVI_FIELD_ELASTIC_AVI_LAYOUT_H
#include "field/elastic_avi/plan.h"

/* Number the cells, and find what is special. The arrays but those of the state have been
 * allocated. */
dvi_status dvi__solid_lay_out(const dvi__solid_plan *plan, dvi__solid_avi *avi);

#endif
