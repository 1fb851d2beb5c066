#include "support/field/marches.h"

#include <stdlib.h>
#include <string.h>

#include "support/suite.h"

void advance_march(dvi_march *march, double t)
{
  ck_assert_msg(dvi_march_advance(march, t) == DVI_OK, "%s", dvi_last_error());
}

double observe_march(const dvi_march *march, const char *name)
{
  const char *found;
  for (int i = 0; (found = dvi_march_observable(march, i)) != NULL; i++) {
    double value;
    if (strcmp(found, name) != 0) continue;
    ck_assert_msg(dvi_march_observe(march, i, &value) == DVI_OK, "%s", dvi_last_error());
    return value;
  }
  ck_abort_msg("there is no observable %s", name);
  return 0;
}

double step_of_march(const dvi_march *march)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  return facts.step;
}

void copy_march(const dvi_march *march, dvi_march_form form, double *values)
{
  ck_assert_msg(dvi_march_sample(march, form, 0, NULL, values) == DVI_OK, "%s", dvi_last_error());
}

double *sample_march(const dvi_march *march, dvi_march_form form)
{
  double *values = calloc((size_t)dvi_march_size(march, form) + 1, sizeof *values);
  copy_march(march, form, values);
  return values;
}
