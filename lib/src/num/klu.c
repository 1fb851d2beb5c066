/* Sparse LU by KLU, with one symbolic analysis, then numeric refactorisations with one order of the
 * pivots, chosen once. A matrix for which that order is bad gets a full factorisation of its own.
 * So a factor depends on its matrix alone, not on earlier ones, and a restarted run gives the same
 * bits.
 *
 * Columns are ordered by approximate minimum degree (KLU's own call of AMD). Other orders and other
 * solvers were measured on nets of springs, user seconds of a complex factor, with Debian 12's
 * SuiteSparse 5.12 and reference BLAS:
 *
 *     net, unknowns            KLU, AMD   KLU, METIS   UMFPACK, AMD   UMFPACK, METIS
 *     120 x 120, n =  28 800       0.25         0.25           0.25             0.26
 *     223 x 223, n =  99 458        2.0          2.0
 *     20^3,      n =  24 000         22           10            8.7              4.1
 *
 * and of real ones 0.13 s by KLU beside 0.08 s by CHOLMOD's supernodes on the first net, 9.5 s
 * beside 1.0 s on the last. UMFPACK and CHOLMOD take memory from the heap in every factorisation,
 * which a step may not. Both are under the GPL (CHOLMOD in its supernodal part), which the library
 * is not. Where KLU takes long, large systems go without a factor
 * (method/element/element_newton.c). */
#include <klu.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/factor.h"

/* Smallest reciprocal pivot growth with which kept pivots are trusted. Six digits are lost then,
 * which Newton's iteration restores. */
#define LEAST_GROWTH 1e-6

/* Small enough beside ones for the diagonal to be preferred as pivots. */
#define OFF_DIAGONAL 1e-6

/* KLU's functions for real numbers, and for complex ones as pairs of real ones. */
typedef struct arithmetic {
  int parts; /* numbers in an entry */
  klu_numeric *(*factor)(int *start, int *row, double *values, klu_symbolic *symbolic,
                         klu_common *common);
  int (*refactor)(int *start, int *row, double *values, klu_symbolic *symbolic,
                  klu_numeric *numeric, klu_common *common);
  int (*growth)(int *start, int *row, double *values, klu_symbolic *symbolic, klu_numeric *numeric,
                klu_common *common);
  int (*condition)(klu_symbolic *symbolic, klu_numeric *numeric, klu_common *common);
  int (*solve)(klu_symbolic *symbolic, klu_numeric *numeric, int rows, int sides, double *b,
               klu_common *common);
  int (*forget)(klu_numeric **numeric, klu_common *common);
} arithmetic;

static const arithmetic real = {1,         klu_factor, klu_refactor,    klu_rgrowth,
                                klu_rcond, klu_solve,  klu_free_numeric};
static const arithmetic complex = {2,           klu_z_factor, klu_z_refactor,    klu_z_rgrowth,
                                   klu_z_rcond, klu_z_solve,  klu_z_free_numeric};

typedef struct sparse {
  const arithmetic *of;
  klu_common common;
  klu_symbolic *symbolic;
  int owns_symbolic;     /* else the analysis belongs to another solver of the same pattern */
  int has_room;          /* room for a factor in the standing order of the pivots has been made */
  klu_numeric *standing; /* factor in the standing order, NULL if the pattern has no such order */
  klu_numeric *own;      /* factor of one matrix that needed an order of its own */
  klu_numeric *current;  /* one of the two factors */
  char *seen;            /* [n] work */
} sparse;

static void klu_destroy(void *factor)
{
  sparse *s = factor;
  if (s == NULL) return;
  s->of->forget(&s->standing, &s->common);
  s->of->forget(&s->own, &s->common);
  if (s->owns_symbolic) klu_free_symbolic(&s->symbolic, &s->common);
  dvi__release(s->seen);
  dvi__release(s);
}

/* More fill-in than an int can count is a lack of memory, too. */
static int lacks_memory(int status)
{
  return status == KLU_OUT_OF_MEMORY || status == KLU_TOO_LARGE;
}

/* Factor a made-up matrix, so that later factors find their memory and no step allocates. Its
 * pivots are on the diagonal, where they are good for the Jacobians of short steps. A pattern
 * without a diagonal may leave no factor. Each real matrix then makes its own. */
