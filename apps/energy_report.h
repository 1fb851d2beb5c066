/** What a run says of its energy error: how large, where, and which step or method would be better. */
#ifndef ENERGY_REPORT_H
#define ENERGY_REPORT_H
#include "energy_watch.h"
#include "run_request.h"

/** Judge the watch's energy; complain, once, if its error went past 1 % of its scale. */
void energy_tell(energy_watch *watch, const run_request *request);

/** The step that theory expects to bring an error down to `part` of it; no longer than `most`, in absolute value, and of two
 *  digits. */
double energy_shorter_step(double h, int order, double part, double most);
#endif
