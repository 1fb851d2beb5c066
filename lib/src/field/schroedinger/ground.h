/* The state in which a ground state is looked for, for its two files. */
#ifndef DVI_FIELD_SCHROEDINGER_GROUND_H
#define DVI_FIELD_SCHROEDINGER_GROUND_H
#include "field/schroedinger/tangent.h"

typedef struct dvi__ground {
  const dvi_schroedinger *s;
  double norm, strength; /* of the interaction now, 0 to 1 */
  double mu;
  double followed; /* part of the interaction up to which the state is followed from none */
  int attracts;
  double *z, *kept, *good, *Mz, *Hz, *residual, *change, *product; /* [free] */
  double *modes;                                                   /* [2*free] */
  double *V;                                                       /* [points] */
  double *work; /* [5*free] of conjugate gradients */
  dvi__schroedinger_room room;
  dvi__tangent *tangent; /* NULL for fourier */
} dvi__ground;

/* Scale psi to the norm, and give mu and the residual M mu psi - H psi. */
void dvi__ground_settle(dvi__ground *g);

/* Set V to V + 3 beta psi^2 - mu, the potential of the second variation. */
void dvi__ground_vary(dvi__ground *g);

/* Divide by the kinetic energy with a constant, which is that of the state's own energies, on the
 * plane that is tangent to the sphere. For fourier. */
void dvi__ground_precondition(void *of, const double *r, double *z);

/* Correct by Newton's method until corrections are roundings. DVI_NOT_CONVERGED or DVI_SINGULAR if
 * the state is too far from the guess. */
dvi_status dvi__ground_converge(dvi__ground *g);

/* Energy, E = norm mu - (integral of beta psi^4)/2. */
double dvi__ground_energy(dvi__ground *g);

/* Tell if the second variation is positive beside psi, with its two lowest modes in `modes`. */
dvi_status dvi__ground_is_minimum(dvi__ground *g, int *is_minimum);

/* Leave the saddle that is followed no more for a minimum. */
dvi_status dvi__ground_descend(dvi__ground *g);

/* Number of dimensions of space. */
static inline int dvi__ground_dimension(const dvi__ground *g)
{
  return g->s->radial > 0 ? g->s->radial : g->s->dimension;
}

#endif
