/* The loops of lanes.c for vectors of WIDTH numbers, after vector_width.h. lanes.c includes this
 * header once for each width. */
#include "num/simd/kick_drift_width.h"

INLINE double NAME(largest_of)(const NAME(vector) * x)
{
  double largest = 0;
  for (int i = 0; i < WIDTH; i++) largest = (*x)[i] > largest ? (*x)[i] : largest;
  return largest;
}

/* Add matrix_k x_k to sum in WIDTH lanes. */
INLINE void NAME(add_column)(int lanes, const double *matrix, const double *x, int k,
                             NAME(vector) * sum)
{
  NAME(vector) column;
  NAME(load)(matrix + (size_t)k * (size_t)lanes, &column);
  *sum += column * x[k];
}

/* Multiply WIDTH lanes of one row. Eight terms and more are four sums, which do not wait for each
 * other. */
INLINE void NAME(row)(int terms, int lanes, const double *matrix, const double *x,
                      NAME(vector) * out)
{
  NAME(vector) sum[4] = {{0}, {0}, {0}, {0}};
  int k = 0;
  for (; terms >= 8 && k < 4; k++) {
    NAME(load)(matrix + (size_t)k * (size_t)lanes, &sum[k]);
    sum[k] *= x[k];
  }
  for (; terms >= 8 && k + 4 <= terms; k += 4)
    for (int j = 0; j < 4; j++) NAME(add_column)(lanes, matrix, x, k + j, &sum[j]);
  for (; k < terms; k++) NAME(add_column)(lanes, matrix, x, k, &sum[0]);
  *out = terms >= 8 ? (sum[0] + sum[1]) + (sum[2] + sum[3]) : sum[0];
}

INLINE void NAME(product)(int n, int terms, int lanes, int width, const double *restrict matrix,
                          const double *restrict x, double *restrict out)
{
  for (size_t i = 0; i < (size_t)n; i++)
    for (int b = 0; b < width; b += WIDTH) {
      NAME(vector) sum;
      NAME(row)(terms, lanes, matrix + b, x + i * (size_t)terms, &sum);
      NAME(store)(out + i * (size_t)width + b, &sum, width - b);
    }
}

/* Weigh all forces before the first is used. Then the products read them from memory, lane by lane,
 * at no cost. */
INLINE void NAME(weigh)(int n, const int stages, const double *restrict weight,
                        double *restrict force)
{
  for (size_t i = 0; i < (size_t)n; i++, force += stages)
    for (int j = 0; j < stages; j++) force[j] *= weight[j];
}

/* Make one row of an iteration, from its sums of forces to its new offsets and places. */
INLINE void NAME(place)(const dvi__fixed_point *s, size_t i, int b, const NAME(vector) * c,
                        const NAME(vector) * sum, double *Z, double *Q, NAME(vector) * change,
                        NAME(vector) * largest)
{
  NAME(vector) before;
  NAME(load)(Z, &before);
  const NAME(vector) next = s->start[i] * *c + (s->factor[i] * *sum + s->low[i] * *c);
  const NAME(vector) moved = before - next, at = s->origin[i] + next;
  NAME(larger)(change, &moved);
  NAME(larger)(largest, &next);
  NAME(store)(Z, &next, WIDTH);
  NAME(store)(Q, &at, s->stages - b);
}

/* Begin with the sums of forces in Z. */
INLINE void NAME(begin)(const dvi__fixed_point *s)
{
  NAME(vector) change = {0}, largest = {0};
  for (size_t i = 0; i < (size_t)s->n; i++)
    for (int b = 0; b < s->lanes; b += WIDTH) {
      double *Z = s->Z + i * (size_t)s->lanes + b;
      NAME(vector) sum, c;
      NAME(load)(Z, &sum);
      NAME(load)(s->node + b, &c);
      NAME(place)(s, i, b, &c, &sum, Z, s->Q + i * (size_t)s->stages + b, &change, &largest);
    }
}

INLINE void NAME(iterate)(dvi__fixed_point *s)
{
  const size_t stages = (size_t)s->stages, lanes = (size_t)s->lanes;
  NAME(vector) change = {0}, largest = {0};
  NAME(weigh)(s->n, s->stages, s->weight, s->force);
  for (size_t i = 0; i < (size_t)s->n; i++)
    for (int b = 0; b < s->lanes; b += WIDTH) {
      NAME(vector) sum, c;
      NAME(row)(s->stages, s->lanes, s->matrix + b, s->force + i * stages, &sum);
      NAME(load)(s->node + b, &c);
      NAME(place)
      (s, i, b, &c, &sum, s->Z + i * lanes + (size_t)b, s->Q + i * stages + (size_t)b, &change,
       &largest);
    }
  s->change = NAME(largest_of)(&change);
  s->largest = NAME(largest_of)(&largest);
}

/* Iterate for five to eight stages, known at compile time. The matrix' columns stay in registers
 * while the loop passes over the coordinates. */
INLINE void NAME(iterate_known)(dvi__fixed_point *iteration, const int stages)
{
  const dvi__fixed_point own = *iteration, *s = &own; /* a copy, which nothing else writes */
  NAME(vector) change = {0}, largest = {0};
  NAME(weigh)(s->n, stages, s->weight, s->force);
  for (int b = 0; b < 8; b += WIDTH) {
    NAME(vector) column[8], c;
    for (int j = 0; j < stages; j++) NAME(load)(s->matrix + 8 * j + b, &column[j]);
    NAME(load)(s->node + b, &c);
    for (size_t i = 0; i < (size_t)s->n; i++) {
      const double *g = s->force + (size_t)stages * i;
      NAME(vector) sum = {0}, four[4];
      for (int j = 0; j < 4 && stages == 8; j++)
        four[j] = column[j] * g[j] + column[j + 4] * g[j + 4];
      for (int j = 0; j < stages && stages < 8; j++) sum += column[j] * g[j];
      if (stages == 8) sum = (four[0] + four[1]) + (four[2] + four[3]);
      NAME(place)
      (s, i, b, &c, &sum, s->Z + 8 * i + b, s->Q + (size_t)stages * i + b, &change, &largest);
    }
  }
  iteration->change = NAME(largest_of)(&change);
  iteration->largest = NAME(largest_of)(&largest);
}
