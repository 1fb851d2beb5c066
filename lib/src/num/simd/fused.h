/* Functions full of fused multiply-adds, compiled also for processors that have them as an
 * instruction, because elsewhere each is a call. The bits are the same. FUSED is for static
 * functions. The processor chooses when the program starts. gcc's thread sanitizer cannot watch
 * that yet. */
#ifndef DVI_NUM_SIMD_FUSED_H
#define DVI_NUM_SIMD_FUSED_H

#if defined(__x86_64__) && defined(__gnu_linux__) && \
    (!defined(__clang__) || __clang_major__ >= 14) && !defined(__SANITIZE_THREAD__)
#define FUSED __attribute__((target_clones("fma", "default")))
#else
#define FUSED
#endif

/* For functions that are compiled into such functions. */
#define FUSED_INLINE static inline __attribute__((always_inline))

#endif
