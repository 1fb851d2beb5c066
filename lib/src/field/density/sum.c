/* The sum of a part over its points, with first and second derivatives, for sparse spaces:
 *
 *     z = B q,    sum_k w_k l(x_k, z_k),    B^T (w l_z),    B^T (w l_zz) B.
 *
 * The callback gets blocks of points on the stack, or coordinates in their place if they are the
 * variables at the points. An entry of a derivative adds the points in
 * their order, so that its bits depend neither on blocks nor on the range of the call. */
#include <string.h>

#include "field/density/density.h"
#include "num/simd/wide.h"

enum { ROOM = 8192 /* numbers of a block */ };

/* A block of points first to first+count-1, and what the callback says of them. */
typedef struct block {
  const dvi__integral *integral;
  const dvi__density_part *part;
  const dvi__density_point *at;
  const double *G, *G_rate, *G_second; /* values that move, and their derivatives in time */
  int64_t first;
  int count;
  double *weight; /* [DVI__BLOCK_MOST] with the integral's sign */
  double *room;   /* [ROOM] */
  const double *x;
  double *z, *l, *l_z, *l_zz;
} block;

/* ---- before the call ---- */

static int points_of_block(const block *b)
{
  const dvi_density_part *given = &b->part->given;
  const int each = b->integral->density->dimension + 2 * given->variables + 1 + given->pairs;
  const int most = ROOM / each;
  return most < DVI__BLOCK_MOST ? most : DVI__BLOCK_MOST;
}

static void lay_out(block *b, const dvi__density_sums *s)
{
  const dvi_density_part *given = &b->part->given;
  const int dimension = b->integral->density->dimension;
  const int has_first = s->q != NULL || s->v != NULL || s->rate != NULL;
  b->x = dimension == 1 ? b->part->x + b->first : b->room;
  b->z = b->room + dimension * b->count;
  b->l = b->z + given->variables * b->count;
  b->l_z = b->l + b->count;
  b->l_zz = b->l_z + given->variables * b->count;
  if (s->value == NULL) b->l = NULL;
  if (!has_first) b->l_z = NULL;
  if (s->qq == NULL && s->qv == NULL && s->vv == NULL) b->l_zz = NULL;
}

/* The places of an interval are the part's. */
static void fill_places(const block *b)
{
  const int dimension = b->integral->density->dimension;
  for (int d = 0; d < dimension && dimension > 1; d++)
    memcpy(b->room + d * b->count, b->part->x + d * b->part->points + b->first,
           (size_t)b->count * sizeof(double));
}

static void fill_weights(const block *b)
{
  for (int k = 0; k < b->count; k++)
    b->weight[k] = b->integral->sign * b->part->weight[b->first + k];
}

static const int *list_of(const block *b, int64_t k)
{
  const dvi__point_groups *g = &b->part->group;
  return g->list + g->start[g->of[k]];
}

static double moving_row(const dvi__csr *rows, int64_t k, const double *G)
{
  double sum = 0;
  for (int64_t e = rows->start[k]; e < rows->start[k + 1]; e++)
    sum += rows->value[e] * G[rows->column[e]];
  return sum;
}

static void gather_variable(const block *b, int a)
{
  const dvi__jet_rows *rows = b->part->rows + a;
  const int is_rate = b->part->given.variable[a].rate != 0;
  const double *const from = is_rate ? b->at->v : b->at->q;
  double *z = b->z + a * b->count;
  for (int k = 0; k < b->count; k++) {
    const int64_t point = b->first + k;
    const int *list = list_of(b, point);
    double sum = rows->fixed != NULL ? rows->fixed[point] : 0;
    for (int64_t e = rows->start[point]; e < rows->start[point + 1] && from != NULL; e++)
      sum += rows->value[e] * from[list[rows->local[e]]];
    if (rows->moving.rows > 0) sum += moving_row(&rows->moving, point, is_rate ? b->G_rate : b->G);
    z[k] = sum;
  }
}

/* ---- behind the call ---- */

static void add_value(const block *b, double *value)
{
  double sum = 0;
  for (int k = 0; k < b->count; k++) sum += b->weight[k] * b->l[k];
  *value += sum;
}

