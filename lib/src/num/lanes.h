/* Small dense products with the stages of a step as lanes of vectors.
 *
 * A row of `lanes` numbers holds what one coordinate has at the stages, padded with zeros to 1, 2, 4 or a multiple of 8. The loops are
 * compiled for several instruction sets and chosen when they are first used; each gives the same bits, for every lane sees the same
 * operations in the same order, and none of them is a fused one. */
#ifndef DVI_NUM_LANES_H
#define DVI_NUM_LANES_H
#include <stddef.h>

/* The least row length for so many stages. */
int dvi__lanes_for(int stages);

/* One iteration for the stages of all coordinates, from the forces at the stages before:
 *     g_ij = weight_j force_ij,   Z_i = start_i node + factor_i sum_j matrix_j g_ij,   Q_ij = origin_i + Z_ij. */
typedef struct dvi__sweep {
  int n, stages, lanes;
  const double *matrix;   /* [stages*lanes], column j at matrix + j*lanes */
  const double *node;     /* [lanes] */
  const double *weight;   /* [stages] */
  const double *start;    /* [n] */
  const double *factor;   /* [n] */
  const double *origin;   /* [n] */
  double *force;          /* [n*stages], replaced by g */
  double *Z;              /* [n*lanes], old and new */
  double *Q;              /* [n*stages] */
  double change, largest; /* results: largest |Z - old Z|, largest |Z| */
} dvi__sweep;

void dvi__lanes_sweep(dvi__sweep *sweep);

/* out_i = sum_k matrix_k x_ik for n rows: x [n*terms], matrix [terms*lanes] by columns, out [n*width], width <= lanes; it may not be x. */
void dvi__lanes_product(int n, int terms, int lanes, int width, const double *matrix, const double *x, double *out);

/* Whether there is no NaN or Inf among them. */
int dvi__lanes_all_finite(size_t count, const double *x);

/* The instruction sets, from the baseline (0) up; their count includes only those that this processor has. */
int dvi__lanes_levels(void);
const char *dvi__lanes_level_name(int level);

/* The one in use. */
int dvi__lanes_level(void);

/* For tests: use this level from now on, on all threads; -1: the best. */
void dvi__lanes_choose(int level);

#endif
