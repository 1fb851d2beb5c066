/* What Yee's grid does exactly: dispersion, loss, and the reflection of Mur's boundary. The speed
 * of light is 1. */
#ifndef SUPPORT_WAVES_GRID_WAVES_H
#define SUPPORT_WAVES_GRID_WAVES_H

/* The frequency w of exp(i(k.x - wt)) on a grid of the spacings h in `axes` directions:
 *     sin^2(w dt/2)/dt^2 = sum_i sin^2(k_i h_i/2)/h_i^2. */
double grid_frequency(int axes, const double *h, double dt, const double *k);

/* The frequency of the mode with `half_waves` half waves along each side of a closed box. */
double grid_box_frequency(int axes, const double *side, const int *cells, double dt,
                          const int *half_waves);

/* With a conductivity, E+ (1+s) = E (1-s) + .., s = sigma dt/(2 eps), a mode that has w without it
 * goes as exp(-decay t) cos(frequency t + ..). */
void grid_lossy_mode(double w, double dt, double sigma, double *frequency, double *decay);

/* A wave q^j z^n along an axis, z = exp((i w - decay) dt). Returns |R| of Mur's boundary
 * E0+ = E1 + b(E1+ - E0), b = (dt-h)/(dt+h), at j = 0, and sets *growth to |q|, 1 without decay. */
double grid_mur_reflection(double w, double decay, double h, double dt, double *growth);

#endif
