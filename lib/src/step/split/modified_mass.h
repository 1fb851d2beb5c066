/* The mass M + h^2/4 K. With this mass Verlet's method takes steps of the implicit midpoint rule,
 * for potentials q.Kq/2 + b.q (Stern 2009, prop. 2.2.1). */
#ifndef DVI_STEP_SPLIT_MODIFIED_MASS_H
#define DVI_STEP_SPLIT_MODIFIED_MASS_H
#include "system/evaluate/evaluator.h"

typedef struct dvi__modified_mass dvi__modified_mass;

/* K is the Hessian of a system with potentials that are all declared quadratic, M its mass. The
 * system and the counters must outlive this. K is evaluated here, at t = 0 and q = 0. */
dvi_status dvi__modified_mass_create(const dvi_system *system, dvi_counters *counters,
                                     dvi__modified_mass **mass);
void dvi__modified_mass_destroy(dvi__modified_mass **mass);

/* Keep the factors of the last `count` lengths, 1 to DVI__LENGTHS_MOST (default 1). To be called
 * once. */
enum { DVI__LENGTHS_MOST = 9 };
dvi_status dvi__modified_mass_keep(dvi__modified_mass *mass, int count);

/* Set x [n] <- (M + h^2/4 K)^-1 x. The matrix is factored if its factor is not kept.
 * DVI_NOT_CONVERGED if the matrix is singular at this length or at a shorter one. For a positive M
 * this always shows, because then the matrix is not positive. For an indefinite M it shows only if
 * the determinant of the matrix has another sign than that of M. */
dvi_status dvi__modified_mass_solve(dvi__modified_mass *mass, double h, double *x);

const dvi__pattern *dvi__modified_mass_pattern(const dvi__modified_mass *mass);
/* Describe the solver in words. */
const char *dvi__modified_mass_solver(const dvi__modified_mass *mass);

#endif
