/* The inside of a user's function space, for given.c and given_check.c. */
#ifndef DVI_SPACE_GIVEN_STRUCT_H
#define DVI_SPACE_GIVEN_STRUCT_H
#include <math.h>

#include "space/user_basis.h"

/* What is known of steps of one length. */
typedef struct dvi__user_basis_tables {
  double h;              /* 0: nothing */
  double *node, *weight; /* [points] */
  double *psi, *dpsi;    /* [points*count] by points */
  /* [count] e_k(0); [count*count] by rows: psi_k = sum_i matrix[k][i] (e_i - e_i(0)), i <= k */
  long double *start, *matrix;
  double *end, *slopes[2]; /* [count] psi_k(1); psi_k' at both ends */
  double *lean;            /* [count] of the function with psi' = tau */
  int order;               /* the quadrature's, 2 degree at most */
  dvi__user_basis_fingerprint fingerprint;
} dvi__user_basis_tables;

struct dvi__user_basis {
  const dvi_shapes *shapes;
  int degree, count, points;         /* count: of polynomials but the constant, and functions */
  double *node, *weight;             /* [points] of the library's quadrature */
  dvi__user_basis_tables now, spare; /* spare: in the making */
  double *numbers;                   /* the memory of both */
  long double *long_numbers;
  long double *value, *slope;       /* [count*points] by functions, work */
  long double *at_value, *at_slope; /* [count] at one point */
  double *f, *df;                   /* [functions] the user's */
  int broken, symmetric, order;
};

/* e_k and e_k' [count] at tau of a step of length h, in at_value and at_slope. */
dvi_status dvi__user_basis_evaluate(const dvi__user_basis *given, double h, double tau);

/* The tables of a length. */
dvi_status dvi__user_basis_fill(const dvi__user_basis *given, double h,
                                dvi__user_basis_tables *tables);

/* What the user supplied, at shapes->h, whose tables are filled. */
dvi_status dvi__user_basis_check(const dvi__user_basis *given);

/* Whether the spaces of h and -h mirror each other, and so do the points; fills the spare
 * tables. */
int dvi__user_basis_mirrors(dvi__user_basis *given);

/* The weight of point j in the inner product by which function l is made orthonormal: of
 * polynomials, to which all are orthogonal, it is the quadrature's own. */
static inline long double dvi__user_basis_measure(const dvi__user_basis *g,
                                                  const dvi__user_basis_tables *t, int j, int l)
{
  return (long double)(l < g->degree ? t->weight[j] : fabs(t->weight[j]));
}

#endif
