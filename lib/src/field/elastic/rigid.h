/* The rigid motions of the bodies of a solid that conditions allow, which small vibrations have as
 * modes of frequency 0. */
#ifndef DVI_FIELD_ELASTIC_RIGID_H
#define DVI_FIELD_ELASTIC_RIGID_H
#include "field/elastic/elastic.h"

enum { DVI__RIGID_MOTIONS = 6 };

/* A body, whose nodes are joined by edges. Parts of it that share no facet count as rigid to each
 * other, although they turn about what they share. Its motions are sums of n translations and of
 * turns about its centre, with orthonormal coefficients in the scalar product of the mass. */
typedef struct dvi__rigid_body {
  double centre[DVI_ELASTIC_DIMENSION_MAX], size;
  int count; /* of motions that conditions allow */
  double coefficient[DVI__RIGID_MOTIONS][DVI__RIGID_MOTIONS];
} dvi__rigid_body;

typedef struct dvi__rigid {
  const dvi_elastic *elastic;
  int *body; /* [vertices] */
  int64_t bodies, count;
  dvi__rigid_body *of; /* [bodies] */
  double *sum;         /* [bodies*DVI__RIGID_MOTIONS] */
} dvi__rigid;

/* Find the motions. What is owned is released by dvi__rigid_clear, also after a failure. */
dvi_status dvi__rigid_create(const dvi_elastic *e, dvi__rigid *rigid);
void dvi__rigid_clear(dvi__rigid *rigid);

/* Give the share of rigid motions in a mode x [unknowns] with x.M x = 1, 0 to 1. */
double dvi__rigid_share(const dvi__rigid *rigid, const double *x);

/* Take the rigid motions out of x [unknowns]. The rest is orthogonal to them in the scalar product
 * of the mass. */
void dvi__rigid_remove(const dvi__rigid *rigid, double *x);

#endif
