/* The normal modes of a system with quadratic potentials, V = q.Kq/2 + b.q, are K X = M X
 * diag(lambda) with X^T M X = 1. Each mode moves alone.
 *
 *     y = X^T M q,      w = X^T p,      y' = w,      w' = -lambda y - X^T b
 *
 * Coordinates that neither M nor K couples form blocks with modes of their own, which are computed
 * once, block by block. */
#ifndef DVI_STEP_SPLIT_MODES_H
#define DVI_STEP_SPLIT_MODES_H
#include "num/simd/lanes.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__modes dvi__modes;

/* Create the modes of a system with potentials that are all declared quadratic, and a positive
 * mass. K is evaluated here, at t = 0 and q = 0. Neither the system nor the counters need outlive
 * the modes. DVI_SINGULAR if the mass is not positive definite. DVI_BAD_SIZE if a block has more
 * than `most` coordinates. */
enum { DVI__MODES_BLOCK_MOST = 2000 };
dvi_status dvi__modes_create(const dvi_system *system, int most, dvi_counters *counters,
                             dvi__modes **modes);
void dvi__modes_destroy(dvi__modes **modes);

int dvi__modes_block_count(const dvi__modes *modes);
int dvi__modes_largest_block(const dvi__modes *modes);

/* lambda [n] are the squared frequencies of the modes. */
const double *dvi__modes_squares(const dvi__modes *modes);

/* The least and the largest frequency of modes that oscillate. Both are 0 if none does. */
void dvi__modes_range(const dvi__modes *modes, double *least, double *most);

/* Compute y = X^T f of forces, or momenta, f, and y = X^T M q, and q = X y, and f = M X y. All are
 * [n] and distinct. */
void dvi__modes_of_forces(const dvi__modes *modes, const double *f, double *y);
void dvi__modes_of_coordinates(const dvi__modes *modes, const double *q, double *y);
void dvi__modes_to_coordinates(const dvi__modes *modes, const double *y, double *q);
void dvi__modes_to_forces(const dvi__modes *modes, const double *y, double *f);

/* Compute c_k(s) = sum_j (-s)^j/(2j+k)!, k = 0 to 3, of s = h^2 lambda, which may be negative. With
 * x = h omega these are cos x, sin x/x, (1 - cos x)/x^2 and (x - sin x)/x^3. */
void dvi__modes_functions(double s, double c[4]);

/* Move over h, exactly for a constant b. V_q [n] is the gradient at the start. */
void dvi__modes_move(dvi__modes *modes, double h, const double *V_q, const dvi__phase *phase);

#endif
