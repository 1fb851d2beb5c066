/** The catalogue of problems, shared by the dvi command, the examples and the tests. */
#ifndef PROBLEM_H
#define PROBLEM_H
#include <stddef.h>

#include <dvi/dvi.h>

/** A number that a user may set. Sizes are whole numbers given as doubles, names of choices their
 * indices. */
typedef struct problem_parameter {
  const char *name;
  /** names of choices, which end with NULL, or NULL for a number */
  const char *const *choice;
  double value;       /**< the default */
  double least, most; /**< smallest and largest value that make sense */
  int whole;          /**< not 0 for whole numbers only */
  int start_only;     /**< not 0 if it affects only the start, and not the system */
  const char *help;   /**< meaning, and range in words */
} problem_parameter;

/** One problem with fixed parameters. It has the system, a start, and the known results. */
typedef struct problem {
  const char *name, *summary;
  const problem_parameter *parameter; /**< ends with one without a name */
  /** specification of its method, or NULL */
  const char *method;
  long every; /**< interval of rows in steps, 0 if it has none */
  /** number of columns that it wants to show, 0 if it has none */
  int column_count;
  const char *const *column; /**< [column_count] */
  dvi_system *system;
  const dvi_system_terms *terms; /**< terms of the system */
  int nq;                        /**< number of coordinates q */
  int nv; /**< number of velocities and momenta, which is nq without factors */
  /** number of points in q, of nq/bodies coordinates each, whose distances matter. 1 for the
   * distance from the origin, 0 for none. */
  int bodies;
  char **coordinate; /**< [nq] names for the columns of tables, such as "x", "theta_1", "R11" */
  /** [nv] with factors, names of the velocities such as "Omega1". Without factors NULL, because
   * velocities are the rates of the coordinates. */
  char **velocity;
  char **momentum;    /**< [nv] names of the momenta, such as "p_x", "Pi1" */
  double *q;          /**< [nq] start at t = 0 */
  double *v, *p;      /**< [nv] velocity and momentum at the start */
  double h, t_end;    /**< step and span for a first run */
  double order_h;     /**< first step of an order study of a method of order 2 to 4 */
  double order_t_end; /**< span of an order study, and time of the digits */
  /** [nq], [nv] quadruple-precision result at order_t_end, without noise, or NULL unless all
   * parameters are the defaults */
  const double *digits_q, *digits_p;
  /** end of a long span with digits, 0 without far_q */
  double far_t_end;
  /** [nq] quadruple-precision result at far_t_end. NULL unless all parameters are the defaults, and
   * for most problems. */
  const double *far_q;
  double far_error; /**< error of far_q if the start and the parameters are rounded to double */
  /** Compute the exact solution. Returns 0 if it is found. NULL if none is known. */
  int (*exact)(const struct problem *problem, double t, double *q, double *p);
  void *parameters; /**< user pointer of the callbacks */
  void *blocks;     /**< memory of the problem */
  /** scene that owns the system, or NULL for a problem of the catalogue */
  void *scene;
  void (*close)(struct problem *problem); /**< frees the scene, NULL without one */
} problem;

#ifdef __cplusplus
extern "C" {
#endif

/** Return the number of problems. */
int problem_count(void);

/** Return the name and the one-line summary of problem i, or NULL if i is out of range. */
const char *problem_name(int i);
const char *problem_summary(int i);

/** Return the parameters of problem i, which end with one without a name, or NULL if i is out of
 * range. */
const problem_parameter *problem_parameters(int i);

/** Return the index of a name, or -1. */
int problem_find(const char *name);

/** Spell a parameter's value. The text is a choice's name, or the shortest spelling of a number
 * that is read back as the same number. */
void problem_spell(const problem_parameter *parameter, double value, char *text, size_t size);

/** Make a problem.
 *
 *  @param      name      name of the catalogue
 *  @param      settings  [setting_count] texts "name=value", one for a name
 *  @param[out] out       owned by the caller, NULL on failure
 *  @param[out] message   [size] on failure, a sentence that names the refused name or value, and
 *                        what is possible
 *  @retval DVI_BAD_OPTION  an unknown name, or a value that makes no sense (e >= 1, N < 2, NaN), or
 *                          a name set twice
 *  @retval DVI_NO_MEMORY
 *  @retval (others)        as dvi_system_create and dvi_system_momentum */
dvi_status problem_create(const char *name, int setting_count, const char *const *settings,
                          problem **out, char *message, size_t size);

/** Declare the terms again with callbacks of the one-point shape, which hand their point on as a
 * batch of one. This is the system of a user without batches, and gives the same numbers. Not
 * allowed after an integrator was made from the old system, which is freed.
 *
 *  @retval DVI_NO_MEMORY   nothing has changed
 *  @retval (others)        as dvi_system_create, nothing has changed */
dvi_status problem_one_point(problem *problem);

/** Free a problem and set the pointer to NULL. NULL is allowed. */
void problem_destroy(problem **problem);

#ifdef __cplusplus
}
#endif
#endif
