#include "step/hamiltonian/canonical.h"

#include <math.h>
#include <string.h>

#include "step/hamiltonian/canonical_struct.h"
#include "step/onestep/collocation.h"
#include "core/memory.h"
#include "core/status.h"
#include "space/trial.h"

enum { DEGREE = DVI__CANONICAL_DEGREE, POINTS = DVI__CANONICAL_POINTS };

static double canonical_dot(int count, const double *x, const double *y)
{
  double sum = 0;
  for (int k = 0; k < count; k++) sum += x[k] * y[k];
  return sum;
}

/* ---- create ---- */

/* The coefficients of a nodal basis are values themselves. */
static void fill_fit(dvi__canonical *c)
{
  const int is_nodal = dvi__basis_is_nodal(c->space.basis);
  for (int k = 0; k < c->s; k++)
    c->tau[k] = is_nodal ? (double)(c->space.mark[k + 1] / c->space.scale) : (k + 1.0) / c->s;
  if (!is_nodal) dvi__trial_fit(c->space.basis, c->s, c->s, c->tau, c->fit);
  for (int k = 0; is_nodal && k < c->s; k++) c->fit[k * c->s + k] = 1;
}

static void canonical_fill_tables(dvi__canonical *c)
{
  for (int j = 0; j < c->r; j++)
    dvi__trial_in(&c->space, c->c[j], c->psi[j], c->bar[j], c->slope[j]);
  dvi__trial_in(&c->space, 1, c->end, NULL, NULL);
  fill_fit(c);
  for (int k = 0; k < c->s; k++) c->line[k] = canonical_dot(c->s, c->fit + k * c->s, c->tau);
}

static double **canonical_owned_array(dvi__canonical *c, int i)
{
  double **const all[] = {&c->t, &c->Q, &c->P, &c->H_q, &c->H_p, &c->H_qq, &c->H_qp, &c->H_pp};
  return i < (int)(sizeof all / sizeof *all) ? all[i] : NULL;
}

static dvi_status canonical_allocate(dvi__canonical *c)
{
  const size_t r = (size_t)c->r, z = (size_t)dvi__canonical_room(c),
               qq = (size_t)dvi__pattern_entries(&c->system->qq),
               qp = (size_t)dvi__pattern_entries(&c->system->qv),
               pp = (size_t)dvi__pattern_entries(&c->system->vv);
  const size_t size[] = {r, z, z, z, z, qq * r, qp * r, pp * r};
  for (int i = 0; canonical_owned_array(c, i) != NULL; i++) {
    *canonical_owned_array(c, i) = DVI_NEW(double, size[i] + 1);
    if (*canonical_owned_array(c, i) == NULL)
      return dvi__fail(DVI_NO_MEMORY, "no memory for %d points in %d dimensions", c->r, c->n);
  }
  return DVI_OK;
}

static dvi_status canonical_initialise(dvi__canonical *c, const dvi__action_space *space,
                                       dvi_counters *counters)
{
  DVI_TRY(dvi__joint_check(c->system, c->m, c->r));
  dvi__space_init(&c->space, space->basis, c->s);
  DVI_TRY(dvi_quadrature(space->rule, c->r, c->c, c->b));
  canonical_fill_tables(c);
  DVI_TRY(dvi__evaluator_create(c->system, c->r, DVI__HESSIANS, counters, &c->evaluator));
  DVI_TRY(dvi__joint_create(c->system, NULL, &c->joint, &c->block));
  DVI_TRY(dvi__pattern_blocks(&c->joint, c->m, &c->pattern));
  DVI_TRY(canonical_allocate(c));
  return dvi__canonical_iteration_create(c);
}