static dvi_status klu_make_room(sparse *s, const dvi__pattern *pattern)
{
  const int parts = s->of->parts;
  double *entries = DVI_NEW(double, (size_t)parts *(size_t)dvi__pattern_entries(pattern));
  if (entries == NULL)
    return dvi__fail(DVI_NO_MEMORY, "KLU: no memory for %d entries", dvi__pattern_entries(pattern));
  for (int j = 0; j < pattern->columns; j++)
    for (int e = pattern->start[j]; e < pattern->start[j + 1]; e++)
      entries[(ptrdiff_t)parts * e] = pattern->row[e] == j ? 1.0 : OFF_DIAGONAL;
  s->standing = s->of->factor(pattern->start, pattern->row, entries, s->symbolic, &s->common);
  dvi__release(entries);
  s->has_room = s->standing != NULL || !lacks_memory(s->common.status);
  if (s->has_room) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "KLU: no memory to factor %d columns", pattern->columns);
}

static dvi_status klu_analyse(sparse *s, const dvi__pattern *pattern, const sparse *like)
{
  klu_defaults(&s->common);
  s->common.scale = 0; /* the values come equilibrated */
  s->owns_symbolic = like == NULL;
  s->symbolic = like != NULL
                    ? like->symbolic
                    : klu_analyze(pattern->columns, pattern->start, pattern->row, &s->common);
  if (s->symbolic != NULL) return DVI_OK;
  if (lacks_memory(s->common.status))
    return dvi__fail(DVI_NO_MEMORY, "KLU: no memory to analyse %d columns", pattern->columns);
  return dvi__fail(DVI_SOLVER_FAILED, "KLU: the analysis of %d columns failed (status %d)",
                   pattern->columns, s->common.status);
}

static dvi_status klu_create(const dvi__factor_form *form, const arithmetic *of, void **factor)
{
  sparse *s = *factor = DVI_NEW(sparse, 1);
  if (s == NULL) return dvi__fail(DVI_NO_MEMORY, "KLU: no memory");
  const int n = form->pattern->columns;
  s->of = of;
  s->seen = DVI_NEW(char, (size_t)n);
  const dvi_status status = s->seen != NULL
                                ? klu_analyse(s, form->pattern, form->like)
                                : dvi__fail(DVI_NO_MEMORY, "KLU: no memory for %d columns", n);
  if (status == DVI_OK) return DVI_OK;
  klu_destroy(s);
  *factor = NULL;
  return status;
}

static dvi_status klu_create_real(const dvi__factor_form *form, void **factor)
{
  return klu_create(form, &real, factor);
}

static dvi_status klu_create_complex(const dvi__factor_form *form, void **factor)
{
  return klu_create(form, &complex, factor);
}

/* Estimate the condition by the smallest and largest pivot, which is coarser than LAPACK's
 * estimate, but nearly free. */
static int well_conditioned(sparse *s)
{
  return s->of->condition(s->symbolic, s->current, &s->common) &&
         s->common.rcond >= DVI__LEAST_RCOND;
}

/* Tell whether the current factor, with these entries, can be trusted. */
static int is_good(sparse *s, const dvi__pattern *pattern, double *entries)
{
  return s->of->growth(pattern->start, pattern->row, entries, s->symbolic, s->current,
                       &s->common) &&
         s->common.rgrowth >= LEAST_GROWTH && well_conditioned(s);
}

static int is_on_diagonal(const sparse *s, const klu_numeric *numeric, int n)
{
  for (int i = 0; i < n; i++)
    if (numeric->Pnum[i] != s->symbolic->Q[i]) return 0;
  return 1;
}

/* Factor the first matrix. If its pivots are good on the diagonal, it makes the room itself. The
 * order of its pivots is that of a made-up matrix, and its numbers are those of a refactorisation,
 * to the last bit (tests/num/test_linear.c). */
static int factor_first(sparse *s, const dvi__pattern *pattern, double *entries)
{
  s->current = s->standing = s->of->factor(pattern->start, pattern->row, entries, s->symbolic,
                                           &s->common);
  s->has_room = s->standing != NULL && is_on_diagonal(s, s->standing, pattern->columns) &&
                is_good(s, pattern, entries);
  if (!s->has_room) s->of->forget(&s->standing, &s->common);
  return s->has_room;
}

/* Refactor in the standing order. klu_refactor keeps the order of the pivots and allocates nothing.
 * The reciprocal pivot growth reveals a matrix for which the order is bad. */
static int refactor_in_order(sparse *s, const dvi__pattern *pattern, double *entries)
{
  s->current = s->standing;
  return s->standing != NULL &&
         s->of->refactor(pattern->start, pattern->row, entries, s->symbolic, s->standing,
                         &s->common) &&
         is_good(s, pattern, entries);
}

/* Factor. A full factorisation lets entries grow 1/0.001 times at a pivot before it chooses another
 * one. */
