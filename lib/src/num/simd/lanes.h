/* Loops for several instruction sets. Small dense products have the stages of a step as lanes of
 * vectors, and kicks and drifts have the coordinates as lanes.
 *
 * A row of `lanes` numbers holds the numbers of one coordinate at the stages, padded with zeros to
 * 1, 2, 4 or a multiple of 8. The loops are compiled for several instruction sets and chosen when
 * they are first used. Each gives the same bits, because every lane sees the same operations in the
 * same order, and none of them is a fused one. */
#ifndef DVI_NUM_SIMD_LANES_H
#define DVI_NUM_SIMD_LANES_H
#include <stddef.h>

/* Give the least row length for so many stages. */
int dvi__lanes_for(int stages);

/* One fixed-point iteration for the stages of all coordinates, from the forces at the old stages:
 *     g_ij = weight_j force_ij,   Z_i = factor_i (p0_i node + sum_j matrix_j g_ij),
 *     Q_ij = origin_i + Z_ij.
 * The product factor_i p0_i is exactly start_i + low_i. Its rounding by the same momentum in each
 * step would add up. */
typedef struct dvi__fixed_point {
  int n, stages, lanes;
  const double *matrix; /* [stages*lanes], column j at matrix + j*lanes */
  const double *node;   /* [lanes] */
  const double *weight; /* [stages] */
  const double *factor; /* [n] */
  const double *p0;     /* [n] */
  double *start, *low;  /* [n] */
  const double *origin; /* [n] */
  double *force;        /* [n*stages], replaced by g */
  double *Z;            /* [n*lanes], old and new */
  double *Q;            /* [n*stages] */
  /* results: largest |Z - old Z| and largest |Z|, NaN if one of them is */
  double change, largest;
} dvi__fixed_point;

void dvi__lanes_iterate(dvi__fixed_point *iteration);

/* Replace x_ij by weight_j x_ij for n rows of `stages`. */
void dvi__lanes_weigh(int n, int stages, const double *weight, double *x);

/* Set start and low before the first iteration. */
void dvi__lanes_split(const dvi__fixed_point *iteration);

/* Then, if Z holds sums of forces, replace them by Z_i = factor_i (p0_i node + Z_i), and set Q. */
void dvi__lanes_begin(const dvi__fixed_point *iteration);

/* Do all of this for the sums table_k g_k of a table [stages*lanes] by columns and g [n*stages],
 * which is not `force`. */
void dvi__lanes_begin_from(const dvi__fixed_point *iteration, const double *table, const double *g);

/* The end values of a step by the g of its last iteration:
 *     sum = sum_j g_ij,   moved + low = factor (p0 + sum/2 + sum_j slant_j g_ij),
 * where moved is the rounded factor (p0 + sum/2), and low holds the rounding error. */
typedef struct dvi__ends {
  int n, stages;
  const double *g;           /* [n*stages] */
  const double *slant;       /* [stages] */
  const double *factor;      /* [n] */
  const double *p0;          /* [n] */
  double *moved, *low, *sum; /* [n] results */
} dvi__ends;

void dvi__lanes_ends(const dvi__ends *ends);

/* Multiply out_i = sum_k matrix_k x_ik for n rows, with x [n*terms], matrix [terms*lanes] by
 * columns, out [n*width], width <= lanes. out may not be x. */
void dvi__lanes_product(int n, int terms, int lanes, int width, const double *matrix,
                        const double *x, double *out);

/* Tell whether no number is NaN or Inf. */
int dvi__lanes_all_finite(size_t count, const double *x);

/* See num/finite.h. */
double dvi__lanes_largest(size_t count, const double *x);

/* Coordinates and momenta with the compensations of their sums. */
typedef struct dvi__phase {
  double *q, *p, *q_compensation, *p_compensation;
} dvi__phase;

/* Division of p by the mass, which gives v. DVI__TIMES_SCALAR multiplies by the inverse of a mass
 * that is a power of two, where the product has the quotient's bits. DVI__BY_SCALAR divides by one
 * mass, DVI__BY_ARRAY by the mass of each coordinate. */
typedef enum dvi__division { DVI__TIMES_SCALAR, DVI__BY_SCALAR, DVI__BY_ARRAY } dvi__division;

/* Kicks and a drift. p <- p + kick_k force for one kick or two, then q <- q + drift v, all sums
 * compensated (num/compensated.h). */
typedef struct dvi__kick_drift {
  size_t count;
  int kicks;
  double kick[2], drift;
  dvi__division by;
  double scalar;
  const double *mass;  /* [count] for DVI__BY_ARRAY */
  const double *force; /* [count] */
  dvi__phase from, to; /* [count] each, the same or apart */
  int far;             /* all of these come from memory, not from a cache */
} dvi__kick_drift;

void dvi__lanes_kick_drift(const dvi__kick_drift *kick_drift);

/* Choose the division by one mass and its scalar. */
dvi__division dvi__division_by(double mass, double *scalar);

/* Add factor x to sum, compensated. */
void dvi__lanes_add_scaled(size_t count, double factor, const double *x, double *sum,
                           double *compensation);

/* Describe the instruction sets, from the baseline (0) up. Their count includes only those that
 * this processor has. */
int dvi__lanes_levels(void);
const char *dvi__lanes_level_name(int level);

/* Give the level in use. */
int dvi__lanes_level(void);

/* Use this level from now on, on all threads. For tests. -1 chooses the best. */
void dvi__lanes_choose(int level);

#endif
