/* Bases of the polynomials of one degree on the unit interval. */
#include "space/basis.h"

#include <math.h>
#include <stddef.h>

#include "core/status.h"
#include "space/legendre.h"
#include "space/quadrature.h"

static const struct basis {
  const char *name;
  int nodal;
} bases[] = {
    [DVI_LAGRANGE_LOBATTO] = {"lobatto", 1},
    [DVI_LAGRANGE_GAUSS] = {"gauss", 1},
    [DVI_LAGRANGE_CHEBYSHEV] = {"chebyshev-lobatto", 1},
    [DVI_LAGRANGE_EQUISPACED] = {"equispaced", 1},
    [DVI_LEGENDRE] = {"legendre", 0},
    [DVI_CHEBYSHEV] = {"chebyshev", 0},
};

/* A caller may pass any number as an enum. */
static int basis_is_known(dvi_basis basis)
{
  return (int)basis >= 0 && (size_t)basis < sizeof bases / sizeof *bases;
}

int dvi__basis_is_nodal(dvi_basis basis)
{
  return bases[basis].nodal;
}

/* The rules cannot fail: every degree has a size that they know. */
static void place_marks(dvi_basis basis, int degree, long double *mark)
{
  long double weight[DVI__TRIAL_MAX];
  switch (basis) {
  case DVI_LAGRANGE_LOBATTO:
    (void)dvi__quadrature_long(DVI_LOBATTO, degree + 1, mark, weight);
    break;
  case DVI_LAGRANGE_GAUSS: (void)dvi__quadrature_long(DVI_GAUSS, degree + 1, mark, weight); break;
  case DVI_LAGRANGE_CHEBYSHEV:
    (void)dvi__quadrature_long(DVI_CLENSHAW_CURTIS, degree + 1, mark, weight);
    break;
  case DVI_LAGRANGE_EQUISPACED:
    for (int k = 0; k <= degree; k++) mark[k] = (long double)k;
    break;
  case DVI_LEGENDRE:
  case DVI_CHEBYSHEV: break;
  }
}

void dvi__space_init(dvi__space *space, dvi_basis basis, int degree)
{
  *space = (dvi__space){.basis = basis, .degree = degree};
  if (!dvi__basis_is_nodal(basis)) return;
  space->scale = basis == DVI_LAGRANGE_EQUISPACED ? (long double)degree : 1;
  place_marks(basis, degree, space->mark);
  for (int k = 0; k <= degree; k++) {
    long double product = 1;
    for (int j = 0; j <= degree; j++)
      if (j != k) product *= space->mark[k] - space->mark[j];
    space->weight[k] = 1 / product;
  }
}

/* The barycentric form of the first kind is phi_k = weight[k] prod_{j != k} (x - mark[j]),
 * x = scale tau. The product without one factor is the product of the factors before and behind
 * that factor. So nothing is divided by x - mark[k], and a tau at a node, or one bit beside a node,
 * is a point like any other. The first kind also stays accurate outside of the interval, where the
 * second kind does not (Higham 2004). */
static void basis_lagrange(const dvi__space *space, long double tau, long double *value,
                           long double *derivative)
{
  const int last = space->degree;
  const long double x = space->scale * tau;
  long double before[DVI__TRIAL_MAX], before_slope[DVI__TRIAL_MAX];
  long double behind = 1, behind_slope = 0;
  before[0] = 1;
  before_slope[0] = 0;
  for (int k = 0; k < last; k++) {
    before[k + 1] = before[k] * (x - space->mark[k]);
    before_slope[k + 1] = before_slope[k] * (x - space->mark[k]) + before[k];
  }
  for (int k = last; k >= 0; k--) {
    if (value) value[k] = space->weight[k] * (before[k] * behind);
    if (derivative)
      derivative[k] = space->scale * space->weight[k] *
                      (before_slope[k] * behind + before[k] * behind_slope);
    behind_slope = behind_slope * (x - space->mark[k]) + behind;
    behind *= x - space->mark[k];
  }
}

