/* The linear-preconditioned fixed-point iteration, for systems of fixed_point.h whose quadratic
 * potentials have a diagonal Hessian K, such as the waves of Fourier's modes.
 *
 * With the forces g_j = -h b_j V_q(q0 + Z_j) the iteration of fixed_point.h replaces the offsets
 * Z [r] of a coordinate by Phi(Z) = h/m [c p0 + sum_j (c_i - P_ij) g_j]. It contracts for
 * h omega < 1 or so. Here the part of K in Phi is taken implicitly,
 *
 *     Z <- Z + (I + h^2 k/m B)^{-1} (Phi(Z) - Z),   B_ij = (c_i - P_ij) b_j,
 *
 * which contracts as if the other potentials were alone. Phi and its forces are those of all
 * potentials, so that the equations, and their symplecticity to the last bit, are those of
 * fixed_point.h. The inverse decides how fast they are solved, and no more. At the end g_j gets the
 * change of the linear forces with the last change of Z. What is left of it is the other forces'.
 *
 * The inverses are kept from step to step as long as h stays, for a composition those of all of its
 * lengths. Coordinates with equal k/m share one. Where k/m is not positive, 0 stands for k, whose
 * inverse is I. Source: Hairer, Lubich and Wanner 2006, sec. VIII.6. */
#include "step/element/action_struct.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/lanes.h"
#include "num/simd/members.h"
#include "num/simd/wide.h"
#include "num/simd/width.h"
#include "step/element/fixed_point.h"
#include "step/element/members.h"
#include "system/term/term.h"

struct dvi__preconditioner {
  int inverses;      /* number of the different k/m */
  double *stiffness; /* [n] k, 0 where k/m is not positive */
  double *ratio;     /* [n] k/m in ascending order, without repetitions */
  int *place;        /* [n] place of each coordinate's k/m among these */
  double *B;         /* [r*r] by rows */
  double *row_sum;   /* [r] of B */
  /* inverses [inverses*r*lanes] by columns of some h, one after the other; their h, 0 if not made;
   * the one to be replaced next, and the one in use */
  int lengths, oldest;
  double *inverse, *length;
  const double *in_use;
  double *matrix; /* [r*2r] work of an inverse, by rows */
  double *rest;   /* [n*r] Phi(Z) - Z */
  double *moved;  /* [n*lanes] its product with the inverse */
};

int dvi__action_has_preconditioner(const dvi__action *a)
{
  return a->preconditioner != NULL;
}

/* ---- stiffness ---- */

static int is_diagonal(const dvi__pattern *qq)
{
  if (qq->start == NULL) return 0;
  for (int j = 0; j < qq->columns; j++)
    for (int e = qq->start[j]; e < qq->start[j + 1]; e++)
      if (qq->row[e] != j) return 0;
  return 1;
}

/* Tell whether the Hessian of this potential is constant and declared diagonal. A pattern that was
 * not declared may be completed by another thread, and is not read. */
static int has_diagonal(const dvi__potential_term *term)
{
  const int declared = term->callbacks.qq.start != NULL;
  return term->callbacks.quadratic && declared && is_diagonal(&term->qq);
}

static int has_diagonals(const dvi_system *s)
{
  for (int k = 0; k < s->potential_count; k++)
    if (has_diagonal(&s->potentials[k])) return 1;
  return 0;
}

/* Add the diagonal of one potential, K (1,..,1) as a difference of gradients. work is [3 n]. Where
 * it cannot be evaluated there is no preconditioner for it. */
static void add_diagonal(const dvi__potential_term *term, dvi__scratch *scratch, double *work,
                         double *stiffness)
{
  const double t = 0;
  const size_t n = (size_t)scratch->n;
  double *ones = work, *at_ones = work + n, *at_origin = work + 2 * n;
  for (size_t i = 0; i < n; i++) ones[i] = 0;
  if (dvi__potential_gradient(term, scratch, 1, &t, ones, at_origin) != DVI_OK) return;
  for (size_t i = 0; i < n; i++) ones[i] = 1;
  if (dvi__potential_gradient(term, scratch, 1, &t, ones, at_ones) != DVI_OK) return;
  for (size_t i = 0; i < n; i++) stiffness[i] += at_ones[i] - at_origin[i];
}

