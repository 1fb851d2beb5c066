/* Signs are taken from numbers of double precision where an error bound allows it. Otherwise the
 * determinants are computed as integers of 384 bits. Ties are broken by symbolic perturbation
 * (Edelsbrunner and Muecke 1990, Devillers and Teillaud 2011). */
#include "field/mesh/delaunay/predicate.h"

#include <float.h>
#include <math.h>

enum { AXES = DVI_MESH_DIMENSION_MAX, ROWS = AXES + 1 };

/* ---- with rounding ---- */

static inline double minor_of_two(const double *a, const double *b)
{
  return a[0] * b[1] - a[1] * b[0];
}

static inline double minor_of_three(const double *a, const double *b, const double *c)
{
  return minor_of_two(a, b) * c[2] - minor_of_two(a, c) * b[2] + minor_of_two(b, c) * a[2];
}

static inline double minor_of_four(const double *a, const double *b, const double *c,
                                   const double *d)
{
  return minor_of_three(a, b, c) * d[3] - minor_of_three(a, b, d) * c[3] +
         minor_of_three(a, c, d) * b[3] - minor_of_three(b, c, d) * a[3];
}

/* Give the determinant of all rows but one. */
static inline double minor_without(int n, double row[ROWS][AXES], int left_out)
{
  const double *r[AXES] = {row[0], row[0], row[0], row[0]};
  for (int i = 0, k = 0; i <= n; i++)
    if (i != left_out) r[k++] = row[i];
  if (n == 2) return minor_of_two(r[0], r[1]);
  return n == 3 ? minor_of_three(r[0], r[1], r[2]) : minor_of_four(r[0], r[1], r[2], r[3]);
}

/* Give the rows x_i - p, and the product of the largest entries of the columns. */
static inline double rows_towards(const dvi__sites *s, const int *vertex, int slot, int p,
                                  double row[ROWS][AXES])
{
  const double *origin = s->x + (int64_t)p * s->n;
  double largest[AXES] = {0}, product = 1;
  for (int i = 0; i <= s->n; i++) {
    if (i == slot) continue;
    const double *x = s->x + (int64_t)vertex[i] * s->n;
    for (int l = 0; l < s->n; l++) {
      row[i][l] = x[l] - origin[l];
      largest[l] = fmax(largest[l], fabs(row[i][l]));
    }
  }
  for (int l = 0; l < s->n; l++) product *= largest[l];
  return product;
}

/* The errors of a sum of `terms` products, each of which went through fewer than 40 roundings, and
 * the last digits of numbers that underflow. */
static inline double error_of(int terms, double product)
{
  return terms * 20 * DBL_EPSILON * product + DBL_MIN;
}

/* ---- with integers ---- */

__extension__ typedef __int128 twofold;
__extension__ typedef unsigned __int128 unsigned_twofold;

enum { LIMBS = 6, SHIFT = 31 };

/* An integer modulo 2^384, of which one half is negative. */
typedef struct wide {
  uint64_t limb[LIMBS];
} wide;

static int sign_of(const wide *a)
{
  uint64_t any = 0;
  for (int i = 0; i < LIMBS; i++) any |= a->limb[i];
  return a->limb[LIMBS - 1] >> 63 ? -1 : any != 0;
}

static void negate(wide *a)
{
  uint64_t carry = 1;
  for (int i = 0; i < LIMBS; i++) {
    a->limb[i] = ~a->limb[i] + carry;
    carry = carry && a->limb[i] == 0;
  }
}

/* Add a * factor to the sum. */
static void add_product(wide *sum, const wide *a, int64_t factor)
{
  const uint64_t size = factor < 0 ? 0 - (uint64_t)factor : (uint64_t)factor;
  uint64_t high = 0, borrow = 0;
  for (int i = 0; i < LIMBS; i++) {
    const unsigned_twofold product = (unsigned_twofold)a->limb[i] * size + high;
    const uint64_t low = (uint64_t)product, old = sum->limb[i];
    high = (uint64_t)(product >> 64);
    if (factor < 0) {
      const uint64_t without = old - low;
      sum->limb[i] = without - borrow;
      borrow = (old < low) | (without < borrow);
    } else {
      const uint64_t with = old + low;
      sum->limb[i] = with + borrow;
      borrow = (with < low) | (sum->limb[i] < borrow);
    }
  }
}

/* Add a times a number of at most 124 bits to the sum. */
static void add_long_product(wide *sum, const wide *a, twofold factor)
{
  const int64_t top = (int64_t)(factor >> (2 * SHIFT));
  wide high = {{0}}, middle = {{0}};
  add_product(&high, a, top);
  add_product(&middle, &high, (int64_t)1 << SHIFT);
  add_product(sum, &middle, (int64_t)1 << SHIFT);
  add_product(sum, a, (int64_t)(factor - top * ((twofold)1 << (2 * SHIFT))));
}

/* Give the determinants of all subsets of rows, each with as many columns, the first ones. A
 * subset is numbered by its bits. */
