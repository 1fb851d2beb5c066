/* Modes of fields that processes share. */
#ifndef DVI_PETSC_MODES_H
#define DVI_PETSC_MODES_H
#include "problem.h"

typedef struct dvi__modes_request {
  dvi_division *division;
  const dvi_field *field;
  const dvi_modes_options *options;
  int64_t most; /* unknowns of a mesh in space for a factor. More are iterated where they can be */
} dvi__modes_request;

/* Find modes, as dvi_division_modes does. */
dvi_status dvi__find_modes(const dvi__modes_request *request, double *eigenvalue, double *mode,
                           dvi_modes_facts *facts);

#endif
