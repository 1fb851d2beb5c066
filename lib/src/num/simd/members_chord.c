#include "num/simd/members_chord.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "num/simd/lanes.h"
#include "num/simd/members.h"
#include "num/simd/tails.h"
#include "num/simd/width.h"

#define LOOPS "num/simd/members_width.h"
#include "num/simd/each_width.h"

#define BY(suffix)                                                                             \
  INLINE void stages_by##suffix(const dvi__members_chord *c)                                   \
  {                                                                                            \
    ALL(suffix, product, c->n, c->s, c->lanes, c->r, c->psi, c->width, c->Y, c->Q);            \
    ALL(suffix, product, c->n, c->s, c->lanes, c->r, c->dpsi, c->width, c->Y, c->V);           \
    place_stages(c);                                                                           \
  }                                                                                            \
  INLINE void residual_by##suffix(const dvi__members_chord *c)                                 \
  {                                                                                            \
    weigh(c, c->L_q);                                                                          \
    weigh(c, c->L_v);                                                                          \
    ALL(suffix, product, c->n, c->r, c->path_lanes, c->s, c->bar_row, c->width, c->L_q, c->R); \
    ALL(suffix, product, c->n, c->r, c->path_lanes, c->s, c->slope_row, c->width, c->L_v,      \
        c->rows);                                                                              \
    add_rows(c);                                                                               \
  }                                                                                            \
  INLINE void correct_by##suffix(const dvi__members_chord *c)                                  \
  {                                                                                            \
    ALL(suffix, product, c->n, c->s, c->path_lanes, c->s, c->stiffness_row, c->width, c->R,    \
        c->rows);                                                                              \
    correct(c);                                                                                \
  }

INLINE void place_stages(const dvi__members_chord *c)
{
  const size_t width = (size_t)c->width;
  for (size_t row = 0; row < (size_t)c->n * (size_t)c->r; row++) {
    const double *restrict q0 = c->q0 + row / (size_t)c->r * width;
    double *restrict Q = c->Q + row * width, *restrict V = c->V + row * width;
    for (size_t k = 0; k < width; k++) Q[k] = q0[k] + Q[k];
    for (size_t k = 0; k < width; k++) V[k] = c->inverse_h * V[k];
  }
}

INLINE void weigh(const dvi__members_chord *c, double *restrict x)
{
  for (int i = 0; i < c->n; i++)
    for (int j = 0; j < c->r; j++, x += c->width)
      for (int k = 0; k < c->width; k++) x[k] *= c->weight[j];
}

INLINE void add_rows(const dvi__members_chord *c)
{
  const size_t width = (size_t)c->width;
  for (size_t row = 0; row < (size_t)c->n * (size_t)c->s; row++) {
    const double end = c->end[row % (size_t)c->s];
    const double *restrict p0 = c->p0 + row / (size_t)c->s * width, *restrict slope = c->rows +
                                                                                      row * width;
    double *restrict R = c->R + row * width;
    for (size_t k = 0; k < width; k++) R[k] = c->h * R[k] + (slope[k] - end * p0[k]);
  }
}

/* Multiply row k of all coordinates. */
INLINE void invert(const dvi__members_chord *c)
{
  const size_t width = (size_t)c->width, n = (size_t)c->n, s = (size_t)c->s;
  memset(c->rows, 0, n * s * width * sizeof(double));
  for (size_t j = 0; j < n; j++)
    for (size_t i = 0; i < n; i++)
      for (size_t l = 0; l < s; l++) {
        const double *restrict entry = c->inverse + (j * n + i) * width, *restrict R = c->R +
                                                                                       (j * s + l) *
                                                                                           width;
        double *restrict sum = c->rows + (i * s + l) * width;
        for (size_t k = 0; k < width; k++) sum[k] += entry[k] * R[k];
      }
  memcpy(c->R, c->rows, n * s * width * sizeof(double));
}

/* Replace most by the larger magnitude. Magnitudes are ordered as their bits are, with NaN above
 * all numbers (num/simd/lanes.c). */
INLINE void larger_magnitudes(size_t width, const double *restrict x, double *restrict most)
{
  for (size_t k = 0; k < width; k++) {
    int64_t here, there;
    memcpy(&here, x + k, sizeof here);
    memcpy(&there, most + k, sizeof there);
    here &= INT64_MAX;
    there = here > there ? here : there;
    memcpy(most + k, &there, sizeof there);
  }
}

INLINE void subtract(const dvi__members_chord *c)
{
  const size_t width = (size_t)c->width;
  memset(c->change, 0, width * sizeof(double));
  memset(c->largest, 0, width * sizeof(double));
  for (size_t row = 0; row < (size_t)c->n * (size_t)c->s; row++) {
    const double *restrict R = c->R + row * width;
    double *restrict Y = c->Y + row * width;
    for (size_t k = 0; k < width; k++) Y[k] -= R[k];
    larger_magnitudes(width, R, c->change);
    larger_magnitudes(width, Y, c->largest);
  }
  for (size_t k = 0; k < width; k++)
    if (isnan(c->largest[k])) c->change[k] = HUGE_VAL;
}

INLINE void correct(const dvi__members_chord *c)
{
  const size_t numbers = (size_t)c->n * (size_t)c->s * (size_t)c->width;
  const double *restrict from = c->rows;
  double *restrict R = c->R;
  for (size_t i = 0; i < numbers; i++) R[i] = c->h * from[i];
  subtract(c);
}

BY(2)
BY(4)
BY(8)

/* ---- inverses ---- */

/* Least magnitude of a pivot beside the largest entry of its row. Six digits are lost then. */
static const double least_pivot = 1e-6;

