/* Hashes of bytes, FNV-1a, and weights of numbers, for telling files and systems apart, not for
 * security. */
#ifndef DVI_CORE_HASH_H
#define DVI_CORE_HASH_H
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#define DVI__HASH_START UINT64_C(14695981039346656037)

static inline uint64_t dvi__hash(uint64_t hash, size_t count, const void *bytes)
{
  const unsigned char *byte = bytes;
  for (size_t i = 0; i < count; i++) hash = (hash ^ byte[i]) * UINT64_C(1099511628211);
  return hash;
}

/* Where numbers are computed and may be rounded otherwise, sums tell them apart: with weights in
 * [1,2), no two of which are equal, so that numbers that change places change the sum, too. */
static inline double dvi__weight(size_t place)
{
  const double golden = 0.61803398874989485;
  return 1 + fmod((double)(place + 1) * golden, 1);
}

#endif
