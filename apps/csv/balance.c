#include "csv/balance.h"

#include <math.h>

bool has_balances(const problem *scene)
{
  const dvi_system_terms *terms = scene->terms;
  return terms->force_count > 0 || terms->damping > 0 || terms->contact_count > 0 ||
         terms->noise != NULL;
}

dvi_status create_balanced(const problem *scene, const char *method, dvi_integrator **integrator)
{
  const dvi_integrator_options options = {
      .size = sizeof options, .method = method, .balances = has_balances(scene)};
  return dvi_integrator_create_with(scene->system, &options, integrator);
}

double balanced_value(const dvi_integrator *integrator, int invariant, double value)
{
  const double supplied = dvi_integrator_supplied(integrator, invariant);
  return isnan(supplied) ? value : value - supplied;
}
