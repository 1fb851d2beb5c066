/* Steps of their own for all cells: the options, and the common period. */
#ifndef DVI_FIELD_STEP_CLASSES_H
#define DVI_FIELD_STEP_CLASSES_H
#include <dvi/status.h>
#include <stdint.h>

/* Read "classes=yes" or "no", and "band=NUMBER". What is not told stays. DVI_BAD_OPTION. */
dvi_status dvi__read_classes(const char *text, int *is_free, double *band);

/* Give the common period of steps between `shortest` and `longest`, or 0 if their ratios are no
 * fractions with denominators up to 64, or if it is above a thousand of the longest one. */
double dvi__common_period(int64_t count, const double *step, double shortest, double longest);

#endif
