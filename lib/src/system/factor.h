/* Configuration spaces with factors, the layout of their numbers, and the mass on the stored
 * coordinates. */
#ifndef DVI_SYSTEM_FACTOR_H
#define DVI_SYSTEM_FACTOR_H
#include "system/system.h"

/* Compute n, nv, nx and the slots. Return DVI_BAD_SIZE or DVI_BAD_ARGUMENT for bad factors. */
dvi_status dvi__factors_lay_out(const dvi_system_terms *terms, dvi_system *system);

/* Compute the mass of the factors and of the terms together, on the stored coordinates. */
dvi_status dvi__factors_mass(const dvi_system_terms *terms, dvi_system *system);

/* Return DVI_BAD_ARGUMENT unless q is on the manifold, and second, p or v, is orthogonal where it
 * must be, up to rounding. The sentence names the distance. */
dvi_status dvi__factors_check(const dvi_system *system, const double *q, const double *second);

/* Compute dq/dt [nq] of a stored velocity [nv]. */
void dvi__factors_rate(const dvi_system *system, const double *q, const double *v, double *rate);

/* Compute the stored momentum [nv] of a covector [nq]. */
void dvi__factors_momentum(const dvi_system *system, const double *q, const double *covector,
                           double *p);

#endif
