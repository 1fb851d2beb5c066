#include "step/split/modes.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "step/split/quadratic.h"
#include "core/memory.h"
#include "core/status.h"
#include "group/stumpff.h"
#include "num/compensated.h"
#include "num/eigen.h"

/* A block of coupled coordinates and their modes. */
typedef struct block {
  int size;
  const int *member; /* [size] coordinates, ascending */
  double *X, *MX;    /* [size*size] modes as columns */
} block;

struct dvi__modes {
  int n, block_count, largest;
  block *blocks;
  int *member;                /* [n] coordinates, block after block; modes have the same order */
  double *values;             /* owns all X and all MX */
  double *square;             /* [n] lambda */
  double h;                   /* length of step of the numbers below (0 before the first) */
  double *factor;             /* [3*n] h c_1, h^2 c_2, s c_2 of each mode */
  double *w, *force, *change; /* [n] work */
};

static dvi_status modes_no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "normal modes: no memory");
}

/* ---- blocks ---- */

static int modes_root_of(int *parent, int i)
{
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/* Set parent[i] to the first coordinate of the block of coordinate i. */
static void modes_join_blocks(const dvi__pattern *pattern, int *parent)
{
  for (int i = 0; i < pattern->columns; i++) parent[i] = i;
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++) {
      const int a = modes_root_of(parent, pattern->row[e]), b = modes_root_of(parent, j);
      parent[a > b ? a : b] = a > b ? b : a;
    }
  for (int i = 0; i < pattern->columns; i++) parent[i] = modes_root_of(parent, i);
}

/* List blocks in the order of their first coordinates. `first` becomes the number of a coordinate's
 * block. */
static void list_blocks(dvi__modes *m, int *first)
{
  int *at = m->member;
  for (int i = 0; i < m->n; i++) {
    if (first[i] == i) m->blocks[m->block_count++] = (block){.size = 0};
    first[i] = first[i] == i ? m->block_count - 1 : first[first[i]];
    m->blocks[first[i]].size++;
  }
  for (int k = 0; k < m->block_count; at += m->blocks[k++].size) m->blocks[k].member = at;
  for (int k = 0; k < m->block_count; k++) {
    if (m->blocks[k].size > m->largest) m->largest = m->blocks[k].size;
    m->blocks[k].size = 0;
  }
  for (int i = 0; i < m->n; i++) {
    block *b = &m->blocks[first[i]];
    m->member[(b->member - m->member) + b->size++] = i;
  }
}

static dvi_status modes_find_blocks(dvi__modes *m, const dvi__pattern *pattern, int most)
{
  int *first = DVI_NEW(int, m->n);
  m->blocks = DVI_NEW(block, m->n);
  m->member = DVI_NEW(int, m->n);
  const int complete = first != NULL && m->blocks != NULL && m->member != NULL;
  if (complete) {
    modes_join_blocks(pattern, first);
    list_blocks(m, first);
  }
  dvi__release(first);
  if (!complete) return modes_no_memory();
  if (m->largest <= most) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE,
                   "normal modes: %d coordinates are coupled; %d at most are possible", m->largest,
                   most);
}

/* ---- the modes of a block ---- */

