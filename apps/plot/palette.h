/** Colours of maps. */
#ifndef PALETTE_H
#define PALETTE_H
#include <stdio.h>

/** Set gnuplot's colours for values from least to most: from blue by white to red, with white at
 * 0, for values of both signs, and from dark to light for those of one sign. Greys for values that
 * are all the same. */
void palette_set(FILE *script, double least, double most);
#endif
