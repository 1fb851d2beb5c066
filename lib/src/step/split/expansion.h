/* Chebyshev expansions of functions of s on low <= s <= high, with low <= 0, by interpolation, and
 * a proven bound of what they leave out.
 *
 * Where |f| <= M on the ellipse around the interval with the half axes (high - low)/4 (rho +-
 * 1/rho), the coefficients are at most 2 M rho^-k; those left out behind degree m, and what
 * interpolation in m + 1 points makes of them, are at most 4 M rho^-m/(rho - 1), for every rho > 1.
 * Source: Trefethen 2013, th. 8.1 and 8.2. */
#ifndef DVI_ACTION_EXPANSION_H
#define DVI_ACTION_EXPANSION_H

/* How fast an even function of x grows, as a function of s = x^2:
 *
 *     |f| <= mass cosh(type Im x) |c_1(s)|^-poles,      c_1(s) = sin x/x,      f(0) = 1,
 *
 * which a mean of cos(tau x) over |tau| <= type with weights of the sum `mass` keeps to. With poles
 * the functions are known up to s < pi^2 alone. */
typedef struct dvi__growth {
  double type, mass, poles;
} dvi__growth;

/* The least degree at which what is left out of f, or of (1 - f)/s if `divided`, is below
 * `tolerance` times the bound of f on the interval; *bound is what is left out. -1: not analytic
 * there. May be larger than can be had. */
int dvi__expansion_degree(const dvi__growth *growth, int divided, double low, double high,
                          double tolerance, double *bound);

enum { DVI__DEGREE_MOST = 1000 };

/* The coefficients of f, a function of `user` and s: c[k*stride] for k = 0 to degree. room
 * [2*degree+3]. */
void dvi__expansion_make(int degree, double low, double high,
                         double (*f)(const void *user, double s), const void *user, double *room,
                         double *c, int stride);

#endif
