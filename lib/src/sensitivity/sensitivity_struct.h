/* The members of a run with derivatives, for the files of this room. */
#ifndef DVI_SENSITIVITY_SENSITIVITY_STRUCT_H
#define DVI_SENSITIVITY_SENSITIVITY_STRUCT_H
#include "sensitivity/linear_step.h"

enum { DVI__SENSITIVITY_METHOD_SIZE = 256 };

struct dvi_sensitivity {
  const dvi_system *system;
  dvi_integrator *integrator;
  dvi_counters counters; /* of the derivatives alone */
  dvi__linear_step *linear;
  char method[DVI__SENSITIVITY_METHOD_SIZE];
  int n, s, r, parameters;
  int has_tangents;
  double *tangent; /* [2n * (2n + parameters)] by columns */
  double *next;    /* as tangent, those of a step that may fail */
  double *q, *Y;   /* [n], [n s] the path of the last step */
  double *offset;  /* [n s + n] work */
};

/* Take a step of the integrator. path becomes that of the step, of which q and Y stand in
 * `numbers` [n + n s]. */
dvi_status dvi__sensitivity_advance(dvi_sensitivity *sensitivity, double h, double *numbers,
                                    dvi__step_path *path);

#endif
