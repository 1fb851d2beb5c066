/* One step of Schroedinger's equation by each method. */
#ifndef DVI_FIELD_SCHROEDINGER_STEPS_H
#define DVI_FIELD_SCHROEDINGER_STEPS_H
#include "field/schroedinger/schroedinger.h"

enum { DVI__STAGES_MAX = 8 };

typedef struct dvi__schroedinger_method {
  int is_split;
  int stages; /* of Gauss */
  int order;  /* of split */
} dvi__schroedinger_method;

/* Read "midpoint", "gauss:stages=2", "split:order=4". DVI_BAD_OPTION, DVI_UNSUPPORTED. */
dvi_status dvi__schroedinger_read_method(const char *text, dvi__schroedinger_method *method);

/* A step of a length, with its factors and room. */
typedef struct dvi__gauss dvi__gauss;
typedef struct dvi__split dvi__split;

dvi_status dvi__gauss_create(const dvi_schroedinger *s, int stages, dvi__gauss **made);
void dvi__gauss_destroy(dvi__gauss **gauss);
dvi_status dvi__split_create(const dvi_schroedinger *s, int order, dvi__split **made);
void dvi__split_destroy(dvi__split **split);

/* Prepare steps of length h. Steps allocate nothing then. */
dvi_status dvi__gauss_prepare(dvi__gauss *gauss, double h);
dvi_status dvi__split_prepare(dvi__split *split, double h);

/* Advance z [2*free] by a step from t. What rounding drops of z is in `compensation`. Both are
 * unchanged on failure. DVI_NOT_CONVERGED, and as the potential fails. */
dvi_status dvi__gauss_step(dvi__gauss *gauss, double t, double *z, double *compensation);
dvi_status dvi__split_step(dvi__split *split, double t, double *z, double *compensation);

#endif
