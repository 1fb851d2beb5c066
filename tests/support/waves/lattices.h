/* Densities on lattices. */
#ifndef TESTS_SUPPORT_LATTICES_H
#define TESTS_SUPPORT_LATTICES_H
#include <dvi/dvi.h>

/* What a lattice of one component has, with l = u_t^2/2 - sum_d u_d^2/2 - V(u). Zero is the
 * default: a periodic axis [0, 2 pi), V = 0, trapezoidal rules. */
typedef struct lattice {
  int axes, cells, fixed; /* fixed: not 0 for ends that are held at 0 instead of periodic ones */
  double from, to;
  double space, time;
  int levels;
  const char *V; /* "none", "mass" u^2/2, "sine" 1 - cos u, "quartic" (u^2-1)^2/4 */
  int in_one;    /* not 0 for one general part */
  double step;
  int mean_rate;
  /* what the terms point to */
  dvi_axis axis[3];
  dvi_density_part part[3];
  dvi_density_condition condition;
  dvi_multisymplectic_terms terms;
} lattice;

/* A density that is nonlinear in the rate, Born and Infeld's. It fails beyond its domain. */
extern const dvi_density_part lattice_strings;

/* Fill in the terms, which point into the lattice. */
const dvi_multisymplectic_terms *lattice_terms(lattice *lattice);

/* Create the march of a lattice. */
dvi_march *lattice_march(lattice *lattice);

/* Start a march at t = 0 with u(t, x) and its rate, or with the mean rate over the first step. */
typedef double lattice_field(double t, const double *x, const void *of);
void lattice_start(dvi_march *march, const lattice *lattice, lattice_field *u, const void *of);

/* Give the largest distance from u at the march's time. */
double lattice_distance(const dvi_march *march, const lattice *lattice, lattice_field *u,
                        const void *of);

#endif
