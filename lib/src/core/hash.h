/* A hash of bytes: FNV-1a, for telling files and systems apart, not for security. */
#ifndef DVI_CORE_HASH_H
#define DVI_CORE_HASH_H
#include <stddef.h>
#include <stdint.h>

#define DVI__HASH_START UINT64_C(14695981039346656037)

static inline uint64_t dvi__hash(uint64_t hash, size_t count, const void *bytes)
{
  const unsigned char *byte = bytes;
  for (size_t i = 0; i < count; i++) hash = (hash ^ byte[i]) * UINT64_C(1099511628211);
  return hash;
}

#endif
