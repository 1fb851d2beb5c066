/* The Jacobian of an element on phase space. */
#include <string.h>

#include "step/hamiltonian/phase_struct.h"
#include "core/status.h"

/* Add factor times the derivative of the vector field (F_p, -F_q) to slope. Entry e of F_qq is
 * qq[e * stride]. */
static void add_slope(const dvi__vector_field_places *at, const dvi__lagrangian_term *of,
                      const double *qq, const double *qp, const double *pp, int stride,
                      double factor, double *slope)
{
  const int in_qq = dvi__pattern_entries(&of->qq), in_pp = dvi__pattern_entries(&of->vv),
            in_qp = dvi__pattern_entries(&of->qv);
  for (int e = 0; e < in_qq; e++) slope[at->qq[e]] -= factor * qq[e * stride];
  for (int e = 0; e < in_pp; e++) slope[at->pp[e]] += factor * pp[e * stride];
  for (int e = 0; e < in_qp; e++) {
    slope[at->qp_in_p[e]] -= factor * qp[e * stride];
    slope[at->qp_in_q[e]] += factor * qp[e * stride];
  }
}

/* Add the derivative of the constraints with the weights at f->point. */
static dvi_status phase_add_constraints(dvi__phase_element *f, double *slope)
{
  DVI_TRY(dvi__constraint_hessian(f->evaluator, f->point, f->point + f->n, f->weight, f->phi_qq,
                                  f->phi_qp, f->phi_pp));
  add_slope(&f->of_phi, &f->system->constraint->weighted, f->phi_qq, f->phi_qp, f->phi_pp, 1, 1,
            slope);
  return DVI_OK;
}

dvi_status dvi__phase_slopes(dvi__phase_element *f, const double *multipliers)
{
  const size_t entries = (size_t)dvi__pattern_entries(&f->joint);
  const int half = f->n * f->d;
  memset(f->slope, 0, entries * ((size_t)f->d + 1) * sizeof *f->slope);
  DVI_TRY(dvi__lagrangian_hessian(f->evaluator, f->d, f->t, f->Z, f->Z + half, f->H_qq, f->H_qp,
                                  f->H_pp));
  for (int i = 0; i <= f->d; i++) {
    double *slope = f->slope + (size_t)i * entries;
    if (i < f->d)
      add_slope(&f->of_H, f->system->lagrangian, f->H_qq + i, f->H_qp + i, f->H_pp + i, f->d, f->h,
                slope);
    if (i < f->d && f->k == 0) continue;
    dvi__phase_take(f, multipliers, i);
    DVI_TRY(phase_add_constraints(f, slope));
  }
  return DVI_OK;
}

/* Evaluate the gradients of the constraints at all points where they act. */
static dvi_status evaluate_gradients(dvi__phase_element *f, const double *multipliers)
{
  for (int i = f->k > 0 ? 0 : f->d; i <= f->d; i++) {
    dvi__phase_take(f, multipliers, i);
    DVI_TRY(dvi__constraint_gradients(f->evaluator, f->point, f->point + f->n,
                                      dvi__phase_gradients(f, i)));
  }
  return DVI_OK;
}

/* Fill the rows of a block of two components in column l, which belongs to W_l or to {z'} - {z}. */
static void component_column(const dvi__phase_element *f, int e, int same, int l, double *column)
{
  const size_t entries = (size_t)dvi__pattern_entries(&f->joint);
  const int d = f->d;
  for (int i = 0; i < d; i++)
    column[i] = l == d ? 0
                       : (same && i == l) - f->a[i][l] * f->slope[(size_t)i * entries + (size_t)e];
  if (l == d)
    column[d] = same - 0.5 * f->slope[(size_t)d * entries + (size_t)e];
  else
    column[d] = same ? -f->b[l] : 0;
}

/* Fill the rows of a constraint in the same column. */
static void constraint_rows(const dvi__phase_element *f, int gradient, int l, double *column)
{
  column[0] = l == f->d ? dvi__phase_gradients(f, f->d)[gradient] : 0;
  for (int k = 0; k < f->k; k++) {
    column[1 + k] = 0;
    for (int i = 0; i < f->d && l < f->d; i++)
      column[1 + k] += f->b[i] * f->legendre[i][k] * dvi__phase_gradients(f, i)[gradient] *
                       f->a[i][l];
  }
}

/* Fill the rows of a component in column l of a constraint, which belongs to h lambda' or to a
 * coefficient of h Lambda. The entries are phi_p for q and -phi_q for p. */
static void constraint_column(const dvi__phase_element *f, int gradient, double sign, int l,
                              double *column)
{
  for (int i = 0; i < f->d; i++)
    column[i] = l == 0 ? 0 : -sign * f->legendre[i][l - 1] * dvi__phase_gradients(f, i)[gradient];
  column[f->d] = l == 0 ? -0.5 * sign * dvi__phase_gradients(f, f->d)[gradient] : 0;
}

dvi_status dvi__phase_element_jacobian(dvi__phase_element *f, const double *x, double *values)
{
  const int z = 2 * f->n;
  dvi__phase_points(f, x);
  DVI_TRY(evaluate_gradients(f, dvi__phase_multipliers(f, x, 0)));
  DVI_TRY(dvi__phase_slopes(f, dvi__phase_multipliers(f, x, 0)));
  for (int j = 0; j < f->joint.columns; j++)
    for (int l = 0; l <= (j < z ? f->d : f->k); l++)
      for (int e = f->joint.start[j]; e < f->joint.start[j + 1]; e++) {
        const int i = f->joint.row[e];
        if (j >= z)
          constraint_column(f, f->gradient[e], i < f->n ? 1 : -1, l, values);
        else if (i < z)
          component_column(f, e, i == j, l, values);
        else
          constraint_rows(f, f->gradient[e], l, values);
        values += 1 + (i < z ? f->d : f->k);
      }
  return DVI_OK;
}
