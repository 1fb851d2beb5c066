/* Scattering of a plane wave exp(i(kx - wt)) by a cylinder and by a sphere, exactly. The refractive
 * index n + i kappa has kappa > 0 where it absorbs. */
#ifndef SUPPORT_WAVES_SCATTERING_H
#define SUPPORT_WAVES_SCATTERING_H
#include "support/waves/bessel.h"

/* The field along a cylinder's axis: E_z (TM) or H_z (TE). */
typedef enum cylinder_case { CYLINDER_TM, CYLINDER_TE } cylinder_case;

/* A solution for a cylinder of the radius a around the origin. */
typedef struct cylinder {
  int orders; /* of the series, from 0 on */
  quad k, radius;
  quad_complex index;
  quad_complex outside[BESSEL_ORDER], inside[BESSEL_ORDER];
} cylinder;

void cylinder_solve(cylinder_case polarization, double k, double radius, double index,
                    double absorption, cylinder *c);

/* Efficiencies of extinction and scattering, powers over that which falls on the diameter. */
void cylinder_efficiencies(const cylinder *c, double *extinction, double *scattering);

/* The whole field at a place, and its derivatives in x and y. */
void cylinder_field(const cylinder *c, double x, double y, quad_complex *field,
                    quad_complex *along_x, quad_complex *along_y);

/* What a sphere does, per area pi a^2. */
typedef struct sphere_efficiencies {
  double extinction, scattering, backscattering, asymmetry;
  double forward_re, forward_im; /* S(0) of Bohren and Huffman, sec. 4.4 */
} sphere_efficiencies;

/* Mie's series for the size parameter x = k a. */
sphere_efficiencies sphere_solve(double x, double index, double absorption);

#endif
