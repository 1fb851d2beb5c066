#include "support/runs.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "support/suite.h"
#include "system/system.h"

const char *method_spec(const char *format, ...)
{
  static char texts[8][256];
  static int next;
  char *text = texts[next++ % 8];
  va_list arguments;
  va_start(arguments, format);
  (void)vsnprintf(text, sizeof texts[0], format, arguments);
  va_end(arguments);
  return text;
}

problem *create_problem(const char *name, const char *setting)
{
  problem *made = NULL;
  char message[256] = "";
  ck_assert_msg(problem_create(name, setting != NULL, &setting, &made, message, sizeof message) ==
                    DVI_OK,
                "%s", message);
  return made;
}

problem *create_undeclared_problem(const char *name, const char *setting)
{
  problem *made = create_problem(name, setting);
  for (int k = 0; k < made->system->potential_count; k++)
    made->system->potentials[k].callbacks.quadratic = 0;
  return made;
}

dvi_integrator *create_integrator(const dvi_system *system, const char *method)
{
  dvi_integrator *made = NULL;
  ck_assert_msg(dvi_integrator_create(system, method, &made) == DVI_OK, "%s", dvi_last_error());
  return made;
}

dvi_integrator *start_integrator(const problem *model, const char *method)
{
  dvi_integrator *made = create_integrator(model->system, method);
  ck_assert_msg(dvi_integrator_start(made, 0, model->q, model->p) == DVI_OK, "%s",
                dvi_last_error());
  return made;
}

dvi_ensemble *create_ensemble(const dvi_system *system, const char *method,
                              dvi_ensemble_options options)
{
  dvi_ensemble *made = NULL;
  ck_assert_msg(dvi_ensemble_create(system, method, &options, &made) == DVI_OK, "%s",
                dvi_last_error());
  return made;
}

void advance(dvi_integrator *integrator, double h, long steps)
{
  for (long i = 0; i < steps; i++)
    if (dvi_integrator_step(integrator, h) != DVI_OK) ck_abort_msg("%s", dvi_last_error());
}

double distance(int n, const double *a, const double *b)
{
  double largest = 0;
  for (int i = 0; i < n; i++) {
    const double apart = fabs(a[i] - b[i]);
    if (!(apart <= largest)) largest = apart; /* NaN stays */
  }
  return largest;
}

double magnitude(int n, const double *a)
{
  double largest = 0;
  for (int i = 0; i < n; i++) largest = fmax(largest, fabs(a[i]));
  return largest;
}
