/* The list of row terms of an element, and the forces in the rows. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "step/element/action_struct.h"

struct dvi__row_jacobian {
  const dvi__action *a;
  const dvi__row_term *term;
  int first; /* column and row of the term's unknowns */
  double *values;
};

/* ---- add a term ---- */

/* Count the groups of own unknowns. */
static int group_count(const dvi__row_term *term)
{
  return term->unknowns > 0 ? term->acting->columns : 0;
}

static dvi_status allocate_terms(dvi__action *a)
{
  dvi__row_terms *terms = &a->terms;
  const size_t n = (size_t)a->n;
  if (terms->numbers != NULL) return DVI_OK;
  terms->numbers = DVI_NEW(double, 3 * n);
  if (terms->numbers == NULL)
    return dvi__fail(DVI_NO_MEMORY, "action: no memory for terms of the rows");
  terms->q1 = terms->numbers;
  terms->in_p = terms->q1 + n;
  terms->dp = terms->in_p + n;
  terms->path = (dvi__row_path){.n = a->n,
                                .s = a->s,
                                .r = a->r,
                                .q1 = terms->q1,
                                .dp = terms->in_p,
                                .t = a->t,
                                .Q = a->Q,
                                .V = a->V,
                                .weight = a->weight,
                                .end = a->end,
                                .lanes = a->lanes,
                                .psi = a->psi,
                                .bar = a->bar,
                                .dpsi = a->dpsi};
  return DVI_OK;
}

dvi_status dvi__action_add_term(dvi__action *a, const dvi__row_term *term)
{
  dvi__row_terms *terms = &a->terms;
  if (terms->count == DVI__ROW_TERMS_MOST)
    return dvi__fail(DVI_BAD_SIZE, "action: %s is one term of the rows too many; %d are possible",
                     term->name, DVI__ROW_TERMS_MOST);
  DVI_TRY(allocate_terms(a));
  terms->term[terms->count] = *term;
  terms->first[terms->count] = a->n * a->s + terms->unknowns;
  terms->count++;
  terms->unknowns += group_count(term) * term->unknowns;
  if (term->pattern == NULL && term->unknowns == 0) return DVI_OK;
  if (a->block == NULL) return DVI_OK;
  dvi__action_clear_jacobian(a);
  return dvi__action_prepare_jacobian(a);
}

int dvi__action_has_terms(const dvi__action *a)
{
  return a->terms.count > 0;
}

/* ---- pattern ---- */

dvi_status dvi__action_join_terms(const dvi__action *a, dvi__pattern *joint)
{
  for (int k = 0; k < a->terms.count; k++) {
    const dvi__pattern *more = a->terms.term[k].pattern;
    dvi__pattern sum;
    if (more == NULL) continue;
    DVI_TRY(dvi__pattern_union(joint->start != NULL ? joint : more, more, &sum));
    dvi__pattern_clear(joint);
    *joint = sum;
  }
  return DVI_OK;
}

/* Count the groups of all terms, and bound the entries that they add to the joint pattern. */
static int count_groups(const dvi__action *a, size_t *entries)
{
  int groups = 0;
  for (int k = 0; k < a->terms.count; k++) {
    const dvi__row_term *term = &a->terms.term[k];
    if (term->unknowns == 0) continue;
    groups += group_count(term);
    *entries += 2 * (size_t)dvi__pattern_entries(term->acting) + (size_t)group_count(term);
  }
  return groups;
}

/* Append the rows of the groups that coordinate j meets. */
static int append_groups(const dvi__action *a, dvi__pattern *const *meeting, int j, int *row)
{
  int count = 0, first = a->n;
  for (int k = 0; k < a->terms.count; k++) {
    const dvi__pattern *met = meeting[k];
    if (met->start == NULL) continue; /* a term without unknowns */
    for (int e = met->start[j]; e < met->start[j + 1]; e++) row[count++] = first + met->row[e];
    first += group_count(&a->terms.term[k]);
  }
  return count;
}

/* Fill the joint pattern with one more row and column for each group. `meeting` are the transposes
 * of `acting`. */
