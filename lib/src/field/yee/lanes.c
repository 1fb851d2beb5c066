#include "field/yee/lanes.h"

#include <stdint.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "num/simd/width.h"

typedef enum dvi__yee_matter { DVI__YEE_VACUUM, DVI__YEE_MATTER, DVI__YEE_LOSSY } dvi__yee_matter;

#define LOOPS "field/yee/lanes_width.h"
#include "num/simd/each_width.h"

/* Choose the loop, in which the metric and the matter are known at compile time. */
#define EDGES_OF(width, row, metric)            \
  if ((row)->ca != NULL)                        \
    edges##width(row, metric, DVI__YEE_LOSSY);  \
  else if ((row)->ce != NULL)                   \
    edges##width(row, metric, DVI__YEE_MATTER); \
  else                                          \
    edges##width(row, metric, DVI__YEE_VACUUM);

#define LEVEL(suffix, target, width)                                                              \
  target static void faces_##suffix(const dvi__yee_faces_row *row)                                \
  {                                                                                               \
    faces##width(row);                                                                            \
  }                                                                                               \
  target static void edges_##suffix(const dvi__yee_edges_row *row)                                \
  {                                                                                               \
    switch (row->metric) {                                                                        \
    case DVI__YEE_EQUAL: EDGES_OF(width, row, DVI__YEE_EQUAL) break;                              \
    case DVI__YEE_ACROSS: EDGES_OF(width, row, DVI__YEE_ACROSS) break;                            \
    case DVI__YEE_P_ALONG: EDGES_OF(width, row, DVI__YEE_P_ALONG) break;                          \
    case DVI__YEE_Q_ALONG: EDGES_OF(width, row, DVI__YEE_Q_ALONG) break;                          \
    }                                                                                             \
  }                                                                                               \
  target static void layers_##suffix(const dvi__yee_layers_row *row)                              \
  {                                                                                               \
    layers##width(row);                                                                           \
  }                                                                                               \
  target static void layers_end_##suffix(const dvi__yee_layers_end *end)                          \
  {                                                                                               \
    layers_end##width(end);                                                                       \
  }                                                                                               \
  target static void product_##suffix(size_t count, const double *mi, const double *b, double *h) \
  {                                                                                               \
    product##width(count, mi, b, h);                                                              \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2,fma"))), 4)
LEVEL(avx512, __attribute__((target("fma,avx512f,avx512dq,avx512vl"))), 8)
#endif

/* Levels in the order of num/simd/lanes.c. */
static const dvi__yee_lanes levels[] = {
    {faces_baseline, edges_baseline, layers_baseline, layers_end_baseline, product_baseline},
#ifdef __x86_64__
    {faces_avx2, edges_avx2, layers_avx2, layers_end_avx2, product_avx2},
    {faces_avx512, edges_avx512, layers_avx512, layers_end_avx512, product_avx512},
#endif
};

const dvi__yee_lanes *dvi__yee_lanes_in_use(void)
{
  return &levels[dvi__lanes_level()];
}
