/* GSL's rk8pd on y = (q, p), qdot = v(t,q,p), pdot = L_q(t,q,v), with the callbacks that the
 * methods get, at one point a call. Source: Prince and Dormand 1981, J. Comput. Appl. Math.
 * 7:67. */
#include "bench/rk8pd.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_version.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ITERATIONS_MAX = 30 };
static const unsigned long steps_max = 50000000; /* the limit of SUNDIALS' codes */

typedef struct rk8pd_flow {
  const dvi_system_terms *terms;
  int n;
  long evaluations;
  double *v;                  /* [n] velocity, and guess for the next one */
  double *L_v;                /* [n] */
  double *V_q;                /* [n] gradient of one potential */
  double *residual, *step;    /* [n] vectors of Newton's method for v */
  double *L_qq, *L_qv, *L_vv; /* [n*n] at most, for a general Lagrangian */
  gsl_matrix *factors;        /* [n,n] factors of L_vv */
  gsl_permutation *permutation;
} rk8pd_flow;

static int rk8pd_potential_gradient(const dvi_potential *of, double t, const double *q, double *V_q)
{
  return of->gradient_batch != NULL ? of->gradient_batch(1, &t, q, V_q, of->user)
                                    : of->gradient(t, q, V_q, of->user);
}

static int rk8pd_lagrangian_gradient(const dvi_lagrangian *of, double t, const double *q,
                                     const double *v, double *L_q, double *L_v)
{
  return of->gradient_batch != NULL ? of->gradient_batch(1, &t, q, v, L_q, L_v, of->user)
                                    : of->gradient(t, q, v, L_q, L_v, of->user);
}

static int rk8pd_lagrangian_hessian(rk8pd_flow *f, double t, const double *q)
{
  const dvi_lagrangian *of = f->terms->lagrangian;
  return of->hessian_batch != NULL
             ? of->hessian_batch(1, &t, q, f->v, f->L_qq, f->L_qv, f->L_vv, of->user)
             : of->hessian(t, q, f->v, f->L_qq, f->L_qv, f->L_vv, of->user);
}

static double rk8pd_norm(int n, const double *x)
{
  double size = 0.0;
  for (int i = 0; i < n; i++) size = isnan(x[i]) ? HUGE_VAL : fmax(size, fabs(x[i]));
  return size;
}

static void set_mass_velocity(rk8pd_flow *f, const double *p)
{
  const dvi_mass *mass = &f->terms->mass;
  for (int i = 0; i < f->n; i++)
    f->v[i] = p[i] / (mass->diagonal != NULL ? mass->diagonal[i] : mass->scalar);
}

static int rk8pd_factor(rk8pd_flow *f, double t, const double *q)
{
  const dvi_pattern *vv = &f->terms->lagrangian->vv;
  int sign;
  const int code = rk8pd_lagrangian_hessian(f, t, q);
  if (code != 0) return code;
  gsl_matrix_set_zero(f->factors);
  for (int column = 0, e = 0; column < f->n; column++) {
    const int end = vv->start != NULL ? vv->start[column + 1] : (column + 1) * f->n;
    for (; e < end; e++)
      gsl_matrix_set(f->factors, (size_t)(vv->row != NULL ? vv->row[e] : e % f->n), (size_t)column,
                     f->L_vv[e]);
  }
  return gsl_linalg_LU_decomp(f->factors, f->permutation, &sign);
}

/* Solve p - L_v = 0 by Newton's method with the L_vv of its first guess. For the usual kinetic
 * energies, quadratic in v, the second residual is roundoff, and L_q was evaluated along with
 * it. */
static int find_velocity(rk8pd_flow *f, double t, const double *q, const double *p, double *L_q)
{
  double before = HUGE_VAL;
  gsl_vector_view residual = gsl_vector_view_array(f->residual, (size_t)f->n);
  gsl_vector_view step = gsl_vector_view_array(f->step, (size_t)f->n);
  for (int i = 0; i < ITERATIONS_MAX; i++) {
    int code = rk8pd_lagrangian_gradient(f->terms->lagrangian, t, q, f->v, L_q, f->L_v);
    f->evaluations++;
    if (code == 0 && i == 0) code = rk8pd_factor(f, t, q);
    for (int j = 0; j < f->n; j++) f->residual[j] = p[j] - f->L_v[j];
    if (code == 0)
      code = gsl_linalg_LU_solve(f->factors, f->permutation, &residual.vector, &step.vector);
    if (code != 0) return code;
    for (int j = 0; j < f->n; j++) f->v[j] += f->step[j];
    const double size = rk8pd_norm(f->n, f->step), scale = rk8pd_norm(f->n, f->v);
    if (size <= 4.0 * DBL_EPSILON * scale || (size <= 1e-10 * scale && size >= 0.5 * before))
      return 0;
    if (!isfinite(size)) break;
    before = size;
  }
  return GSL_EFAILED;
}

/* Evaluate the right side. GSL tries a smaller step after any failure but GSL_EBADFUNC, and takes a
 * NaN for a small error. */
static int right_side(double t, const double y[], double ydot[], void *user)
{
  rk8pd_flow *f = user;
  const double *q = y;
  const double *p = y + f->n;
  double *pdot = ydot + f->n;
  int code = 0;
  memset(pdot, 0, (size_t)f->n * sizeof *pdot);
  if (f->terms->lagrangian != NULL) {
    code = find_velocity(f, t, q, p, pdot);
  } else {
    set_mass_velocity(f, p);
    f->evaluations++;
  }
  for (int k = 0; k < f->terms->potential_count && code == 0; k++) {
    code = rk8pd_potential_gradient(&f->terms->potentials[k], t, q, f->V_q);
    for (int i = 0; i < f->n; i++) pdot[i] -= f->V_q[i];
  }
  memcpy(ydot, f->v, (size_t)f->n * sizeof *ydot);
  if (code == 0 && !isfinite(rk8pd_norm(2 * f->n, ydot))) code = GSL_EFAILED;
  return code == 0 ? GSL_SUCCESS : code < 0 ? GSL_EBADFUNC : GSL_EFAILED;
}

