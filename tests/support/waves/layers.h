/* Frequencies of layers of dielectrics between walls, in one dimension, exactly. The speed of light
 * is 1. */
#ifndef SUPPORT_WAVES_LAYERS_H
#define SUPPORT_WAVES_LAYERS_H

/* A homogeneous layer. */
typedef struct layer {
  double thickness, eps, mu, sigma;
} layer;

/* What stands behind the last layer. A wall that conducts stands before the first one. */
typedef enum layer_end { LAYER_CONDUCTOR, LAYER_MAGNETIC_WALL, LAYER_VACUUM } layer_end;

/* Find the mode exp(-decay t) cos(frequency t + ..) nearest to a guess. Returns 1 if the iteration
 * settled. */
int layers_mode(int count, const layer *layers, layer_end end, double guess, double *frequency,
                double *decay);

/* Find the lowest frequencies of layers without loss between walls. */
void layers_frequencies(int count, const layer *layers, layer_end end, int most, double *frequency);

#endif