static dvi_status find_stiffness(const dvi_system *s, double *stiffness)
{
  dvi__scratch scratch;
  double *work = DVI_NEW(double, 3 * (size_t)s->n);
  dvi_status status = dvi__scratch_create(s, 1, 0, &scratch);
  if (status == DVI_OK && work == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "action: no memory for %d coordinates", s->n);
  for (int k = 0; k < s->potential_count && status == DVI_OK; k++)
    if (has_diagonal(&s->potentials[k])) add_diagonal(&s->potentials[k], &scratch, work, stiffness);
  dvi__scratch_clear(&scratch);
  dvi__release(work);
  return status;
}

/* ---- tables ---- */

static int compare_ratios(const void *one, const void *other)
{
  const double a = *(const double *)one, b = *(const double *)other;
  return (a > b) - (a < b);
}

static double ratio_of(const dvi__action *a, int i)
{
  return a->preconditioner->stiffness[i] / a->system->mass_diagonal[i];
}

/* List the different k/m, and find the place of each coordinate's. */
static void list_ratios(dvi__action *a)
{
  struct dvi__preconditioner *p = a->preconditioner;
  const size_t count = (size_t)a->n;
  for (size_t i = 0; i < count; i++) {
    if (!(ratio_of(a, (int)i) > 0)) p->stiffness[i] = 0;
    p->ratio[i] = ratio_of(a, (int)i);
  }
  qsort(p->ratio, count, sizeof *p->ratio, compare_ratios);
  for (size_t k = 0; k < count; k++)
    if (p->inverses == 0 || p->ratio[k] != p->ratio[p->inverses - 1])
      p->ratio[p->inverses++] = p->ratio[k];
  for (size_t i = 0; i < count; i++) {
    const double ratio = ratio_of(a, (int)i);
    const double *found = bsearch(&ratio, p->ratio, (size_t)p->inverses, sizeof ratio,
                                  compare_ratios);
    p->place[i] = (int)(found - p->ratio);
  }
}

static void fill_B(dvi__action *a)
{
  struct dvi__preconditioner *p = a->preconditioner;
  const int r = a->r;
  for (int i = 0; i < r; i++)
    for (int j = 0; j < r; j++) {
      p->B[i * r + j] = a->fixed_point.matrix[j * a->fixed_point.lanes + i] * a->weight[j];
      p->row_sum[i] += p->B[i * r + j];
    }
}

static dvi_status no_memory(const dvi__action *a)
{
  return dvi__fail(DVI_NO_MEMORY, "action: no memory for %d nodes in %d dimensions", a->r, a->n);
}

static size_t inverse_size(const dvi__action *a)
{
  return (size_t)a->r * (size_t)a->fixed_point.lanes;
}

static size_t size_of_length(const dvi__action *a)
{
  return (size_t)a->preconditioner->inverses * inverse_size(a);
}

dvi_status dvi__action_keep_lengths(dvi__action *a, int count)
{
  struct dvi__preconditioner *p = a->preconditioner;
  if (p == NULL) return DVI_OK;
  dvi__release(p->inverse);
  dvi__release(p->length);
  p->inverse = DVI_NEW(double, (size_t)count *size_of_length(a));
  p->length = DVI_NEW(double, count);
  p->lengths = count;
  return p->inverse && p->length ? DVI_OK : no_memory(a);
}

static dvi_status allocate_numbers(dvi__action *a)
{
  struct dvi__preconditioner *p = a->preconditioner;
  const size_t n = (size_t)a->n, r = (size_t)a->r, lanes = (size_t)a->fixed_point.lanes;
  p->B = DVI_NEW(double, r *r);
  p->row_sum = DVI_NEW(double, r);
  p->matrix = DVI_NEW(double, 2 * r * r);
  p->rest = DVI_NEW(double, n *r);
  p->moved = DVI_NEW(double, n *lanes);
  if (!p->B || !p->row_sum || !p->matrix || !p->rest || !p->moved) return no_memory(a);
  return dvi__action_keep_lengths(a, 1);
}

