/* The loops of members.c for vectors of WIDTH numbers; it includes this once for each width. The last few of a row are done one by one, by the
 * same functions at WIDTH 1. As in lanes_width.h, vectors are handed on by pointers. */

typedef double NAME(vector) __attribute__((vector_size(WIDTH * sizeof(double))));
typedef int64_t NAME(mask) __attribute__((vector_size(WIDTH * sizeof(double))));

INLINE void NAME(load)(const double *x, NAME(vector) * loaded)
{
  memcpy(loaded, x, sizeof *loaded);
}

INLINE void NAME(store)(double *out, const NAME(vector) * x)
{
  memcpy(out, x, sizeof *x);
}

/* largest <- max(largest, |x|), lane by lane; NaN is not seen. */
INLINE void NAME(larger)(NAME(vector) * largest, const NAME(vector) * x)
{
  const NAME(mask) magnitude = (NAME(mask)) * x & INT64_MAX, take = (NAME(mask))((NAME(vector))magnitude > *largest);
  *largest = (NAME(vector))((take & magnitude) | (~take & (NAME(mask)) * largest));
}

/* sum_k matrix_k x_k, with x_k and x_(k+1) `width` apart. */
INLINE void NAME(row)(int terms, int lanes, const double *matrix, int width, const double *x, NAME(vector) * out)
{
  NAME(vector) sum = {0}, value;
  for (int k = 0; k < terms; k++) {
    NAME(load)(x + (size_t)k * (size_t)width, &value);
    sum += value * matrix[(size_t)k * (size_t)lanes];
  }
  *out = sum;
}

/* WIDTH members, from member m on, of coordinate i. */
INLINE void NAME(product_at)(int terms, int lanes, int rows, const double *matrix, int width, const double *x, double *out)
{
  for (int j = 0; j < rows; j++) {
    NAME(vector) sum;
    NAME(row)(terms, lanes, matrix + j, width, x, &sum);
    NAME(store)(out + (size_t)j * (size_t)width, &sum);
  }
}

/* WIDTH members of one coordinate: all forces are weighed, then the stages move. */
INLINE void NAME(sweep_at)(const dvi__members_sweep *s, const int stages, size_t i, int m, NAME(vector) * change,
                           NAME(vector) * largest)
{
  const size_t width = (size_t)s->width, at = i * (size_t)stages * width + (size_t)m;
  double *restrict force = s->force + at, *restrict Z = s->Z + at, *restrict Q = s->Q + at;
  NAME(vector) start, origin, value;
  NAME(load)(s->start + i * width + m, &start);
  NAME(load)(s->origin + i * width + m, &origin);
  for (size_t j = 0; j < (size_t)stages; j++) {
    NAME(load)(force + j * width, &value);
    value = value * s->weight[j];
    NAME(store)(force + j * width, &value);
  }
  for (size_t j = 0; j < (size_t)stages; j++) {
    NAME(vector) sum, before;
    NAME(row)(stages, s->lanes, s->matrix + j, s->width, force, &sum);
    NAME(load)(Z + j * width, &before);
    const NAME(vector) next = start * s->node[j] + s->factor[i] * sum, moved = before - next, place = origin + next;
    NAME(larger)(change, &moved);
    NAME(larger)(largest, &next);
    NAME(store)(Z + j * width, &next);
    NAME(store)(Q + j * width, &place);
  }
}

INLINE int NAME(sweep)(const dvi__members_sweep *s, const int stages, int m)
{
  for (; m + WIDTH <= s->width; m += WIDTH) {
    NAME(vector) change = {0}, largest = {0};
    for (size_t i = 0; i < (size_t)s->n; i++) NAME(sweep_at)(s, stages, i, m, &change, &largest);
    NAME(store)(s->change + m, &change);
    NAME(store)(s->largest + m, &largest);
  }
  return m;
}

INLINE int NAME(product)(int n, int terms, int lanes, int rows, const double *matrix, int width, const double *x, double *out,
                         int m)
{
  for (; m + WIDTH <= width; m += WIDTH)
    for (size_t i = 0; i < (size_t)n; i++) NAME(product_at)
  (terms, lanes, rows, matrix, width, x + i * (size_t)terms * (size_t)width + m, out + i * (size_t)rows * (size_t)width + m);
  return m;
}

/* As dvi__add_compensated. */
INLINE void NAME(add_at)(double *sum, double *carry, const NAME(vector) * term)
{
  NAME(vector) before, rest;
  NAME(load)(sum, &before);
  NAME(load)(carry, &rest);
  const NAME(vector) wanted = *term - rest, next = before + wanted;
  rest = (next - before) - wanted;
  NAME(store)(carry, &rest);
  NAME(store)(sum, &next);
}

INLINE size_t NAME(add)(size_t count, double factor, const double *restrict x, double *restrict sum, double *restrict carry,
                        size_t k)
{
  for (; k + WIDTH <= count; k += WIDTH) {
    NAME(vector) term;
    NAME(load)(x + k, &term);
    term = factor * term;
    NAME(add_at)(sum + k, carry + k, &term);
  }
  return k;
}

INLINE size_t NAME(drift)(size_t count, double h, double mass, const double *restrict p, double *restrict q,
                          double *restrict q_carry, size_t k)
{
  for (; k + WIDTH <= count; k += WIDTH) {
    NAME(vector) term;
    NAME(load)(p + k, &term);
    term = term / mass * h;
    NAME(add_at)(q + k, q_carry + k, &term);
  }
  return k;
}
