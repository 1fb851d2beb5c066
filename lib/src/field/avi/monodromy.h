/* The growth of fields under a schedule. */
#ifndef DVI_FIELD_AVI_MONODROMY_H
#define DVI_FIELD_AVI_MONODROMY_H
#include "field/avi/engine.h"
#include "field/step/growth.h"

/* Find the growth under steps, as dvi_field_stability does. Currents of the terms take no part. */
dvi_status dvi__avi_stability(const dvi__avi_terms *terms, double span, dvi_stability *report);

/* Show steps without currents as a flow, which carries their own state. */
dvi__flow dvi__avi_flow(dvi__avi *avi);

#endif
