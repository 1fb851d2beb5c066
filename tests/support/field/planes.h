/* Fields on meshes of triangles that move, and such meshes. */
#ifndef TESTS_SUPPORT_FIELD_PLANES_H
#define TESTS_SUPPORT_FIELD_PLANES_H
#include <dvi/moving.h>

/* (u_t^2 - |grad u|^2)/2, that with cos u - 1, and that with -|grad u|^4/4. */
extern const dvi_density_part plane_wave, plane_sine_gordon, plane_quartic;

/* -(|grad u|^2 + u^2)/2 + u_t^2/2. */
extern const dvi_density_part plane_massive;

/* Make Kuhn's mesh of a box, whose points `move` takes elsewhere. It may be NULL. */
dvi_mesh *plane_mesh(const dvi_generator_options *options, void (*move)(double *point, void *user),
                     void *user);

/* Move points by some 0.06, or a part of it, a double, alike in each period of 1. */
void shake(double *point, void *user);

/* A path of nodes with the period 1, about 0.03 to and fro. */
int plane_sway(int count, double t, const double *X, double *x, double *rate, void *user);

/* A wave with the period 1 whose nodes have the velocity (1, 0.3) times `user`, a double. */
dvi_moving_wave plane_bump;

/* A kink 4 atan exp(g (n.x - v t)), n = (1,1)/sqrt 2, that repeats itself after `period` along n,
 * as a wave at t = 0, and points that are graded by its slope. */
typedef struct plane_kink {
  double v, period;
} plane_kink;
double plane_kink_value(const plane_kink *k, double t, const double *x);
dvi_moving_wave plane_kink_wave;
void grade_for_kink(double *point, void *user);

#endif
