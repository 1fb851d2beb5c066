/** Problems and integrators as the command line names them. */
#ifndef OPEN_H
#define OPEN_H
#include "cli/options.h"
#include "load/pacing.h"
#include "problem.h"
#include "load/scene.h"

/** Make the problem, with its "name=value" settings. Returns DONE, or complains (with the nearest
 *  known name) and returns the exit code. */
int open_problem(const char *name, const words *settings, problem **scene);

/** The same, of a scene whose text was loaded before; without a text, of the catalogue. */
int open_text(const char *name, const scene_text *text, const words *settings, problem **scene);

/** As open_problem; `one_point`: with callbacks of the one-point shape. */
int open_shaped(const char *name, const words *settings, bool one_point, problem **scene);

/** If no method is asked for, take the one that the scene wants. Returns DONE, or complains that
 * there is none: `command` wants one. */
int open_wish(const char *command, const problem *scene, const char **method);

/** The first setting of a parameter that only places the start; NULL if there is none. */
const char *start_setting(const problem *scene, const words *settings);

/** Read the monitor that `how` names, if it names one. A distance is that of the problem's bodies.
 * Returns DONE, or complains. */
int open_monitor(const problem *scene, const pacing *how, dvi_monitor *monitor);

/** Make an integrator whose steps follow the monitor, if `how` names one, and say nothing. */
dvi_status create_paced(const problem *scene, const char *method, const pacing *how,
                        const dvi_monitor *monitor, dvi_integrator **integrator);

/** Both, in the manner of open_integrator. */
int open_paced(const problem *scene, const char *method, const pacing *how,
               dvi_integrator **integrator);

/** Make an integrator for it from a method's specification, in the same manner. */
int open_integrator(const problem *scene, const char *method, dvi_integrator **integrator);
#endif
