/** The report on a run's energy error, with its size, its time, and a better step or method. */
#ifndef ENERGY_REPORT_H
#define ENERGY_REPORT_H
#include "watch/energy_watch.h"
#include "watch/run_request.h"

/** Return the fraction of its scale above which an energy error is reported. It is 1 %, and 10 %
 * for a method whose steps exceed the periods of fast potentials. */
double energy_bound(const problem *scene, const char *method);

/** Judge the energy. Complains, once, if its error went past the bound. */
void energy_tell(energy_watch *watch, const run_request *request);

/** Return the step that theory expects to reduce an error to the fraction `part`. It is no longer
 * than `most`, in absolute value, and has two digits. */
double energy_shorter_step(double h, int order, double part, double most);

/** Return a symplectic method of a higher order for such a system. */
const char *energy_better_method(const dvi_system_terms *terms);
#endif
