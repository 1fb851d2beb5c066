/** Problems and integrators as the command line names them. */
#ifndef OPEN_H
#define OPEN_H
#include "cli/options.h"
#include "load/pacing.h"
#include "problem.h"
#include "load/scene.h"

/** Create the problem, with its "name=value" settings. Returns DONE, or complains (with the nearest
 * known name) and returns the exit code. */
int open_problem(const char *name, const words *settings, problem **scene);

/** Do the same without the system of a scene, which scene_complete makes. A grid without a mesh has
 * none. */
int open_any(const char *name, const words *settings, problem **scene);

/** Tell what of a scene's grid without a mesh only yee takes, and what helps: for another method in
 * dvi run, or in a command that takes no grid. */
void grid_sentence(const problem *scene, bool in_run, char *text, size_t size);

/** Refuse such a scene, and destroy it. Returns the exit code. */
int refuse_grid(problem **scene, bool in_run);

/** Do the same for a scene whose text was loaded before, or for the catalogue if there is no
 * text. */
int open_text(const char *name, const scene_text *text, const words *settings, problem **scene);

/** Create the problem as open_problem does. `one_point` asks for callbacks of the one-point
 * shape. */
int open_shaped(const char *name, const words *settings, bool one_point, problem **scene);

/** Take the scene's method if no method is asked for. Returns DONE, or complains that `command`
 * needs a method. */
int open_wish(const char *command, const problem *scene, const char **method);

/** Refuse a march of the scene's field, for a command that takes mechanical methods. Returns DONE
 * for any other method. */
int refuse_march(const problem *scene, const char *method);

/** Refuse a problem with noise, for a command that measures errors. Returns DONE without noise. */
int refuse_noise(const char *command, const problem *scene);

/** Return the first setting of a parameter that affects only the start, or NULL. */
const char *start_setting(const problem *scene, const words *settings);

/** Read the monitor of `how`, if there is one. A distance is that of the problem's bodies. Returns
 * DONE, or complains. */
int open_monitor(const problem *scene, const pacing *how, dvi_monitor *monitor);

/** Create an integrator, whose steps follow the monitor if `how` names one. Leaves messages to the
 * caller. */
dvi_status create_paced(const problem *scene, const char *method, const pacing *how,
                        const dvi_monitor *monitor, dvi_integrator **integrator);

/** Read the monitor and create the integrator. Returns and complains as open_integrator does. */
int open_paced(const problem *scene, const char *method, const pacing *how,
               dvi_integrator **integrator);

/** Create an integrator for the problem from a method's specification. Returns DONE, or complains
 * and returns the exit code. */
int open_integrator(const problem *scene, const char *method, dvi_integrator **integrator);
#endif
