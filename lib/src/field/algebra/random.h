/* Numbers at random for starts of iterations and for tests of laws. */
#ifndef DVI_FIELD_ALGEBRA_RANDOM_H
#define DVI_FIELD_ALGEBRA_RANDOM_H
#include <stdint.h>

/* Fill in numbers from -1/2 to 1/2, which only depend on the seed. Returns a seed for the next. */
uint64_t dvi__fill_random(int64_t count, uint64_t seed, double *values);

#endif
