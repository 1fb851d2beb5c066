/* The patterns of alpha + grad f. */
#ifndef DVI_SYSTEM_GAUGE_H
#define DVI_SYSTEM_GAUGE_H
#include "system/system.h"

/* Add f to a one-form whose patterns qq and qv are copied. They become those of the sum. After a
 * failure the term owns the remains. */
dvi_status dvi__gauge_join(const dvi_gauge *given, dvi__lagrangian_term *term);
void dvi__gauge_clear(dvi__gauge_term *gauge);

#endif