static bool rk8pd_provides_for(const dvi_system_terms *terms)
{
  if (terms->factors != NULL || terms->vector_potential != NULL || terms->force_count > 0 ||
      terms->damping > 0)
    return false;
  for (int k = 0; k < terms->potential_count; k++)
    if (terms->potentials[k].gradient == NULL && terms->potentials[k].gradient_batch == NULL)
      return false;
  const dvi_lagrangian *l = terms->lagrangian;
  if (l != NULL)
    return (l->gradient != NULL || l->gradient_batch != NULL) &&
           (l->hessian != NULL || l->hessian_batch != NULL);
  return terms->mass.values == NULL;
}

/* Allocate memory for 5 n numbers, and for three matrices if the Lagrangian is general. */
static bool rk8pd_allocate(rk8pd_flow *f)
{
  const size_t n = (size_t)f->n;
  const size_t block = f->terms->lagrangian != NULL ? n * n : 0;
  f->v = calloc(5 * n + 3 * block, sizeof *f->v);
  if (f->v == NULL) return false;
  f->L_v = f->v + n;
  f->V_q = f->v + 2 * n;
  f->residual = f->v + 3 * n;
  f->step = f->v + 4 * n;
  f->L_qq = f->v + 5 * n;
  f->L_qv = f->L_qq + block;
  f->L_vv = f->L_qv + block;
  if (block == 0) return true;
  f->factors = gsl_matrix_alloc(n, n);
  f->permutation = gsl_permutation_alloc(n);
  return f->factors != NULL && f->permutation != NULL;
}

static void rk8pd_release(rk8pd_flow *f)
{
  gsl_permutation_free(f->permutation);
  gsl_matrix_free(f->factors);
  free(f->v);
}

/* Integrate y [2n] from the start to the end. */
static dvi_status rk8pd_integrate(rk8pd_flow *f, const problem *scene, double t_end,
                                  double tolerance, double *y, long *steps, char *reason,
                                  size_t size)
{
  const gsl_odeiv2_system equations = {
      .function = right_side, .dimension = 2 * (size_t)f->n, .params = f};
  const double h = copysign(fmin(scene->h, fabs(t_end)), t_end);
  gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&equations, gsl_odeiv2_step_rk8pd, h,
                                                            tolerance, tolerance);
  if (driver == NULL) return DVI_NO_MEMORY;
  (void)gsl_odeiv2_driver_set_nmax(driver, steps_max);
  (void)gsl_odeiv2_driver_set_hmin(driver, 4.0 * DBL_EPSILON * fabs(t_end));
  double t = 0.0;
  const int code = gsl_odeiv2_driver_apply(driver, &t, t_end, y);
  *steps = (long)driver->n;
  gsl_odeiv2_driver_free(driver);
  if (code == GSL_SUCCESS) return DVI_OK;
  (void)snprintf(reason, size, "gsl-rk8pd: stopped at t = %.9g, before %.9g, after %ld steps (%s)",
                 t, t_end, *steps, gsl_strerror(code));
  return DVI_REFERENCE_FAILED;
}

static dvi_status rk8pd_run(rk8pd_flow *f, const problem *scene, double t_end, double tolerance,
                            double *q, double *p, dvi_reference_report *report, char *reason,
                            size_t size)
{
  const size_t n = (size_t)f->n;
  double *y = calloc(2 * n, sizeof *y);
  if (y == NULL) return DVI_NO_MEMORY;
  memcpy(y, q, n * sizeof *y);
  memcpy(y + n, p, n * sizeof *y);
  memcpy(f->v, scene->v, n * sizeof *f->v);
  const dvi_status status = rk8pd_integrate(f, scene, t_end, tolerance, y, &report->steps, reason,
                                            size);
  if (status == DVI_OK) {
    memcpy(q, y, n * sizeof *q);
    memcpy(p, y + n, n * sizeof *p);
    report->evaluations = f->evaluations;
  }
  free(y);
  return status;
}

dvi_status rk8pd_solve(const problem *scene, double t_end, double tolerance, double *q, double *p,
                       dvi_reference_report *report, char *reason, size_t size)
{
  rk8pd_flow f = {.terms = scene->terms, .n = scene->nq};
  if (!rk8pd_provides_for(f.terms)) {
    (void)snprintf(reason, size,
                   "gsl-rk8pd: it is provided for scalar and diagonal masses on R^n and for "
                   "general Lagrangians with Hessians, without forces and vector potentials");
    return DVI_UNSUPPORTED;
  }
  /* GSL's own handler ends the program */
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  dvi_status status = rk8pd_allocate(&f) ? DVI_OK : DVI_NO_MEMORY;
  if (status == DVI_OK) status = rk8pd_run(&f, scene, t_end, tolerance, q, p, report, reason, size);
  if (status == DVI_NO_MEMORY)
    (void)snprintf(reason, size, "gsl-rk8pd: no memory for %d coordinates", f.n);
  rk8pd_release(&f);
  (void)gsl_set_error_handler(handler);
  return status;
}

const char *rk8pd_version(void)
{
  return gsl_version;
}
