/* Points for tests of the group's functions: random vectors, and the lengths at which formulas are
 * apt to break. */
#ifndef TEST_GROUP_POINTS_H
#define TEST_GROUP_POINTS_H
#include <float.h>
#include <math.h>
#include <stdint.h>

#define PI 3.14159265358979323846

enum { SPECIAL_ANGLES = 12, POINTS = 3000 };

static inline double special_angle(int i)
{
  const double angle[SPECIAL_ANGLES] = {0,          1e-300,    1e-160,    1e-8,
                                        1e-4,       sqrt(2.5), PI - 1e-4, PI - 1e-8,
                                        PI - 1e-16, PI,        PI + 1e-8, 2 * PI - 1e-3};
  return angle[i];
}

/* Uniform in (-1, 1). */
static inline double uniform(uint64_t *seed)
{
  *seed += 0x9e3779b97f4a7c15u;
  uint64_t z = *seed;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

/* Gives a vector of this length in a random direction. */
static inline void random_vector(uint64_t *seed, double length, double w[3])
{
  double size = 0;
  while (!(size > 0.01 && size <= 1)) {
    for (int i = 0; i < 3; i++) w[i] = uniform(seed);
    size = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  }
  for (int i = 0; i < 3; i++) w[i] *= length / size;
}

/* Gives point `i`. The special lengths come in turn, with axes of coordinates among the directions,
 * then random lengths below `longest`. */
static inline void point(int i, double longest, uint64_t *seed, double w[3])
{
  random_vector(seed,
                i < 20 * SPECIAL_ANGLES ? special_angle(i % SPECIAL_ANGLES)
                                        : longest * fabs(uniform(seed)),
                w);
  if (i >= 6 * SPECIAL_ANGLES) return;
  const double length = special_angle(i % SPECIAL_ANGLES);
  for (int j = 0; j < 3; j++)
    w[j] = j == (i / SPECIAL_ANGLES) % 3 ? (i / SPECIAL_ANGLES < 3 ? length : -length) : 0;
}

#endif
