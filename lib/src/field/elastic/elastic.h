/* A solid, and what its cells store and pull. */
#ifndef DVI_FIELD_ELASTIC_ELASTIC_H
#define DVI_FIELD_ELASTIC_ELASTIC_H
#include <dvi/contact.h>
#include <dvi/elastic.h>

#include "field/algebra/csr.h"

enum {
  DVI__SOLID_NODES = 4,    /* of a cell */
  DVI__SOLID_NUMBERS = 12, /* of displacements of a cell */
  DVI__SOLID_ENTRIES = 9   /* of a deformation gradient */
};

/* A material, whose names are not needed any more. */
typedef struct dvi__solid_material {
  dvi_elastic_law law;
  double lambda, mu, mooney, rho, alpha, beta;
  int (*energy)(int64_t count, const double *F, double *W, double *P, double *Hessian, void *user);
  void *user;
  double rest[DVI__SOLID_ENTRIES * DVI__SOLID_ENTRIES]; /* Hessian of W at rest, symmetric */
} dvi__solid_material;

struct dvi_elastic {
  dvi_mesh *mesh;
  int n;                                             /* dimension */
  int64_t vertices, cells, unknowns, whole_unknowns; /* the last ones of all processes */
  const int *vertex;                                 /* [cells*(n+1)] the mesh's */
  const double *point;                               /* [vertices*n] the mesh's */
  double *gradient; /* [cells*(n+1)*n] of the barycentric coordinates, vertex by vertex */
  double *volume;   /* [cells] above 0 */
  double *mass;     /* [vertices] */
  int *material;    /* [cells] */
  dvi__solid_material *materials;
  int material_count;
  int *unknown;   /* [vertices*n] coordinates, or -1 */
  int *condition; /* [vertices*n] the condition of a component, or -1 */
  dvi_elastic_condition *conditions;
  int condition_count;
  double *steady; /* [vertices*n] displacements that do not depend on time, 0 for the others */
  int is_driven;  /* a condition depends on time */
  /* Loads: those of a cell are load_of[load_start[c]] .. with the weight, its volume or the area of
   * its facet, over the nodes on which it acts in equal parts. */
  int64_t *load_start; /* [cells+1], NULL without loads */
  struct dvi__solid_load *load_of;
  dvi_elastic_load *loads;
  int load_count;
  int has_steady_loads;   /* none depends on time */
  dvi_obstacle *obstacle; /* [obstacles] normals have length 1 */
  int obstacles;
  int8_t *is_outer; /* [vertices] not 0 at the boundary */
  int is_split;
  _Atomic double fastest;           /* bound of the frequencies at rest, 0 until it is asked for */
  struct dvi__solid_system *system; /* what its mechanical system needs, made when asked for */
};

/* A load on a cell or on one of its facets. */
typedef struct dvi__solid_load {
  int load;
  unsigned nodes; /* bit a is set if the node a of the cell takes a part */
  double weight;  /* the part of a node: volume or area over the number of nodes */
  int is_facet;
  double at[DVI_ELASTIC_DIMENSION_MAX], normal[DVI_ELASTIC_DIMENSION_MAX];
} dvi__solid_load;

/* Gather numbers of a cell's nodes [(n+1)*n] from those of all [vertices*n]. */
static inline void dvi__solid_gather(const dvi_elastic *e, int64_t cell, const double *all,
                                     double *own)
{
  const int n = e->n, *vertex = e->vertex + cell * (n + 1);
  for (int a = 0; a <= n; a++)
    for (int i = 0; i < n; i++) own[a * n + i] = all[(int64_t)vertex[a] * n + i];
}

/* Give the forces f [(n+1)*n] of what a cell stores, -V dW/du, at displacements u [(n+1)*n] of its
 * nodes. Returns 0, a positive number if the cell is inverted where its law is not defined, or a
 * negative one if the callback failed. Messages are left to the caller. */
int dvi__solid_force(const dvi_elastic *e, int64_t cell, const double *u, double *f);

/* Give the energy V W, and the stiffness V d2W/du2 [((n+1)*n)^2]. Returns as dvi__solid_force.
 * The stiffness at rest has u = NULL, and is always there. */
int dvi__solid_stored(const dvi_elastic *e, int64_t cell, const double *u, double *energy);
int dvi__solid_stiffness(const dvi_elastic *e, int64_t cell, const double *u, double *K);

/* Add the loads of a cell at time t to f [(n+1)*n]. Returns 0, or as the callbacks do. */
int dvi__solid_add_load(const dvi_elastic *e, int64_t cell, double t, double *f);

/* Set the components of u and rate [n] of a vertex that are given to what the conditions say at a
 * time. Others stay. rate may be NULL. Returns as callbacks do, -1 for numbers that are not finite,
 * or DVI__GIVEN_INSIDE, with a reason, where that is inside of an obstacle. */
enum { DVI__GIVEN_INSIDE = -1000000 };
int dvi__solid_given(const dvi_elastic *e, int64_t vertex, double t, double *u, double *rate);

/* Give the largest eigenvalue of a cell's stiffness at rest against its own lumped mass
 * rho V/(n+1), over components that are not given. The time step of a cell alone is stable below
 * 2/sqrt(lambda). */
dvi_status dvi__solid_largest(const dvi_elastic *e, int64_t cell, double *lambda);

/* Write the sentence about an inverted cell or a callback that failed, with a remedy. */
dvi_status dvi__solid_refuse(const dvi_elastic *e, int64_t cell, int returned);

/* Assemble the stiffness at rest of the unknowns. */
dvi_status dvi__solid_rest_stiffness(const dvi_elastic *e, dvi__csr *K);

#endif
