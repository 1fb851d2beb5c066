/* What a star stores. */
#ifndef DVI_FIELD_FORMS_STAR_H
#define DVI_FIELD_FORMS_STAR_H
#include <dvi/forms.h>
#include <pthread.h>
#include <stdatomic.h>

#include "field/algebra/csr.h"
#include "field/mesh/mesh.h"

struct dvi_star {
  atomic_int owners;
  dvi_mesh *mesh;
  dvi_star_kind kind;
  double *factor[DVI__DEGREES];   /* [cells] or NULL for 1 */
  double *diagonal[DVI__DEGREES]; /* [k-cells] M_k, or NULL if it is not diagonal */
  double *dual[DVI__DEGREES];     /* [k-cells] |*s|, or NULL */
  pthread_mutex_t making;         /* held while a matrix is made */
  dvi__csr matrix[DVI__DEGREES];
};

/* Create a star as dvi_star_create does, but without asking the other processes of a share. */
dvi_status dvi__star_create(const dvi_mesh *mesh, const dvi_star_options *options, dvi_star **star);

/* Make the diagonals and the duals of a circumcentric star. */
dvi_status dvi__circumcentric_star(dvi_star *star);

/* Make M_k of the same kind of star with another factor [cells], or NULL for 1. */
dvi_status dvi__star_with_factor(const dvi_star *star, int k, const double *factor,
                                 dvi__csr *matrix);

/* Make M_k with the star's factor in the cells whose mark [cells] is `which`, and 0 elsewhere. */
dvi_status dvi__star_of_part(const dvi_star *star, int k, const char *mark, int which,
                             dvi__csr *matrix);

/* Make d_k^T M_{k+1} d_k. */
dvi_status dvi__stiffness(const dvi_star *star, int k, dvi__csr *stiffness);

/* Refuse a cell without volume in the mesh's metric. */
dvi_status dvi__refuse_null(const dvi_mesh *mesh, int k, int64_t cell);

/* Refuse a mesh that has no spectral star, and make its matrix of degree k. */
dvi_status dvi__spectral_check(const dvi_mesh *mesh);
dvi_status dvi__spectral_star(dvi_star *star, int k);

/* Make the matrix of degree k of Whitney's forms. */
dvi_status dvi__whitney_star(dvi_star *star, int k);

#endif
