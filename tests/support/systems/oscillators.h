/* Resonance of methods that split, on the problem oscillators, q'' = -(1 + omega^2) q, with steps
 * of length h. */
#ifndef SUPPORT_OSCILLATORS_H
#define SUPPORT_OSCILLATORS_H

/* By what a step multiplies the amplitude that grows fastest, at omega h = pi x; 1 where none
 * does. */
double oscillators_growth(const char *method, double h, double x);

/* The largest change of the energy in so many steps from q = 1, p = 0, relative to it; a run that
 * grows beyond 1e6 ends. */
double oscillators_energy_error(const char *method, double h, double x, long steps);

#endif
