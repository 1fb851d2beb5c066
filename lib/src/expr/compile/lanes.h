/* Loops over lanes, compiled for several instruction sets, of which the processor chooses when the
 * program starts. All give the same bits: no sums are reordered, and -ffp-contract=off keeps
 * products and sums apart. The choice is made before gcc's thread sanitizer can watch it. */
#ifndef DVI_EXPR_LANES_H
#define DVI_EXPR_LANES_H

#if defined(__x86_64__) && defined(__gnu_linux__) && \
    (!defined(__clang__) || __clang_major__ >= 14) && !defined(__SANITIZE_THREAD__)
#define DVI__EXPR_LANES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define DVI__EXPR_LANES
#endif

/* Before a loop of which no step writes what another one reads: restrict inside of functions does
 * not convince gcc. */
#if defined(__GNUC__) && !defined(__clang__)
#define DVI__EXPR_INDEPENDENT _Pragma("GCC ivdep")
#else
#define DVI__EXPR_INDEPENDENT
#endif

/* Compiled into its callers, once for each of their instruction sets. */
#define DVI__EXPR_INLINE static inline __attribute__((always_inline))

#endif
