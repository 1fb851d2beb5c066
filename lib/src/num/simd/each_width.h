/* Includes vector_width.h and LOOPS, a header in quotes, for vectors of 1, 2, 4 and 8 numbers.
 * Follows num/simd/width.h. */
#define WIDTH 1
#include "num/simd/vector_width.h"
#include LOOPS
#undef WIDTH
#define WIDTH 2
#include "num/simd/vector_width.h"
#include LOOPS
#undef WIDTH
#define WIDTH 4
#include "num/simd/vector_width.h"
#include LOOPS
#undef WIDTH
#define WIDTH 8
#include "num/simd/vector_width.h"
#include LOOPS
#undef WIDTH
#undef LOOPS
