/* The inside of a user's function space, for user_basis.c and user_basis_check.c. */
#ifndef DVI_SPACE_USER_BASIS_STRUCT_H
#define DVI_SPACE_USER_BASIS_STRUCT_H
#include <math.h>

#include "space/user_basis.h"

/* Tables of steps of one length. */
typedef struct dvi__user_basis_tables {
  double h;              /* length of the step, 0 for empty tables */
  double *node, *weight; /* nodes and weights [points] */
  double *psi, *dpsi;    /* values and derivatives [points*count], by points */
  /* Values e_k(0) [count], and the matrix [count*count] by rows with psi_k = sum_i matrix[k][i]
   * (e_i - e_i(0)), i <= k. */
  long double *start, *matrix;
  double *end, *slopes[2]; /* psi_k(1), and psi_k' at both ends, [count] */
  double *lean;            /* coefficients [count] of the function with psi' = tau */
  int order;               /* order of the quadrature, 2 degree at most */
  dvi__user_basis_fingerprint fingerprint;
} dvi__user_basis_tables;

struct dvi__user_basis {
  const dvi_shapes *shapes;
  /* count is the number of functions, polynomials without the constant included */
  int degree, count, points;
  double *node, *weight;             /* nodes and weights [points] of the library's quadrature */
  dvi__user_basis_tables now, spare; /* tables in use, and tables under construction */
  double *numbers;                   /* memory of both tables */
  long double *long_numbers;
  long double *value, *slope;       /* work [count*points], by functions */
  long double *at_value, *at_slope; /* e_k and e_k' [count] at one point */
  double *f, *df;                   /* the user's functions [functions] at one point */
  int broken, symmetric, order;
};

/* Compute e_k and e_k' [count] at tau of a step of length h, in at_value and at_slope. */
dvi_status dvi__user_basis_evaluate(const dvi__user_basis *basis, double h, double tau);

/* Compute the tables of steps of length h. */
dvi_status dvi__user_basis_fill(const dvi__user_basis *basis, double h,
                                dvi__user_basis_tables *tables);

/* Check what the user supplied at shapes->h, whose tables are computed. */
dvi_status dvi__user_basis_check(const dvi__user_basis *basis);

/* Return 1 if the spaces of h and -h mirror each other, with their points. The spare tables are
 * overwritten. */
int dvi__user_basis_mirrors(dvi__user_basis *basis);

/* Return the weight of point j in the inner product by which function l is made orthonormal. All
 * functions are orthogonal to the polynomials, whose weight is the quadrature's own. */
static inline long double dvi__user_basis_measure(const dvi__user_basis *g,
                                                  const dvi__user_basis_tables *t, int j, int l)
{
  return (long double)(l < g->degree ? t->weight[j] : fabs(t->weight[j]));
}

#endif
