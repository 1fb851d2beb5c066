/** What dvi bench --scale varies: a parameter of the problem, which makes it grow, or a key of the
 * methods. */
#ifndef AXIS_H
#define AXIS_H
#include <stdbool.h>

#include "cli/numbers.h"
#include "cli/options.h"
#include "problem.h"

enum { AXIS_NAME_SIZE = 128, SPECIFICATION_SIZE = 512 };

/** What its name names. */
typedef enum axis_kind {
  AXIS_PARAMETER, /**< a parameter of the problem */
  AXIS_KEY        /**< a key that every method's specification gets: a reserved word */
} axis_kind;

/** The name and its values. */
typedef struct scale_axis {
  axis_kind kind;
  /** its values are numbers of threads: elapsed time counts, and what it gains against the first */
  bool parallel;
  char name[AXIS_NAME_SIZE];
  numbers values;
} scale_axis;

/** Read "ell=100,1000", "degree=2,4,8" or "threads=1,2". Returns DONE, or complains and returns
 * USAGE. */
int axis_read(const char *text, scale_axis *axis);

/** Make the problem at value k; `settings` has room for one more; `one_point` as open_shaped has
 * it. Returns DONE, or complains and returns the exit code. */
int axis_problem(const scale_axis *axis, int k, const char *name, const words *settings,
                 bool one_point, problem **scene);

/** Write the method's specification at value k. Returns DONE, or complains and returns USAGE if it
 * does not fit. */
int axis_method(const scale_axis *axis, int k, const char *method,
                char specification[SPECIFICATION_SIZE]);

/** What costs are fitted and drawn against: the number of coordinates, or the value. */
double axis_abscissa(const scale_axis *axis, int k, int n);

/** Its name in an exponent, "n" or the key, and on a plot. */
const char *axis_symbol(const scale_axis *axis);
const char *axis_title(const scale_axis *axis);
#endif
