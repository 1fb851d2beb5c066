/* Chebyshev expansions of functions of s on low <= s <= high, with low <= 0, by interpolation, with
 * a proven bound of the truncation error.
 *
 * Let |f| <= M on the ellipse around the interval with the half axes (high - low)/4 (rho +- 1/rho).
 * Then the coefficients are at most 2 M rho^-k. The coefficients behind degree m, and the error of
 * interpolation in m + 1 points, are at most 4 M rho^-m/(rho - 1), for every rho > 1. Source:
 * Trefethen 2013, th. 8.1 and 8.2. */
#ifndef DVI_STEP_SPLIT_EXPANSION_H
#define DVI_STEP_SPLIT_EXPANSION_H

/* The growth of an even function of x, as a function of s = x^2, is bounded by
 *
 *     |f| <= mass cosh(type Im x) |c_1(s)|^-poles,      c_1(s) = sin x/x,      f(0) = 1.
 *
 * A mean of cos(tau x) over |tau| <= type with weights of the sum `mass` satisfies this bound. With
 * poles the functions are known up to s < pi^2 alone. */
typedef struct dvi__growth {
  double type, mass, poles;
} dvi__growth;

/* Return the least degree for which the truncation error of f, or of (1 - f)/s if `divided`, is
 * below `tolerance` times the bound of f on the interval. *bound is the truncation error. Returns
 * -1 if f is not analytic there. The degree may exceed DVI__DEGREE_MOST. */
int dvi__expansion_degree(const dvi__growth *growth, int divided, double low, double high,
                          double tolerance, double *bound);

enum { DVI__DEGREE_MOST = 1000 };

/* Compute the coefficients of f, a function of `user` and s, as c[k*stride] for k = 0 to degree.
 * room [2*degree+3] is work. */
void dvi__expansion_make(int degree, double low, double high,
                         double (*f)(const void *user, double s), const void *user, double *room,
                         double *c, int stride);

#endif
