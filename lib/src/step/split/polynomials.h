/* Functions of h^2 M^-1 K of a system whose potentials are quadratic, V = q.Kq/2 + b.q, by
 * Chebyshev polynomials of one product with K each degree: for sparse K of any size, and masses of
 * one number a coordinate.
 *
 * All eigenvalues omega^2 of M^-1 K lie in the discs of Gershgorin of M^-1 K, and in those of
 * M^-1/2 K M^-1/2: between `low` <= 0 and `high`. That is proven, but may be wide. Degrees are such
 * that what is left out is below a rounding (step/split/expansion.h). Sums of the same products in
 * the same order in each step: the motion is symmetric, and symplectic to rounding, and conserves
 * momenta that K has. */
#ifndef DVI_ACTION_POLYNOMIALS_H
#define DVI_ACTION_POLYNOMIALS_H
#include "step/split/expansion.h"
#include "num/simd/lanes.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__polynomials dvi__polynomials;

/* K is sparse if its rows have so many entries on average. */
enum { DVI__POLYNOMIALS_ROW = 100 };

/* Of a system whose potentials are all declared quadratic, and whose mass is positive. K is asked
 * for here, at t = 0 and q = 0. The system need not outlive it, the counters (products) must.
 * DVI_UNSUPPORTED: the mass is not diagonal, or K is not sparse; DVI_SINGULAR: a mass is not
 * positive. */
dvi_status dvi__polynomials_create(const dvi_system *system, dvi_counters *counters,
                                   dvi__polynomials **polynomials);
void dvi__polynomials_destroy(dvi__polynomials **polynomials);

/* Between which all omega^2 lie. */
void dvi__polynomials_interval(const dvi__polynomials *polynomials, double *low, double *high);

/* A function f of s = h^2 omega^2, or (1 - f)/s if `divided`, as the polynomial of a slot.
 * DVI_NOT_CONVERGED if it has poles there, or its degree would be too high; the sentence says for
 * which steps it would not. */
enum { DVI__POLYNOMIALS_SLOTS = 2 };
dvi_status dvi__polynomials_expand(dvi__polynomials *polynomials, int slot, double h,
                                   const dvi__growth *growth, int divided,
                                   double (*f)(const void *user, double s), const void *user);

/* x = f(h^2 M^-1 K) M^-1 force, of forces or momenta, and M x, with the function and the h of the
 * slot. All [n]; x may be the force. */
void dvi__polynomials_to_coordinates(dvi__polynomials *polynomials, int slot, const double *force,
                                     double *x);
void dvi__polynomials_to_forces(dvi__polynomials *polynomials, int slot, const double *force,
                                double *Mx);

/* The motion over h, exactly where b does not move: V_q [n] is the gradient at its start.
 * DVI_NOT_CONVERGED as above; then nothing moved. */
dvi_status dvi__polynomials_move(dvi__polynomials *polynomials, double h, const double *V_q,
                                 const dvi__phase *phase);

/* The longest step in which no mode that grows grows too much for digits; HUGE_VAL: none grows. */
double dvi__polynomials_longest(const dvi__polynomials *polynomials);

/* The degree that the motion over h has, or would have if it is too high, and the bound of what is
 * left out. h is not above the longest. */
int dvi__polynomials_degree(const dvi__polynomials *polynomials, double h, double *bound);

#endif
