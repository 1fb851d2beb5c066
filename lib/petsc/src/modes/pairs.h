/* Eigenpairs of K x = lambda M x that have been found. */
#ifndef DVI_PETSC_PAIRS_H
#define DVI_PETSC_PAIRS_H
#include <dvi/status.h>
#include <petscvec.h>

typedef struct dvi__pairs {
  PetscInt count, room;
  double *value, *residual; /* [room] lambda, and |K x - lambda M x| in the norm of M^-1 */
  Vec *vector;              /* [room] y, of length 1 */
} dvi__pairs;

/* Make room for more pairs. All zero is an empty set. DVI_NO_MEMORY, which leaves it as it was. */
dvi_status dvi__pairs_reserve(PetscInt more, dvi__pairs *pairs);

void dvi__pairs_swap(PetscInt a, PetscInt b, dvi__pairs *pairs);

/* Leave the first `count` pairs. */
void dvi__pairs_shorten(PetscInt count, dvi__pairs *pairs);
void dvi__pairs_clear(dvi__pairs *pairs);

#endif