dvi_status dvi__action_prepare_preconditioner(dvi__action *a)
{
  if (a->system->vector != NULL || !has_diagonals(a->system)) return DVI_OK;
  struct dvi__preconditioner *p = a->preconditioner = DVI_NEW(struct dvi__preconditioner, 1);
  if (p == NULL) return no_memory(a);
  p->stiffness = DVI_NEW(double, a->n);
  p->ratio = DVI_NEW(double, a->n);
  p->place = DVI_NEW(int, a->n);
  if (p->stiffness == NULL || p->ratio == NULL || p->place == NULL) return no_memory(a);
  DVI_TRY(find_stiffness(a->system, p->stiffness));
  list_ratios(a);
  if (!(p->ratio[p->inverses - 1] > 0)) {
    dvi__action_clear_preconditioner(a);
    return DVI_OK;
  }
  DVI_TRY(allocate_numbers(a));
  fill_B(a);
  return DVI_OK;
}

void dvi__action_clear_preconditioner(dvi__action *a)
{
  struct dvi__preconditioner *p = a->preconditioner;
  if (p == NULL) return;
  double *const owned[] = {p->stiffness, p->ratio,  p->B,    p->row_sum, p->inverse,
                           p->length,    p->matrix, p->rest, p->moved};
  for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) dvi__release(owned[i]);
  dvi__release(p->place);
  dvi__release(p);
  a->preconditioner = NULL;
}

/* ---- inverses ---- */

/* A smaller pivot, beside entries of about 1 and more, is that of a singular matrix. */
static const double least_pivot = 1e-10;

static void swap_rows(int count, double *one, double *other)
{
  for (int j = 0; j < count; j++) {
    const double kept = one[j];
    one[j] = other[j];
    other[j] = kept;
  }
}

static int largest_row(int r, int column, const double *matrix)
{
  int largest = column;
  for (int i = column + 1; i < r; i++)
    if (fabs(matrix[i * 2 * r + column]) > fabs(matrix[largest * 2 * r + column])) largest = i;
  return largest;
}

/* Turn [A, I] into [I, A^{-1}] by Gauss and Jordan. Returns 0 if A is singular. */
static int eliminate(int r, double *matrix)
{
  const int width = 2 * r;
  for (int k = 0; k < r; k++) {
    double *pivot = matrix + k * width;
    const int largest = largest_row(r, k, matrix);
    if (largest != k) swap_rows(width, pivot, matrix + largest * width);
    if (!(fabs(pivot[k]) > least_pivot)) return 0;
    const double scale = 1 / pivot[k];
    for (int j = 0; j < width; j++) pivot[j] *= scale;
    for (int i = 0; i < r; i++) {
      double *row = matrix + i * width;
      const double factor = row[k];
      for (int j = 0; j < width && i != k; j++) row[j] -= factor * pivot[j];
    }
  }
  return 1;
}

/* Invert I + z B. Where it is singular, nothing is taken implicitly. */
static void invert(const dvi__action *a, double z, double *inverse)
{
  struct dvi__preconditioner *p = a->preconditioner;
  const int r = a->r;
  for (int i = 0; i < r; i++)
    for (int j = 0; j < r; j++) {
      p->matrix[i * 2 * r + j] = z * p->B[i * r + j] + (i == j);
      p->matrix[i * 2 * r + r + j] = i == j;
    }
  const int regular = eliminate(r, p->matrix);
  for (int i = 0; i < r; i++)
    for (int j = 0; j < r; j++)
      inverse[j * a->fixed_point.lanes + i] = regular ? p->matrix[i * 2 * r + r + j] : i == j;
}

