/** What `dvi control` prints of a solution. */
#ifndef CONTROL_REPORT_H
#define CONTROL_REPORT_H
#include <stdio.h>

#include "problem.h"

/** A control problem of a scene with its solution. */
typedef struct controlled {
  problem *scene;
  dvi_control *control;
  int count; /**< of the controls */
  dvi_control_report report;
} controlled;

void control_print(const controlled *c, FILE *stream);

/** Write the nodes as CSV: t, coordinates, momenta, controls, costates. Returns DONE, or complains
 * and returns the exit code. */
int control_write(const controlled *c, const char *out);
#endif
