/* What a problem's file gives to the table in problem.c, and what the files share. */
#ifndef PROBLEMS_ENTRY_H
#define PROBLEMS_ENTRY_H
#include <stdint.h>
#include <string.h>

#include "problem.h"

/* A callback with loops over a batch's points is compiled for several instruction sets, and the
 * processor chooses when the program starts. All give the same bits: no sums are reordered, and
 * -ffp-contract=off keeps products and sums apart. The choice is made before gcc's thread sanitizer
 * can watch it. */
#if defined(__x86_64__) && defined(__gnu_linux__) && \
    (!defined(__clang__) || __clang_major__ >= 14) && !defined(__SANITIZE_THREAD__)
#define PROBLEM_LANES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define PROBLEM_LANES
#endif

/* Compiled into its callers, once for each of their instruction sets. */
#define PROBLEM_INLINE static inline __attribute__((always_inline))

/* Numbers that are worked on together. */
#define PROBLEM_TILE 32

/* x <- x^(-3/2), right to three ulp, for positive normal numbers; not finite for 0 and NaN. A
 * square root and a division take longer: the exponent's bits halved and negated are right to 3.5 %
 * (Lomont 2003), then e = 1 - x y^2 shrinks by the series of (1 - e)^(-1/2). Each line is a loop,
 * for one number after the other the chain of operations would wait for itself. */
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

/* Most parameters that a problem may have. */
#define PROBLEM_PARAMETERS_MAX 12

/* Room for one number's name. */
#define PROBLEM_LABEL_SIZE 24

/* One problem of the catalogue. */
typedef struct problem_entry {
  const char *name, *summary;
  const problem_parameter *parameters; /* ended by one without a name; NULL: none */
  /* Given the parameters' values, allocate with problem_room, label the coordinates, fill q and v,
   * create the system with problem_system. The momenta are p = L_v(q, v) for all problems, and with
   * a one-form v is that of the equations of motion; problem_create sees to them. With a
   * Hamiltonian p is filled in the place of v. */
  dvi_status (*make)(const double *value, problem *made);
  int (*exact)(const problem *made, double t, double *q, double *p);
  double h, t_end, order_h, order_t_end;
  /* for the default parameters; recomputed by tests/reference/test_digits */
  const double *digits_q, *digits_p;
  double far_t_end, far_error; /* as in problem.h; 0 without far_q */
  const double *far_q;         /* recomputed by tests/reference/test_far_digits */
} problem_entry;

#define PROBLEM_ENTRY(name) extern const problem_entry problem_entry_##name;
#include "problems.def"
#undef PROBLEM_ENTRY

/* Zeroed memory that problem_destroy frees; NULL if there is none left. */
void *problem_allocate(problem *made, size_t count, size_t size);

/* Set nq = nv = n, and allocate q, v, p, the labels, and `parameters` of that size. */
dvi_status problem_room(problem *made, int n, size_t parameters_size);

/* The same with nq coordinates and nv velocities; and room for so many names, NULL if there is
 * none. */
dvi_status problem_room_of(problem *made, int nq, int nv, size_t parameters_size);
char **problem_names(problem *made, int count);

/* The same for a product of SO(3), SE(3) and S^2, with the names of all numbers; rotations are set
 * to the identity, their places and the directions are left 0. */
dvi_status problem_factors(problem *made, int count, const dvi_factor *factors,
                           size_t parameters_size);

/* Make the system from these terms, and keep them with the problem. What they point to, but for the
 * arrays of terms, lives as long as the problem: parameters, patterns, masses. */
dvi_status problem_system(problem *made, const dvi_system_terms *terms);

/* Name coordinate i, and its momentum after it. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void problem_label(problem *made, int i, const char *format, ...);

/* cos(w t) and sin(w t) for w = sqrt(square), right to a few ulp even if w t is large: the
 * roundings of w and of w t are carried along. */
void problem_oscillation(double square, double t, double *cosine, double *sine);

/* V = k q^2/2 of one coordinate, as dvi_potential's taylor. */
void problem_spring_taylor(double k, int degree, const double *q, double *V, double *V_q,
                           double *V_qq);

#endif