/* Tell whether the pivots of row p are sound, before that row is eliminated. `largest` is that of
 * the row at first. */
INLINE void test_pivots(size_t width, const double *restrict pivot, const double *restrict largest,
                        char *restrict sound)
{
  for (size_t k = 0; k < width; k++) sound[k] &= fabs(pivot[k]) >= least_pivot * largest[k];
}

/* Eliminate by row p (Gauss and Jordan, in place). */
INLINE void eliminate(size_t n, size_t width, size_t p, double *A)
{
  double *restrict pivot = A + (p * n + p) * width;
  for (size_t k = 0; k < width; k++) pivot[k] = 1.0 / pivot[k];
  for (size_t j = 0; j < n; j++) {
    double *restrict entry = A + (j * n + p) * width;
    for (size_t k = 0; k < width && j != p; k++) entry[k] *= pivot[k];
  }
  for (size_t i = 0; i < n; i++) {
    if (i == p) continue;
    double *restrict factor = A + (p * n + i) * width;
    for (size_t j = 0; j < n; j++) {
      const double *restrict from = A + (j * n + p) * width;
      double *restrict to = A + (j * n + i) * width;
      for (size_t k = 0; k < width && j != p; k++) to[k] -= factor[k] * from[k];
    }
    for (size_t k = 0; k < width; k++) factor[k] = -(factor[k] * pivot[k]);
  }
}

/* Eliminate in one matrix alone, whose rows are the lanes then. */
INLINE void eliminate_alone(size_t n, size_t p, double *A)
{
  double *restrict factor = A + p * n;
  const double pivot = 1.0 / factor[p];
  for (size_t j = 0; j < n; j++) {
    double *restrict column = A + j * n;
    if (j == p) continue;
    const double from = column[p] * pivot;
    for (size_t i = 0; i < n; i++) column[i] -= factor[i] * from;
    column[p] = from;
  }
  for (size_t i = 0; i < n; i++) factor[i] = -(factor[i] * pivot);
  factor[p] = pivot;
}

INLINE void inverse(size_t n, size_t width, double *A, double *largest, char *sound)
{
  memset(largest, 0, n * width * sizeof(double));
  memset(sound, 1, width);
  for (size_t e = 0; e < n * n; e++)
    larger_magnitudes(width, A + e * width, largest + e % n * width);
  for (size_t p = 0; p < n; p++) {
    test_pivots(width, A + (p * n + p) * width, largest + p * width, sound);
    if (width == 1)
      eliminate_alone(n, p, A);
    else
      eliminate(n, width, p, A);
  }
}

/* ---- instruction sets ---- */

typedef struct level {
  void (*stages)(const dvi__members_chord *c);
  void (*residual)(const dvi__members_chord *c);
  void (*invert)(const dvi__members_chord *c);
  void (*inverse)(size_t n, size_t width, double *A, double *largest, char *sound);
  void (*correct)(const dvi__members_chord *c);
  void (*subtract)(const dvi__members_chord *c);
} level;

#define LEVEL(suffix, target, by)                                                         \
  target static void stages_##suffix(const dvi__members_chord *c)                         \
  {                                                                                       \
    stages_by##by(c);                                                                     \
  }                                                                                       \
  target static void residual_##suffix(const dvi__members_chord *c)                       \
  {                                                                                       \
    residual_by##by(c);                                                                   \
  }                                                                                       \
  target static void invert_##suffix(const dvi__members_chord *c)                         \
  {                                                                                       \
    invert(c);                                                                            \
  }                                                                                       \
  target static void inverse_##suffix(size_t n, size_t width, double *A, double *largest, \
                                      char *sound)                                        \
  {                                                                                       \
    inverse(n, width, A, largest, sound);                                                 \
  }                                                                                       \
  target static void correct_##suffix(const dvi__members_chord *c)                        \
  {                                                                                       \
    correct_by##by(c);                                                                    \
  }                                                                                       \
  target static void subtract_##suffix(const dvi__members_chord *c)                       \
  {                                                                                       \
    subtract(c);                                                                          \
  }

LEVEL(baseline, , 2)
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2,fma"))), 4)
LEVEL(avx512, __attribute__((target("fma,avx512f,avx512dq,avx512vl"))), 8)
#endif

/* Levels in the order of num/simd/lanes.c. */
static const level levels[] = {
    {stages_baseline, residual_baseline, invert_baseline, inverse_baseline, correct_baseline,
     subtract_baseline},
#ifdef __x86_64__
    {stages_avx2, residual_avx2, invert_avx2, inverse_avx2, correct_avx2, subtract_avx2},
    {stages_avx512, residual_avx512, invert_avx512, inverse_avx512, correct_avx512,
     subtract_avx512},
#endif
};

static const level *level_in_use(void)
{
  return &levels[dvi__lanes_level()];
}

void dvi__members_chord_stages(const dvi__members_chord *chord)
{
  level_in_use()->stages(chord);
}

void dvi__members_chord_residual(const dvi__members_chord *chord)
{
  level_in_use()->residual(chord);
}

void dvi__members_chord_invert(const dvi__members_chord *chord)
{
  level_in_use()->invert(chord);
}

void dvi__members_inverse(int n, int width, double *matrix, double *largest, char *sound)
{
  level_in_use()->inverse((size_t)n, (size_t)width, matrix, largest, sound);
}

void dvi__members_chord_correct(const dvi__members_chord *chord)
{
  level_in_use()->correct(chord);
}

void dvi__members_chord_subtract(const dvi__members_chord *chord)
{
  level_in_use()->subtract(chord);
}