/* Add w l_z of a variable to the derivatives of the coordinates in the range. */
static void scatter_variable(const block *b, int a, double *derivative)
{
  const dvi__jet_rows *rows = b->part->rows + a;
  const double *l_z = b->l_z + a * b->count;
  for (int k = 0; k < b->count; k++) {
    const int64_t point = b->first + k;
    const int *list = list_of(b, point);
    const double weighted = b->weight[k] * l_z[k];
    for (int64_t e = rows->start[point]; e < rows->start[point + 1]; e++) {
      const int i = list[rows->local[e]];
      if (i >= b->at->first && i < b->at->last)
        derivative[i - b->at->first] += rows->value[e] * weighted;
    }
  }
}

/* Add c times the product of the rows of a and b at a point to the entries of a Hessian. */
static void add_product(const block *b, int64_t point, const int pair[2], double c,
                        const int *slots, double *values)
{
  const dvi__point_groups *g = &b->part->group;
  const int of = g->of[point], size = (int)(g->start[of + 1] - g->start[of]);
  const dvi__jet_rows *A = b->part->rows + pair[0], *B = b->part->rows + pair[1];
  const int *square = slots + g->square[of];
  for (int64_t i = A->start[point]; i < A->start[point + 1]; i++)
    for (int64_t j = B->start[point]; j < B->start[point + 1]; j++)
      values[square[A->local[i] * size + B->local[j]]] += c * (A->value[i] * B->value[j]);
}

static void scatter_pair(const block *b, int e, const dvi__density_sums *s)
{
  const dvi_density_part *given = &b->part->given;
  const int pair[2] = {given->pair[e][0], given->pair[e][1]}, turned[2] = {pair[1], pair[0]};
  const int is_rate[2] = {given->variable[pair[0]].rate != 0, given->variable[pair[1]].rate != 0};
  const dvi__slots *slots = &b->part->slots;
  const double *l_zz = b->l_zz + e * b->count;
  double *const same = is_rate[0] ? s->vv : s->qq;
  for (int k = 0; k < b->count; k++) {
    const int64_t point = b->first + k;
    const double c = b->weight[k] * l_zz[k];
    if (is_rate[0] == is_rate[1] && same != NULL) {
      const int *const of = is_rate[0] ? slots->vv : slots->qq;
      add_product(b, point, pair, c, of, same);
      if (pair[0] != pair[1]) add_product(b, point, turned, c, of, same);
    } else if (is_rate[0] != is_rate[1] && s->qv != NULL) {
      add_product(b, point, is_rate[0] ? turned : pair, c, slots->qv, s->qv);
    }
  }
}

/* Add l_t and what values that move do. */
static int add_rate(const block *b, double *rate)
{
  const dvi_density_part *given = &b->part->given;
  double l_t[DVI__BLOCK_MOST];
  if (given->time_derivative != NULL) {
    const int failed = given->time_derivative(b->count, b->at->t, b->x, b->z, l_t, given->user);
    if (failed != 0) return failed;
    for (int k = 0; k < b->count; k++) *rate += b->weight[k] * l_t[k];
  }
  for (int a = 0; a < given->variables; a++) {
    const dvi__csr *moving = &b->part->rows[a].moving;
    const double *const G_t = given->variable[a].rate ? b->G_second : b->G_rate;
    if (moving->rows == 0) continue;
    for (int k = 0; k < b->count; k++)
      *rate += b->weight[k] * b->l_z[a * b->count + k] * moving_row(moving, b->first + k, G_t);
  }
  return 0;
}

/* ---- points that are coordinates ---- */

/* Tell if the block's points are coordinates, of whose derivatives no others are wanted. */
static int has_own_coordinates(const block *b, const dvi__density_sums *s)
{
  const dvi_density_part *given = &b->part->given;
  const int is_more = s->qq != NULL || s->qv != NULL || s->vv != NULL || s->rate != NULL;
  for (int a = 0; a < given->variables; a++)
    if ((given->variable[a].rate ? b->at->v : b->at->q) == NULL) return 0;
  return b->first >= b->part->own_points.first && !is_more;
}

/* Return the coordinate of a variable at the block's first point. */
static int64_t first_coordinate(const block *b, int a)
{
  const dvi__jet_rows *rows = b->part->rows + a;
  return list_of(b, b->first)[rows->local[rows->start[b->first]]];
}

