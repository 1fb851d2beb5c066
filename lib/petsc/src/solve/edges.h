/* A preconditioner for equations of edges, such as M + h^2/4 K of Maxwell's field, with the same
 * bits for any division. What a smoother leaves is in the gradients of functions of the vertices,
 * and in fields that such functions give along each axis. The equations of these have cycles of
 * their own. Source: Hiptmair and Xu 2007; Kolev and Vassilevski 2009. */
#ifndef DVI_PETSC_EDGES_H
#define DVI_PETSC_EDGES_H
#include "multigrid.h"

typedef struct dvi__edges dvi__edges;

/* Prepare for a positive definite operator of a share's edges, which stays, and is a diagonal
 * `of_gradients` [unknowns] for gradients. */
PetscErrorCode dvi__edges_create(const dvi__unknowns *edges, dvi__operator *A,
                                 const double *of_gradients, dvi__edges **made);
PetscErrorCode dvi__edges_destroy(dvi__edges **made);

/* Let a preconditioner be one cycle, which stays as long as it. */
PetscErrorCode dvi__edges_use(dvi__edges *e, PC pc);

#endif
