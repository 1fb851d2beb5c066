/* The loops of members.c and members_chord.c for vectors of WIDTH numbers, after vector_width.h.
 * They include this header once for each width. The last few of a row are done one by one, by the
 * same functions at WIDTH 1. */

/* Add matrix_k x_k to sum, with x_k and x_(k+1) `width` apart. */
INLINE void NAME(add_term)(int lanes, const double *matrix, int width, const double *x, int k,
                           NAME(vector) * sum)
{
  NAME(vector) value;
  NAME(load)(x + (size_t)k * (size_t)width, &value);
  *sum += value * matrix[(size_t)k * (size_t)lanes];
}

/* Give sum_k matrix_k x_k. Eight terms and more are four sums, as in lanes_width.h. */
INLINE void NAME(row)(int terms, int lanes, const double *matrix, int width, const double *x,
                      NAME(vector) * out)
{
  NAME(vector) sum[4] = {{0}, {0}, {0}, {0}};
  int k = 0;
  for (; terms >= 8 && k < 4; k++) {
    NAME(load)(x + (size_t)k * (size_t)width, &sum[k]);
    sum[k] *= matrix[(size_t)k * (size_t)lanes];
  }
  for (; terms >= 8 && k + 4 <= terms; k += 4)
    for (int j = 0; j < 4; j++) NAME(add_term)(lanes, matrix, width, x, k + j, &sum[j]);
  for (; k < terms; k++) NAME(add_term)(lanes, matrix, width, x, k, &sum[0]);
  *out = terms >= 8 ? (sum[0] + sum[1]) + (sum[2] + sum[3]) : sum[0];
}

/* Give row j of the matrix times g, as `row` does, for up to eight terms in registers. */
INLINE void NAME(known_row)(const int terms, int lanes, const double *row, const NAME(vector) * g,
                            NAME(vector) * out)
{
  NAME(vector) sum = {0}, four[4];
  for (int k = 0; k < 4 && terms == 8; k++)
    four[k] = g[k] * row[k * lanes] + g[k + 4] * row[(k + 4) * lanes];
  for (int k = 0; k < terms && terms < 8; k++) sum += g[k] * row[k * lanes];
  *out = terms == 8 ? (four[0] + four[1]) + (four[2] + four[3]) : sum;
}

/* Multiply for WIDTH members, from member m on, of coordinate i. Eight terms are read once. */
INLINE void NAME(product_at)(const int terms, int lanes, int rows, const double *matrix, int width,
                             const double *x, double *out)
{
  NAME(vector) g[8];
  for (int k = 0; k < 8 && terms == 8; k++) NAME(load)(x + (size_t)k * (size_t)width, &g[k]);
  for (int j = 0; j < rows; j++) {
    NAME(vector) sum;
    if (terms == 8)
      NAME(known_row)(8, lanes, matrix + j, g, &sum);
    else
      NAME(row)(terms, lanes, matrix + j, width, x, &sum);
    NAME(store)(out + (size_t)j * (size_t)width, &sum, WIDTH);
  }
}

INLINE int NAME(product)(int n, int terms, int lanes, int rows, const double *matrix, int width,
                         const double *x, double *out, int m)
{
  for (; m + WIDTH <= width; m += WIDTH)
    for (size_t i = 0; i < (size_t)n; i++) {
      const double *from = x + i * (size_t)terms * (size_t)width + m;
      double *to = out + i * (size_t)rows * (size_t)width + m;
      if (terms == 8)
        NAME(product_at)(8, lanes, rows, matrix, width, from, to);
      else
        NAME(product_at)(terms, lanes, rows, matrix, width, from, to);
    }
  return m;
}

/* ---- iterations ---- */

/* Numbers of WIDTH members at one coordinate. */
typedef struct NAME(base) {
  NAME(vector) start, low, origin;
  double factor;
} NAME(base);

INLINE void NAME(load_base)(const dvi__members_fixed_point *s, size_t i, int m, NAME(base) * base)
{
  const size_t at = i * (size_t)s->width + (size_t)m;
  NAME(load)(s->start + at, &base->start);
  NAME(load)(s->low + at, &base->low);
  NAME(load)(s->origin + at, &base->origin);
  base->factor = s->factor[i];
}

