/* Schroedinger equations and their marches, for tests. What fails is reported. */
#ifndef TESTS_SUPPORT_FIELD_SCHROEDINGER_H
#define TESTS_SUPPORT_FIELD_SCHROEDINGER_H
#include <complex.h>
#undef I
#include <dvi/schroedinger.h>

typedef int potential_of_points(int64_t count, double t, const double *x, double *V, void *user);

/* An equation with hbar = m = 1, and its space. */
typedef struct quantum {
  dvi_space *space;
  dvi_schroedinger *equation;
  int64_t functions;
} quantum;

/* On [from,to], or periodic on it. */
quantum quantum_on_line(const char *kind, double from, double to, int periodic,
                        potential_of_points *V, double interaction);

/* On a square, from the same ends along both axes. */
quantum quantum_on_square(const char *kind, double from, double to, int periodic,
                          potential_of_points *V, double interaction);

/* With all terms but the space. */
quantum quantum_with(dvi_space *space, const dvi_schroedinger_terms *terms);
void free_quantum(quantum *q);

/* x^2/2, summed over two axes by the second one. */
int harmonic(int64_t count, double t, const double *x, double *V, void *user);
int harmonic_square(int64_t count, double t, const double *x, double *V, void *user);

dvi_march *quantum_march(const quantum *q, const char *method, double step);

/* A complex function of x. */
typedef double complex wave_of_x(double x, const double *parameter);

/* exp(i angle) */
double complex turned_by(double angle);

/* Coefficients [2*functions], for free(), of a function on a line. */
double *wave_on(const quantum *q, wave_of_x *f, const double *parameter);
void start_wave(dvi_march *march, const quantum *q, wave_of_x *f, const double *parameter);

/* The distance in L2 of a march's psi from a function, by the quadrature of the space. */
double distance_from(const dvi_march *march, const quantum *q, wave_of_x *f,
                     const double *parameter);

/* exp(i x p) times the ground state of the harmonic oscillator at a place: parameters place, p. */
double complex packet(double x, const double *parameter);

/* The coherent state of the oscillator that begins as that packet, at the time of parameter 2. */
double complex moved_packet(double x, const double *parameter);

#endif
