/* The exact motion of momenta in a heat bath for a time tau, O in names such as BAOAB.
 *
 *     p <- c p + sqrt(kT (1 - c^2)) M^(1/2) N,     c = e^{-gamma tau}
 *
 * with standard normal numbers N and M^(1/2) a factor of the mass. It leaves the distribution
 * exp(-p.M^-1 p/2kT) as it is. Source: Leimkuhler and Matthews 2013, eq. 5. */
#ifndef DVI_METHOD_SPLIT_BATH_H
#define DVI_METHOD_SPLIT_BATH_H
#include "method/method.h"

typedef struct dvi__bath dvi__bath;

/* The first numbers of a member in the memory of a method with noise: how many times it drew random
 * numbers, and its stream. */
enum { DVI__BATH_DRAWS, DVI__BATH_STREAM, DVI__BATH_MEMORY };

/* Make the bath of a system with DVI__NOISE, for up to `capacity` members at a time, one if the
 * mass is not diagonal. DVI_SINGULAR if the mass is not positive definite. */
dvi_status dvi__bath_create(const dvi_system *system, int capacity, dvi__bath **bath);
void dvi__bath_destroy(dvi__bath **bath);

/* Write the memory [DVI__BATH_MEMORY] of this member of an ensemble at its start. */
void dvi__bath_start(const dvi_system *system, uint32_t member, double *memory);

/* Move the momenta of members side by side, in equal parts of the time, each with random numbers of
 * its own. */
void dvi__bath_move(dvi__bath *bath, double tau, int parts, int count, double *memory, double *p,
                    double *p_compensation);

#endif
