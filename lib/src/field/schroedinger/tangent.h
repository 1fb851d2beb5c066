/* The bordered matrix of Newton's method for a state of a norm on sparse spaces. */
#ifndef DVI_FIELD_SCHROEDINGER_TANGENT_H
#define DVI_FIELD_SCHROEDINGER_TANGENT_H
#include "field/schroedinger/schroedinger.h"

typedef struct dvi__tangent dvi__tangent;

dvi_status dvi__tangent_create(const dvi_schroedinger *s, dvi__tangent **made);
void dvi__tangent_destroy(dvi__tangent **tangent);

/* Solve (T + V) x - c y = b with c.x = 0 for x [free] and y. V is [points]. DVI_SINGULAR. */
dvi_status dvi__tangent_solve(dvi__tangent *tangent, const double *V, const double *c,
                              const double *b, double *x);

#endif
