/* Functions of h^2 M^-1 K of a system with quadratic potentials, V = q.Kq/2 + b.q, by Chebyshev
 * polynomials, with one product with K for each degree. K is sparse and of any size, and the mass
 * is one number for each coordinate.
 *
 * All eigenvalues omega^2 of M^-1 K lie in the discs of Gershgorin of M^-1 K, and in those of
 * M^-1/2 K M^-1/2, and therefore between `low` <= 0 and `high`. This interval is proven, but may be
 * wide. Degrees are such that the truncation error is below a rounding (step/split/expansion.h).
 * Each step sums the same products in the same order. Therefore the motion is symmetric, symplectic
 * to rounding, and conserves the momenta of the symmetries of K. */
#ifndef DVI_STEP_SPLIT_POLYNOMIALS_H
#define DVI_STEP_SPLIT_POLYNOMIALS_H
#include "step/split/expansion.h"
#include "num/simd/lanes.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__polynomials dvi__polynomials;

/* K is sparse if its rows have at most this number of entries on average. */
enum { DVI__POLYNOMIALS_ROW = 100 };

/* Create polynomials for a system with potentials that are all declared quadratic, and a positive
 * mass. K is evaluated here, at t = 0 and q = 0. The counters, which count products, must outlive
 * the polynomials, and the system need not. DVI_UNSUPPORTED if the mass is not diagonal or K is not
 * sparse. DVI_SINGULAR if a mass is not positive. */
dvi_status dvi__polynomials_create(const dvi_system *system, dvi_counters *counters,
                                   dvi__polynomials **polynomials);
void dvi__polynomials_destroy(dvi__polynomials **polynomials);

/* All omega^2 lie in this interval. */
void dvi__polynomials_interval(const dvi__polynomials *polynomials, double *low, double *high);

/* Expand a function f of s = h^2 omega^2, or (1 - f)/s if `divided`, as the polynomial of a slot.
 * DVI_NOT_CONVERGED if f has poles there, or the degree would be too high. The sentence names the
 * possible steps. */
enum { DVI__POLYNOMIALS_SLOTS = 2 };
dvi_status dvi__polynomials_expand(dvi__polynomials *polynomials, int slot, double h,
                                   const dvi__growth *growth, int divided,
                                   double (*f)(const void *user, double s), const void *user);

/* Compute x = f(h^2 M^-1 K) M^-1 force, of forces or momenta, or M x, with the function and the h
 * of the slot. All are [n], and x may be the force. */
void dvi__polynomials_to_coordinates(dvi__polynomials *polynomials, int slot, const double *force,
                                     double *x);
void dvi__polynomials_to_forces(dvi__polynomials *polynomials, int slot, const double *force,
                                double *Mx);

/* Move over h, exactly for a constant b. V_q [n] is the gradient at the start. DVI_NOT_CONVERGED as
 * in dvi__polynomials_expand, and then nothing moved. */
dvi_status dvi__polynomials_move(dvi__polynomials *polynomials, double h, const double *V_q,
                                 const dvi__phase *phase);

/* The longest step in which no mode grows so much that the others lose their digits. HUGE_VAL if no
 * mode grows. */
double dvi__polynomials_longest(const dvi__polynomials *polynomials);

/* The degree of the motion over h, also if it is too high, and the bound of the truncation error. h
 * is at most the longest step. */
int dvi__polynomials_degree(const dvi__polynomials *polynomials, double h, double *bound);

#endif
