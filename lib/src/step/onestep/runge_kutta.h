/* One-step methods of Runge and Kutta, by their tableaus.
 *
 *     Z_i = z0 + h sum_j a_ij f(t0 + c_i h, Z_j),     z1 = z0 + h sum_i b_i f(t0 + c_i h, Z_i),     i =
 * 1..s */
#ifndef DVI_ACTION_RUNGE_KUTTA_H
#define DVI_ACTION_RUNGE_KUTTA_H
#include <dvi/status.h>
#include <stdint.h>

enum { DVI__RK_STAGES_MOST = 16 };

typedef struct dvi__runge_kutta {
  int stages, order;
  int is_explicit; /* a_ij = 0 for j >= i */
  int symmetric;   /* self-adjoint: a step of -h undoes one of h */
  /* not 0: the motion's Taylor series to this degree, and no tableau; it counts as one stage with b
   * = 1 */
  int series;
  double a[DVI__RK_STAGES_MOST][DVI__RK_STAGES_MOST], b[DVI__RK_STAGES_MOST],
      c[DVI__RK_STAGES_MOST];
} dvi__runge_kutta;

/* How many are built in, and which of them is Kutta's of order 4. */
enum { DVI__RK_NAMED = 15, DVI__RK_4 = 4 };

/* Name of method i, NULL past the last one. */
const char *dvi__runge_kutta_name(int i);

/* Fewest and most stages of method i; they are the same but for families. */
void dvi__runge_kutta_range(int i, int *fewest, int *most);

/* Method i with so many stages, in its range. */
dvi_status dvi__runge_kutta_named(int i, int stages, dvi__runge_kutta *method);

/* The tableau in a file (docs/methods/shooting.md has the format). DVI_BAD_OPTION, with line and
 * column; also if it has not the order that it claims. */
dvi_status dvi__runge_kutta_read(const char *path, dvi__runge_kutta *method);

/* A hash of the coefficients, by which a tableau is known wherever its file is. */
uint64_t dvi__runge_kutta_fingerprint(const dvi__runge_kutta *method);

/* Set is_explicit and symmetric from the coefficients. */
void dvi__runge_kutta_classify(dvi__runge_kutta *method);

/* Whether all conditions of orders up to `order` hold, and c_i = sum_j a_ij; orders above
 * DVI__TREES_MOST are believed. DVI_BAD_OPTION names the condition that does not. Source: Butcher
 * 1963; Hairer, Lubich and Wanner 2006, sec. III.1. */
enum { DVI__TREES_MOST = 8 };
dvi_status dvi__runge_kutta_check(const dvi__runge_kutta *method, int order);

#endif
