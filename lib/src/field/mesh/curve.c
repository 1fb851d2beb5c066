/* Hilbert's curve, by Skilling 2004. */
#include "field/mesh/curve.h"

#include <dvi/mesh.h>

/* Turn and mirror the cubes so that their corners follow each other. */
static void follow_hilbert(int n, int bits, uint32_t *x)
{
  const uint32_t top = UINT32_C(1) << ((unsigned)(bits - 1) % 32);
  uint32_t turn = 0;
  for (uint32_t bit = top; bit > 1; bit >>= 1)
    for (int i = 0; i < n; i++) {
      const uint32_t below = bit - 1, differ = (x[0] ^ x[i]) & below;
      x[0] ^= (x[i] & bit) != 0 ? below : differ;
      x[i] ^= (x[i] & bit) != 0 ? 0 : differ;
    }
  for (int i = 1; i < n; i++) x[i] ^= x[i - 1];
  for (uint32_t bit = top; bit > 1; bit >>= 1)
    if (x[n - 1] & bit) turn ^= bit - 1;
  for (int i = 0; i < n; i++) x[i] ^= turn;
}

uint64_t dvi__place_on_curve(int n, int bits, const double *point)
{
  uint32_t x[DVI_MESH_DIMENSION_MAX];
  uint64_t place = 0;
  for (int l = 0; l < n; l++) {
    const double part = (point[l] + 1) / 2 * (double)(UINT32_C(1) << bits);
    const uint32_t last = (UINT32_C(1) << bits) - 1;
    x[l] = part < last ? (uint32_t)part : last;
  }
  follow_hilbert(n, bits, x);
  for (int bit = bits - 1; bit >= 0; bit--)
    for (int l = 0; l < n; l++) place = place << 1 | (x[l] >> bit & 1);
  return place;
}
