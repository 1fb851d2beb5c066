/* The tables of an action element, which are the trial functions at the quadrature nodes and their
 * products. */
#ifndef DVI_STEP_ELEMENT_TABLE_H
#define DVI_STEP_ELEMENT_TABLE_H
#include "step/element/action.h"

/* Allocate and fill all tables of a->space. */
dvi_status dvi__action_fill_tables(dvi__action *action);

#endif
