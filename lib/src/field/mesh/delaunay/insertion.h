/* Delaunay's triangulation of points, or the regular one of points with weights. */
#ifndef DVI_FIELD_MESH_DELAUNAY_INSERTION_H
#define DVI_FIELD_MESH_DELAUNAY_INSERTION_H
#include "field/mesh/delaunay/predicate.h"

enum {
  DVI__INFINITE = -1, /* the vertex of the simplices outside of the hull */
  DVI__UNUSED = -2    /* the first vertex of a simplex that is none any more */
};

/* A simplex of positive volume. The neighbour with a number shares all vertices but the one with
 * this number. */
typedef struct dvi__delaunay_simplex {
  int vertex[DVI_MESH_DIMENSION_MAX + 1];
  int neighbour[DVI_MESH_DIMENSION_MAX + 1];
  int64_t mark; /* of the last visit */
} dvi__delaunay_simplex;

/* A list of simplices, or of places in them, that grows. */
typedef struct dvi__places {
  int *at;
  int64_t count, room;
} dvi__places;

/* Simplices that fill the hull, and one with the infinite vertex at each facet of the hull. */
typedef struct dvi__triangulation {
  const dvi__sites *sites;
  dvi__delaunay_simplex *simplex;
  double peeled; /* n! times the volume of the simplices that were removed at the hull */
  int64_t count, room;
  int unused;         /* the first unused simplex, whose neighbour 0 is the next one, or -1 */
  int last;           /* a simplex of the hull */
  int64_t visit;      /* number of visits so far */
  dvi__places hole;   /* simplices whose spheres hold the new point */
  dvi__places border; /* their outer facets: simplex * 8 + slot */
} dvi__triangulation;

/* Triangulate. dvi__triangulation_clear follows in any case.
 *
 * @retval DVI_BAD_ARGUMENT  two points are equal, or all lie in a plane
 * @retval DVI_BAD_SIZE      an int cannot number the simplices
 * @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi__triangulate(const dvi__sites *sites, dvi__triangulation *t);

void dvi__triangulation_clear(dvi__triangulation *t);

/* Append a number. */
dvi_status dvi__place_add(dvi__places *list, int place);

/* Give the slot of a vertex, or of a neighbour, which the simplex has. */
int dvi__slot_of(const int *entry, int wanted);

/* Tell whether a simplex of the triangulation lies in the hull. */
int dvi__is_finite(const dvi__triangulation *t, int simplex);

#endif
