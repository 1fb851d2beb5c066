/* Loops with the members of an ensemble as lanes of vectors.
 *
 * A row of `width` numbers holds one number of each member, so that a matrix of members is
 * [rows*width] by rows. The loops are compiled for the levels of num/simd/lanes.h. Each gives the
 * bits that its loop gives for one member alone, because every lane sees the same operations in the
 * same order. */
#ifndef DVI_NUM_SIMD_MEMBERS_H
#define DVI_NUM_SIMD_MEMBERS_H
#include <stddef.h>

/* A dvi__fixed_point for every member. Numbers that differ between members have rows of `width`,
 * and Z has no padding. */
typedef struct dvi__members_fixed_point {
  int n, stages, width;
  int lanes;                          /* length of the matrix's columns */
  const double *matrix;               /* [stages*lanes], column l at matrix + l*lanes */
  const double *node, *weight;        /* [stages] */
  const double *factor;               /* [n] */
  const double *start, *low, *origin; /* [n*width] */
  double *force;                      /* [n*stages*width], replaced by g */
  double *Z, *Q;                      /* [n*stages*width] */
  double *change, *largest;           /* [width] results, largest |Z - old Z| and largest |Z| */
} dvi__members_fixed_point;

/* Iterate as dvi__lanes_iterate. */
void dvi__members_iterate(const dvi__members_fixed_point *iteration);

/* Split start + low = factor p0 as dvi__lanes_split, for p0 [n*width]. */
void dvi__members_split(int n, int width, const double *factor, const double *p0, double *start,
                        double *low);

/* Begin as dvi__lanes_begin, with sums of forces in Z. */
void dvi__members_begin(const dvi__members_fixed_point *iteration);

/* A dvi__ends for every member. */
typedef struct dvi__members_ends {
  int n, stages, width;
  const double *g;           /* [n*stages*width] */
  const double *slant;       /* [stages] */
  const double *factor;      /* [n] */
  const double *p0;          /* [n*width] */
  double *moved, *low, *sum; /* [n*width] results */
} dvi__members_ends;

/* Find the end values as dvi__lanes_ends. */
void dvi__members_ends_of(const dvi__members_ends *ends);

/* Multiply out_ij = sum_k matrix_jk x_ik as dvi__lanes_product, for n coordinates and `rows` values
 * of j, with x [n*terms*width], matrix by columns of length `lanes`, out [n*rows*width]. out may
 * not be x. */
void dvi__members_product(int n, int terms, int lanes, int rows, const double *matrix, int width,
                          const double *x, double *out);

#endif
