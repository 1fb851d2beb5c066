/* What PETSc counts of messages in this process. */
#ifndef DVI_PETSC_TRAFFIC_H
#define DVI_PETSC_TRAFFIC_H
#include <stdint.h>

/* As dvi_division_traffic, whose header comes before PETSc's alone. */
typedef struct dvi__traffic {
  int64_t messages, bytes, sums, gathers;
} dvi__traffic;

/* Give what has been received since the process began. */
dvi__traffic dvi__traffic_so_far(void);

/* Give what `now` has beyond `before`. */
dvi__traffic dvi__traffic_since(dvi__traffic now, dvi__traffic before);

#endif
