/* Marches by any method, for tests. What fails is reported. */
#ifndef TESTS_SUPPORT_FIELD_MARCHES_H
#define TESTS_SUPPORT_FIELD_MARCHES_H
#include <dvi/march.h>

void advance_march(dvi_march *march, double t);
double observe_march(const dvi_march *march, const char *name);
double step_of_march(const dvi_march *march);

/* Give all values of a form, in an array of the caller's, or in one for free(). */
void copy_march(const dvi_march *march, dvi_march_form form, double *values);
double *sample_march(const dvi_march *march, dvi_march_form form);

#endif
