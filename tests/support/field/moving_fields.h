/* Fields on moving meshes: the sine-Gordon field, and one whose waves break. */
#ifndef TESTS_SUPPORT_FIELD_MOVING_FIELDS_H
#define TESTS_SUPPORT_FIELD_MOVING_FIELDS_H
#include <dvi/moving.h>

/* u_t^2/2 - u_x^2/2, and that with cos u - 1 at quadrature points. */
extern const dvi_density_part free_wave, sine_gordon;

/* The mean of cos u - 1 over cells. */
extern const dvi_moving_mean sine_gordon_mean;

/* u_t^2/2 - (1 + u_x)^4/12, the field with u_tt = (1 + u_x)^2 u_xx. */
extern const dvi_density_part breaking;

/* The kink 4 atan exp(g (x - v t - x0)), g = 1/sqrt(1 - v^2), as a wave at t = 0. `user` is a kink.
 * The nodes move with it. */
typedef struct kink {
  double v, x0;
} kink;
double kink_value(const kink *k, double t, double x);
dvi_moving_wave kink_wave;

#endif
