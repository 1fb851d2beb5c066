/* Hashes of bytes (FNV-1a) and weighted sums of numbers. They tell files and systems apart, and are
 * not meant for security. */
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

/* Return the weight of a number in a sum. Sums, unlike hashes, tolerate numbers that are rounded
 * otherwise. The weights lie in [1,2), and no two are equal, so numbers that change places change
 * the sum, too. */
static inline double dvi__weight(size_t place)
{
  const double golden = 0.61803398874989485;
  return 1 + fmod((double)(place + 1) * golden, 1);
}

#endif
