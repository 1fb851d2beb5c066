/* What a problem's file gives to the table in problem.c, and what the files share. */
#ifndef PROBLEMS_ENTRY_H
#define PROBLEMS_ENTRY_H
#include "problem.h"

/* Most parameters that a problem may have. */
#define PROBLEM_PARAMETERS_MAX 8

/* One problem of the catalogue. */
typedef struct problem_entry {
  const char *name, *summary;
  const problem_parameter *parameters; /* ended by one without a name; NULL: none */
  /* Given the parameters' values, allocate with problem_room, label the coordinates, fill q and v, create the system. The momenta
   * are p = L_v(q, v) for all problems; problem_create sees to them. */
  dvi_status (*make)(const double *value, problem *made);
  int (*exact)(const problem *made, double t, double *q, double *p);
  double h, t_end, order_h, order_t_end;
  const double *digits_q, *digits_p; /* for the default parameters; recomputed by tests/reference/test_digits */
} problem_entry;

#define PROBLEM_ENTRY(name) extern const problem_entry problem_entry_##name;
#include "problems.def"
#undef PROBLEM_ENTRY

/* Zeroed memory that problem_destroy frees; NULL if there is none left. */
void *problem_allocate(problem *made, size_t count, size_t size);

/* Set n, and allocate q, v, p, the labels, and `parameters` of that size. */
dvi_status problem_room(problem *made, int n, size_t parameters_size);

/* Name coordinate i. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void problem_label(problem *made, int i, const char *format, ...);

/* cos(w t) and sin(w t) for w = sqrt(square), right to a few ulp even if w t is large: the roundings of w and of w t are
 * carried along. */
void problem_oscillation(double square, double t, double *cosine, double *sine);

#endif
