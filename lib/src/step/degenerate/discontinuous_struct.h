/* The inside of an element of the discontinuous Galerkin method, for the files that share it. */
#ifndef DVI_STEP_DEGENERATE_DISCONTINUOUS_STRUCT_H
#define DVI_STEP_DEGENERATE_DISCONTINUOUS_STRUCT_H
#include "step/degenerate/discontinuous.h"
#include "step/joint.h"

typedef struct dvi__dg_inverse dvi__dg_inverse; /* discontinuous_jacobian.c */

struct dvi__discontinuous {
  const dvi_system *system;
  dvi__evaluator *evaluator;
  int n, S, r, points;
  /* nodes of the basis; phi_k and phi_k' at c_i, stored as [k][i] */
  double node[DVI__DG_POINTS_MOST], phi[DVI__DG_POINTS_MOST][DVI__DG_POINTS_MOST],
      dphi[DVI__DG_POINTS_MOST][DVI__DG_POINTS_MOST];
  double b[DVI__DG_POINTS_MOST], c[DVI__DG_POINTS_MOST];
  /* b_i phi_k(c_i) and b_i phi_k'(c_i), stored as [i][k], padded with zeros */
  double weighted[DVI__DG_POINTS_MOST][DVI__DG_POINTS_MOST],
      weighted_slope[DVI__DG_POINTS_MOST][DVI__DG_POINTS_MOST];
  double ratio; /* the lengths of elements for which `shift` continues the last one, 0 if none */
  double shift[DVI__DG_POINTS_MOST][DVI__DG_POINTS_MOST];
  double side[DVI__DG_POINTS_MOST],
      weight[DVI__DG_POINTS_MOST]; /* points of the path 1/2 + s_g, and weights w_g */
  double lean;                     /* sum_g w_g s_g */
  dvi__pattern joint, pattern; /* joint is the pattern of one block, pattern that of the Jacobian */
  dvi__joint_entry *block;     /* [entries of joint] */
  int stiff;                   /* c is not 0 */
  double *c_diagonal;          /* [n] diagonal of c */
  /* The current step. */
  double h;
  dvi__dg_node from;
  /* [n] dN/dq+ at the start; diagonal of c with the sign of h */
  double *left, *stiffness;
  /* [n*r] values at c_i, component by component */
  double *t, *Q, *V, *L_q, *L_v, *H_qq, *H_qv, *H_vv;
  /* [n*S] coefficients relative to q*; [n] jump at the end */
  double *Y, *u;
  /* [n] values at one point of a path: the point, alpha, (Dalpha)^T u; and dN/dq- of all points */
  double *y, *alpha, *gradient, *flux;
  /* Hessians at the points of the path, entry by entry [entries*points]; Hessians at one point */
  double *qq, *qv, *one_qq, *one_qv;
  dvi__dg_inverse *inverse; /* that of the Jacobian, NULL if it is factored */
};

/* Compute the values at the nodes of the element x. */
void dvi__discontinuous_spread(dvi__discontinuous *element, const double *x);

/* Create the inverse, if it can serve. The tables must be filled. */
dvi_status dvi__discontinuous_create_inverse(dvi__discontinuous *element);
void dvi__discontinuous_destroy_inverse(dvi__discontinuous *element);

#endif
