/* Checks of a user's function space, and the test for its symmetry. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "space/user_basis_struct.h"

enum { NAME_MOST = 40 };

/* ---- the struct ---- */

dvi_shapes *dvi__shapes_copy(const dvi_shapes *shapes)
{
  const size_t coordinates = shapes->coordinates != NULL ? (size_t)shapes->coordinate_count : 0,
               name = strlen(shapes->name) + 1;
  dvi_shapes *copy = dvi__allocate(1, sizeof *copy + sizeof(dvi_flow) + coordinates * sizeof(int) +
                                          name);
  if (copy == NULL) return NULL;
  dvi_flow *flow = (dvi_flow *)(void *)(copy + 1);
  int *list = (int *)(void *)(flow + 1);
  *copy = *shapes;
  if (shapes->flow != NULL) {
    *flow = *shapes->flow;
    copy->flow = flow;
  }
  if (shapes->coordinates != NULL)
    copy->coordinates = memcpy(list, shapes->coordinates, coordinates * sizeof *list);
  copy->name = memcpy(list + coordinates, shapes->name, name);
  return copy;
}

static dvi_status check_shapes_name(const char *name)
{
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  if (name == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "shapes: the name is NULL; it tells checkpoints which space they are of");
  const size_t length = strlen(name);
  if (length >= 1 && length <= NAME_MOST && strspn(name, letters) == length) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "shapes: the name '%.48s' is not of 1 to %d letters, digits, '-', '_' and '.'",
                   name, NAME_MOST);
}

static dvi_status check_shapes_points(const dvi_shapes *s)
{
  if ((s->point == NULL) != (s->points == 0))
    return dvi__fail(
        DVI_BAD_ARGUMENT,
        "shapes %s: there are %d points, and the callback for them is %s; give both or none",
        s->name, s->points, s->point == NULL ? "NULL" : "given");
  if (s->points >= 0 && s->points <= DVI_SHAPES_POINTS_MOST) return DVI_OK;
  return dvi__fail(DVI_BAD_SIZE, "shapes %s: %d points; 1 to %d are possible", s->name, s->points,
                   DVI_SHAPES_POINTS_MOST);
}

static dvi_status check_shapes_flow(const dvi_shapes *s)
{
  const dvi_flow *flow = s->flow;
  if (flow->size != sizeof *flow)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "shapes %s: the flow's size is %zu; set it to sizeof(dvi_flow), %zu", s->name,
                     flow->size, sizeof *flow);
  if (flow->move == NULL || flow->pullback == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "shapes %s: the flow's callback %s is NULL", s->name,
                     flow->move == NULL ? "move" : "pullback");
  if (s->evaluate == NULL && s->functions == 0 && s->point == NULL && s->points == 0 &&
      s->coordinates == NULL && s->coordinate_count == 0 && s->order == 0 && s->h == 0)
    return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "shapes %s: there are a flow and functions, or what belongs to these; give the "
                   "flow and the name alone",
                   s->name);
}

dvi_status dvi__shapes_check(const dvi_shapes *s)
{
  if (s == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "shapes: the shapes are NULL");
  DVI_TRY(check_shapes_name(s->name));
  if (s->flow != NULL) return check_shapes_flow(s);
  if (s->evaluate == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "shapes %s: the callback evaluate is NULL", s->name);
  if (s->functions < 1 || s->functions > DVI_SHAPES_MOST)
    return dvi__fail(DVI_BAD_SIZE, "shapes %s: %d functions; 1 to %d are possible", s->name,
                     s->functions, DVI_SHAPES_MOST);
  if (!isfinite(s->h) || (s->h != 0 && !isnormal(s->h)))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "shapes %s: h = %g is no length of a step at which functions can be checked; "
                     "0 says that they do not depend on it",
                     s->name, s->h);
  if (s->coordinate_count < 0 || (s->coordinates == NULL) != (s->coordinate_count == 0))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "shapes %s: coordinate_count is %d, and the list of coordinates is %s; list "
                     "them, or leave both out for all",
                     s->name, s->coordinate_count, s->coordinates == NULL ? "NULL" : "given");
  if (s->order < 0)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "shapes %s: the order %d is claimed; 0 leaves it to the polynomials", s->name,
                     s->order);
  return check_shapes_points(s);
}

/* ---- the functions ---- */

/* Irrational points, so that none lies on a knot. */
enum { PLACES = 41 };
static const double golden = 0.61803398874989485, least_move = 6e-6;

static double derivative_point(int i)
{
  return least_move + (1 - 2 * least_move) * fmod((i + 1) * golden, 1);
}

/* Find the size of f_k', by which its errors are measured. This is the largest value over the
 * points, and the possible effect of f_k's rounding on differences. */
static dvi_status measure_derivative(const dvi__user_basis *g, int k, double h, double *size)
{
  *size = 0;
  for (int i = 0; i < PLACES; i++) {
    DVI_TRY(dvi__user_basis_evaluate(g, h, derivative_point(i)));
    *size = fmax(*size, fabs(g->df[k]) + 1e-9 * fabs(g->f[k]));
  }
  return DVI_OK;
}

/* Compare with second-order differences. Their error for sin(nu tau) is nu^2 6e-12 of its
 * derivative. */