/* Compute P_k(1-2y) and its derivative in x = 1-2y, from P'_{k+1} = P'_{k-1} + (2k+1) P_k. */
static void basis_legendre(int degree, long double y, long double *value, long double *slope)
{
  long double difference[DVI__TRIAL_MAX];
  dvi__legendre(degree, y, value, difference);
  for (int k = 0; k <= degree; k++)
    slope[k] = k == 0 ? 0 : (k > 1 ? slope[k - 2] : 0) + (long double)(2 * k - 1) * value[k - 1];
}

/* Compute T_k(1-2y) and its derivative k U_{k-1}, by differences as for Legendre. They satisfy
 * T_{k+1} - T_k = T_k - T_{k-1} - 4 y T_k, and U_k = U_{k-2} + 2 T_k. */
static void basis_chebyshev(int degree, long double y, long double *value, long double *slope)
{
  long double difference = -2 * y, U[DVI__TRIAL_MAX];
  value[0] = 1;
  U[0] = 1;
  slope[0] = 0;
  for (int k = 1; k <= degree; k++) {
    value[k] = value[k - 1] + difference;
    difference -= 4 * y * value[k];
    U[k] = (k > 1 ? U[k - 2] : 0) + 2 * value[k];
    slope[k] = (long double)k * U[k - 1];
  }
}

/* Evaluate both families from the nearer end. Seen from the left one, x = -(1-2y), and odd
 * functions change their sign. */
static void basis_modal(const dvi__space *space, long double tau, long double *value,
                        long double *derivative)
{
  const int from_left = tau < 0.5L;
  const long double y = from_left ? tau : 1 - tau;
  long double seen[DVI__TRIAL_MAX], slope[DVI__TRIAL_MAX];
  (space->basis == DVI_LEGENDRE ? basis_legendre : basis_chebyshev)(space->degree, y, seen, slope);
  for (int k = 0; k <= space->degree; k++) {
    const long double sign = from_left && k % 2 ? -1 : 1;
    if (value) value[k] = sign * seen[k];
    if (derivative) derivative[k] = (from_left ? -2 : 2) * sign * slope[k];
  }
}

void dvi__space_evaluate(const dvi__space *space, long double tau, long double *value,
                         long double *derivative)
{
  (dvi__basis_is_nodal(space->basis) ? basis_lagrange : basis_modal)(space, tau, value, derivative);
}

static dvi_status check_basis(dvi_basis basis, int degree)
{
  if (!basis_is_known(basis))
    return dvi__fail(DVI_BAD_ARGUMENT, "basis: there is no basis with number %d", (int)basis);
  if (degree < 1 || degree > DVI_DEGREE_MAX)
    return dvi__fail(DVI_BAD_SIZE, "basis: degree %d asked, 1 to %d possible", degree,
                     DVI_DEGREE_MAX);
  return DVI_OK;
}

dvi_status dvi_basis_evaluate(dvi_basis basis, int degree, double tau, double *value,
                              double *derivative)
{
  DVI_TRY(check_basis(basis, degree));
  if (!isfinite(tau)) return dvi__fail(DVI_BAD_ARGUMENT, "basis: tau = %g is not finite", tau);
  dvi__space space;
  long double value_long[DVI__TRIAL_MAX] = {0}, derivative_long[DVI__TRIAL_MAX] = {0};
  dvi__space_init(&space, basis, degree);
  dvi__space_evaluate(&space, (long double)tau, value_long, derivative_long);
  for (int k = 0; k <= degree; k++) {
    if (value) value[k] = (double)value_long[k];
    if (derivative) derivative[k] = (double)derivative_long[k];
  }
  return DVI_OK;
}

dvi_status dvi_basis_nodes(dvi_basis basis, int degree, double *node)
{
  DVI_TRY(check_basis(basis, degree));
  if (!dvi__basis_is_nodal(basis))
    return dvi__fail(DVI_BAD_ARGUMENT, "basis: %s is a modal basis, it has no nodes",
                     bases[basis].name);
  if (!node) return dvi__fail(DVI_BAD_ARGUMENT, "basis: the array for the nodes is NULL");
  dvi__space space;
  dvi__space_init(&space, basis, degree);
  for (int k = 0; k <= degree; k++) node[k] = (double)(space.mark[k] / space.scale);
  return DVI_OK;
}

const char *dvi_basis_name(dvi_basis basis)
{
  return basis_is_known(basis) ? bases[basis].name : NULL;
}
