/* Random bits by Philox4x32-10 (Salmon et al. 2011): ten rounds of multiplications that scramble a
 * counter of 128 bits under a key of 64. No state is kept, so that the bits of any counter are the
 * same in any order, on any thread, and after any restart. */
#ifndef DVI_NUM_PHILOX_H
#define DVI_NUM_PHILOX_H
#include <stdint.h>

enum { DVI__PHILOX_ROUNDS = 10 };

/* Replace the counter x[4] by its random bits. */
static inline void dvi__philox(uint32_t x[4], uint64_t key)
{
  uint32_t k0 = (uint32_t)key, k1 = (uint32_t)(key >> 32);
  for (int round = 0; round < DVI__PHILOX_ROUNDS; round++) {
    const uint64_t a = (uint64_t)x[0] * UINT32_C(0xD2511F53),
                   b = (uint64_t)x[2] * UINT32_C(0xCD9E8D57);
    x[0] = (uint32_t)(b >> 32) ^ x[1] ^ k0;
    x[1] = (uint32_t)b;
    x[2] = (uint32_t)(a >> 32) ^ x[3] ^ k1;
    x[3] = (uint32_t)a;
    k0 += UINT32_C(0x9E3779B9); /* the golden ratio */
    k1 += UINT32_C(0xBB67AE85); /* sqrt(3) - 1 */
  }
}

#endif