/* Place one stage, from its sum of forces to its offset and place. */
INLINE void NAME(place)(const NAME(base) * base, double node, const NAME(vector) * sum,
                        NAME(vector) * next, double *Z, double *Q)
{
  *next = base->start * node + (base->factor * *sum + base->low * node);
  const NAME(vector) place = base->origin + *next;
  NAME(store)(Z, next, WIDTH);
  NAME(store)(Q, &place, WIDTH);
}

/* Begin with the sums of forces in Z. */
INLINE int NAME(begin)(const dvi__members_fixed_point *s, int m)
{
  const size_t width = (size_t)s->width, stages = (size_t)s->stages;
  for (; m + WIDTH <= s->width; m += WIDTH)
    for (size_t i = 0; i < (size_t)s->n; i++) {
      NAME(base) base;
      NAME(load_base)(s, i, m, &base);
      for (size_t j = 0; j < stages; j++) {
        const size_t at = (i * stages + j) * width + (size_t)m;
        NAME(vector) sum, next;
        NAME(load)(s->Z + at, &sum);
        NAME(place)(&base, s->node[j], &sum, &next, s->Z + at, s->Q + at);
      }
    }
  return m;
}

/* Iterate for WIDTH members of one coordinate. All forces are weighed, then the stages move. Up to
 * eight stages, known at compile time, have their forces in registers. */
INLINE void NAME(iterate_at)(const dvi__members_fixed_point *s, const int stages, size_t i, int m,
                             NAME(vector) * change, NAME(vector) * largest)
{
  const size_t width = (size_t)s->width, at = i * (size_t)stages * width + (size_t)m;
  double *restrict force = s->force + at, *restrict Z = s->Z + at, *restrict Q = s->Q + at;
  const int known = __builtin_constant_p(stages) && stages <= 8;
  NAME(base) base;
  NAME(vector) g[8];
  NAME(load_base)(s, i, m, &base);
  for (size_t j = 0; j < (size_t)stages; j++) {
    NAME(vector) value;
    NAME(load)(force + j * width, &value);
    value = value * s->weight[j];
    NAME(store)(force + j * width, &value, WIDTH);
    if (known) g[j] = value;
  }
  for (size_t j = 0; j < (size_t)stages; j++) {
    NAME(vector) sum, before, next;
    if (known)
      NAME(known_row)(stages, s->lanes, s->matrix + j, g, &sum);
    else
      NAME(row)(stages, s->lanes, s->matrix + j, s->width, force, &sum);
    NAME(load)(Z + j * width, &before);
    NAME(place)(&base, s->node[j], &sum, &next, Z + j * width, Q + j * width);
    const NAME(vector) moved = before - next;
    NAME(larger)(change, &moved);
    NAME(larger)(largest, &next);
  }
}

INLINE int NAME(iterate)(const dvi__members_fixed_point *s, const int stages, int m)
{
  for (; m + WIDTH <= s->width; m += WIDTH) {
    NAME(vector) change = {0}, largest = {0};
    for (size_t i = 0; i < (size_t)s->n; i++) NAME(iterate_at)(s, stages, i, m, &change, &largest);
    NAME(store)(s->change + m, &change, WIDTH);
    NAME(store)(s->largest + m, &largest, WIDTH);
  }
  return m;
}

/* ---- ends ---- */

/* Give sum_j g_j, and sum_j slant_j g_j in the place of `low`. */
INLINE int NAME(sums)(const dvi__members_ends *e, int m)
{
  const size_t width = (size_t)e->width, stages = (size_t)e->stages;
  for (; m + WIDTH <= e->width; m += WIDTH)
    for (size_t i = 0; i < (size_t)e->n; i++) {
      NAME(vector) sum = {0}, slanted = {0};
      for (size_t j = 0; j < stages; j++) {
        NAME(vector) g;
        NAME(load)(e->g + (i * stages + j) * width + m, &g);
        sum += g;
        slanted += e->slant[j] * g;
      }
      NAME(store)(e->sum + i * width + m, &sum, WIDTH);
      NAME(store)(e->low + i * width + m, &slanted, WIDTH);
    }
  return m;
}
