/** A surface as pixels, each with what is nearest to the eye there. */
#ifndef RASTER_H
#define RASTER_H
#include "picture/skin.h"

/** The pixels. */
typedef struct raster {
  int width, height;
  double pixel;    /**< length of its side */
  double least[2]; /**< centre of the lower left pixel */
  double *value;   /**< [height][width] NaN where nothing is seen */
  double *depth;   /**< [height][width] towards the eye */
} raster;

/** Draw the faces with the values of a field, or without one with the cosines of their slopes, in
 * `pixels` along the longer side. Complains and returns false without memory. */
bool raster_make(const skin *s, const vtu_field *field, int pixels, raster *r);

/** Return whether something is clearly nearer to the eye than a turned point. */
bool raster_hides(const raster *r, const double *point);

void raster_clear(raster *r);
#endif
