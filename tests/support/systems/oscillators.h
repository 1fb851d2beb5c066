/* Resonance of methods that split, on the problem oscillators, q'' = -(1 + omega^2) q, with steps
 * of length h. */
#ifndef SUPPORT_OSCILLATORS_H
#define SUPPORT_OSCILLATORS_H

/* Gives the factor by which a step multiplies the amplitude that grows fastest, at omega h = pi x,
 * or 1 if none grows. */
double oscillators_growth(const char *method, double h, double x);

/* Gives the largest relative change of the energy in so many steps from q = 1, p = 0. A run ends
 * when the change exceeds 1e6. */
double oscillators_energy_error(const char *method, double h, double x, long steps);

#endif
