/* Elastic solids in quadruple precision, written from dvi/elastic.h alone, without code of the
 * library but for the arrays of a mesh:
 *
 *     m_a u_a'' = sum over cells K of  V_K (-P(F_K) - beta dP_linear(F_K')) grad N_a
 *                                      - alpha m_a^K u_a' + (loads).
 *
 * Motions are found by Gragg's extrapolated midpoint rule of order 20, with an error that is
 * stated. */
#ifndef SUPPORT_SOLID_QUAD_SOLID_H
#define SUPPORT_SOLID_QUAD_SOLID_H
#include <dvi/elastic.h>

#include "support/quad/quad_real.h"

/* A displacement with its rate at a node, and a force at the centre of a cell or facet. What they
 * say stands beside the functions of the solid's terms, which have the digits of doubles. */
typedef void quad_displacement(quad t, const quad *X, quad *u, quad *rate);
typedef void quad_load(quad t, const quad *X, const quad *normal, quad *force);

/* A load on the nodes `nodes` (bit a for the node a) of a cell. */
typedef struct quad_solid_load {
  quad_load *force;
  int cell;
  unsigned nodes;
  quad weight, at[3], normal[3];
} quad_solid_load;

typedef struct quad_solid {
  int n, vertices, cells, size;   /* size = vertices*n */
  const int *vertex;              /* [cells*(n+1)] */
  quad *point;                    /* [size] */
  quad *gradient;                 /* [cells*(n+1)*n] */
  quad *volume, *mass;            /* [cells], [vertices] */
  dvi_elastic_material *material; /* [cells] */
  quad_displacement **given;      /* [size] NULL where a component is free */
  quad_solid_load *load;
  int loads;
} quad_solid;

/* Create the solid of these terms, without obstacles. `displacement` [conditions] and `load`
 * [loads] may be NULL, or hold NULL for 0. Laws are those with a name. */
quad_solid quad_solid_of(const dvi_elastic_terms *terms, quad_displacement *const *displacement,
                         quad_load *const *load);
void quad_solid_clear(quad_solid *s);

/* Set f [(n+1)*n] to the forces -V P grad N of a cell at displacements u [(n+1)*n] of its nodes,
 * and return V W. The linear law is taken instead of the cell's own with `is_linear`. */
quad quad_solid_cell(const quad_solid *s, int cell, int is_linear, const quad *u, quad *f);

/* Set what is given in u and rate [size] at a time. rate may be NULL. */
void quad_solid_give(const quad_solid *s, quad t, quad *u, quad *rate);

/* Set a [size] to the accelerations at displacements u and rates v [size]. Those of components that
 * are given are 0. */
void quad_solid_accelerate(const quad_solid *s, quad t, const quad *u, const quad *v, quad *a);

/* Advance u and v [size] from `from` to `to`. Returns the error of u by the judge's own estimate,
 * absolute. */
double quad_solid_advance(const quad_solid *s, quad from, quad to, quad *u, quad *v);

#endif
