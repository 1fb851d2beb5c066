/* The order in which edges and faces are stored, and what is gathered from whom. */
#ifndef DVI_FIELD_AVI_LAYOUT_H
#define DVI_FIELD_AVI_LAYOUT_H
#include "field/avi/engine.h"
#include "field/avi/plan.h"

/* Number edges and faces, and fill in the arrays of an engine that do not change, whose counts are
 * set. */
dvi_status dvi__avi_lay_out(const dvi__avi_terms *terms, const dvi__avi_plan *plan, dvi__avi *avi);

#endif
