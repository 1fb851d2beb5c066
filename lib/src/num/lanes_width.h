/* The loops of lanes.c for vectors of WIDTH numbers; it includes this once for each width.
 *
 * GCC and clang lower a vector that the target lacks to smaller ones, lane by lane: the same operations. Vectors are handed on by pointers: as
 * arguments they would have another calling convention on every target. */

typedef double NAME(vector) __attribute__((vector_size(WIDTH * sizeof(double))));
typedef int64_t NAME(mask) __attribute__((vector_size(WIDTH * sizeof(double))));

/* largest <- max(largest, |x|), lane by lane; NaN is not seen. */
INLINE void NAME(larger)(NAME(vector) * largest, const NAME(vector) * x)
{
  const NAME(mask) magnitude = (NAME(mask)) * x & INT64_MAX, take = (NAME(mask))((NAME(vector))magnitude > *largest);
  *largest = (NAME(vector))((take & magnitude) | (~take & (NAME(mask)) * largest));
}

INLINE double NAME(largest_of)(const NAME(vector) * x)
{
  double largest = 0;
  for (int i = 0; i < WIDTH; i++) largest = (*x)[i] > largest ? (*x)[i] : largest;
  return largest;
}

INLINE void NAME(load)(const double *x, NAME(vector) * loaded)
{
  memcpy(loaded, x, sizeof *loaded);
}

/* The first `count` lanes. */
INLINE void NAME(store)(double *out, const NAME(vector) * x, int count)
{
  if (count >= WIDTH) {
    memcpy(out, x, sizeof *x);
    return;
  }
  for (int i = 0; i < count; i++) out[i] = (*x)[i];
}

/* WIDTH lanes of one row of a product. */
INLINE void NAME(row)(int terms, int lanes, const double *matrix, const double *x, NAME(vector) * out)
{
  NAME(vector) sum = {0}, column;
  for (int k = 0; k < terms; k++) {
    NAME(load)(matrix + (size_t)k * (size_t)lanes, &column);
    sum += column * x[k];
  }
  *out = sum;
}

INLINE void NAME(product)(int n, int terms, int lanes, int width, const double *restrict matrix, const double *restrict x,
                          double *restrict out)
{
  for (size_t i = 0; i < (size_t)n; i++)
    for (int b = 0; b < width; b += WIDTH) {
      NAME(vector) sum;
      NAME(row)(terms, lanes, matrix + b, x + i * (size_t)terms, &sum);
      NAME(store)(out + i * (size_t)width + b, &sum, width - b);
    }
}

/* All forces are weighed before the first is used: then the products take them from memory, lane by lane, at no cost. */
INLINE void NAME(weigh)(int n, const int stages, const double *restrict weight, double *restrict force)
{
  for (size_t i = 0; i < (size_t)n; i++, force += stages)
    for (int j = 0; j < stages; j++) force[j] *= weight[j];
}

INLINE void NAME(sweep)(dvi__sweep *s, const int stages, const int lanes)
{
  const double *restrict matrix = s->matrix, *restrict node = s->node, *restrict start = s->start, *restrict factor = s->factor;
  const double *restrict origin = s->origin, *restrict g = s->force;
  double *restrict Z = s->Z, *restrict Q = s->Q;
  NAME(vector) change = {0}, largest = {0};
  NAME(weigh)(s->n, stages, s->weight, s->force);
  for (size_t i = 0, n = (size_t)s->n; i < n; i++, g += stages, Z += lanes, Q += stages)
    for (int b = 0; b < lanes; b += WIDTH) {
      NAME(vector) sum, c, before;
      NAME(row)(stages, lanes, matrix + b, g, &sum);
      NAME(load)(node + b, &c);
      NAME(load)(Z + b, &before);
      const NAME(vector) next = start[i] * c + factor[i] * sum, moved = before - next, place = origin[i] + next;
      NAME(larger)(&change, &moved);
      NAME(larger)(&largest, &next);
      NAME(store)(Z + b, &next, WIDTH);
      NAME(store)(Q + b, &place, stages - b);
    }
  s->change = NAME(largest_of)(&change);
  s->largest = NAME(largest_of)(&largest);
}
