/* The roundoff of long double where the test runs, which LDBL_EPSILON does not always tell, because
 * emulators such as valgrind compute it as double. */
#ifndef TEST_SPACE_ROUNDOFF_H
#define TEST_SPACE_ROUNDOFF_H

#include <float.h>

static inline long double long_roundoff(void)
{
  volatile long double epsilon = 1, sum = 2;
  while (sum > 1) {
    epsilon /= 2;
    sum = 1 + epsilon;
  }
  return 2 * epsilon;
}

/* True if results can be right to the last places of a double. */
static inline int long_double_is_long(void)
{
  return long_roundoff() < (long double)DBL_EPSILON / 1000;
}

#endif
