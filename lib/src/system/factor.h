/* Configuration spaces with factors: where their numbers stand, and the mass on the stored
 * coordinates. */
#ifndef DVI_SYSTEM_FACTOR_H
#define DVI_SYSTEM_FACTOR_H
#include "system/system.h"

/* Fill in n, nv, nx and the slots; DVI_BAD_SIZE, DVI_BAD_ARGUMENT. */
dvi_status dvi__factors_lay_out(const dvi_system_terms *terms, dvi_system *system);

/* The mass of the factors and of the terms together, on the stored coordinates. */
dvi_status dvi__factors_mass(const dvi_system_terms *terms, dvi_system *system);

/* DVI_BAD_ARGUMENT unless q is on the manifold and second, p or v, where it must be orthogonal, up
 * to rounding; the sentence names the distance. */
dvi_status dvi__factors_check(const dvi_system *system, const double *q, const double *second);

/* dq/dt [nq] of a stored velocity [nv]. */
void dvi__factors_rate(const dvi_system *system, const double *q, const double *v, double *rate);

/* The stored momentum [nv] of a covector [nq]. */
void dvi__factors_momentum(const dvi_system *system, const double *q, const double *covector,
                           double *p);

#endif