static void fill_wide(const dvi__action *a, dvi__pattern *const *meeting, dvi__pattern *wide)
{
  int at = 0, column = a->n;
  for (int j = 0; j < a->n; j++) {
    wide->start[j] = at;
    for (int e = a->joint.start[j]; e < a->joint.start[j + 1]; e++)
      wide->row[at++] = a->joint.row[e];
    at += append_groups(a, meeting, j, wide->row + at);
  }
  for (int k = 0; k < a->terms.count; k++) {
    const dvi__pattern *acting = a->terms.term[k].acting;
    for (int b = 0; b < group_count(&a->terms.term[k]); b++, column++) {
      wide->start[column] = at;
      for (int e = acting->start[b]; e < acting->start[b + 1]; e++)
        wide->row[at++] = acting->row[e];
      wide->row[at++] = column;
    }
  }
  wide->start[column] = at;
}

static dvi_status widen_joint(const dvi__action *a, dvi__pattern *wide)
{
  dvi__pattern transposes[DVI__ROW_TERMS_MOST] = {{0}}, *meeting[DVI__ROW_TERMS_MOST];
  size_t most = (size_t)dvi__pattern_entries(&a->joint);
  const int size = a->n + count_groups(a, &most);
  *wide = (dvi__pattern){size, size, DVI_NEW(int, (size_t)size + 1), DVI_NEW(int, most)};
  dvi_status status = wide->start != NULL && wide->row != NULL
                          ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "action: no memory for the Jacobian");
  for (int k = 0; k < a->terms.count; k++) {
    meeting[k] = &transposes[k];
    if (status == DVI_OK && a->terms.term[k].unknowns > 0)
      status = dvi__pattern_transpose(a->terms.term[k].acting, meeting[k]);
  }
  if (status == DVI_OK) fill_wide(a, meeting, wide);
  for (int k = 0; k < a->terms.count; k++) dvi__pattern_clear(meeting[k]);
  return status;
}

/* List where the unknowns of each coordinate and of each group begin, and end. */
static void list_first(const dvi__action *a, int *first)
{
  int at = a->n;
  for (int j = 0; j <= a->n; j++) first[j] = j * a->s;
  for (int k = 0; k < a->terms.count; k++)
    for (int b = 0; b < group_count(&a->terms.term[k]); b++, at++)
      first[at + 1] = first[at] + a->terms.term[k].unknowns;
}

dvi_status dvi__action_wide_pattern(const dvi__action *a, dvi__pattern *pattern)
{
  dvi__pattern wide = {0};
  if (a->terms.unknowns == 0) return dvi__pattern_blocks(&a->joint, a->s, pattern);
  dvi_status status = widen_joint(a, &wide);
  int *first = status == DVI_OK ? DVI_NEW(int, (size_t)wide.columns + 1) : NULL;
  if (status == DVI_OK && first == NULL)
    status = dvi__fail(DVI_NO_MEMORY, "action: no memory for the Jacobian");
  if (status == DVI_OK) {
    list_first(a, first);
    status = dvi__pattern_uneven_blocks(&wide, first, pattern);
  }
  dvi__pattern_clear(&wide);
  dvi__release(first);
  return status;
}

/* ---- residual and Jacobian ---- */

void dvi__action_place_terms(dvi__action *a, const double *Y)
{
  dvi__row_terms *terms = &a->terms;
  if (terms->count == 0) return;
  terms->path.t0 = a->t0;
  terms->path.h = a->h;
  terms->path.q0 = a->q0;
  terms->path.p0 = a->p0;
  terms->path.Y = Y;
  for (int i = 0; i < a->n; i++) {
    terms->q1[i] = a->q0[i];
    for (int k = 0; k < a->s; k++) terms->q1[i] += a->end[k] * Y[i * a->s + k];
  }
  for (int k = 0; k < terms->count; k++)
    if (terms->term[k].place != NULL) terms->term[k].place(terms->term[k].of, &terms->path);
}

/* Add the rows of all terms. L_q holds the weights here. */
dvi_status dvi__action_add_term_rows(dvi__action *a, const double *Y, double *R)
{
  dvi__row_terms *terms = &a->terms;
  if (terms->count == 0) return DVI_OK;
  for (int i = 0; i < a->n; i++) {
    terms->in_p[i] = terms->dp[i] = 0;
    for (int j = 0; j < a->r; j++) terms->in_p[i] += a->h * a->L_q[i * a->r + j];
  }
  for (int k = 0; k < terms->count; k++) {
    const dvi__row_term *term = &terms->term[k];
    DVI_TRY(
        term->rows(term->of, &terms->path, Y + terms->first[k], R, terms->dp, R + terms->first[k]));
  }
  return DVI_OK;
}

