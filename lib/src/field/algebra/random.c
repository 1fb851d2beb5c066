/* A linear congruential generator modulo 2^64, with Knuth's multiplier (Knuth 1997, sec. 3.3.4). */
#include "field/algebra/random.h"

uint64_t dvi__fill_random(int64_t count, uint64_t seed, double *values)
{
  for (int64_t i = 0; i < count; i++) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    values[i] = (double)(int64_t)(seed >> 11) / 9007199254740992.0 - 0.5;
  }
  return seed;
}
