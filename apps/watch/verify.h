/** dvi run --verify, which repeats the whole job with half the step, a quarter of it, and another
 * method. */
#ifndef VERIFY_H
#define VERIFY_H
#include "problem.h"
#include "watch/run_request.h"

/** Put the integrator at the start three times, run it to the requested end, and print how many
 * digits of that end can be trusted.
 *
 *  @return DONE, CHECK_FAILED if there are fewer digits than request->digits, or the code of a
 *          failure, with a complaint */
int verify(const run_request *request, const problem *scene, dvi_integrator *integrator);
#endif
