/* One-step methods of Runge and Kutta, by their tableaus.
 *
 *     Z_i = z0 + h sum_j a_ij f(t0 + c_i h, Z_j),                   i = 1..s
 *     z1  = z0 + h sum_i b_i f(t0 + c_i h, Z_i) */
#ifndef DVI_STEP_ONESTEP_RUNGE_KUTTA_H
#define DVI_STEP_ONESTEP_RUNGE_KUTTA_H
#include <dvi/status.h>
#include <stdint.h>

enum { DVI__RK_STAGES_MOST = 16 };

typedef struct dvi__runge_kutta {
  int stages, order;
  int is_explicit; /* a_ij = 0 for j >= i */
  int symmetric;   /* the method is self-adjoint, so that a step of -h undoes a step of h */
  /* not 0 for the motion's Taylor series to this degree in place of a tableau, which counts as one
   * stage with b = 1 */
  int series;
  double a[DVI__RK_STAGES_MOST][DVI__RK_STAGES_MOST], b[DVI__RK_STAGES_MOST],
      c[DVI__RK_STAGES_MOST];
} dvi__runge_kutta;

/* The number of built-in methods, and the index of Kutta's method of order 4. */
enum { DVI__RK_NAMED = 15, DVI__RK_4 = 4 };

/* Name of method i, NULL past the last one. */
const char *dvi__runge_kutta_name(int i);

/* Fewest and most stages of method i. Only families have different numbers. */
void dvi__runge_kutta_range(int i, int *fewest, int *most);

/* Make method i with the given number of stages, which must lie in its range. */
dvi_status dvi__runge_kutta_named(int i, int stages, dvi__runge_kutta *method);

/* Read the tableau in a file (docs/methods/shooting.md has the format). DVI_BAD_OPTION, with line
 * and column, for a bad file and for a tableau that does not have the order that it claims. */
dvi_status dvi__runge_kutta_read(const char *path, dvi__runge_kutta *method);

/* A hash of the coefficients identifies a tableau wherever its file is. */
uint64_t dvi__runge_kutta_fingerprint(const dvi__runge_kutta *method);

/* Set is_explicit and symmetric from the coefficients. */
void dvi__runge_kutta_classify(dvi__runge_kutta *method);

/* Check that all conditions of orders up to `order` hold, and c_i = sum_j a_ij. Orders above
 * DVI__TREES_MOST are not checked. DVI_BAD_OPTION names the first condition that fails. Source:
 * Butcher 1963; Hairer, Lubich and Wanner 2006, sec. III.1. */
enum { DVI__TREES_MOST = 8 };
dvi_status dvi__runge_kutta_check(const dvi__runge_kutta *method, int order);

#endif
