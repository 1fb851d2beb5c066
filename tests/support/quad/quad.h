/* The quadruple-precision judge solves the catalogue's problems by a scheme of its own
 * (Gragg-Bulirsch-Stoer extrapolation of order 24), from right-hand sides written again from the
 * problems' definitions. It shares no code with the library or apps/problems.
 * Settings are "name=value" texts as for problem_create, read in quadruple precision (e=0.9 is
 * 9/10). */
#ifndef SUPPORT_QUAD_H
#define SUPPORT_QUAD_H

/* Largest number of coordinates (toda N=64, fpu ell=32). */
#define QUAD_N_MAX 64

/* Room for one number's text. */
#define QUAD_TEXT 48

/* Advances (q, p) by time t, which may be negative, from the given numbers. Returns the judge's own
 * error, the largest difference between this result and that of doubled steps, relative to the
 * largest |q_i| in q and to the largest |p_i| in p. Returns NaN and changes nothing if there is no
 * such problem or setting, or if there are more than QUAD_N_MAX coordinates. */
double quad_solve(const char *problem, int setting_count, const char *const *settings, double t,
                  double *q, double *p);

/* Advances the problem's own start, taken from its definition in quadruple precision, and writes
 * the result as texts of 30 digits. q and p have room for QUAD_N_MAX texts, and *n is the number of
 * texts. */
double quad_digits(const char *problem, int setting_count, const char *const *settings, double t,
                   int *n, char (*q)[QUAD_TEXT], char (*p)[QUAD_TEXT]);

#endif