/* Give the variables at the block's points. Those that stand in a row are not copied. */
static const double *find_own_variables(const block *b)
{
  const dvi_density_part *given = &b->part->given;
  const int64_t stride = b->part->own_points.stride;
  for (int a = 0; a < given->variables; a++) {
    const double *from = (given->variable[a].rate ? b->at->v : b->at->q) + first_coordinate(b, a);
    double *z = b->z + a * b->count;
    if (given->variables == 1 && stride == 1) return from;
    for (int k = 0; k < b->count; k++) z[k] = from[k * stride];
  }
  return b->z;
}

WIDE static void add_scaled(int count, double weight, const double *restrict l_z,
                            double *restrict derivative)
{
  for (int k = 0; k < count; k++) derivative[k] += weight * l_z[k];
}

/* Add w l_z of a variable to the derivatives of the coordinates in the range. */
static void add_own_variable(const block *b, int a, double *derivative)
{
  const dvi__own_points *own = &b->part->own_points;
  const int64_t stride = own->stride, shift = first_coordinate(b, a) - b->at->first,
                size = b->at->last - b->at->first;
  const double *l_z = b->l_z + a * b->count, weight = b->integral->sign * own->weight;
  int first = 0, last = b->count;
  while (first < last && shift + first * stride < 0) first++;
  while (first < last && shift + (last - 1) * stride >= size) last--;
  if (first == last) return;
  derivative += shift + first * stride;
  if (own->weight != 0 && stride == 1)
    add_scaled(last - first, weight, l_z + first, derivative);
  else
    for (int k = first; k < last; k++, derivative += stride)
      *derivative += (own->weight != 0 ? weight : b->weight[k]) * l_z[k];
}

/* Give what the general functions would give, to the last bit. */
static int sum_own_points(block *b, const dvi__density_sums *s)
{
  const dvi_density_part *given = &b->part->given;
  const double *z = find_own_variables(b);
  fill_places(b);
  if (b->part->own_points.weight == 0 || s->value != NULL) fill_weights(b);
  const int failed = given->density(b->count, b->at->t, b->x, z, b->l, b->l_z, NULL, given->user);
  if (failed != 0) return failed;
  if (s->value != NULL) add_value(b, s->value);
  for (int a = 0; a < given->variables; a++) {
    double *const derivative = given->variable[a].rate ? s->v : s->q;
    if (derivative != NULL) add_own_variable(b, a, derivative);
  }
  return 0;
}

/* ---- all ---- */

static int sum_block(block *b, const dvi__density_sums *s)
{
  const dvi_density_part *given = &b->part->given;
  lay_out(b, s);
  if (has_own_coordinates(b, s)) return sum_own_points(b, s);
  fill_places(b);
  fill_weights(b);
  for (int a = 0; a < given->variables; a++) gather_variable(b, a);
  const int failed = given->density(b->count, b->at->t, b->x, b->z, b->l, b->l_z, b->l_zz,
                                    given->user);
  if (failed != 0) return failed;
  if (s->value != NULL) add_value(b, s->value);
  for (int a = 0; a < given->variables; a++) {
    double *const derivative = given->variable[a].rate ? s->v : s->q;
    if (derivative != NULL) scatter_variable(b, a, derivative);
  }
  for (int e = 0; e < given->pairs && b->l_zz != NULL; e++) scatter_pair(b, e, s);
  return s->rate != NULL ? add_rate(b, s->rate) : 0;
}

int dvi__part_sum(const dvi__integral *integral, const dvi__density_part *part,
                  const dvi__density_point *at, const double *room, const dvi__density_sums *sums)
{
  struct {
    double weight[DVI__BLOCK_MOST], room[ROOM];
  } work;
  block b = {
      .integral = integral, .part = part, .at = at, .weight = work.weight, .room = work.room};
  if (room != NULL) {
    b.G = room;
    b.G_second = room + 2 * integral->density->moving;
    b.G_rate = at->take_second ? b.G_second : room + integral->density->moving;
  }
  const int is_whole = at->first == 0 && at->last == integral->density->unknowns;
  const int64_t from = is_whole ? 0 : part->low[at->first],
                to = is_whole ? part->points : part->high[at->last - 1];
  const int64_t cut = part->own_points.first, most = points_of_block(&b);
  int failed = 0;
  for (b.first = from; b.first < to && failed == 0; b.first += b.count) {
    const int64_t end = b.first < cut && cut < to ? cut : to;
    b.count = (int)(end - b.first < most ? end - b.first : most);
    failed = sum_block(&b, sums);
  }
  return failed;
}
