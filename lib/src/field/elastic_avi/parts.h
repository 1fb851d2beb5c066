/* Parts of the cells with events, one for each of some threads. */
#ifndef DVI_FIELD_ELASTIC_AVI_PARTS_H
#define DVI_FIELD_ELASTIC_AVI_PARTS_H
#include "field/elastic_avi/engine.h"

/* Set owner [active] to numbers below `members`, and is_edge [active] to whether a cell has a node
 * in common with one of another owner. */
dvi_status dvi__solid_share_out(const dvi__solid_avi *avi, int members, int *owner,
                                uint8_t *is_edge);

#endif