static dvi_status check_derivative(const dvi__user_basis *g, int k, double h)
{
  double size;
  DVI_TRY(measure_derivative(g, k, h, &size));
  for (int i = 0; i < PLACES; i++) {
    const double tau = derivative_point(i), before = tau - least_move, after = tau + least_move;
    DVI_TRY(dvi__user_basis_evaluate(g, h, before));
    const double f = g->f[k];
    DVI_TRY(dvi__user_basis_evaluate(g, h, after));
    const double difference = (g->f[k] - f) / (after - before);
    DVI_TRY(dvi__user_basis_evaluate(g, h, tau));
    if (fabs(g->df[k] - difference) > 1e-4 * size)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "shapes %s: at tau = %.6g of a step of h = %.3g derivative[%d] = %.9g, but "
                       "differences of the values give "
                       "%.9g; it is d/dtau",
                       g->shapes->name, tau, h, k, g->df[k], difference);
  }
  return DVI_OK;
}

static dvi_status check_independence(const dvi__user_basis *g)
{
  for (int k = 0; k < g->count; k++) {
    if (g->now.matrix[k * g->count + k] != 0) continue;
    if (k < g->degree)
      return dvi__fail(
          DVI_BAD_ARGUMENT,
          "shapes %s: the %d points do not tell polynomials up to degree %d apart; spread them",
          g->shapes->name, g->points, g->degree);
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "shapes %s: at the %d points function %d is a combination of a constant, "
                     "polynomials up to degree %d and the functions "
                     "before it, but for 1e-8 of itself; leave it out, or take more points%s",
                     g->shapes->name, g->points, k - g->degree, g->degree,
                     g->shapes->h != 0 ? ", or a longer h" : "");
  }
  return DVI_OK;
}

/* Functions are orthonormal, sum_j |b_j| psi'^2 = 1. By Schwarz' inequality no value is above 1 but
 * for the quadrature's error. A function with a larger value has almost all of its slope between
 * the points. Its correction (space/user_basis.c) would be as large as the value, and orders would
 * show only at steps that are shorter by this factor. */
static dvi_status check_resolution(const dvi__user_basis *g)
{
  enum { LARGEST = 100 };
  for (int k = g->degree; k < g->count; k++) {
    double largest = fabs(g->now.end[k]);
    for (int j = 0; j < g->points; j++) largest = fmax(largest, fabs(g->now.psi[j * g->count + k]));
    if (largest > LARGEST)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "shapes %s: the %d points are much too coarse for function %d: it changes "
                       "by %.3g times as much as its "
                       "derivatives there allow; take more points, or place them where it changes",
                       g->shapes->name, g->points, k - g->degree, largest);
  }
  return DVI_OK;
}

dvi_status dvi__user_basis_check(const dvi__user_basis *g)
{
  for (int k = 0; k < g->shapes->functions; k++) DVI_TRY(check_derivative(g, k, g->now.h));
  DVI_TRY(check_independence(g));
  return check_resolution(g);
}

/* ---- symmetry ---- */

static int points_mirror(const dvi__user_basis *g, const dvi__user_basis_tables *a,
                         const dvi__user_basis_tables *b)
{
  for (int j = 0; j < g->points; j++) {
    const int other = g->points - 1 - j;
    if (fabs(a->node[j] + b->node[other] - 1) > 1e-12 ||
        fabs(a->weight[j] - b->weight[other]) > 1e-12)
      return 0;
  }
  return 1;
}

/* Expand the mirrored function tau -> psi_k(1 - tau) - psi_k(1) in the basis b, with the
 * coefficients [count] in at_value. Return the largest residual of the derivatives. */
static long double project_mirrored(const dvi__user_basis *g, const dvi__user_basis_tables *a,
                                    const dvi__user_basis_tables *b, int k)
{
  long double *left = g->slope, most = 0;
  for (int j = 0; j < g->points; j++)
    left[j] = -(long double)a->dpsi[(g->points - 1 - j) * g->count + k];
  for (int l = 0; l < g->count; l++) {
    g->at_value[l] = 0;
    for (int j = 0; j < g->points; j++)
      g->at_value[l] += dvi__user_basis_measure(g, b, j, l) * left[j] *
                        (long double)b->dpsi[j * g->count + l];
    for (int j = 0; j < g->points; j++)
      left[j] -= g->at_value[l] * (long double)b->dpsi[j * g->count + l];
  }
  for (int j = 0; j < g->points; j++) most = fmaxl(most, fabsl(left[j]));
  return most;
}

static long double combine_functions(const dvi__user_basis *g, const double *function)
{
  long double sum = 0;
  for (int l = 0; l < g->count; l++) sum += g->at_value[l] * (long double)function[l];
  return sum;
}

static int function_mirrors(const dvi__user_basis *g, const dvi__user_basis_tables *a,
                            const dvi__user_basis_tables *b, int k)
{
  long double most = project_mirrored(g, a, b, k);
  most = fmaxl(most, fabsl((long double)a->end[k] + combine_functions(g, b->end)));
  for (int j = 0; j < g->points; j++) {
    const double value = a->psi[(g->points - 1 - j) * g->count + k];
    const long double mirrored = (long double)value - (long double)a->end[k];
    most = fmaxl(most, fabsl(mirrored - combine_functions(g, b->psi + j * g->count)));
  }
  return most <= 1e-9L;
}

/* A step back undoes a step if both have the same paths and the same points. A space that cannot be
 * evaluated backward is not symmetric. */
int dvi__user_basis_mirrors(dvi__user_basis *g)
{
  if (dvi__user_basis_fill(g, -g->shapes->h, &g->spare) != DVI_OK) return 0;
  if (!points_mirror(g, &g->now, &g->spare)) return 0;
  for (int k = 0; k < g->count; k++)
    if (!function_mirrors(g, &g->now, &g->spare, k)) return 0;
  return 1;
}
