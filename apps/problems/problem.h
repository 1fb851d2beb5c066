/** The catalogue of problems, shared by the dvi command, the examples and the tests. */
#ifndef PROBLEM_H
#define PROBLEM_H
#include <stddef.h>

#include <dvi/dvi.h>

/** A number that a user may set. Sizes are whole numbers given as doubles, names of choices their
 * indices. */
typedef struct problem_parameter {
  const char *name;
  /** the names that it may be set to, ended by NULL; NULL: it is set to a number */
  const char *const *choice;
  double value;       /**< the default */
  double least, most; /**< the values that make sense, both included */
  int whole;          /**< not 0: whole numbers only */
  int start_only;     /**< not 0: it places the start and leaves the system as it is */
  const char *help;   /**< what it is, and its range in words */
} problem_parameter;

/** One problem with its parameters fixed: the system, a start, and what is known about the
 * solution. */
typedef struct problem {
  const char *name, *summary;
  const problem_parameter *parameter; /**< ended by one without a name */
  /** the specification that it wants to be run with; NULL: none */
  const char *method;
  long every; /**< a row after so many steps; 0: it does not say */
  /** how many names of columns it wants to be shown; 0: it does not say */
  int column_count;
  const char *const *column; /**< [column_count] */
  dvi_system *system;
  const dvi_system_terms *terms; /**< what the system was made of */
  int nq;                        /**< numbers of q */
  int nv;                        /**< numbers of v and p: nq, but for systems with factors */
  /** q lists so many points, of nq/bodies coordinates each, between which distances matter; 1: from
   * the origin; 0: none */
  int bodies;
  char **coordinate; /**< [nq] names, for the columns of tables: "x", "theta_1", "R11" */
  /** [nv] with factors: names of the velocities, "Omega1"; else NULL, they are the rates of the
   *  coordinates */
  char **velocity;
  char **momentum;    /**< [nv] names of the momenta: "p_x", "Pi1" */
  double *q;          /**< [nq] the start at t = 0 */
  double *v, *p;      /**< [nv] its velocity and its momentum */
  double h, t_end;    /**< a step and a span that suit a first run */
  double order_h;     /**< first step of an order study of a method of order 2 to 4 */
  double order_t_end; /**< span of an order study; digits, if there are any, are for this time */
  /** [nq], [nv] quadruple-precision result at order_t_end; NULL unless all parameters are the
   *  defaults */
  const double *digits_q, *digits_p;
  /** the end of a long span, for which there are digits too; 0 unless far_q is there */
  double far_t_end;
  const double
      /** [nq] quadruple-precision result there; NULL unless all parameters are the defaults, and
       * for most problems */
      *far_q;
  double far_error; /**< what rounding the start and the parameters to double does to it */
  /** The exact solution; NULL if none is known. 0 if found. */
  int (*exact)(const struct problem *problem, double t, double *q, double *p);
  void *parameters; /**< the callbacks' user pointer */
  void *blocks;     /**< the memory that goes with the problem */
  /** what it was read from, which owns the system; NULL: nothing, it is of the catalogue */
  void *scene;
  void (*close)(struct problem *problem); /**< frees that; NULL without it */
} problem;

#ifdef __cplusplus
extern "C" {
#endif

/** How many problems there are. */
int problem_count(void);

/** Name and one-line summary of problem i; NULL if i is out of range. */
const char *problem_name(int i);
const char *problem_summary(int i);

/** Parameters of problem i, ended by one without a name; NULL if i is out of range. */
const problem_parameter *problem_parameters(int i);

/** Index of a name, or -1. */
int problem_find(const char *name);

/** What a parameter is set by to have this value: a choice's name, or the shortest spelling of a
 * number that is read back as it. */
void problem_spell(const problem_parameter *parameter, double value, char *text, size_t size);

/** Make a problem.
 *
 *  @param      name      of the catalogue
 *  @param      settings  [setting_count] texts "name=value", one for a name
 *  @param[out] out       owned by the caller; NULL on failure
 *  @param[out] message   [size] on failure, a sentence: which name or value is refused, and what is
 *                        possible
 *  @retval DVI_BAD_OPTION  an unknown name, or a value that makes no sense (e >= 1, N < 2, NaN), or
 *                          a name set twice
 *  @retval DVI_NO_MEMORY
 *  @retval (others)        as dvi_system_create and dvi_system_momentum */
dvi_status problem_create(const char *name, int setting_count, const char *const *settings,
                          problem **out, char *message, size_t size);

/** Declare the terms again with callbacks of the one-point shape, which hand their point on as a
 *  batch of one: the system of a user who knows nothing of batches. Gives the same numbers. Not
 *  after an integrator was made from the old system, which is freed.
 *
 *  @retval DVI_NO_MEMORY   nothing has changed
 *  @retval (others)        as dvi_system_create; nothing has changed */
dvi_status problem_one_point(problem *problem);

/** Free it and set the pointer to NULL; NULL is allowed. */
void problem_destroy(problem **problem);

#ifdef __cplusplus
}
#endif
#endif
