/* The loops of lanes.c for vectors of WIDTH numbers, after vector_width.h. lanes.c includes this
 * header once for each width, and so does lanes_solve.c. */

/* A fused product gives the rounding error of a product. Where the processor has none, the library
 * function gives the same bits. */
INLINE void NAME(split_one)(const dvi__fixed_point *s, size_t i)
{
  s->start[i] = s->factor[i] * s->p0[i];
  s->low[i] = __builtin_fma(s->factor[i], s->p0[i], -s->start[i]);
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
  NAME(vector) sum = {0}, second, third, fourth;
  int k = 0;
  if (terms < 8) {
    for (; k < terms; k++) NAME(add_column)(lanes, matrix, x, k, &sum);
    *out = sum;
    return;
  }
  NAME(load)(matrix, &sum);
  NAME(load)(matrix + (size_t)lanes, &second);
  NAME(load)(matrix + 2 * (size_t)lanes, &third);
  NAME(load)(matrix + 3 * (size_t)lanes, &fourth);
  sum *= x[0], second *= x[1], third *= x[2], fourth *= x[3];
  for (k = 4; k + 4 <= terms; k += 4) {
    NAME(add_column)(lanes, matrix, x, k, &sum);
    NAME(add_column)(lanes, matrix, x, k + 1, &second);
    NAME(add_column)(lanes, matrix, x, k + 2, &third);
    NAME(add_column)(lanes, matrix, x, k + 3, &fourth);
  }
  for (; k < terms; k++) NAME(add_column)(lanes, matrix, x, k, &sum);
  *out = (sum + second) + (third + fourth);
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

/* Make one row of an iteration, from its sums of forces to its new offsets and the places of its
 * first `count` stages. */
INLINE void NAME(place)(const dvi__fixed_point *s, size_t i, int count, const NAME(vector) * c,
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
  NAME(store)(Q, &at, count);
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
      NAME(place)
      (s, i, s->stages - b, &c, &sum, Z, s->Q + i * (size_t)s->stages + b, &change, &largest);
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
      (s, i, s->stages - b, &c, &sum, s->Z + i * lanes + (size_t)b, s->Q + i * stages + (size_t)b,
       &change, &largest);
    }
  s->change = NAME(largest_of)(&change);
  s->largest = NAME(largest_of)(&largest);
}

/* Columns of at most eight stages. Compilers keep an array of them in memory, too. */
typedef struct NAME(columns) {
  NAME(vector) c0, c1, c2, c3, c4, c5, c6, c7;
} NAME(columns);

INLINE void NAME(load_columns)(const int stages, const int lanes, const double *matrix,
                               NAME(columns) * c)
{
  NAME(load)(matrix, &c->c0);
  if (stages > 1) NAME(load)(matrix + lanes, &c->c1);
  if (stages > 2) NAME(load)(matrix + 2 * lanes, &c->c2);
  if (stages > 3) NAME(load)(matrix + 3 * lanes, &c->c3);
  if (stages > 4) NAME(load)(matrix + 4 * lanes, &c->c4);
  if (stages > 5) NAME(load)(matrix + 5 * lanes, &c->c5);
  if (stages > 6) NAME(load)(matrix + 6 * lanes, &c->c6);
  if (stages > 7) NAME(load)(matrix + 7 * lanes, &c->c7);
}

/* Add up products as `row` does. */
INLINE void NAME(known_row)(const int stages, const NAME(columns) * c, const double *g,
                            NAME(vector) * out)
{
  if (stages == 8) {
    *out = ((c->c0 * g[0] + c->c4 * g[4]) + (c->c1 * g[1] + c->c5 * g[5])) +
           ((c->c2 * g[2] + c->c6 * g[6]) + (c->c3 * g[3] + c->c7 * g[7]));
    return;
  }
  NAME(vector) sum = (NAME(vector)){0} + c->c0 * g[0];
  if (stages > 1) sum += c->c1 * g[1];
  if (stages > 2) sum += c->c2 * g[2];
  if (stages > 3) sum += c->c3 * g[3];
  if (stages > 4) sum += c->c4 * g[4];
  if (stages > 5) sum += c->c5 * g[5];
  if (stages > 6) sum += c->c6 * g[6];
  *out = sum;
}

/* Multiply for at most eight terms, known at compile time, and rows of eight lanes. */
INLINE void NAME(known_product)(int n, const int terms, const int width,
                                const double *restrict matrix, const double *restrict x,
                                double *restrict out)
{
  for (int b = 0; b < width; b += WIDTH) {
    NAME(columns) columns;
    NAME(load_columns)(terms, 8, matrix + b, &columns);
    for (size_t i = 0; i < (size_t)n; i++) {
      NAME(vector) sum;
      NAME(known_row)(terms, &columns, x + i * (size_t)terms, &sum);
      NAME(store)(out + i * (size_t)width + b, &sum, width - b);
    }
  }
}

/* Iterate for at most eight stages, known at compile time. The matrix' columns stay in registers
 * while the loop passes over the coordinates. */
INLINE void NAME(iterate_known)(dvi__fixed_point *iteration, const int stages, const int lanes)
{
  const dvi__fixed_point own = *iteration, *s = &own; /* a copy, which nothing else writes */
  NAME(vector) change = {0}, largest = {0};
  NAME(weigh)(s->n, stages, s->weight, s->force);
  for (int b = 0; b < lanes; b += WIDTH) {
    NAME(columns) columns;
    NAME(vector) c;
    NAME(load_columns)(stages, lanes, s->matrix + b, &columns);
    NAME(load)(s->node + b, &c);
    for (size_t i = 0; i < (size_t)s->n; i++) {
      double *Z = s->Z + (size_t)lanes * i + b, *Q = s->Q + (size_t)stages * i + b;
      NAME(vector) sum;
      NAME(known_row)(stages, &columns, s->force + (size_t)stages * i, &sum);
      NAME(place)(s, i, stages - b, &c, &sum, Z, Q, &change, &largest);
    }
  }
  iteration->change = NAME(largest_of)(&change);
  iteration->largest = NAME(largest_of)(&largest);
}

/* Begin with eight stages as split, product and begin do one after the other. */
INLINE void NAME(begin_eight)(const dvi__fixed_point *iteration, const double *table,
                              const double *g)
{
  const dvi__fixed_point own = *iteration, *s = &own;
  for (int b = 0; b < 8; b += WIDTH) {
    NAME(columns) columns;
    NAME(vector) c, change = {0}, largest = {0};
    NAME(load_columns)(8, 8, table + b, &columns);
    NAME(load)(s->node + b, &c);
    for (size_t i = 0; i < (size_t)s->n; i++) {
      NAME(vector) sum;
      if (b == 0) NAME(split_one)(s, i);
      NAME(known_row)(8, &columns, g + 8 * i, &sum);
      NAME(place)(s, i, 8, &c, &sum, s->Z + 8 * i + b, s->Q + 8 * i + b, &change, &largest);
    }
  }
}
