/* The interface between a problem's file and the table in problem.c, and shared functions. */
#ifndef PROBLEMS_ENTRY_H
#define PROBLEMS_ENTRY_H
#include <stdint.h>
#include <string.h>

#include "problem.h"

/* Compile a callback with loops over a batch's points for several instruction sets. The processor
 * chooses when the program starts. All give the same bits, because no sums are reordered, and
 * -ffp-contract=off keeps products and sums apart. The choice is made before gcc's thread sanitizer
 * can watch it. */
#if defined(__x86_64__) && defined(__gnu_linux__) && \
    (!defined(__clang__) || __clang_major__ >= 14) && !defined(__SANITIZE_THREAD__)
#define PROBLEM_LANES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define PROBLEM_LANES
#endif

/* Compile a function into its callers, once for each of their instruction sets. */
#define PROBLEM_INLINE static inline __attribute__((always_inline))

/* Count of numbers that are worked on together. */
#define PROBLEM_TILE 32

/* Replace x by x^(-3/2), right to three ulp, for positive normal numbers. 0 and NaN give numbers
 * that are not finite. A square root and a division would take longer. The exponent's bits halved
 * and negated are right to 3.5 % (Lomont 2003). The series of (1 - e)^(-1/2) then reduces e = 1 - x
 * y^2. Each line is a loop, because for single numbers each operation would wait for the one
 * before. */
PROBLEM_INLINE void problem_inverse_cubes(const int count, double *restrict x)
{
  double y[PROBLEM_TILE], e[PROBLEM_TILE];
  for (int k = 0; k < count; k++) {
    uint64_t bits;
    memcpy(&bits, x + k, sizeof bits);
    bits = UINT64_C(0x5fe6eb50c7b537a9) - (bits >> 1);
    memcpy(y + k, &bits, sizeof bits);
  }
  for (int k = 0; k < count; k++) e[k] = 1.0 - x[k] * (y[k] * y[k]);
  for (int k = 0; k < count; k++) y[k] += y[k] * (e[k] * (0.5 + e[k] * (0.375 + e[k] * 0.3125)));
  for (int k = 0; k < count; k++) e[k] = 1.0 - x[k] * (y[k] * y[k]);
  for (int k = 0; k < count; k++) y[k] += y[k] * (e[k] * (0.5 + e[k] * 0.375));
  for (int k = 0; k < count; k++) x[k] = y[k] * y[k] * y[k];
}

/* Largest number of parameters of a problem. */
#define PROBLEM_PARAMETERS_MAX 12

/* Memory for one number's name. */
#define PROBLEM_LABEL_SIZE 24

/* Parameters that several problems have, by their default. */
#define PROBLEM_MASS(number)                                                                   \
  {                                                                                            \
    .name = "m", .value = (number), .least = 1e-50, .most = 1e50, .help = "the mass, positive" \
  }
#define PROBLEM_GRAVITY(number)                                   \
  {                                                               \
    .name = "g", .value = (number), .least = -1e50, .most = 1e50, \
    .help = "the acceleration of gravity, any number"             \
  }

/* One problem of the catalogue. */
typedef struct problem_entry {
  const char *name, *summary;
  const problem_parameter *parameters; /* ends with one without a name, or NULL for none */
  /* Allocate with problem_room, label the coordinates, fill q and v, and create the system with
   * problem_system, for the parameters' values. problem_create computes the momenta p = L_v(q, v),
   * and with a one-form the v of the equations of motion. With a Hamiltonian p is filled instead of
   * v. */
  dvi_status (*make)(const double *value, problem *made);
  int (*exact)(const problem *made, double t, double *q, double *p);
  double h, t_end, order_h, order_t_end;
  /* results for the default parameters, recomputed by tests/reference/test_digits */
  const double *digits_q, *digits_p;
  double far_t_end, far_error; /* as in problem.h, 0 without far_q */
  const double *far_q;         /* recomputed by tests/reference/test_far_digits */
} problem_entry;

#define PROBLEM_ENTRY(name) extern const problem_entry problem_entry_##name;
#include "problems.def"
#undef PROBLEM_ENTRY

/* Allocate zeroed memory that problem_destroy frees. NULL without memory. */
void *problem_allocate(problem *made, size_t count, size_t size);

/* Set nq = nv = n, and allocate q, v, p, the labels, and `parameters` of that size. */
dvi_status problem_room(problem *made, int n, size_t parameters_size);

/* Do the same with nq coordinates and nv velocities. problem_names allocates so many names, or
 * returns NULL without memory. */
dvi_status problem_room_of(problem *made, int nq, int nv, size_t parameters_size);
char **problem_names(problem *made, int count);

/* Do the same for a product of SO(3), SE(3) and S^2, with the names of all numbers. Rotations are
 * set to the identity. Their places and the directions are left 0. */
dvi_status problem_factors(problem *made, int count, const dvi_factor *factors,
                           size_t parameters_size);

/* Make the system from these terms, and keep them with the problem. Except for the arrays of terms,
 * all that they point to (parameters, patterns, masses) must live as long as the problem. */
dvi_status problem_system(problem *made, const dvi_system_terms *terms);

/* Do the same for unit masses and so many potentials. Nothing depends on time. */
dvi_status problem_potential_system(problem *made, int count, const dvi_potential *potentials);

/* Do the same for a one-form and a Hamiltonian of the coordinates, with so many symmetries. Nothing
 * depends on time. */
dvi_status problem_one_form_system(problem *made, const dvi_one_form *form,
                                   const dvi_potential *hamiltonian, int symmetry_count,
                                   const dvi_symmetry *symmetries);

/* Name coordinate i, and its momentum after it. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void problem_label(problem *made, int i, const char *format, ...);

/* Compute cos(w t) and sin(w t) for w = sqrt(square), right to a few ulp even if w t is large. The
 * rounding errors of w and of w t are corrected. */
void problem_oscillation(double square, double t, double *cosine, double *sine);

/* Evaluate V = k q^2/2 of one coordinate, as dvi_potential's taylor. */
void problem_spring_taylor(double k, int degree, const double *q, double *V, double *V_q,
                           double *V_qq);

#endif
