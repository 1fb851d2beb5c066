/* A motion over several steps, for the laws that it fulfils. */
#ifndef DVI_FIELD_MULTISYMPLECTIC_LAWS_H
#define DVI_FIELD_MULTISYMPLECTIC_LAWS_H
#include "field/multisymplectic/march.h"

/* Levels 0 to `steps`, and rows of cells between them. */
typedef struct dvi__history {
  dvi__lattice_march march;
  double t;
  int steps;
  double *u; /* [(steps+1)*size] */
} dvi__history;

static inline dvi__row dvi__history_row(const dvi__history *h, const double *levels, int row)
{
  const double *lower = levels + row * h->march.lattice.size;
  return (dvi__row){.t = h->t + row * h->march.lattice.dt,
                    .u = {lower, lower + h->march.lattice.size}};
}

/* Whether the lattice has the local laws of the box scheme, and their errors: [1+axes] that of
 * energy and those of momentum along each axis. */
int dvi__has_local_laws(const dvi__lattice *lattice);
dvi_status dvi__local_laws(const dvi__history *h, double *error);

#endif