void dvi__action_add_term_magnitudes(const dvi__action *a, double *magnitude)
{
  const dvi__row_terms *terms = &a->terms;
  for (int k = 0; k < terms->unknowns; k++) magnitude[a->n * a->s + k] = 0;
  for (int k = 0; k < terms->count; k++) {
    const dvi__row_term *term = &terms->term[k];
    if (term->magnitudes != NULL)
      term->magnitudes(term->of, &terms->path, magnitude, magnitude + terms->first[k]);
  }
}

dvi_status dvi__action_add_term_derivatives(dvi__action *a, const double *Y, double *values)
{
  const dvi__row_terms *terms = &a->terms;
  for (int k = 0; k < terms->count; k++) {
    const dvi__row_term *term = &terms->term[k];
    const dvi__row_jacobian J = {a, term, terms->first[k], values};
    if (term->derivatives != NULL)
      DVI_TRY(term->derivatives(term->of, &terms->path, Y + terms->first[k], &J));
  }
  return DVI_OK;
}

void dvi__action_scale_terms(const dvi__action *a, double *scale)
{
  const dvi__row_terms *terms = &a->terms;
  for (int k = 0; k < terms->count; k++) {
    const dvi__row_term *term = &terms->term[k];
    if (term->unknowns > 0) term->scale(term->of, a->h, scale + terms->first[k]);
  }
}

/* ---- places of derivatives ---- */

const dvi__pattern *dvi__row_joint(const dvi__row_jacobian *J)
{
  return &J->a->joint;
}

double *dvi__row_entry(const dvi__row_jacobian *J, int entry, int column, int l)
{
  const dvi__action *a = J->a;
  return J->values + a->pattern.start[column * a->s + l] + (entry - a->joint.start[column]) * a->s;
}

double *dvi__row_block(const dvi__row_jacobian *J, int row, int column, int l)
{
  const int entry = dvi__pattern_find(&J->a->joint, row, column);
  return entry >= 0 ? dvi__row_entry(J, entry, column, l) : NULL;
}

static double *find_value(const dvi__row_jacobian *J, int row, int column)
{
  const int entry = dvi__pattern_find(&J->a->pattern, row, column);
  return entry >= 0 ? J->values + entry : NULL;
}

double *dvi__row_own_rows(const dvi__row_jacobian *J, int group, int column, int l)
{
  return find_value(J, J->first + group * J->term->unknowns, column * J->a->s + l);
}

double *dvi__row_own_column(const dvi__row_jacobian *J, int unknown, int row)
{
  return find_value(J, row * J->a->s, J->first + unknown);
}

double *dvi__row_own_diagonal(const dvi__row_jacobian *J, int unknown)
{
  return find_value(J, J->first + unknown, J->first + unknown);
}

/* ---- forces at the nodes ---- */

void dvi__row_add_forces(const dvi__row_path *p, const double *F, double *R, double *dp)
{
  for (int i = 0; i < p->n; i++)
    for (int j = 0; j < p->r; j++) {
      const double impulse = p->h * p->weight[j] * F[i * p->r + j];
      for (int k = 0; k < p->s; k++) R[i * p->s + k] += p->bar[k * p->lanes + j] * impulse;
      dp[i] += impulse;
    }
}

void dvi__row_add_force_magnitudes(const dvi__row_path *p, const double *F, double *magnitude)
{
  for (int i = 0; i < p->n; i++)
    for (int j = 0; j < p->r; j++)
      for (int k = 0; k < p->s; k++)
        magnitude[i * p->s + k] += fabs(p->bar[k * p->lanes + j] * p->h * p->weight[j] *
                                        F[i * p->r + j]);
}

void dvi__row_add_force_derivatives(const dvi__row_path *p, const dvi__pattern *pattern,
                                    const double *F_q, const double *F_v,
                                    const dvi__row_jacobian *J)
{
  for (int column = 0; column < p->n; column++)
    for (int e = pattern->start[column]; e < pattern->start[column + 1]; e++)
      for (int l = 0; l < p->s; l++) {
        double *rows = dvi__row_block(J, pattern->row[e], column, l);
        const double *psi = p->psi + l * p->lanes, *dpsi = p->dpsi + l * p->lanes;
        for (int j = 0; j < p->r; j++) {
          const double by = p->weight[j] *
                            (p->h * F_q[e * p->r + j] * psi[j] + F_v[e * p->r + j] * dpsi[j]);
          for (int k = 0; k < p->s; k++) rows[k] += p->bar[k * p->lanes + j] * by;
        }
      }
}
