/* Impulses of closed contacts by Signorini's and Coulomb's laws at the level of velocities.
 *
 * The relative velocities after an impact are u = b + W P, with the impulses P, W = H M^-1 H^T, and
 * the matrix H of the gaps' gradients and of the tangential maps. For each contact, with its normal
 * part N and its tangential part T, and with e times the rate before the impact in b_N,
 *
 *     0 <= u_N  _|_  P_N >= 0,        |P_T| <= mu P_N,        P_T = -mu P_N u_T/|u_T|  if u_T != 0.
 *
 * Equivalent equations, with y = P - rho u and the disk D(r) of radius r, are
 *
 *     P_N = max(0, y_N),        P_T = the point of D(mu y_N) nearest to y_T.
 *
 * Sweeps of projected Gauss-Seidel iteration come near the solution (Moreau 1999; Jean 1999), and a
 * semismooth Newton's method takes it to roundoff (Alart and Curnier 1991). If more contacts are
 * closed than there are degrees of freedom, W is singular, and P is not unique. A small multiple of
 * the diagonal then makes Newton's matrix regular, and the velocities are the same. Contacts that
 * jam, whose impulses can grow against each other without an effect, may have no solution at all.
 * Proximal iteration then leaves a small residual, which is reported. */
#ifndef DVI_STEP_SPLIT_CONTACT_LAW_H
#define DVI_STEP_SPLIT_CONTACT_LAW_H
#include <dvi/integrator.h>

/* One closed contact with its rows in W, b and P, first the normal one, then its tangents. */
typedef struct dvi__closed {
  int index;    /* of the system's contact */
  int row;      /* its first row */
  int tangents; /* 0, 1 or 2 */
  double mu;
  double rho_N, rho_T; /* 1 over the diagonal of W, for tangents the larger one. Set by solve */
} dvi__closed;

typedef struct dvi__contact_law {
  int most, count, rows;
  int rows_most;
  dvi__closed *closed; /* [most] */
  double *W;           /* [rows * rows], symmetric */
  double *b, *P;       /* [rows]. P holds a guess, and then the solution */
  double *u, *F;       /* [rows] work: velocities, residuals */
  double *matrix;      /* [rows * rows] work */
  double *kept;        /* [rows] work: impulses before Newton's method */
  double *centre;      /* [rows] work: P of the proximal iteration */
  double shift;        /* of the diagonal, in parts of it */
  double *correction;  /* [rows] work: of Newton's method */
  int *pivot;          /* [rows] work */
  double residual;     /* of the last solution, as a part of the largest impulse */
  double worst;        /* the largest residual so far */
  dvi_counters *counters;
} dvi__contact_law;

/* Create room for so many closed contacts with so many tangents each. */
dvi_status dvi__contact_law_create(int most, int tangents, dvi_counters *counters,
                                   dvi__contact_law *law);
void dvi__contact_law_clear(dvi__contact_law *law);

/* Find the impulses. DVI_NOT_CONVERGED, with the residual in the sentence. */
dvi_status dvi__contact_law_solve(dvi__contact_law *law);

#endif
