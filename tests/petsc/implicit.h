/* Equations that are solved on shares, and what tests of them have in common. */
#ifndef TESTS_PETSC_IMPLICIT_H
#define TESTS_PETSC_IMPLICIT_H
#include <dvi/field.h>
#include <stdint.h>

/* What is solved: with fixed values all around or without any, and with the potential u^2/2 +
 * u^4/4. */
typedef struct problem {
  int is_fixed, has_potential;
} problem;

/* What the potential does: it is good, fails on the last process, pushes apart, or has another
 * slope whenever it is asked for. */
extern enum mood { GOOD, FAILING, PUSHING, JUMPING } mood;
extern int slopes; /* how often its derivative was asked for */

dvi_field *make_field(const dvi_mesh *mesh, const problem *p);

/* Give the largest distance of own values of a share from those of the whole mesh. */
double distance(const dvi_mesh *share, const double *u, const double *whole);

/* Expect a number to be below a bound in size. Called on all processes. */
void expect_below(double number, double bound, const char *what, const char *where);

/* Give the sum of hashes of the values of owned vertices, with their numbers. */
uint64_t hash_values(const dvi_mesh *share, const double *u);

/* Print what must be the same on any number of processes. */
void tell(const char *what, uint64_t hash, int iterations);

/* Check the motions of a mesh that a partitioner cuts, or failures, costs and orders. */
void check_motions(const dvi_mesh *mesh, const char *partitioner, int is_long);
void check_failures(void);
void check_costs(void);
void check_orders(void);

#endif