dvi_status dvi__canonical_create(const dvi_system *system, const dvi__action_space *space,
                                 dvi_counters *counters, dvi__canonical **canonical)
{
  *canonical = NULL;
  dvi__canonical *c = DVI_NEW(dvi__canonical, 1);
  if (c == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  c->system = system;
  c->n = system->n;
  c->s = space->degree;
  c->r = space->nodes;
  c->m = c->s + c->r;
  c->rule = space->rule;
  const dvi_status status = canonical_initialise(c, space, counters);
  if (status != DVI_OK) dvi__canonical_destroy(&c);
  *canonical = c;
  return status;
}

void dvi__canonical_destroy(dvi__canonical **canonical)
{
  dvi__canonical *c = *canonical;
  if (c == NULL) return;
  for (int i = 0; canonical_owned_array(c, i) != NULL; i++)
    dvi__release(*canonical_owned_array(c, i));
  dvi__canonical_iteration_clear(&c->iteration);
  dvi__evaluator_destroy(&c->evaluator);
  dvi__pattern_clear(&c->joint);
  dvi__pattern_clear(&c->pattern);
  dvi__release(c->block);
  dvi__release(c);
  *canonical = NULL;
}

const dvi__pattern *dvi__canonical_pattern(const dvi__canonical *c)
{
  return &c->pattern;
}

dvi__evaluator *dvi__canonical_evaluator(const dvi__canonical *c)
{
  return c->evaluator;
}

void dvi__canonical_place(dvi__canonical *c, double t0, double h, const double *q0,
                          const double *p0, const double *unit)
{
  c->t0 = t0;
  c->h = h;
  c->q0 = q0;
  c->p0 = p0;
  c->unit = unit;
  for (int j = 0; j < c->r; j++) c->t[j] = t0 + c->c[j] * h;
}

/* ---- the rows ---- */

/* Return the row of the equation q' = H_p at point j. */
static int velocity_row(const dvi__canonical *c, int j)
{
  return j < c->s ? j : c->s + j;
}

void dvi__canonical_points(dvi__canonical *c, const double *x)
{
  for (int i = 0; i < c->n; i++, x += c->m)
    for (int j = 0; j < c->r; j++) {
      c->Q[i * c->r + j] = c->q0[i] + canonical_dot(c->s, c->psi[j], x);
      c->P[i * c->r + j] = c->p0[i] + c->unit[i] * x[c->s + j];
    }
}

dvi_status dvi__canonical_residual(dvi__canonical *c, const double *x, double *R)
{
  dvi__canonical_points(c, x);
  DVI_TRY(dvi__lagrangian_gradient(c->evaluator, c->r, c->t, c->Q, c->P, c->H_q, c->H_p));
  for (int i = 0; i < c->n; i++, x += c->m, R += c->m) {
    const double *H_q = c->H_q + i * c->r, *H_p = c->H_p + i * c->r, *Pi = x + c->s;
    for (int j = 0; j < c->r; j++)
      R[velocity_row(c, j)] = canonical_dot(c->s, c->slope[j], x) - c->h * H_p[j];
    for (int k = 0; k < c->s; k++) {
      double sum = 0;
      for (int j = 0; j < c->r; j++)
        sum += c->b[j] * (c->slope[j][k] * Pi[j] - c->h / c->unit[i] * c->bar[j][k] * H_q[j]);
      R[c->s + k] = sum;
    }
  }
  return DVI_OK;
}

/* The rows have the size of the unknowns. */
dvi_status dvi__canonical_scale(dvi__canonical *c, double *scale)
{
  for (int i = 0; i < c->n * c->m; i++) scale[i] = 1;
  return DVI_OK;
}

/* With as many points as degrees both increments have the same weights, to the last bit. Others
 * would make the energy drift. */
void dvi__canonical_ends(const dvi__canonical *c, const double *x, double *dq, double *dp)
{
  for (int i = 0; i < c->n; i++) {
    dq[i] = c->r == c->s ? c->h * canonical_dot(c->r, c->b, c->H_p + i * c->r)
                         : canonical_dot(c->s, c->end, x + i * c->m);
    dp[i] = -c->h * canonical_dot(c->r, c->b, c->H_q + i * c->r);
  }
}

/* ---- Jacobian ---- */

/* An entry (i,j) of the joint pattern has, at the points and times h, d2H/dq_i dq_j, d2H/dq_i dp_j,
 * d2H/dp_i dq_j and d2H/dp_i dp_j. */
typedef struct entry {
  double qq[POINTS], qp[POINTS], pq[POINTS], pp[POINTS];
} entry;

static double canonical_at(const dvi__canonical *c, const double *values, int where, int j)
{
  return where >= 0 ? c->h * values[where * c->r + j] : 0;
}

static void canonical_gather_entry(const dvi__canonical *c, const dvi__joint_entry *where,
                                   entry *out)
{
  for (int j = 0; j < c->r; j++) {
    out->qq[j] = canonical_at(c, c->H_qq, where->qq, j);
    out->qp[j] = canonical_at(c, c->H_qp, where->qv, j);
    out->pq[j] = canonical_at(c, c->H_qp, where->vq, j);
    out->pp[j] = canonical_at(c, c->H_pp, where->vv, j);
  }
}

/* Fill the rows of a block in the column of Y_l. `same` marks a block on the diagonal. */
static void path_column(const dvi__canonical *c, const entry *e, int same, double unit_i, int l,
                        double *column)
{
  for (int j = 0; j < c->r; j++)
    column[velocity_row(c, j)] = (same ? c->slope[j][l] : 0) - e->pq[j] * c->psi[j][l];
  for (int k = 0; k < c->s; k++) {
    double sum = 0;
    for (int j = 0; j < c->r; j++) sum -= c->b[j] * c->bar[j][k] * e->qq[j] * c->psi[j][l];
    column[c->s + k] = sum / unit_i;
  }
}

/* Fill the rows of a block in the column of Pi_l. `same` marks a block on the diagonal. */
static void momentum_column(const dvi__canonical *c, const entry *e, int same, double unit_i,
                            double unit_j, int l, double *column)
{
  for (int j = 0; j < c->r; j++) column[velocity_row(c, j)] = j == l ? -e->pp[l] * unit_j : 0;
  for (int k = 0; k < c->s; k++)
    column[c->s + k] = c->b[l] *
                       ((same ? c->slope[l][k] : 0) - c->bar[l][k] * e->qp[l] * (unit_j / unit_i));
}

dvi_status dvi__canonical_jacobian(dvi__canonical *c, const double *x, double *values)
{
  const int m = c->m;
  dvi__canonical_points(c, x);
  DVI_TRY(dvi__lagrangian_hessian(c->evaluator, c->r, c->t, c->Q, c->P, c->H_qq, c->H_qp, c->H_pp));
  for (int j = 0; j < c->n; j++) {
    const int first = c->joint.start[j], height = (c->joint.start[j + 1] - first) * m;
    for (int b = 0; b < height / m; b++) {
      const int i = c->joint.row[first + b];
      entry e = {0};
      canonical_gather_entry(c, &c->block[first + b], &e);
      for (int l = 0; l < m; l++) {
        double *column = values + l * height + b * m;
        if (l < c->s)
          path_column(c, &e, i == j, c->unit[i], l, column);
        else
          momentum_column(c, &e, i == j, c->unit[i], c->unit[j], l - c->s, column);
      }
    }
    values += height * m;
  }
  return DVI_OK;
}

dvi_status dvi__canonical_curvature(dvi__canonical *c, double t, const double *q, const double *p,
                                    const double **H_pp)
{
  *H_pp = c->H_pp;
  return dvi__lagrangian_hessian(c->evaluator, 1, &t, q, p, c->H_qq, c->H_qp, c->H_pp);
}

dvi_status dvi__canonical_stiffness(dvi__canonical *c, double t, const double *q, const double *p,
                                    double *rows)
{
  const dvi__pattern *qq = &c->system->qq;
  DVI_TRY(dvi__lagrangian_hessian(c->evaluator, 1, &t, q, p, c->H_qq, c->H_qp, c->H_pp));
  memset(rows, 0, (size_t)c->n * sizeof(double));
  for (int j = 0; j < qq->columns; j++)
    for (int e = qq->start[j]; e < qq->start[j + 1]; e++) rows[qq->row[e]] += fabs(c->H_qq[e]);
  return DVI_OK;
}

/* ---- guesses and path ---- */

void dvi__canonical_keep(const dvi__canonical *c, const double *x, double *kept)
{
  for (int i = 0; i < c->n; i++)
    for (int k = 0; k < c->m; k++) *kept++ = *x++ * (k < c->s ? 1 : c->unit[i]);
}

void dvi__canonical_straight(const dvi__canonical *c, const double *v, double *x)
{
  for (int i = 0; i < c->n; i++)
    for (int k = 0; k < c->m; k++) *x++ = k < c->s ? c->h * v[i] * c->line[k] : 0;
}

/* Fill the matrices that continue a step. The first gives q(1 + ratio tau) - q(1) by its values at
 * the points tau_k. The second continues the polynomial through the Pi_j, relative to its end. */
static void fill_shifts(dvi__canonical *c, double ratio)
{
  double bar[DEGREE][DEGREE], end[POINTS];
  c->ratio = ratio;
  for (int k = 0; k < c->s; k++)
    dvi__trial_in(&c->space, 1 + ratio * c->tau[k], NULL, bar[k], NULL);
  for (int k = 0; k < c->s; k++)
    for (int l = 0; l < c->s; l++) {
      c->shift[k][l] = 0;
      for (int j = 0; j < c->s; j++) c->shift[k][l] += c->fit[k * c->s + j] * bar[j][l];
    }
  dvi__lagrange_weights(c->r, c->c, 1, end);
  for (int j = 0; j < c->r; j++) {
    dvi__lagrange_weights(c->r, c->c, 1 + ratio * c->c[j], c->shift_p[j]);
    for (int l = 0; l < c->r; l++) c->shift_p[j][l] -= end[l];
  }
}

void dvi__canonical_continue(dvi__canonical *c, double ratio, const double *last, double *x)
{
  if (!(ratio == c->ratio)) fill_shifts(c, ratio);
  for (int i = 0; i < c->n; i++, last += c->m, x += c->m) {
    for (int k = 0; k < c->s; k++) x[k] = canonical_dot(c->s, c->shift[k], last);
    for (int j = 0; j < c->r; j++)
      x[c->s + j] = canonical_dot(c->r, c->shift_p[j], last + c->s) / c->unit[i];
  }
}

void dvi__canonical_path(const dvi__canonical *c, const double *kept, const double *q0, double h,
                         double tau, double *q, double *v)
{
  double psi[DEGREE], slope[DEGREE];
  dvi__trial_in(&c->space, tau, psi, NULL, slope);
  for (int i = 0; i < c->n; i++, kept += c->m) {
    if (q != NULL) q[i] = q0[i] + canonical_dot(c->s, psi, kept);
    if (v != NULL) v[i] = canonical_dot(c->s, slope, kept) / h;
  }
}
