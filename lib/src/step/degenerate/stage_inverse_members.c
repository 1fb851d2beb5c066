/* The operations of stage_inverse.c and num/simd/small_inverse.c, in their order. */
#include "step/degenerate/stage_inverse_members.h"

#include "core/memory.h"
#include "core/status.h"
#include "num/simd/small_inverse.h"
#include "step/degenerate/stage_inverse_struct.h"

enum { MOST = DVI__NEAR_ONE_MOST, STAGES = DVI__STAGE_LANES };

typedef dvi__abreast abreast;

struct dvi__stage_inverse_members {
  const dvi__stage_inverse *one;
  dvi__stage_entry_members *given, *turned; /* [n*n] by columns */
  abreast *Omega, *inverse;                 /* [n*n], [unknowns*unknowns], by columns */
};

/* ---- create ---- */

dvi_status dvi__stage_inverse_members_create(const dvi__stage_inverse *one,
                                             dvi__stage_inverse_members **members)
{
  const size_t n = (size_t)one->n, unknowns = (size_t)one->unknowns;
  dvi__stage_inverse_members *m = *members = DVI_NEW(dvi__stage_inverse_members, 1);
  if (m == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  m->one = one;
  m->given = DVI_NEW(dvi__stage_entry_members, n * n);
  m->turned = DVI_NEW(dvi__stage_entry_members, n * n);
  m->Omega = DVI_NEW(abreast, n * n);
  m->inverse = DVI_NEW(abreast, unknowns * unknowns);
  if (m->given && m->turned && m->Omega && m->inverse) return DVI_OK;
  dvi__stage_inverse_members_destroy(members);
  return dvi__fail(DVI_NO_MEMORY, "no memory for inverses of %d stages", one->m);
}

void dvi__stage_inverse_members_destroy(dvi__stage_inverse_members **members)
{
  dvi__stage_inverse_members *m = *members;
  if (m == NULL) return;
  dvi__release(m->given);
  dvi__release(m->turned);
  dvi__release(m->Omega);
  dvi__release(m->inverse);
  dvi__release(m);
  *members = NULL;
}

dvi__stage_entry_members *dvi__stage_inverse_members_entry(dvi__stage_inverse_members *m, int i,
                                                           int j)
{
  return m->given + j * m->one->n + i;
}

/* ---- the matrix ---- */

WIDE static void sum_two_forms(const dvi__stage_inverse_members *m, int count, const double *weight)
{
  for (int at = 0; at < m->one->n * m->one->n; at++) {
    const dvi__stage_entry_members *of = m->given + at;
    abreast sum = {0};
    for (int k = 0; k < count; k++) sum += weight[k] * (of->A[k] - of->B[k]);
    m->Omega[at] = sum;
  }
}

/* Each member has its own exchanges. */
static void invert_two_forms(const dvi__stage_inverse_members *m, int regular[DVI__ABREAST])
{
  const int n = m->one->n;
  double Omega[MOST * MOST];
  for (int lane = 0; lane < DVI__ABREAST; lane++) {
    for (int at = 0; at < n * n; at++) Omega[at] = m->Omega[at][lane];
    regular[lane] &= dvi__small_invert(n, Omega) != 0;
    for (int at = 0; at < n * n; at++) m->Omega[at][lane] = Omega[at];
  }
}

INLINE void turn_members_entry(const dvi__stage_inverse_members *m, int i, int j)
{
  const int n = m->one->n, stages = m->one->m;
  dvi__stage_entry_members *sum = m->turned + j * n + i;
  const dvi__stage_entry_members *of = m->given + j * n;
  for (int k = 0; k < stages; k++) {
    abreast A = {0}, B = {0}, K = {0};
    for (int l = 0; l < n; l++) {
      A += m->Omega[l * n + i] * of[l].A[k];
      B += m->Omega[l * n + i] * of[l].B[k];
      K += m->Omega[l * n + i] * of[l].K[k];
    }
    sum->A[k] = A;
    sum->B[k] = B;
    sum->K[k] = K;
  }
  abreast a = {0};
  for (int l = 0; l < n; l++) a += m->Omega[l * n + i] * of[l].a;
  sum->a = a;
}

INLINE void write_members_rows(const dvi__stage_inverse *s, const dvi__stage_entry_members *of,
                               int l, abreast *rows)
{
  const int last = s->m - 1;
  for (int k = 0; k < s->m; k++) {
    abreast sum = {0};
    for (int r = 0; r < s->m; r++) sum += of->A[r] * s->path[l][r][k];
    if (s->has_end) sum += of->K[last] * s->path_of_end[l][k];
    if (s->has_end && l == last) {
      sum += -of->a * s->of_start[k];
      sum += -of->B[last] * s->of_end[k];
    }
    rows[k] = sum - (of->K[k] * s->inner[l][k] + of->B[k] * s->unit[l][k]);
  }
}

WIDE static void write_members_matrix(const dvi__stage_inverse_members *m)
{
  const dvi__stage_inverse *s = m->one;
  for (int j = 0; j < s->n; j++)
    for (int i = 0; i < s->n; i++) turn_members_entry(m, i, j);
  for (int j = 0; j < s->n; j++)
    for (int l = 0; l < s->m; l++)
      for (int i = 0; i < s->n; i++)
        write_members_rows(s, m->turned + j * s->n + i, l,
                           m->inverse + (j * s->m + l) * s->unknowns + i * s->m);
}

void dvi__stage_inverse_members_begin(dvi__stage_inverse_members *m, int count,
                                      const double *weight, int regular[DVI__ABREAST])
{
  sum_two_forms(m, count, weight);
  invert_two_forms(m, regular);
  write_members_matrix(m);
  dvi__near_one_invert_abreast(m->one->unknowns, m->inverse, regular);
}

/* ---- solve ---- */

WIDE static void solve_abreast(const dvi__stage_inverse_members *of, abreast *r)
{
  const dvi__stage_inverse *s = of->one;
  const int n = s->n, m = s->m, unknowns = s->unknowns;
  abreast back[MOST], x[MOST];
  for (int i = 0; i < n; i++)
    for (int k = 0; k < m; k++) {
      abreast sum = {0};
      for (int l = 0; l < m; l++) sum += s->sign[l] * r[i * m + l] * s->back[l][k];
      back[i * m + k] = sum;
    }
  for (int i = 0; i < n; i++)
    for (int k = 0; k < m; k++) {
      abreast sum = {0};
      for (int l = 0; l < n; l++) sum += of->Omega[l * n + i] * back[l * m + k];
      x[i * m + k] = sum;
    }
  for (int i = 0; i < unknowns; i++) {
    abreast sum = {0};
    for (int k = 0; k < unknowns; k++) sum += x[k] * of->inverse[k * unknowns + i];
    r[i] = sum;
  }
}

void dvi__stage_inverse_members_solve(dvi__stage_inverse_members *m, dvi__abreast *r)
{
  solve_abreast(m, r);
}
