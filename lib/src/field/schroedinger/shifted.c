#include "field/schroedinger/shifted.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/linear.h"

struct dvi__shifted {
  const dvi_schroedinger *s;
  int shifts;
  double complex *c;
  double middle;
  int *start; /* [free+1] of the pattern, whose rows are columns, too */
  dvi__pattern pattern;
  dvi__linear **factor; /* [shifts] NULL for fourier */
  double *H, *pairs;    /* [entries] and [2*entries], or [2*free] if that is more */
};

static dvi_status make_factors(dvi__shifted *a)
{
  const dvi_schroedinger *s = a->s;
  const int64_t entries = s->T.start[s->free];
  a->start = DVI_NEW(int, s->free + 1);
  a->factor = DVI_NEW(dvi__linear *, a->shifts);
  a->H = DVI_NEW(double, entries);
  a->pairs = DVI_NEW(double, 2 * (entries > s->free ? entries : s->free));
  if (!a->start || !a->factor || !a->H || !a->pairs)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for matrices with %lld entries",
                     (long long)entries);
  for (int64_t i = 0; i <= s->free; i++) a->start[i] = (int)s->T.start[i];
  a->pattern = (dvi__pattern){(int)s->free, (int)s->free, a->start, s->T.column};
  DVI_TRY(dvi__linear_create(&a->pattern, DVI__LINEAR_COMPLEX, NULL, a->factor));
  for (int j = 1; j < a->shifts; j++)
    DVI_TRY(dvi__linear_create_like(a->factor[0], DVI__LINEAR_COMPLEX, NULL, a->factor + j));
  return DVI_OK;
}

dvi_status dvi__shifted_create(const dvi_schroedinger *s, int shifts, dvi__shifted **made)
{
  dvi__shifted *a = DVI_NEW(dvi__shifted, 1);
  *made = NULL;
  if (a == NULL) return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for a solver");
  *a = (dvi__shifted){.s = s, .shifts = shifts, .c = DVI_NEW(double complex, shifts)};
  dvi_status status = a->c != NULL ? DVI_OK
                                   : dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for shifts");
  if (status == DVI_OK && !s->is_fourier) status = make_factors(a);
  if (status == DVI_OK)
    *made = a;
  else
    dvi__shifted_destroy(&a);
  return status;
}

/* The first solver's analysis serves the others, which are destroyed before. */
void dvi__shifted_destroy(dvi__shifted **shifted)
{
  if (shifted == NULL || *shifted == NULL) return;
  dvi__shifted *a = *shifted;
  for (int j = a->shifts - 1; j >= 0 && a->factor != NULL; j--) dvi__linear_destroy(a->factor + j);
  dvi__release(a->factor);
  dvi__release(a->start);
  dvi__release(a->H);
  dvi__release(a->pairs);
  dvi__release(a->c);
  dvi__release(a);
  *shifted = NULL;
}

static double middle_of(const dvi_schroedinger *s, const double *V)
{
  double least = INFINITY, most = -INFINITY;
  for (int64_t k = 0; k < s->points && V != NULL; k++) {
    least = fmin(least, V[k]);
    most = fmax(most, V[k]);
  }
  return V != NULL ? 0.5 * least + 0.5 * most : 0;
}

dvi_status dvi__shifted_factor(dvi__shifted *a, const double complex *c, const double *V)
{
  const dvi_schroedinger *s = a->s;
  for (int j = 0; j < a->shifts; j++) a->c[j] = c[j];
  if (s->is_fourier) {
    a->middle = middle_of(s, V);
    return DVI_OK;
  }
  dvi__schroedinger_assemble(s, V, a->H);
  for (int j = 0; j < a->shifts; j++) {
    for (int64_t e = 0; e < s->T.start[s->free]; e++) {
      const double complex entry = s->M[e] + c[j] * a->H[e];
      a->pairs[2 * e] = creal(entry);
      a->pairs[2 * e + 1] = cimag(entry);
    }
    const dvi_status status = dvi__linear_factor(a->factor[j], a->pairs);
    if (status != DVI_OK)
      return dvi__fail_in(status, "schroedinger: the matrix M + i dt H of a step");
  }
  return DVI_OK;
}

static void solve_diagonal(const dvi__shifted *a, int j, double *b)
{
  const int64_t n = a->s->free;
  for (int64_t i = 0; i < n; i++) {
    const double complex x = dvi__of_parts(b[i], b[n + i]) /
                             (1 + a->c[j] * (a->s->diagonal[i] + a->middle));
    b[i] = creal(x);
    b[n + i] = cimag(x);
  }
}

void dvi__shifted_solve(dvi__shifted *a, int j, double *b)
{
  const int64_t n = a->s->free;
  if (a->factor == NULL) {
    solve_diagonal(a, j, b);
    return;
  }
  for (int64_t i = 0; i < n; i++) {
    a->pairs[2 * i] = b[i];
    a->pairs[2 * i + 1] = b[n + i];
  }
  (void)dvi__linear_solve(a->factor[j], a->pairs); /* a factor always gives a solution */
  for (int64_t i = 0; i < n; i++) {
    b[i] = a->pairs[2 * i];
    b[n + i] = a->pairs[2 * i + 1];
  }
}
