/* Symmetric equations whose unknowns are cells of a share, and what solves them on all processes
 * together: the solver that came with the share (dvi_ranks.solver). */
#ifndef DVI_FIELD_MODEL_ELLIPTIC_H
#define DVI_FIELD_MODEL_ELLIPTIC_H
#include <dvi/matrix.h>
#include <dvi/mesh.h>

/* Equations r(x) = 0 with the Jacobian A + D(x), where A is positive definite or semidefinite, and
 * D is diagonal.
 *
 * Equations of pairs have two numbers of each unknown, which is a vertex. x, r and d are
 * [2*unknowns], and the Jacobian with B = A - (1 - cosine) M is
 *
 *     [ B + D_1    sine M     ]
 *     [ sine M    -(B + D_2) ],
 *
 * which is symmetric and indefinite. cosine^2 + sine^2 = 1.
 *
 * All arrays of unknowns have those of other processes, too, which the solver gives, and which it
 * does not ask for. */
typedef struct dvi__elliptic {
  const dvi_mesh *share;
  int degree;
  int64_t unknowns;
  const int *cell; /* [unknowns] of the degree, ascending */
  dvi_matrix A;    /* [unknowns] rows, which are right for own unknowns */
  /* Of degree 1: the diagonal [unknowns] that A is for gradients of functions of the vertices,
   * which a small one beside other entries would lose in roundings. Right for own unknowns */
  const double *of_gradients;
  /* The kernel of A: constants on each of the components, which are those of all processes. */
  int64_t components;
  const int *component; /* [unknowns] or -1. May be NULL without components */
  const double *mass;   /* [unknowns] the diagonal M of pairs, or NULL */
  double cosine, sine;  /* of pairs */
  dvi_status (*residual)(void *of, const double *x, double *r);
  dvi_status (*diagonal)(void *of, const double *x, double *d); /* NULL for linear equations */
  void *of;
  double rounding; /* the norm of residuals that are but roundings, or 0 if it is not known */
} dvi__elliptic;

typedef struct dvi__elliptic_report {
  int corrections;    /* of Newton's method */
  int64_t iterations; /* of conjugate gradients, or minimal residuals, of all corrections */
  double residual;    /* the norm of r */
  double correction;  /* the norm of the last correction beside that of x */
  const char *why;    /* it ended, in a few words */
} dvi__elliptic_report;

/* Create a solver, with a copy of A. What the equations point to stays. All processes fail alike.
 */
typedef struct dvi_ranks_solver {
  dvi_status (*create)(const dvi__elliptic *equations, void *user, void **solver);
  /* Solve, from x [unknowns] on, to roundoff. The user's ranks are those of dvi_ranks. The last
   * call of `residual` is that of the solution.
   * DVI_NOT_CONVERGED without a sentence, which is the caller's, and the status of a function that
   * failed. x is unchanged then. All processes have the same result. */
  dvi_status (*solve)(void *solver, double *x, dvi__elliptic_report *report);
  void (*destroy)(void *solver);
} dvi_ranks_solver;

#endif
