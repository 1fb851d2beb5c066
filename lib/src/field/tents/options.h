/* The options of tents in the text of a method. */
#ifndef DVI_FIELD_TENTS_OPTIONS_H
#define DVI_FIELD_TENTS_OPTIONS_H
#include "field/tents/tents.h"

/* Read "least=0.5,seed=3,band=2", in any order, or "". DVI_BAD_OPTION. */
dvi_status dvi__tents_read_options(const char *text, dvi__tents_options *options);

#endif
