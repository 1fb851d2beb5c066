/* The normal modes of a system whose potentials are quadratic, V = q.Kq/2 + b.q: K X = M X
 * diag(lambda), X^T M X = 1. A mode moves by itself,
 *
 *     y = X^T M q,      w = X^T p,      y' = w,      w' = -lambda y - X^T b.
 *
 * Coordinates that neither M nor K couples are blocks with modes of their own, which are found
 * once, one block after the other. */
#ifndef DVI_ACTION_MODES_H
#define DVI_ACTION_MODES_H
#include "num/simd/lanes.h"
#include "system/evaluate/evaluator.h"

typedef struct dvi__modes dvi__modes;

/* Of a system whose potentials are all declared quadratic, and whose mass is positive. K is asked
 * for here, at t = 0 and q = 0. Neither the system nor the counters need outlive it. DVI_SINGULAR:
 * the mass is not positive definite; DVI_BAD_SIZE: a block has more than `most` coordinates. */
enum { DVI__MODES_BLOCK_MOST = 2000 };
dvi_status dvi__modes_create(const dvi_system *system, int most, dvi_counters *counters,
                             dvi__modes **modes);
void dvi__modes_destroy(dvi__modes **modes);

int dvi__modes_block_count(const dvi__modes *modes);
int dvi__modes_largest_block(const dvi__modes *modes);

/* lambda [n], the squared frequencies of the modes. */
const double *dvi__modes_squares(const dvi__modes *modes);

/* The least and the largest frequency. Modes that do not oscillate do not count; both are 0 if none
 * does. */
void dvi__modes_range(const dvi__modes *modes, double *least, double *most);

/* y = X^T f of forces, or momenta, f; q = X y; f = M X y. All [n], none may be another. */
void dvi__modes_of_forces(const dvi__modes *modes, const double *f, double *y);
void dvi__modes_to_coordinates(const dvi__modes *modes, const double *y, double *q);
void dvi__modes_to_forces(const dvi__modes *modes, const double *y, double *f);

/* c_k(s) = sum_j (-s)^j/(2j+k)!, k = 0 to 3, of s = h^2 lambda, which may be negative: cos, sin
 * x/x, (1 - cos x)/x^2, (x - sin x)/x^3 of x = h omega. */
void dvi__modes_functions(double s, double c[4]);

/* The motion over h, exactly where b does not move: V_q [n] is the gradient at its start. */
void dvi__modes_move(dvi__modes *modes, double h, const double *V_q, const dvi__phase *phase);

#endif