static void make_inverses(const dvi__action *a, double *inverse)
{
  const struct dvi__preconditioner *p = a->preconditioner;
  for (size_t k = 0; k < (size_t)p->inverses; k++)
    invert(a, a->h * a->h * p->ratio[k], inverse + k * inverse_size(a));
}

void dvi__preconditioner_set_step(dvi__action *a)
{
  struct dvi__preconditioner *p = a->preconditioner;
  int k = 0;
  while (k < p->lengths && p->length[k] != a->h) k++;
  if (k == p->lengths) {
    k = p->oldest;
    p->oldest = k + 1 < p->lengths ? k + 1 : 0;
    p->length[k] = a->h;
    make_inverses(a, p->inverse + (size_t)k * size_of_length(a));
  }
  p->in_use = p->inverse + (size_t)k * size_of_length(a);
}

/* ---- iterations ---- */

/* Loops for one node and for two, which compilers make vectors of, and for any number. */
#define FOR_FEW_NODES(loop, ...)                        \
  do {                                                  \
    const size_t nodes = (size_t)a->r;                  \
    const size_t length = (size_t)a->fixed_point.lanes; \
    if (nodes == 1 && length == 1)                      \
      loop(a, 1, 1, __VA_ARGS__);                       \
    else if (nodes == 2 && length == 2)                 \
      loop(a, 2, 2, __VA_ARGS__);                       \
    else                                                \
      loop(a, nodes, length, __VA_ARGS__);              \
  } while (0)

/* Multiply a row of r numbers. Its sums are those of dvi__lanes_product, which is called for
 * longer rows and for many. */
static inline void multiply_row(const size_t r, size_t lanes, const double *matrix,
                                const double *from, double *to)
{
  for (size_t k = 0; k < lanes; k++) {
    double sum = 0;
    for (size_t j = 0; j < r; j++) sum += matrix[j * lanes + k] * from[j];
    to[k] = sum;
  }
}

INLINE void multiply_few_rows(const dvi__action *a, const size_t r, const size_t lanes, int rows,
                              const double *matrix, const double *from, double *to)
{
  (void)a;
  for (int i = 0; i < rows; i++, from += r, to += lanes) multiply_row(r, lanes, matrix, from, to);
}

/* Multiply `rest` by the inverses. Neighbours that share one are multiplied at once. */
static void multiply_by_inverses(const dvi__action *a, double *product)
{
  enum { FEW_ROWS = 4, FEW = 4 };
  const struct dvi__preconditioner *p = a->preconditioner;
  const size_t r = (size_t)a->r, lanes = (size_t)a->fixed_point.lanes;
  for (int i = 0, next; i < a->n; i = next) {
    const double *from = p->rest + (size_t)i * r,
                 *inverse = p->in_use + (size_t)p->place[i] * inverse_size(a);
    double *to = product + (size_t)i * lanes;
    for (next = i + 1; next < a->n && p->place[next] == p->place[i];) next++;
    if (a->r <= FEW && next - i <= FEW_ROWS)
      FOR_FEW_NODES(multiply_few_rows, next - i, inverse, from, to);
    else
      dvi__lanes_product(next - i, a->r, a->fixed_point.lanes, a->fixed_point.lanes, inverse, from,
                         to);
  }
}

/* Find `rest` from sums of forces, less Z. */
INLINE void find_rest_of(const dvi__action *a, const size_t r, const size_t lanes,
                         const double *restrict sums, double *restrict rest)
{
  const double *start = a->fixed_point.start, *low = a->fixed_point.low,
               *factor = a->fixed_point.factor, *node = a->fixed_point.node, *Z = a->Z;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++)
      rest[i * r + j] = (start[i] * node[j] +
                         (factor[i] * sums[i * lanes + j] + low[i] * node[j])) -
                        Z[i * lanes + j];
}

WIDE static void find_own_rest(const dvi__action *a, const double *restrict sums,
                               double *restrict rest)
{
  FOR_FEW_NODES(find_rest_of, sums, rest);
}

