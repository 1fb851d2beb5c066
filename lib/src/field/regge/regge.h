/* A complex of simplices with lengths. */
#ifndef DVI_FIELD_REGGE_REGGE_H
#define DVI_FIELD_REGGE_REGGE_H
#include <dvi/regge.h>

#include "field/algebra/csr.h"
#include "field/mesh/mesh.h"
#include "field/regge/simplex.h"

struct dvi_regge {
  dvi_mesh *mesh;
  int n, pairs; /* dimension, and pairs of corners of a simplex */
  double lambda;
  int64_t cells, edges, hinges, boundary_hinges;
  int *edge;            /* [cells*pairs] */
  int *hinge;           /* [cells*pairs] */
  int64_t *owner;       /* [hinges] a place in `hinge` where the hinge stands */
  unsigned char *outer; /* [hinges] 1 at the boundary */
  unsigned char *rim;   /* [edges] 1 at the boundary */
  dvi__csr pattern;     /* [edges*edges] of the Hessian, without values */
};

/* What is computed of lengths. NULL is not asked for. */
typedef struct dvi__regge_sums {
  double action, volume;
  double *deficit;  /* [hinges] eps_h, always asked for */
  double *size;     /* [hinges] |h|, always asked for */
  double *gradient; /* [edges] */
  double *terms;    /* [edges] the sums of the sizes of the gradient's terms, of which roundings
                     * cannot be told. Needs `gradient` */
  double *hessian;  /* entries of the pattern */
} dvi__regge_sums;

/* Compute the sums that are asked for. DVI_BAD_ARGUMENT with a sentence if a simplex does not
 * exist. */
dvi_status dvi__regge_evaluate(const dvi_regge *regge, const double *length, dvi__regge_sums *sums);

/* Measure a simplex. DVI_BAD_ARGUMENT with a sentence if it does not exist. */
dvi_status dvi__regge_measure_cell(const dvi_regge *regge, const double *length, int64_t cell,
                                   dvi__measured_simplex *simplex);

/* Refuse arguments that are missing. */
dvi_status dvi__regge_check(const dvi_regge *regge, const double *length);

#endif
