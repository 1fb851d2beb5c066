/** What a run says of its energy error: how large, where, and which step or method would be
 *  better. */
#ifndef ENERGY_REPORT_H
#define ENERGY_REPORT_H
#include "watch/energy_watch.h"
#include "watch/run_request.h"

/** The part of its scale above which an energy error is told: 1 %; of a method whose steps go
 *  beyond the periods of fast potentials 10 %. */
double energy_bound(const problem *scene, const char *method);

/** Judge the watch's energy; complain, once, if its error went past the bound. */
void energy_tell(energy_watch *watch, const run_request *request);

/** The step that theory expects to bring an error down to `part` of it; no longer than `most`,
 *  in absolute value, and of two digits. */
double energy_shorter_step(double h, int order, double part, double most);

/** A symplectic method of a higher order for such a system. */
const char *energy_better_method(const dvi_system_terms *terms);
#endif
