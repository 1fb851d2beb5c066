/* Newton's method for large systems F(x) = 0 whose Jacobian is known by its products alone: KINSOL
 * with line search, and SUNDIALS' GMRES with restarts (Brown and Saad 1990).
 *
 * The equations come with their preconditioner applied, so that the Jacobian is near 1 in part of
 * the space, and F has the size of the error of x. */
#ifndef DVI_SOLVE_KRYLOV_H
#define DVI_SOLVE_KRYLOV_H
#include <dvi/status.h>

typedef struct dvi__smooth_equations {
  int unknowns;
  void *of; /* first argument of the functions */
  void (*residual)(void *of, const double *x, double *f);
  /* Let x be the point of the Jacobian, and set y to J v there. */
  void (*stand_at)(void *of, const double *x);
  void (*times)(void *of, const double *v, double *y);
} dvi__smooth_equations;

typedef struct dvi__krylov dvi__krylov;

/* Make a solver of a copy of the equations, with all its memory. DVI_NO_MEMORY. */
dvi_status dvi__krylov_create(const dvi__smooth_equations *equations, dvi__krylov **made);
void dvi__krylov_destroy(dvi__krylov **krylov);

/* Solve from the guess in x, for numbers of a size above 0, to their roundoff. The largest
 * |F_i|/size that is left goes to `residual`. DVI_NOT_CONVERGED, without a sentence, if that is
 * more than roundings make. x is the last point then. */
dvi_status dvi__krylov_solve(dvi__krylov *krylov, double size, double *x, double *residual);

#endif
