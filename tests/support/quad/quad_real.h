/* Real numbers of 128 bits are __float128 with libquadmath on x86, or long double where that has
 * 113 bits (aarch64). */
#ifndef SUPPORT_QUAD_REAL_H
#define SUPPORT_QUAD_REAL_H
#include <float.h>

#if LDBL_MANT_DIG == 113

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
typedef long double quad;
#define quad_sqrt sqrtl
#define quad_sin sinl
#define quad_cos cosl
#define quad_acos acosl
#define quad_exp expl
#define quad_log logl
#define quad_abs fabsl
#define quad_parse strtold
#define quad_print snprintf
#define QUAD_FORMAT "%.29Le"

#elif defined(__SIZEOF_FLOAT128__)

/* Declared here because clang finds libquadmath but not its header. */
#include <stddef.h>
typedef __float128 quad;
quad sqrtq(quad);
quad sinq(quad);
quad cosq(quad);
quad acosq(quad);
quad expq(quad);
quad logq(quad);
quad fabsq(quad);
quad strtoflt128(const char *, char **);
int quadmath_snprintf(char *, size_t, const char *, ...);
#define quad_sqrt sqrtq
#define quad_sin sinq
#define quad_cos cosq
#define quad_acos acosq
#define quad_exp expq
#define quad_log logq
#define quad_abs fabsq
#define quad_parse strtoflt128
#define quad_print quadmath_snprintf
#define QUAD_FORMAT "%.29Qe"

#else
#error "the quadruple-precision judge needs a 128-bit floating-point type"
#endif
#endif
