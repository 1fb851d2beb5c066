/* What tents store. */
#ifndef DVI_FIELD_TENTS_FRONT_H
#define DVI_FIELD_TENTS_FRONT_H
#include "field/forms/duals.h"
#include "field/forms/star.h"
#include "field/tents/tents.h"

/* The front: a time at each vertex of the mesh of space, and the field there. */
typedef struct dvi__front {
  double *time;   /* [vertices] */
  int64_t *rises; /* [vertices] tents so far */
  double *A;      /* [k-cells] */
  double *row;    /* [k-cells] rows of d^T M d of all spacetime below. M_k E on a level front */
  int *heap;      /* [vertices] the lowest vertex first */
  int64_t tents;
} dvi__front;

/* The cells of a degree around each vertex. */
typedef struct dvi__around {
  int64_t *start; /* [vertices+1] */
  int *cell;
} dvi__around;

enum { DVI__TENT_FACES = 10 }; /* of one degree of a simplex with five corners */

/* Sets of corners with the same count. */
typedef struct dvi__sets {
  int count, set[DVI__TENT_FACES];
} dvi__sets;

struct dvi__tents {
  dvi_star *star;
  const dvi_mesh *mesh; /* the star's */
  int k;
  int8_t *held;  /* [k-cells] */
  double *force; /* [k-cells], or NULL for 0 */
  double fraction, least;
  uint64_t seed;
  double metric[DVI_MESH_SPACE_MAX]; /* of spacetime */
  double *speed, *weight;            /* [n-cells] sqrt(eps mu)^-1 and sqrt(eps/mu) */
  double *reach;                     /* [edges] largest difference of the times of its ends */
  int *face;                         /* [n-cells][2^(n+1)] faces by the set of their corners */
  dvi__sets faces, raised;           /* the k-faces of n-cells, and (k+1)-faces over them */
  dvi__around cells, edges, values;  /* n-cells, edges, k-cells */
  double t;                          /* the time asked for */
  double *base;                      /* [(k+1)-cells] B - dA, which does not depend on the time */
  double *charge;                    /* [3][(k-1)-cells] at the start, and room. NULL for k = 0 */
  dvi__front front;
  dvi__front *level; /* the front at the time `t`, if `level_time` says so */
  double *level_time;
  /* Of the tent in work: [k-cells] and [most n-cells around a vertex][sets of corners]. */
  double *rise, *row, *dual, *size, *star_of;
};

/* Return a face of an n-cell. */
static inline int64_t dvi__face_of(const dvi__tents *tents, int64_t cell, int set)
{
  return tents->face[(cell << (tents->mesh->n + 1)) + set];
}

/* Give the largest slope of a front over an n-cell whose edges have slopes of at most 1. */
double dvi__steepest(const dvi_mesh *mesh, int64_t cell);

/* Pitch a tent: raise a vertex of a front to the time t. On failure nothing changes. */
dvi_status dvi__tent_pitch(const dvi__tents *tents, dvi__front *front, int vertex, double t);

/* Put the vertices of a front in order. */
void dvi__front_order(const dvi__tents *tents, dvi__front *front);

/* Copy a front. */
void dvi__front_copy(const dvi__tents *tents, const dvi__front *from, dvi__front *to);

/* Make the front level at the time `t` beside the state. */
dvi_status dvi__tents_level(const dvi__tents *tents);

#endif
