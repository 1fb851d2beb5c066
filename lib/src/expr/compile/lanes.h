/* Loops over lanes, compiled for several instruction sets. libdvi chooses one for the whole program
 * (num/simd/lanes.h). All give the same bits. No sums are reordered, and -ffp-contract=off keeps
 * products and sums apart. */
#ifndef DVI_EXPR_COMPILE_LANES_H
#define DVI_EXPR_COMPILE_LANES_H

#include "num/simd/lanes.h"

/* Define the function `name` by versions of the function name_body, one for each instruction
 * set. */
#ifdef __x86_64__
#define DVI__EXPR_VERSIONS(name, parameters, arguments)                                         \
  static void name##_baseline parameters                                                        \
  {                                                                                             \
    name##_body arguments;                                                                      \
  }                                                                                             \
  __attribute__((target("avx2,fma"))) static void name##_avx2 parameters                        \
  {                                                                                             \
    name##_body arguments;                                                                      \
  }                                                                                             \
  __attribute__((target("fma,avx512f,avx512dq,avx512vl"))) static void name##_avx512 parameters \
  {                                                                                             \
    name##_body arguments;                                                                      \
  }                                                                                             \
  static void name parameters                                                                   \
  {                                                                                             \
    const int level = dvi__lanes_level();                                                       \
    (level == 2 ? name##_avx512 : level == 1 ? name##_avx2 : name##_baseline) arguments;        \
  }
#else
#define DVI__EXPR_VERSIONS(name, parameters, arguments) \
  static void name parameters                           \
  {                                                     \
    name##_body arguments;                              \
  }
#endif

/* Mark a loop of which no step writes what another one reads. gcc does not believe restrict inside
 * of functions. */
#if defined(__GNUC__) && !defined(__clang__)
#define DVI__EXPR_INDEPENDENT _Pragma("GCC ivdep")
#else
#define DVI__EXPR_INDEPENDENT
#endif

/* Compile a function into its callers, once for each of their instruction sets. */
#define DVI__EXPR_INLINE static inline __attribute__((always_inline))

#endif