/* Return the index of a coordinate among the members. */
static int modes_place_of(const block *b, int i)
{
  int low = 0, high = b->size - 1;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (b->member[middle] < i)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static void modes_gather(const dvi__pattern *pattern, const double *values, const block *b,
                         double *dense)
{
  memset(dense, 0, (size_t)b->size * (size_t)b->size * sizeof(double));
  for (int j = 0; j < b->size; j++)
    for (int e = pattern->start[b->member[j]]; e < pattern->start[b->member[j] + 1]; e++)
      dense[(size_t)j * (size_t)b->size + (size_t)modes_place_of(b, pattern->row[e])] = values[e];
}

/* Clear squared frequencies of the size of rounding errors, which would hold a free motion as a
 * spring. */
static void modes_clear_rounding(int size, double *square)
{
  const double rounding = size * DBL_EPSILON * fmax(fabs(square[0]), fabs(square[size - 1]));
  for (int k = 0; k < size; k++)
    if (fabs(square[k]) <= rounding) square[k] = 0;
}

/* Set MX = M X, by the entries of M. */
static void modes_multiply(const dvi__quadratic *q, const block *b)
{
  const size_t size = (size_t)b->size;
  for (int j = 0; j < b->size; j++)
    for (int e = q->pattern.start[b->member[j]]; e < q->pattern.start[b->member[j] + 1]; e++)
      for (size_t k = 0, i = (size_t)modes_place_of(b, q->pattern.row[e]); k < size; k++)
        b->MX[k * size + i] += q->mass[e] * b->X[k * size + (size_t)j];
}

static dvi_status find_modes(const dvi__quadratic *q, const block *b, double *square, double *K,
                             double *M)
{
  modes_gather(&q->pattern, q->stiffness, b, K);
  modes_gather(&q->pattern, q->mass, b, M);
  if (b->size > 1) {
    DVI_TRY(dvi__eigen_symmetric(b->size, K, M, square, b->X));
    modes_clear_rounding(b->size, square);
  } else if (M[0] > 0) { /* many blocks have one coordinate */
    square[0] = K[0] / M[0];
    b->X[0] = 1 / sqrt(M[0]);
  } else {
    return dvi__fail(DVI_SINGULAR, "normal modes: the mass of coordinate %d is not positive",
                     b->member[0]);
  }
  modes_multiply(q, b);
  return DVI_OK;
}

static dvi_status find_all_modes(dvi__modes *m, const dvi__quadratic *q)
{
  const size_t most = (size_t)m->largest * (size_t)m->largest;
  size_t entries = 0;
  for (int k = 0; k < m->block_count; k++)
    entries += (size_t)m->blocks[k].size * (size_t)m->blocks[k].size;
  double *K = DVI_NEW(double, most), *M = DVI_NEW(double, most),
         *X = m->values = DVI_NEW(double, 2 * entries);
  dvi_status status = K != NULL && M != NULL && X != NULL ? DVI_OK : modes_no_memory();
  for (int k = 0; k < m->block_count && status == DVI_OK; k++) {
    block *b = &m->blocks[k];
    b->X = X;
    b->MX = X + entries;
    X += (size_t)b->size * (size_t)b->size;
    status = find_modes(q, b, m->square + (b->member - m->member), K, M);
  }
  dvi__release(K);
  dvi__release(M);
  return status;
}

/* ---- create ---- */

static dvi_status modes_initialise(dvi__modes *m, const dvi_system *system, int most,
                                   dvi__evaluator *evaluator, dvi__quadratic *q)
{
  const size_t n = (size_t)m->n;
  DVI_TRY(dvi__quadratic_fill(system, evaluator, q));
  m->square = DVI_NEW(double, n);
  m->factor = DVI_NEW(double, 3 * n);
  m->w = DVI_NEW(double, n);
  m->force = DVI_NEW(double, n);
  m->change = DVI_NEW(double, n);
  if (!m->square || !m->factor || !m->w || !m->force || !m->change) return modes_no_memory();
  DVI_TRY(modes_find_blocks(m, &q->pattern, most));
  return find_all_modes(m, q);
}

dvi_status dvi__modes_create(const dvi_system *system, int most, dvi_counters *counters,
                             dvi__modes **modes)
{
  dvi__evaluator *evaluator;
  dvi__quadratic quadratic = {.mass = NULL};
  *modes = NULL;
  DVI_TRY(dvi__evaluator_create(system, 1, DVI__HESSIANS, counters, &evaluator));
  dvi__modes *made = *modes = DVI_NEW(dvi__modes, 1);
  if (made != NULL) made->n = system->n;
  const dvi_status status = made != NULL
                                ? modes_initialise(made, system, most, evaluator, &quadratic)
                                : modes_no_memory();
  dvi__quadratic_clear(&quadratic);
  dvi__evaluator_destroy(&evaluator);
  if (status != DVI_OK) dvi__modes_destroy(modes);
  return status;
}

void dvi__modes_destroy(dvi__modes **modes)
{
  dvi__modes *m = *modes;
  if (m == NULL) return;
  dvi__release(m->blocks);
  dvi__release(m->member);
  dvi__release(m->values);
  dvi__release(m->square);
  dvi__release(m->factor);
  dvi__release(m->w);
  dvi__release(m->force);
  dvi__release(m->change);
  dvi__release(m);
  *modes = NULL;
}

int dvi__modes_block_count(const dvi__modes *m)
{
  return m->block_count;
}

int dvi__modes_largest_block(const dvi__modes *m)
{
  return m->largest;
}

const double *dvi__modes_squares(const dvi__modes *m)
{
  return m->square;
}

void dvi__modes_range(const dvi__modes *m, double *least, double *most)
{
  double low = INFINITY, high = 0;
  for (int k = 0; k < m->n; k++) high = fmax(high, m->square[k]);
  for (int k = 0; k < m->n; k++)
    if (m->square[k] > 1e-10 * high) low = fmin(low, m->square[k]);
  *most = sqrt(high);
  *least = high > 0 ? sqrt(low) : 0;
}

/* ---- coordinates and modes ---- */

/* Compute the products y of each column with x. */
static void modes_multiply_columns(const block *b, const double *columns, const double *x,
                                   double *y)
{
  for (int k = 0; k < b->size; k++) {
    const double *column = columns + (size_t)k * (size_t)b->size;
    y[k] = 0;
    for (int i = 0; i < b->size; i++) y[k] += column[i] * x[b->member[i]];
  }
}

void dvi__modes_of_forces(const dvi__modes *m, const double *f, double *y)
{
  for (const block *b = m->blocks; b < m->blocks + m->block_count; y += b++->size)
    modes_multiply_columns(b, b->X, f, y);
}

void dvi__modes_of_coordinates(const dvi__modes *m, const double *q, double *y)
{
  for (const block *b = m->blocks; b < m->blocks + m->block_count; y += b++->size)
    modes_multiply_columns(b, b->MX, q, y);
}

/* Add the column of each mode, times y, to x. */
static void modes_add_columns(const block *b, const double *columns, const double *y, double *x)
{
  for (int k = 0; k < b->size; k++)
    for (int i = 0; i < b->size; i++)
      x[b->member[i]] += columns[(size_t)k * (size_t)b->size + (size_t)i] * y[k];
}

void dvi__modes_to_coordinates(const dvi__modes *m, const double *y, double *q)
{
  memset(q, 0, (size_t)m->n * sizeof(double));
  for (const block *b = m->blocks; b < m->blocks + m->block_count; y += b++->size)
    modes_add_columns(b, b->X, y, q);
}

void dvi__modes_to_forces(const dvi__modes *m, const double *y, double *f)
{
  memset(f, 0, (size_t)m->n * sizeof(double));
  for (const block *b = m->blocks; b < m->blocks + m->block_count; y += b++->size)
    modes_add_columns(b, b->MX, y, f);
}

/* ---- motion ---- */

/* Compute the hyperbolic functions of x = sqrt(-s), and sinh x - x by its series where it
 * cancels. */
static void modes_hyperbolic(double s, double c[4])
{
  const double x = sqrt(-s), half = sinh(0.5 * x) / x;
  c[0] = cosh(x);
  c[1] = sinh(x) / x;
  c[2] = 2 * half * half;
  c[3] = 1;
  for (int j = 9; j > 0; j--) c[3] = 1 - s / ((2 * j + 2) * (2 * j + 3)) * c[3];
  c[3] = x < 1 ? c[3] / 6 : (c[1] - 1) / -s;
}

void dvi__modes_functions(double s, double c[4])
{
  if (s < 0)
    modes_hyperbolic(s, c);
  else
    dvi__stumpff_four(s, c);
}

static void make_factors(dvi__modes *m, double h)
{
  for (int k = 0; k < m->n; k++) {
    double c[4];
    const double s = h * h * m->square[k];
    dvi__modes_functions(s, c);
    m->factor[3 * k] = h * c[1];
    m->factor[3 * k + 1] = h * h * c[2];
    m->factor[3 * k + 2] = s * c[2];
  }
  m->h = h;
}

/* Move each mode by y(h) - y = h c_1 w - h^2 c_2 X^T V_q and w(h) - w = -h c_1 X^T V_q - s c_2
 * w. */
void dvi__modes_move(dvi__modes *m, double h, const double *V_q, const dvi__phase *phase)
{
  double *w = m->w, *force = m->force;
  if (m->h != h) make_factors(m, h);
  dvi__modes_of_forces(m, phase->p, w);
  dvi__modes_of_forces(m, V_q, force);
  for (int k = 0; k < m->n; k++) {
    const double *factor = m->factor + 3 * (ptrdiff_t)k,
                 y_change = factor[0] * w[k] - factor[1] * force[k];
    w[k] = -factor[0] * force[k] - factor[2] * w[k];
    force[k] = y_change;
  }
  dvi__modes_to_coordinates(m, force, m->change);
  dvi__add_compensated_all(m->n, phase->q, phase->q_compensation, m->change);
  dvi__modes_to_forces(m, w, m->change);
  dvi__add_compensated_all(m->n, phase->p, phase->p_compensation, m->change);
}
