/* Forms of one degree with their neighbours, for Hodge's decomposition and Poisson's equation. */
#ifndef DVI_FIELD_FORMS_HODGE_H
#define DVI_FIELD_FORMS_HODGE_H
#include "field/forms/star.h"

typedef struct dvi__hodge {
  const dvi_star *star;
  int k;
  const char *held;            /* part on which forms vanish, or NULL */
  int64_t below, count, above; /* cells of degree k-1, k, k+1 */
  dvi_matrix d, d_below, M;    /* d_k, d_{k-1}, M_k */
  double *work, *more;         /* [count] each */
} dvi__hodge;

/* Prepare for degree k. DVI_BAD_ARGUMENT, DVI_NO_MEMORY. On failure nothing is owned. */
dvi_status dvi__hodge_begin(const dvi_star *star, int k, const char *held, dvi__hodge *hodge);
void dvi__hodge_end(dvi__hodge *hodge);

/* Set the entries on the cells of a degree that are held to zero. */
void dvi__hodge_hold(const dvi__hodge *hodge, int degree, double *form);

/* Solve with M of a degree among the forms that vanish where they are held. */
dvi_status dvi__hodge_divide(const dvi__hodge *hodge, int degree, double *form);

/* Split a form into [3][count], the exact, the coexact and the harmonic part. */
dvi_status dvi__hodge_split(dvi__hodge *hodge, const double *form, double *part);

/* Give the product a.M b and the length of a. */
double dvi__hodge_product(const dvi__hodge *hodge, const double *a, const double *b);

#endif
