/* Where there is no SLEPc there are no modes. */
#include <dvi/petsc.h>

#include "core/status.h"

dvi_status dvi_division_modes(const dvi_division *division, const dvi_field *field,
                              const dvi_modes_options *options, double *eigenvalue, double *mode,
                              dvi_modes_facts *facts)
{
  (void)division;
  (void)field;
  (void)options;
  (void)eigenvalue;
  (void)mode;
  (void)facts;
  return dvi__fail(DVI_UNSUPPORTED, "modes: libdvi-petsc was built without SLEPc, which finds the "
                                    "modes of a mesh that is divided: install it (slepc-dev), and "
                                    "build again");
}
