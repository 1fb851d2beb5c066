/* Where there is no SLEPc nothing finds eigenpairs. */
#include "eigen.h"

#include "core/status.h"

static dvi_status refuse(void)
{
  return dvi__fail(DVI_UNSUPPORTED, "modes: libdvi-petsc was built without SLEPc, which finds the "
                                    "modes of a mesh that is divided: install it (slepc-dev), and "
                                    "build again");
}

dvi_status dvi__find_pairs(const dvi__pencil_of_all *pencil, PetscInt count, dvi__pairs *pairs)
{
  (void)pencil;
  (void)count;
  (void)pairs;
  return refuse();
}

dvi_status dvi__estimate_next(const dvi__pencil_of_all *pencil, const dvi__pairs *pairs,
                              double *distance)
{
  (void)pencil;
  (void)pairs;
  (void)distance;
  return refuse();
}
