/* Symmetric compositions of a symmetric method: parts g_i = g_{m+1-i} of a step, sum g_i = 1.
 *
 * Order 4: Suzuki 1990, 5 substeps. Order 6: Kahan and Li 1997, 9 substeps. Order 8: Kahan and Li
 * 1997, 17 substeps. All three as collected by Hairer, Lubich and Wanner 2006, eqs. II.4.5, V.3.12
 * and V.3.14. */
#ifndef DVI_METHOD_SCHEME_H
#define DVI_METHOD_SCHEME_H

enum { DVI__SUBSTEPS_MOST = 17 };

/* The first half of the parts and the middle one; the rest mirrors them. `lengths` of them
 * differ. */
typedef struct dvi__scheme {
  int order, substeps, lengths;
  double weight[(DVI__SUBSTEPS_MOST + 1) / 2];
} dvi__scheme;

/* The order as specifications spell it, NULL past the last one; the scheme of that index. */
const char *dvi__scheme_name(int index);
const dvi__scheme *dvi__scheme_at(int index);

/* g of substep i, from 0 on. */
double dvi__scheme_part(const dvi__scheme *scheme, int i);

#endif
