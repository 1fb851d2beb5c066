/** The quantity that dvi bench --scale varies. It is a parameter of the problem, which makes the
 * problem grow, or a key of the methods. */
#ifndef AXIS_H
#define AXIS_H
#include <stdbool.h>

#include "cli/numbers.h"
#include "cli/options.h"
#include "problem.h"

enum { AXIS_NAME_SIZE = 128, SPECIFICATION_SIZE = 512 };

/** The kind of quantity that the axis names. */
typedef enum axis_kind {
  AXIS_PARAMETER, /**< parameter of the problem */
  AXIS_KEY        /**< reserved word, a key that is added to every method's specification */
} axis_kind;

/** The name and its values. */
typedef struct scale_axis {
  axis_kind kind;
  /** values are numbers of threads, so that elapsed time and speedup against the first value
   * count */
  bool parallel;
  char name[AXIS_NAME_SIZE];
  numbers values;
} scale_axis;

/** Read "ell=100,1000", "degree=2,4,8" or "threads=1,2". Returns DONE, or complains and returns
 * USAGE. */
int axis_read(const char *text, scale_axis *axis);

/** Create the problem at value k. `settings` needs room for one more setting. `one_point` is that
 * of open_shaped. Returns DONE, or complains and returns the exit code. */
int axis_problem(const scale_axis *axis, int k, const char *name, const words *settings,
                 bool one_point, problem **scene);

/** Write the method's specification at value k. Returns DONE, or complains and returns USAGE if it
 * does not fit. */
int axis_method(const scale_axis *axis, int k, const char *method,
                char specification[SPECIFICATION_SIZE]);

/** Return the abscissa of cost fits and plots, which is the number of coordinates or the value. */
double axis_abscissa(const scale_axis *axis, int k, int n);

/** Return its name in an exponent, "n" or the key, and on a plot. */
const char *axis_symbol(const scale_axis *axis);
const char *axis_title(const scale_axis *axis);
#endif