/* Z holds the pull of K at q0 in the meantime. */
void dvi__preconditioner_begin(dvi__action *a)
{
  const struct dvi__preconditioner *p = a->preconditioner;
  const size_t n = (size_t)a->n, r = (size_t)a->r, lanes = (size_t)a->fixed_point.lanes;
  memcpy(p->moved, a->Z, n * lanes * sizeof(double));
  for (size_t i = 0; i < n; i++) {
    const double pull = a->fixed_point.factor[i] * a->h * p->stiffness[i] * a->q0[i];
    for (size_t j = 0; j < r; j++) a->Z[i * lanes + j] = pull * p->row_sum[j];
  }
  find_own_rest(a, p->moved, p->rest);
  multiply_by_inverses(a, a->Z);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < r; j++) a->fixed_point.Q[i * r + j] = a->q0[i] + a->Z[i * lanes + j];
}

/* Move the nodes, and their linear forces. */
INLINE void move_nodes_of(const dvi__action *a, const size_t r, const size_t lanes,
                          const double *restrict moved, double *restrict Z, double *restrict Q,
                          double *restrict force)
{
  const double *stiffness = a->preconditioner->stiffness, *weight = a->fixed_point.weight,
               *q0 = a->q0;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++) {
      const double next = Z[i * lanes + j] + moved[i * lanes + j];
      Z[i * lanes + j] = next;
      Q[i * r + j] = q0[i] + next;
      force[i * r + j] += weight[j] * (stiffness[i] * moved[i * lanes + j]);
    }
}

WIDE static void move_nodes(const dvi__action *a, const double *restrict moved, double *restrict Z,
                            double *restrict Q, double *restrict force)
{
  FOR_FEW_NODES(move_nodes_of, moved, Z, Q, force);
}

void dvi__preconditioner_iterate(dvi__action *a, double *change, double *largest)
{
  const struct dvi__preconditioner *p = a->preconditioner;
  const size_t count = (size_t)a->n * (size_t)a->fixed_point.lanes;
  dvi__lanes_weigh(a->n, a->r, a->fixed_point.weight, a->fixed_point.force);
  dvi__lanes_product(a->n, a->r, a->fixed_point.lanes, a->fixed_point.lanes, a->fixed_point.matrix,
                     a->fixed_point.force, p->moved);
  find_own_rest(a, p->moved, p->rest);
  multiply_by_inverses(a, p->moved);
  move_nodes(a, p->moved, a->Z, a->fixed_point.Q, a->fixed_point.force);
  *change = dvi__lanes_largest(count, p->moved);
  *largest = dvi__lanes_largest(count, a->Z);
  if (isnan(*change) || isnan(*largest)) *change = HUGE_VAL;
}

void dvi__preconditioner_other_forces(const dvi__action *a, double *g)
{
  const struct dvi__preconditioner *p = a->preconditioner;
  const size_t r = (size_t)a->r;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++)
      g[i * r + j] += a->h * a->weight[j] * (p->stiffness[i] * a->fixed_point.Q[i * r + j]);
}

/* ---- members side by side ---- */

static size_t members_at(const dvi__action_members *m, size_t i, size_t j)
{
  return (i * (size_t)m->action->r + j) * (size_t)m->width;
}

/* Find `rest` from sums of forces, for Z or what stands in its place. */
WIDE static void find_rest(const dvi__action_members *m, const double *sums,
                           const double *restrict before, double *restrict rest)
{
  const dvi__action *a = m->action;
  const size_t width = (size_t)m->width;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < (size_t)a->r; j++) {
      const size_t at = members_at(m, i, j);
      const double c = a->fixed_point.node[j], factor = a->fixed_point.factor[i];
      const double *start = m->start + i * width, *low = m->low + i * width;
      for (size_t k = 0; k < width; k++)
        rest[at + k] = (start[k] * c + (factor * sums[at + k] + low[k] * c)) - before[at + k];
    }
}

