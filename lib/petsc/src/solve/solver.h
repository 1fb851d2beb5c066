/* What solves symmetric equations on all processes together (field/model/elliptic.h): Newton's
 * method of SNES, whose corrections come from the conjugate gradients of KSP with multigrid, or
 * from its minimal residuals for equations of pairs (pair.h). */
#ifndef DVI_PETSC_SOLVER_H
#define DVI_PETSC_SOLVER_H
#include "field/model/elliptic.h"

/* The user of the ranks is a dvi__world. */
extern const dvi_ranks_solver dvi__solver_of_petsc;

#endif
