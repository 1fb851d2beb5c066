/* The threads of asynchronous steps. */
#ifndef DVI_FIELD_ELASTIC_AVI_MEMBERS_H
#define DVI_FIELD_ELASTIC_AVI_MEMBERS_H
#include "field/elastic_avi/engine.h"

/* Make avi->members for avi->threads threads. On failure nothing is owned. */
dvi_status dvi__solid_members_create(dvi__solid_avi *avi);
void dvi__solid_members_destroy(struct dvi__solid_members **members);

/* Order the members' calendars after the counts. */
void dvi__solid_members_order(dvi__solid_avi *avi);

/* Order a calendar after the counts. Its numbers are places in a list of cells, or for NULL the
 * cells themselves. */
void dvi__solid_order_some(const dvi__solid_avi *avi, int64_t count, const int *cell,
                           dvi__calendar *calendar);

#endif
