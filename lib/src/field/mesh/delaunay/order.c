#include "field/mesh/delaunay/order.h"

#include <stdlib.h>

#include "core/memory.h"
#include "field/mesh/curve.h"

enum { HILBERT_BITS = 58 };

typedef struct place {
  uint64_t key;
  int point;
} place;

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
    places[i].key = late << HILBERT_BITS | dvi__place_on_curve(sites->n, HILBERT_BITS / sites->n,
                                                               sites->x + (int64_t)i * sites->n);
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
