/* The coefficient a of a div (a grad u), at points. */
#ifndef DVI_FIELD_MULTISCALE_COEFFICIENT_H
#define DVI_FIELD_MULTISCALE_COEFFICIENT_H
#include <dvi/status.h>
#include <stdint.h>

typedef struct dvi__coefficient {
  const char *name; /* of the object that asks, in messages */
  int axes;
  int (*function)(int64_t count, const double *x, double *a, void *user);
  void *user;
} dvi__coefficient;

/* Set a [count] to the coefficient at x [axes*count], axis by axis. DVI_CALLBACK_FAILED, or
 * DVI_NOT_FINITE if it is not positive and finite. */
dvi_status dvi__coefficient_sample(const dvi__coefficient *coefficient, int64_t count,
                                   const double *x, double *a);

/* Return how far two positive numbers are apart, as a share of the second one. */
double dvi__coefficient_defect(double coarse, double fine);

#endif
