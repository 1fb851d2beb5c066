/* Grids of parameters. */
#ifndef DVI_STUDY_GRID_H
#define DVI_STUDY_GRID_H
#include <dvi/study.h>

/* Find the indices [axes] and the values [axes] of a point. */
void dvi__grid_at(int axes, const dvi_study_axis *axis, int64_t number, int64_t *index,
                  double *value);
#endif
