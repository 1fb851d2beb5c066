#include "field/mesh/delaunay/order.h"

#include <stdlib.h>

#include "core/memory.h"

enum { HILBERT_BITS = 58 };

typedef struct place {
  uint64_t key;
  int point;
} place;

/* Turn and mirror the cubes so that their corners follow each other (Skilling 2004). */
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

/* Give the place of a point on Hilbert's curve. */
static uint64_t place_on_curve(int n, const double *point)
{
  const int bits = HILBERT_BITS / n;
  uint32_t x[DVI_MESH_DIMENSION_MAX];
  uint64_t key = 0;
  for (int l = 0; l < n; l++) {
    const double part = (point[l] + 1) / 2 * (double)(UINT32_C(1) << bits);
    const uint32_t last = (UINT32_C(1) << bits) - 1;
    x[l] = part < last ? (uint32_t)part : last;
  }
  follow_hilbert(n, bits, x);
  for (int bit = bits - 1; bit >= 0; bit--)
    for (int l = 0; l < n; l++) key = key << 1 | (x[l] >> bit & 1);
  return key;
}

/* Give the round of a point, counted from the last one: 0 for 7 of 8 points, and so on. */
static int round_of(uint64_t point)
{
  uint64_t bits = (point + 1) * UINT64_C(0x9E3779B97F4A7C15); /* the golden ratio */
  bits ^= bits >> 32;
  bits *= UINT64_C(0xD6E8FEB86659FD93);
  bits ^= bits >> 32;
  int round = 0;
  for (; round < 15 && (bits & 7) == 0; round++) bits >>= 3;
  return round;
}

static int compare_places(const void *left, const void *right)
{
  const place *a = left, *b = right;
  if (a->key != b->key) return a->key < b->key ? -1 : 1;
  return (a->point > b->point) - (a->point < b->point);
}

int *dvi__insertion_order(const dvi__sites *sites)
{
  place *places = DVI_NEW(place, sites->points);
  int *order = DVI_NEW(int, sites->points);
  for (int i = 0; places != NULL && i < sites->points; i++) {
    const uint64_t late = (uint64_t)(15 - round_of((uint64_t)i));
    places[i].point = i;
    places[i].key = late << HILBERT_BITS |
                    place_on_curve(sites->n, sites->x + (int64_t)i * sites->n);
  }
  if (places != NULL && order != NULL) {
    qsort(places, (size_t)sites->points, sizeof *places, compare_places);
    for (int64_t i = 0; i < sites->points; i++) order[i] = places[i].point;
  }
  if (places == NULL) {
    dvi__release(order);
    order = NULL;
  }
  dvi__release(places);
  return order;
}
