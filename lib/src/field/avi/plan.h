/* The steps of the faces. */
#ifndef DVI_FIELD_AVI_PLAN_H
#define DVI_FIELD_AVI_PLAN_H
#include "field/avi/avi.h"

/* By the user's numbers of cells. */
typedef struct dvi__avi_plan {
  int *sharing;      /* [edges] faces with events at each edge */
  double *strongest; /* [edges] largest M2 of its faces */
  double *bound;     /* [faces] longest stable step of a face by itself. Infinite without events */
  double *step;      /* [faces] infinite without events */
  int *face_class;   /* [faces] log2 of the step beside the shortest one. 0 for free steps */
  int classes;
  double shortest, longest, tightest; /* steps, and the least bound */
  int64_t tightest_face;
} dvi__avi_plan;

/* Make the plan. On failure nothing is owned. */
dvi_status dvi__avi_plan_make(const dvi__avi_terms *terms, dvi__avi_plan *plan);
void dvi__avi_plan_clear(dvi__avi_plan *plan);

#endif
