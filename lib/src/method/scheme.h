/* Symmetric compositions of a symmetric method have parts g_i = g_{m+1-i} of a step with sum
 * g_i = 1.
 *
 * Order 4 has 5 substeps (Suzuki 1990). Orders 6 and 8 have 9 and 17 substeps (Kahan and Li 1997).
 * Hairer, Lubich and Wanner 2006 collect all three in eqs. II.4.5, V.3.12 and V.3.14. */
#ifndef DVI_METHOD_SCHEME_H
#define DVI_METHOD_SCHEME_H

enum { DVI__SUBSTEPS_MOST = 17 };

/* The weights are the first half of the parts and the middle one. The others follow by symmetry.
 * `lengths` counts the distinct parts. Steps of Verlet's method on q'' = -omega^2 q are stable for
 * h omega up to `stable`, rounded down to a thousandth. */
typedef struct dvi__scheme {
  int order, substeps, lengths;
  double stable;
  double weight[(DVI__SUBSTEPS_MOST + 1) / 2];
} dvi__scheme;

/* The name of an order in specifications, NULL past the last one, and the scheme with that
 * index. */
const char *dvi__scheme_name(int index);
const dvi__scheme *dvi__scheme_at(int index);

/* The part g of substep i, counted from 0. */
double dvi__scheme_part(const dvi__scheme *scheme, int i);

/* The lengths of the substeps of a step of h. */
void dvi__scheme_lengths(const dvi__scheme *scheme, double h, double *length);

#endif
