/* A row phi = a.b - value of a joint. Each of a and b is a sum of vectors that are affine in q,
 * such as a body's point x + R r, its direction R u, and constants.
 *
 * The row's numbers are those of two bodies, at most twelve each, in the order in which they are
 * stored. */
#ifndef DVI_JOINT_JOINT_ROWS_H
#define DVI_JOINT_JOINT_ROWS_H
#include <dvi/system.h>

enum { DVI__JOINT_ROWS = 6, DVI__BODY_NUMBERS = 12, DVI__JOINT_NUMBERS = 2 * DVI__BODY_NUMBERS };

/* The places of a body's numbers in q, -1 for those that it has not. */
typedef struct dvi__body {
  int turn, place;
} dvi__body;

/* sign (x + R r) of a body, or sign R r for a direction. */
typedef struct dvi__affine_part {
  int body; /* 0 or 1 of the joint */
  int is_direction;
  double sign, r[3];
} dvi__affine_part;

typedef struct dvi__affine {
  double constant[3];
  int count;
  dvi__affine_part part[2];
} dvi__affine;

typedef struct dvi__joint_row {
  dvi__affine a, b;
  double value;
} dvi__joint_row;

/* One joint. Numbers of its two bodies are local: number 12 k + i is that of body k, entries of R
 * first, then x. */
typedef struct dvi__joint {
  dvi__body body[2];
  int row_count;
  dvi__joint_row row[DVI__JOINT_ROWS];
  /* gradients by columns, the local number of every entry */
  int start[DVI__JOINT_ROWS + 1], local[DVI__JOINT_ROWS * DVI__JOINT_NUMBERS];
  /* Entries of the Hessians, local row * DVI__JOINT_NUMBERS + local column, their places in the
   * pattern of all joints, and their numbers in each row, [row_count*bend_count]. */
  int bend_count, bend[DVI__JOINT_NUMBERS * DVI__JOINT_NUMBERS], *in_qq;
  double *curvature;
} dvi__joint;

/* Compute the row at q. */
double dvi__joint_row_value(const dvi__joint *joint, const dvi__joint_row *row, const double *q);

/* Write whether each local number enters the row, and the row's Hessian in them. */
void dvi__joint_row_numbers(const dvi__joint *joint, const dvi__joint_row *row, int *enters);
void dvi__joint_row_hessian(const dvi__joint *joint, const dvi__joint_row *row,
                            double hessian[DVI__JOINT_NUMBERS][DVI__JOINT_NUMBERS]);

/* Compute the row's gradient in the local numbers. */
void dvi__joint_row_gradient(const dvi__joint *joint, const dvi__joint_row *row, const double *q,
                             double *gradient);

/* Return the place of a local number in q, or -1. */
int dvi__joint_coordinate(const dvi__joint *joint, int local);

#endif
