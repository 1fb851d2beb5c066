/* Schroedinger's equation in coefficients: mass, kinetic energy, and potentials at the quadrature
 * points. An amplitude z [2*free] is the real parts of the free functions and the imaginary parts
 * behind them. */
#ifndef DVI_FIELD_SCHROEDINGER_SCHROEDINGER_H
#define DVI_FIELD_SCHROEDINGER_SCHROEDINGER_H
#include <dvi/schroedinger.h>

#include "field/space/space.h"

struct dvi_schroedinger {
  dvi_space *space; /* shared */
  double hbar, mass;
  int dimension, radial, is_fourier;
  int64_t functions, free, points;
  int *place; /* [free] the function of each free one */
  int (*potential)(int64_t count, double t, const double *x, double *V, void *user);
  void *user;
  int depends_on_time;
  const double *x;              /* [dimension*points] of the space */
  double *weight;               /* [points] with the radial measure */
  double *still;                /* [points] V at t = 0 */
  double *beta;                 /* [points], NULL without interaction */
  dvi__space_operator values;   /* of all functions, for fourier */
  dvi__space_operator slope[3]; /* first derivatives of all functions */
  dvi__csr B;                   /* [points x free] values of free functions, else */
  /* Sparse matrices of free functions with one pattern, which has the kinetic energy's values. */
  dvi__csr T;
  double *M;
  double *diagonal; /* [free] kinetic energy for fourier, whose mass is 1 */
};

/* Room for products: values at the points, and work of transforms. */
typedef struct dvi__schroedinger_room {
  double *u;    /* [2*points] */
  double *work; /* of the space's operators */
} dvi__schroedinger_room;

dvi_status dvi__schroedinger_make_room(const dvi_schroedinger *s, dvi__schroedinger_room *room);
void dvi__schroedinger_clear_room(dvi__schroedinger_room *room);

/* Check values at the points. DVI_NOT_FINITE, with the name and the point. */
dvi_status dvi__schroedinger_check(const dvi_schroedinger *s, const char *name,
                                   const double *values);

/* Give V [points] at a time, checked. DVI_CALLBACK_FAILED, DVI_NOT_FINITE. */
dvi_status dvi__schroedinger_potential(const dvi_schroedinger *s, double t, double *V);

/* Add sum w V B^T B to the values of a matrix in the pattern of T. V is NULL for 1. */
void dvi__schroedinger_add_square(const dvi_schroedinger *s, const double *V, double *values);

/* Give the sparse matrix T + sum w V B^T B in the pattern of T. V may be NULL for 0. */
void dvi__schroedinger_assemble(const dvi_schroedinger *s, const double *V, double *values);

/* u [points] = B x, and y [free] += B^T p. */
void dvi__schroedinger_to_points(const dvi_schroedinger *s, const double *x, double *u,
                                 double *work);
void dvi__schroedinger_add_points(const dvi_schroedinger *s, const double *p, double *y,
                                  double *work);

/* y [free] = M x, and y [free] = T x. */
void dvi__schroedinger_mass(const dvi_schroedinger *s, const double *x, double *y);
void dvi__schroedinger_kinetic(const dvi_schroedinger *s, const double *x, double *y);

/* y = H z with V [points], and `strength` times the interaction, of z with one part, a real
 * amplitude, or two. */
void dvi__schroedinger_act(const dvi_schroedinger *s, const double *V, double strength, int parts,
                           const double *z, double *y, const dvi__schroedinger_room *room);

/* y = H(psi) z + 2 beta Re(psi* z) psi, the derivative of H(psi) psi along an amplitude z of two
 * parts. psi [2*points] is not read without an interaction. */
void dvi__schroedinger_act_beside(const dvi_schroedinger *s, const double *V, const double *psi,
                                  const double *z, double *y, const dvi__schroedinger_room *room);

/* Give z [free] of coefficients of all functions, and back, with 0 for fixed ones. */
void dvi__schroedinger_restrict(const dvi_schroedinger *s, const double *psi, double *z);
void dvi__schroedinger_extend(const dvi_schroedinger *s, const double *z, double *psi);

/* Measure coefficients psi [2*functions] whose fixed functions are 0, with V at their time. `u`
 * [4*points] and `work` are room. */
void dvi__schroedinger_measure_at(const dvi_schroedinger *s, const double *V, const double *psi,
                                  double *u, double *work, dvi_schroedinger_values *values);

/* The lowest modes for fourier with many functions, by products alone. */
dvi_status dvi__schroedinger_iterate_modes(const dvi_schroedinger *s, int count, double *energy,
                                           double *z);

/* Bound the largest kinetic energy of a fourier or nodal space, by a thousandth of it. */
dvi_status dvi__schroedinger_largest_kinetic(const dvi_schroedinger *s, double *kinetic);

/* The lowest modes z [count][free], real. */
dvi_status dvi__schroedinger_lowest(const dvi_schroedinger *s, int count, double *energy,
                                    double *z);

#endif
