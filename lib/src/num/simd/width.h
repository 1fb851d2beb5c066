/* Functions that are compiled once for each width of vectors. A file defines WIDTH and includes the
 * header that holds them. */
#ifndef DVI_NUM_SIMD_WIDTH_H
#define DVI_NUM_SIMD_WIDTH_H

#define INLINE static inline __attribute__((always_inline))
#define JOIN(a, b) a##b
#define JOIN_EXPANDED(a, b) JOIN(a, b)
#define NAME(name) JOIN_EXPANDED(name, WIDTH)

#endif
