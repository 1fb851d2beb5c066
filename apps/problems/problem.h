/** The catalogue of problems, shared by the dvi command, the examples and the tests. */
#ifndef PROBLEM_H
#define PROBLEM_H
#include <dvi/dvi.h>

/** A number that a user may set: its name, its default, what it is. Sizes are whole numbers given as doubles. */
typedef struct problem_parameter {
  const char *name;
  double value;
  const char *help;
} problem_parameter;

/** One problem with its parameters fixed: the system, a start, and what is known about the solution. */
typedef struct problem {
  const char *name;
  dvi_system *system;
  int n;
  char **coordinate;  /**< [n] names, for the columns of tables: "x", "theta1"; momenta are "p_" and the name */
  double *q, *p;      /**< [n] the start at t = 0 */
  double *v;          /**< [n] its velocity */
  double h, t_end;    /**< a step and a span that suit a first run */
  double order_h;     /**< first step of an order study of a method of order 2 to 4 */
  double order_t_end; /**< span of an order study; digits, if there are any, are for this time */
  const double *digits_q, *digits_p; /**< [n] quadruple-precision result at order_t_end; NULL unless all parameters are the
                                          defaults */
  /** The exact solution; NULL if none is known. 0 if found. */
  int (*exact)(const struct problem *problem, double t, double *q, double *p);
  void *parameters; /**< the callbacks' user pointer */
} problem;

/** How many problems there are; name and one-line summary of problem i; its parameters, ended by one without a name. */
int problem_count(void);
const char *problem_name(int i);
const char *problem_summary(int i);
const problem_parameter *problem_parameters(int i);

/** Index of a name, or -1. */
int problem_find(const char *name);

/** Make a problem. settings are "name=value" texts; an unknown name or a value that makes no sense (e >= 1, N < 2, NaN) is refused with a
 *  sentence in `message` [size]. Returns DVI_OK, DVI_BAD_OPTION, or what dvi_system_create says. */
dvi_status problem_create(const char *name, int setting_count, const char *const *settings, problem **out, char *message,
                          size_t size);

/** Free it and set the pointer to NULL. */
void problem_destroy(problem **problem);
#endif
