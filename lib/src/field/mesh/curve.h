/* A curve that fills a cube. */
#ifndef DVI_FIELD_MESH_CURVE_H
#define DVI_FIELD_MESH_CURVE_H
#include <stdint.h>

/* Give the place of a point of [-1, 1]^n on Hilbert's curve, with n*bits bits, at most 64. Points
 * whose places are close to each other are so in space. n is at most DVI_MESH_DIMENSION_MAX. */
uint64_t dvi__place_on_curve(int n, int bits, const double *point);

#endif
