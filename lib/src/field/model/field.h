/* A scalar field on a mesh: what is fixed, and the equations of the rest. */
#ifndef DVI_FIELD_MODEL_FIELD_H
#define DVI_FIELD_MODEL_FIELD_H
#include <dvi/field.h>

#include "field/algebra/csr.h"
#include "field/mesh/mesh.h"

/* A translation of the field, q -> q + epsilon D q. */
typedef struct dvi__translation {
  char name[16];
  dvi__csr D;
} dvi__translation;

struct dvi_field {
  dvi_star *star;
  const dvi_mesh *mesh; /* the star's */
  int64_t vertices, unknowns;
  int *unknown;       /* [unknowns] vertices */
  int *number;        /* [vertices] of the unknown at a vertex, or -1 */
  double *fixed;      /* [vertices] values, 0 where they are not fixed */
  double *load;       /* [unknowns] W f + b, less what the fixed values take away */
  double rest;        /* energy of the fixed values alone */
  double *weight;     /* [unknowns] sums of the rows of W */
  double *point;      /* [unknowns*space] */
  int *component;     /* [unknowns] number of the free component, or -1 */
  int64_t components; /* without a fixed value */
  dvi__csr mass, stiffness;
  int mass_is_diagonal;
  dvi_field_potential potential; /* without a density if there is none */
  /* The rest is made for systems. */
  double fastest;                /* bound of the frequencies, 0 if not known */
  int *mass_start, *stiff_start; /* [unknowns+1] */
  int *diagonal_start;           /* [unknowns+1] 0, 1, 2 ..., also the rows */
  int reach;                     /* largest distance of neighbours in the order of unknowns */
  dvi_potential potentials[2];
  dvi_symmetry symmetry[DVI_MESH_SPACE_MAX];
  dvi__translation translation[DVI_MESH_SPACE_MAX];
  int translations;
};

/* Find what is fixed: fill in `unknown`, `number`, `fixed`. */
dvi_status dvi__field_fix(dvi_field *field, const dvi_wave_terms *terms);

/* Add the fluxes of the conditions to b [vertices]. */
dvi_status dvi__field_add_fluxes(const dvi_field *field, const dvi_wave_terms *terms, double *b);

/* Find the components of the mesh without fixed values. */
dvi_status dvi__field_find_components(dvi_field *field);

/* Evaluate the sum of w V(u), and its derivatives, of unknowns `first` to `last`-1. Each result may
 * be NULL; the derivatives are [last-first]. */
typedef struct dvi__density {
  double *sum, *first, *second;
} dvi__density;
int dvi__field_density(const dvi_field *field, const double *q, int64_t first, int64_t last,
                       const dvi__density *density);

/* Find the translations under which the field is invariant. */
dvi_status dvi__field_find_translations(dvi_field *field);

/* Refuse a datum that is not finite, or whose callback failed, at a vertex or facet. */
dvi_status dvi__field_check_datum(const dvi_field *field, const char *what, int failed,
                                  double value, int k, int64_t cell);

#endif
