/* Numbers of several members of an ensemble abreast, as one value. Code on them reads like that for
 * one member, and every member sees its operations. Functions get pointers to them, because as
 * arguments they would have another calling convention on every target. */
#ifndef DVI_NUM_SIMD_ABREAST_H
#define DVI_NUM_SIMD_ABREAST_H
#include <stdint.h>

#include "num/simd/wide.h"
#include "num/simd/width.h"

/* As many as the vectors of WIDE functions hold. gcc 12 works on longer ones in memory. */
enum { DVI__ABREAST = 4 };

typedef double dvi__abreast __attribute__((vector_size(DVI__ABREAST * sizeof(double)), may_alias));
typedef int64_t dvi__abreast_mask
    __attribute__((vector_size(DVI__ABREAST * sizeof(double)), may_alias));

/* Replace most by max(most, |x|). Magnitudes are ordered as their bits are, with NaN above all
 * numbers, so that NaN stays. */
INLINE void abreast_larger(dvi__abreast *most, const dvi__abreast *x)
{
  const dvi__abreast_mask magnitude = (dvi__abreast_mask)*x & INT64_MAX,
                          take = magnitude > (dvi__abreast_mask)*most;
  *most = (dvi__abreast)((take & magnitude) | (~take & (dvi__abreast_mask)*most));
}

/* Replace x by y where the mask is -1. */
INLINE void abreast_replace(const dvi__abreast_mask *where, const dvi__abreast *y, dvi__abreast *x)
{
  *x = (dvi__abreast)((*where & (dvi__abreast_mask)*y) | (~*where & (dvi__abreast_mask)*x));
}

#endif
