/* The geometry of obstacles. */
#ifndef DVI_FIELD_ELASTIC_CONTACTS_H
#define DVI_FIELD_ELASTIC_CONTACTS_H
#include <dvi/elastic.h>

/* Give the gap at x [n], below 0 inside of the obstacle, and its gradient, a unit vector [n]. At the
 * centre of a ball it is that of the first axis. */
double dvi__solid_gap(const dvi_obstacle *o, int n, const double *x, double *normal);

#endif
