/* What a march of a solid is asked for. */
#ifndef DVI_FIELD_ELASTIC_AVI_MARCH_H
#define DVI_FIELD_ELASTIC_AVI_MARCH_H
#include "field/elastic_avi/plan.h"

/* Read the options of a march, NULL for the defaults. DVI_BAD_OPTION, DVI_BAD_ARGUMENT. */
dvi_status dvi__solid_ask(const dvi_elastic *solid, const dvi_march_options *options,
                          dvi__solid_request *request);

#endif
