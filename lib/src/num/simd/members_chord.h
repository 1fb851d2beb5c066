/* Loops of an iteration on paths with the members of an ensemble as lanes (num/simd/members.h).
 *
 * The unknowns Y of a member's path are corrected by C^{-1} R(Y), with R and C as in
 * step/element/residual.c, whose operations every lane sees in their order. */
#ifndef DVI_NUM_SIMD_MEMBERS_CHORD_H
#define DVI_NUM_SIMD_MEMBERS_CHORD_H

/* Numbers that differ between members have rows of `width`. */
typedef struct dvi__members_chord {
  int n, s, r, width; /* coordinates, functions, nodes, members */
  double h, inverse_h;
  int lanes, path_lanes;             /* lengths of the tables' columns */
  const double *psi, *dpsi;          /* [s*lanes] values and slopes at the nodes */
  const double *bar_row, *slope_row; /* [r*path_lanes] */
  const double *stiffness_row;       /* [s*path_lanes] */
  const double *weight, *end;        /* [r], [s] */
  const double *q0, *p0;             /* [n*width] */
  double *Y;                         /* [n*s*width] */
  double *Q, *V, *L_q, *L_v;         /* [n*r*width] */
  double *R, *rows;                  /* [n*s*width] */
  const double *inverse;             /* [n*n*width] of the mass, by columns */
  double *change, *largest;          /* [width] results, largest correction and largest |Y| */
} dvi__members_chord;

/* Find places Q and velocities V at the nodes. */
void dvi__members_chord_stages(const dvi__members_chord *chord);

/* Find R from the gradients L_q and L_v at the nodes, which are multiplied by the weights. */
void dvi__members_chord_residual(const dvi__members_chord *chord);

/* Multiply R by the inverse of the mass. */
void dvi__members_chord_invert(const dvi__members_chord *chord);

/* Invert the matrices of members, [n*n*width] by columns, in place. sound[width] tells for each
 * whether elimination without exchanges of rows was sound, as it is for positive matrices. The
 * others are spoilt. largest [n*width] is work. One matrix alone is one of width 1. */
void dvi__members_inverse(int n, int width, double *matrix, double *largest, char *sound);

/* Replace R by the correction, and correct Y by it. A change is infinite where Y is not a
 * number. */
void dvi__members_chord_correct(const dvi__members_chord *chord);

/* Correct Y alone, by the correction R. */
void dvi__members_chord_subtract(const dvi__members_chord *chord);

#endif
