/* Galerkin variational integrators in quadruple precision, written again from their definition. The
 * library's own arithmetic has too few digits to show an order of 16, whose leading term dominates
 * only where the error is below double roundoff. */
#ifndef SUPPORT_QUAD_GALERKIN_H
#define SUPPORT_QUAD_GALERKIN_H
#include "quad_system.h"

#define QUAD_DEGREE_MAX 8
#define QUAD_NODES_MAX 9

typedef struct quad_galerkin {
  int degree, nodes;
  quad node[QUAD_NODES_MAX], weight[QUAD_NODES_MAX];
  /* psi_k = P_k(2 tau - 1) - P_k(-1), at the nodes and at the end, and its derivative */
  quad psi[QUAD_DEGREE_MAX][QUAD_NODES_MAX], slope[QUAD_DEGREE_MAX][QUAD_NODES_MAX],
      end[QUAD_DEGREE_MAX];
  quad inverse[QUAD_DEGREE_MAX][QUAD_DEGREE_MAX]; /* of K_kl = sum_j b_j psi_k' psi_l' */
} quad_galerkin;

/* Prepares a method with nodes >= degree, of Gauss or (from 2 nodes) Lobatto. */
void quad_galerkin_prepare(quad_galerkin *method, int degree, int lobatto, int nodes);

/* Takes a step of h on the state (q, p) in place. Returns 1 if the iteration settled. */
int quad_galerkin_step(const quad_galerkin *method, const quad_field *field, quad h, quad *q,
                       quad *p);

#endif
