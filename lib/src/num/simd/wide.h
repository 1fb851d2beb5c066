/* Functions that are compiled also for processors with wider vectors. The bits are the same. WIDE
 * is for static functions, whose names occur once in the library, because clang makes the choice
 * between the versions global. The processor chooses when the program starts. gcc's thread
 * sanitizer cannot watch that yet. */
#ifndef DVI_NUM_SIMD_WIDE_H
#define DVI_NUM_SIMD_WIDE_H

#if defined(__x86_64__) && defined(__gnu_linux__) && \
    (!defined(__clang__) || __clang_major__ >= 14) && !defined(__SANITIZE_THREAD__)
#define WIDE __attribute__((target_clones("avx2", "default")))
#else
#define WIDE
#endif

#endif