static void expand_minors(int n, int64_t row[ROWS][AXES], unsigned rows, wide *minor)
{
  minor[0] = (wide){{1}};
  for (unsigned set = 1; set <= rows; set++) {
    int size = 0;
    for (int i = 0; i <= n; i++) size += (int)(set >> i & 1);
    if ((set & ~rows) != 0 || size > n) continue;
    minor[set] = (wide){{0}};
    for (int i = 0, sign = size % 2 ? 1 : -1; i <= n; i++)
      if (set >> i & 1) {
        add_product(&minor[set], &minor[set ^ 1U << i], sign * row[i][size - 1]);
        sign = -sign;
      }
  }
}

static int64_t integer(double x)
{
  return (int64_t)(x * 0x1p60);
}

static void integer_rows(const dvi__sites *s, const int *vertex, int slot, int p,
                         int64_t row[ROWS][AXES])
{
  for (int i = 0; i <= s->n; i++)
    for (int l = 0; l < s->n && i != slot; l++)
      row[i][l] = integer(s->x[(int64_t)vertex[i] * s->n + l]) -
                  integer(s->x[(int64_t)p * s->n + l]);
}

static twofold integer_weight(const dvi__sites *s, int p)
{
  return s->weight != NULL ? (twofold)(s->weight[p] * 0x1p120) : 0;
}

/* Tell whether point a comes before b in the order of their coordinates. */
static int precedes(const dvi__sites *s, int a, int b)
{
  const double *x = s->x + (int64_t)a * s->n, *y = s->x + (int64_t)b * s->n;
  for (int l = 0; l < s->n; l++)
    if (x[l] != y[l]) return x[l] < y[l];
  return 0;
}

/* Of the points whose heights matter, the first one decides. That of p always matters, because the
 * simplex has a volume. */
static int break_tie(const dvi__sites *s, const int *vertex, int p, const int *sign)
{
  int first = -1;
  for (int i = 0; i <= s->n; i++)
    if (sign[i] != 0 && (first < 0 || precedes(s, vertex[i], vertex[first]))) first = i;
  return first < 0 || precedes(s, p, vertex[first]) || sign[first] < 0;
}

static int is_inside_exactly(const dvi__sites *s, const int *vertex, int p)
{
  const int n = s->n;
  const unsigned all = (1U << (n + 1)) - 1;
  int64_t row[ROWS][AXES] = {{0}};
  int sign[ROWS];
  wide minor[1 << ROWS], sum = {{0}};
  integer_rows(s, vertex, -1, p, row);
  expand_minors(n, row, all, minor);
  for (int i = 0; i <= n; i++) {
    wide *cofactor = &minor[all ^ 1U << i];
    twofold height = integer_weight(s, p) - integer_weight(s, vertex[i]);
    for (int l = 0; l < n; l++) height += (twofold)row[i][l] * row[i][l];
    if (i % 2) negate(cofactor);
    sign[i] = sign_of(cofactor);
    add_long_product(&sum, cofactor, height);
  }
  const int whole = sign_of(&sum);
  return whole != 0 ? whole > 0 : break_tie(s, vertex, p, sign);
}

static int side_exactly(const dvi__sites *s, const int *vertex, int slot, int p)
{
  const unsigned rows = ((1U << (s->n + 1)) - 1) ^ 1U << slot;
  int64_t row[ROWS][AXES] = {{0}};
  wide minor[1 << ROWS];
  integer_rows(s, vertex, slot, p, row);
  expand_minors(s->n, row, rows, minor);
  return slot % 2 ? -sign_of(&minor[rows]) : sign_of(&minor[rows]);
}

/* ---- both ---- */

int dvi__side(const dvi__sites *s, const int *vertex, int slot, int p)
{
  static const int terms[] = {1, 1, 2, 6, 24};
  double row[ROWS][AXES] = {{0}};
  const double error = error_of(terms[s->n], rows_towards(s, vertex, slot, p, row)),
               minor = minor_without(s->n, row, slot);
  if (!(fabs(minor) > error)) return side_exactly(s, vertex, slot, p);
  return (minor > 0) == (slot % 2 == 0) ? 1 : -1;
}

int dvi__is_inside(const dvi__sites *s, const int *vertex, int p)
{
  static const int terms[] = {1, 2, 6, 24, 120};
  double row[ROWS][AXES] = {{0}}, sum = 0, largest = 0;
  const double product = rows_towards(s, vertex, -1, p, row);
  for (int i = 0; i <= s->n; i++) {
    double height = 0;
    for (int l = 0; l < s->n; l++) height += row[i][l] * row[i][l];
    if (s->weight != NULL) {
      largest = fmax(largest, s->weight[p] + s->weight[vertex[i]]);
      height += s->weight[p] - s->weight[vertex[i]];
    }
    largest = fmax(largest, fabs(height));
    const double part = height * minor_without(s->n, row, i);
    sum += i % 2 ? -part : part;
  }
  if (!(fabs(sum) > error_of(terms[s->n], product * largest)))
    return is_inside_exactly(s, vertex, p);
  return sum > 0;
}