static void multiply_members(const dvi__action_members *m, double *product)
{
  const dvi__action *a = m->action;
  const struct dvi__preconditioner *p = a->preconditioner;
  const size_t row = (size_t)a->r * (size_t)m->width;
  for (size_t i = 0; i < (size_t)a->n; i++)
    dvi__members_product(1, a->r, a->fixed_point.lanes, a->r,
                         p->in_use + (size_t)p->place[i] * inverse_size(a), m->width,
                         m->rest + i * row, product + i * row);
}

/* Z holds the pull of K at q0 in the meantime. */
void dvi__preconditioner_begin_members(dvi__action_members *m)
{
  const dvi__action *a = m->action;
  const struct dvi__preconditioner *p = a->preconditioner;
  const size_t n = (size_t)a->n, r = (size_t)a->r, width = (size_t)m->width;
  memcpy(m->moved, m->Z, n * r * width * sizeof(double));
  for (size_t i = 0; i < n; i++) {
    const double strength = a->fixed_point.factor[i] * a->h * p->stiffness[i];
    for (size_t j = 0; j < r; j++)
      for (size_t k = 0; k < width; k++)
        m->Z[members_at(m, i, j) + k] = strength * m->origin[i * width + k] * p->row_sum[j];
  }
  find_rest(m, m->moved, m->Z, m->rest);
  multiply_members(m, m->Z);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < r; j++)
      for (size_t k = 0; k < width; k++)
        m->Q[members_at(m, i, j) + k] = m->origin[i * width + k] + m->Z[members_at(m, i, j) + k];
}

/* Move stage j of coordinate i of all members. A change that is NaN counts as infinite. */
WIDE static void move_members(const dvi__action_members *m, size_t i, size_t j, double stiffness,
                              double *restrict change, double *restrict largest)
{
  const size_t width = (size_t)m->width, at = members_at(m, i, j);
  const double weight = m->action->fixed_point.weight[j], *origin = m->origin + i * width,
               *moved = m->moved + at;
  double *restrict Z = m->Z + at, *restrict Q = m->Q + at, *restrict g = m->force + at;
  for (size_t k = 0; k < width; k++) {
    Z[k] += moved[k];
    Q[k] = origin[k] + Z[k];
    g[k] += weight * (stiffness * moved[k]);
    const double by = fabs(moved[k]), now = fabs(Z[k]);
    change[k] = by <= change[k] ? change[k] : by == by ? by : HUGE_VAL;
    largest[k] = now > largest[k] ? now : largest[k];
  }
}

void dvi__preconditioner_iterate_members(dvi__action_members *m)
{
  const dvi__action *a = m->action;
  const struct dvi__preconditioner *p = a->preconditioner;
  const size_t n = (size_t)a->n, r = (size_t)a->r, width = (size_t)m->width;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < r; j++)
      for (size_t k = 0; k < width; k++)
        m->force[members_at(m, i, j) + k] *= a->fixed_point.weight[j];
  dvi__members_product(a->n, a->r, a->fixed_point.lanes, a->r, a->fixed_point.matrix, m->width,
                       m->force, m->moved);
  find_rest(m, m->moved, m->Z, m->rest);
  multiply_members(m, m->moved);
  memset(m->change, 0, width * sizeof(double));
  memset(m->largest, 0, width * sizeof(double));
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < r; j++) move_members(m, i, j, p->stiffness[i], m->change, m->largest);
}

void dvi__preconditioner_other_forces_of_members(dvi__action_members *m)
{
  const dvi__action *a = m->action;
  const struct dvi__preconditioner *p = a->preconditioner;
  const size_t r = (size_t)a->r, count = (size_t)m->count;
  for (size_t i = 0; i < (size_t)a->n; i++)
    for (size_t j = 0; j < r; j++)
      for (size_t k = 0; k < count; k++) {
        const size_t at = (i * r + j) * count + k;
        m->forces[at] += a->h * a->weight[j] * (p->stiffness[i] * m->kept_Q[at]);
      }
}
