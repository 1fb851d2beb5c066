/* Loops with the members of an ensemble as lanes of vectors.
 *
 * A row of `width` numbers holds one number of each member, so that a matrix of members is [rows*width] by rows. The loops are compiled for
 * the levels of num/lanes.h, and each gives the bits that num/lanes.h and num/compensated.h give for one member alone: every lane sees their
 * operations in their order. */
#ifndef DVI_NUM_MEMBERS_H
#define DVI_NUM_MEMBERS_H
#include <stddef.h>

/* One iteration of dvi__lanes_sweep for every member: g = weight_j force, Z = start node_j + factor_i sum_l matrix_l g, Q = origin + Z. */
typedef struct dvi__members_sweep {
  int n, stages, width;
  int lanes;                    /* length of the matrix's columns */
  const double *matrix;         /* [stages*lanes], column l at matrix + l*lanes */
  const double *node, *weight;  /* [stages] */
  const double *factor;         /* [n] */
  const double *start, *origin; /* [n*width] */
  double *force;                /* [n*stages*width], replaced by g */
  double *Z, *Q;                /* [n*stages*width] */
  double *change, *largest;     /* [width] results: largest |Z - old Z|, largest |Z| */
} dvi__members_sweep;

void dvi__members_sweep_once(dvi__members_sweep *sweep);

/* out_ij = sum_k matrix_jk x_ik for n coordinates and `rows` values of j: x [n*terms*width], matrix by columns of length `lanes`,
 * out [n*rows*width]; it may not be x. */
void dvi__members_product(int n, int terms, int lanes, int rows, const double *matrix, int width, const double *x, double *out);

/* sum <- sum + factor x, compensated. */
void dvi__members_add(size_t count, double factor, const double *x, double *sum, double *carry);

/* q <- q + h (p/mass), compensated. */
void dvi__members_drift(size_t count, double h, double mass, const double *p, double *q, double *q_carry);

#endif
