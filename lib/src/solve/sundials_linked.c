/* The table of SUNDIALS' functions where it is linked: in the static library, and in the small
 * library that the shared one loads. */
#define DVI__SUNDIALS_IS_LINKED
#include "solve/sundials.h"

const dvi__sundials_table dvi__sundials_linked = {
    .new_context = dvi__sundials_context,
#define FUNCTION(name) .name = (name),
#define FUNCTION_OF(name, function) .name = (function),
#include "solve/sundials.def"
};

const dvi__sundials_table *dvi__sundials = &dvi__sundials_linked;

dvi_status dvi__sundials_load(void)
{
  return DVI_OK;
}