static dvi_status klu_factor_again(void *factor, const dvi__pattern *pattern, const double *values)
{
  sparse *s = factor;
  double *entries = (double *)(uintptr_t)values; /* KLU's interface lacks const, but only reads */
  s->of->forget(&s->own, &s->common);
  if (!s->has_room && factor_first(s, pattern, entries)) return DVI_OK;
  if (!s->has_room) DVI_TRY(klu_make_room(s, pattern));
  if (refactor_in_order(s, pattern, entries)) return DVI_OK;
  s->current = s->own = s->of->factor(pattern->start, pattern->row, entries, s->symbolic,
                                      &s->common);
  if (s->own != NULL && well_conditioned(s)) return DVI_OK;
  if (s->own == NULL && lacks_memory(s->common.status))
    return dvi__fail(DVI_NO_MEMORY, "KLU: no memory to factor %d columns", pattern->columns);
  return dvi__fail(DVI_SINGULAR, "KLU: the %d x %d matrix is singular to working precision",
                   pattern->rows, pattern->columns);
}

static dvi_status klu_solve_one(void *factor, const dvi__pattern *pattern, double *b)
{
  sparse *s = factor;
  s->of->solve(s->symbolic, s->current, pattern->rows, 1, b, &s->common);
  return DVI_OK;
}

/* Tell whether the permutation takes an odd number of exchanges. A cycle takes one less than its
 * length. */
static int is_odd(int n, const int *permutation, char *seen)
{
  int odd = 0;
  memset(seen, 0, (size_t)n);
  for (int i = 0; i < n; i++)
    for (int j = i; !seen[j]; j = permutation[j]) {
      seen[j] = 1;
      odd ^= permutation[j] != i;
    }
  return odd;
}

static int klu_sign(const void *factor, const dvi__pattern *pattern)
{
  const sparse *s = factor;
  const double *pivot = s->current->Udiag;
  int negative = is_odd(pattern->columns, s->current->Pnum, s->seen) ^
                 is_odd(pattern->columns, s->symbolic->Q, s->seen);
  for (int i = 0; i < pattern->columns; i++) negative ^= pivot[i] < 0;
  return negative ? -1 : 1;
}

/* That of the last factorisation, which has asked for it. */
static double klu_condition(const void *factor)
{
  return ((const sparse *)factor)->common.rcond;
}

/* Pivots on the diagonal are those of A = L D L^T. A definite matrix keeps them there, because none
 * of them is small beside its column. */
static int klu_is_definite(const void *factor, const dvi__pattern *pattern, int sign)
{
  const sparse *s = factor;
  const double *pivot = s->current->Udiag;
  for (int i = 0; i < pattern->columns; i++)
    if (!(sign * pivot[i] > 0)) return 0;
  return is_on_diagonal(s, s->current, pattern->columns);
}

/* AMD estimates both costs from below. A factor counts its entries. */
static dvi__linear_cost klu_cost(const void *factor, const dvi__pattern *pattern)
{
  const sparse *s = factor;
  const double entries = s->standing != NULL ? (double)s->standing->lnz + s->standing->unz
                                             : s->symbolic->lnz + s->symbolic->unz;
  return (dvi__linear_cost){entries - pattern->columns, s->symbolic->est_flops};
}

const dvi__factor_kind dvi__sparse_factor = {.name = "sparse LU (KLU)",
                                             .create = klu_create_real,
                                             .destroy = klu_destroy,
                                             .refactor = klu_factor_again,
                                             .solve = klu_solve_one,
                                             .sign = klu_sign,
                                             .is_definite = klu_is_definite,
                                             .condition = klu_condition,
                                             .cost = klu_cost};

/* A multiplication of complex numbers takes four of real ones. */
static dvi__linear_cost klu_complex_cost(const void *factor, const dvi__pattern *pattern)
{
  const dvi__linear_cost one = klu_cost(factor, pattern);
  return (dvi__linear_cost){2 * one.entries, 4 * one.operations};
}

/* L has a unit diagonal. */
static double klu_complex_log_determinant(const void *factor, const dvi__pattern *pattern)
{
  const double *pivot = ((const sparse *)factor)->current->Udiag;
  double sum = 0;
  for (ptrdiff_t i = 0; i < pattern->columns; i++)
    sum += log(hypot(pivot[2 * i], pivot[2 * i + 1]));
  return sum;
}

const dvi__factor_kind dvi__complex_factor = {.name = "sparse complex LU (KLU)",
                                              .create = klu_create_complex,
                                              .destroy = klu_destroy,
                                              .refactor = klu_factor_again,
                                              .solve = klu_solve_one,
                                              .log_determinant = klu_complex_log_determinant,
                                              .cost = klu_complex_cost};
