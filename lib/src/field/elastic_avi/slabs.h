/* Slabs of a solid, which threads share (slabs.c tells why). */
#ifndef DVI_FIELD_ELASTIC_AVI_SLABS_H
#define DVI_FIELD_ELASTIC_AVI_SLABS_H
#include "field/elastic_avi/plan.h"

/* Make the plan's slabs and turns of its steps. */
dvi_status dvi__solid_slabs_make(const dvi_elastic *solid, const dvi__solid_request *request,
                                 dvi__solid_plan *plan);

#endif
