/** Trial functions: bases of the polynomials of one degree on the unit interval. */
#ifndef DVI_BASIS_H
#define DVI_BASIS_H
#include <dvi/status.h>

/** Highest degree of a trial space. */
#define DVI_DEGREE_MAX 40

/** The bases. A nodal basis is Lagrange's on the named nodes. A modal basis holds orthogonal
 *  polynomials. */
typedef enum dvi_basis {
  DVI_LAGRANGE_LOBATTO,    /**< nodal, both ends are nodes */
  DVI_LAGRANGE_GAUSS,      /**< nodal, no end is a node */
  DVI_LAGRANGE_CHEBYSHEV,  /**< nodal, Chebyshev points of the second kind, both ends are nodes */
  DVI_LAGRANGE_EQUISPACED, /**< nodal, with a Lebesgue constant that grows like 2^degree */
  DVI_LEGENDRE,            /**< modal, P_k(2 tau - 1) */
  DVI_CHEBYSHEV            /**< modal, T_k(2 tau - 1) */
} dvi_basis;

#ifdef __cplusplus
extern "C" {
#endif

/** Evaluate all trial functions of a degree, and their derivatives, at one point.
 *
 *  @param      basis       the basis
 *  @param      degree      1 to DVI_DEGREE_MAX. There are degree+1 functions
 *  @param      tau         reference time. The step is [0,1], values outside extrapolate
 *  @param[out] value       [degree+1], phi_k(tau). NULL if not wanted
 *  @param[out] derivative  [degree+1], phi_k'(tau). NULL if not wanted
 *  @retval DVI_OK            values right to a few ulp of the largest of them
 *  @retval DVI_BAD_SIZE      the degree is out of range. Nothing is written
 *  @retval DVI_BAD_ARGUMENT  unknown basis, or tau not finite. Nothing is written
 *
 *  Nodal bases are evaluated by the barycentric form (Berrut and Trefethen 2004), modal bases by
 *  their three-term recurrence. */
dvi_status dvi_basis_evaluate(dvi_basis basis, int degree, double tau, double *value,
                              double *derivative);

/** Write the nodes of a nodal basis.
 *
 *  @param[out] node  [degree+1], ascending, in [0,1]
 *  @retval DVI_OK            node is filled
 *  @retval DVI_BAD_SIZE      the degree is out of range
 *  @retval DVI_BAD_ARGUMENT  the basis is modal, or unknown, or node is NULL */
dvi_status dvi_basis_nodes(dvi_basis basis, int degree, double *node);

/** Return the basis' name as method specifications spell it ("lobatto", "legendre", ...). NULL if
 *  the basis is out of range. */
const char *dvi_basis_name(dvi_basis basis);

#ifdef __cplusplus
}
#endif
#endif
