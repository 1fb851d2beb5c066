/** Invariants of systems with forces or noise, which are balanced instead of conserved. */
#ifndef BALANCE_H
#define BALANCE_H
#include <stdbool.h>

#include "problem.h"

/** Return whether forces without a potential, contacts, or a heat bath act in a problem. */
bool has_balances(const problem *scene);

/** Create an integrator of steps of time that keeps balances if there are any. */
dvi_status create_balanced(const problem *scene, const char *method, dvi_integrator **integrator);

/** Return an invariant's value less what forces have supplied since the start, if the integrator
 * keeps balances, else the value. It is constant but for the method's error. */
double balanced_value(const dvi_integrator *integrator, int invariant, double value);
#endif
