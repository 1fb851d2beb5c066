/* A run that carries its tangents from step to step. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_step.h"
#include "num/finite.h"
#include "sensitivity/sensitivity_struct.h"
#include "system/term_name.h"

/* ---- create ---- */

static dvi_status check_system(const dvi_system *system)
{
  const unsigned taken = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL | DVI__FORCES |
                         DVI__FAST | DVI__VECTOR_POTENTIAL;
  if ((system->terms & ~taken) == 0) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "sensitivity: derivatives of a run are for constant masses and general "
                   "Lagrangians in R^n with potentials and forces; the system declares %s",
                   dvi__term_name(system->terms & ~taken));
}

/* Give the element whose map is that of the method. A step of verlet is one of trapezoidal. */
static dvi_status find_space(dvi_sensitivity *own, const char *method, dvi__action_space *space)
{
  const size_t name = strcspn(method, ":");
  dvi__text spelled = {own->method, sizeof own->method, 0};
  if (name != strlen("verlet") || strncmp(method, "verlet", name) != 0)
    return dvi__element_space(own->system, method, "sensitivity", space, &spelled);
  char trapezoidal[DVI__SENSITIVITY_METHOD_SIZE] = "";
  dvi__text_add(&spelled, "%s", method);
  return dvi__element_space(own->system, "trapezoidal", "sensitivity", space,
                            &(dvi__text){trapezoidal, sizeof trapezoidal, 0});
}

static dvi_status assemble(dvi_sensitivity *own, const char *method,
                           const dvi_dependence *dependence)
{
  dvi__action_space space;
  DVI_TRY(dvi_integrator_create(own->system, method, &own->integrator));
  DVI_TRY(find_space(own, method, &space));
  DVI_TRY(dvi__linear_step_create(own->system, &space, dependence, &own->counters, &own->linear));
  own->s = space.degree;
  own->r = space.nodes;
  const size_t n = (size_t)own->n, s = (size_t)own->s,
               tangents = 2 * n * (2 * n + (size_t)own->parameters);
  own->tangent = DVI_NEW(double, tangents);
  own->next = DVI_NEW(double, tangents);
  own->q = DVI_NEW(double, n + n * s);
  own->offset = DVI_NEW(double, n + n * s);
  if (own->tangent && own->next && own->q && own->offset) return DVI_OK;
  return dvi__fail(DVI_NO_MEMORY, "sensitivity: no memory for %d coordinates", own->n);
}

dvi_status dvi_sensitivity_create(const dvi_system *system, const char *method,
                                  const dvi_dependence *dependence, dvi_sensitivity **sensitivity)
{
  if (sensitivity == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "sensitivity: no place for the result");
  *sensitivity = NULL;
  if (system == NULL || method == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "sensitivity: the system or the method is NULL");
  if (dependence != NULL &&
      (dependence->count < 0 || (dependence->count > 0 && dependence->derivative == NULL)))
    return dvi__fail(DVI_BAD_ARGUMENT, "sensitivity: %d parameters%s", dependence->count,
                     dependence->count > 0 ? " without their derivative" : "");
  DVI_TRY(check_system(system));
  dvi_sensitivity *made = DVI_NEW(dvi_sensitivity, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "sensitivity: no memory");
  made->system = system;
  made->n = system->n;
  made->parameters = dependence != NULL ? dependence->count : 0;
  const dvi_status status = assemble(made, method, dependence);
  if (status != DVI_OK) dvi_sensitivity_destroy(&made);
  *sensitivity = made;
  return status;
}

void dvi_sensitivity_destroy(dvi_sensitivity **sensitivity)
{
  if (sensitivity == NULL || *sensitivity == NULL) return;
  dvi_sensitivity *own = *sensitivity;
  dvi_integrator_destroy(&own->integrator);
  dvi__linear_step_destroy(&own->linear);
  dvi__release(own->tangent);
  dvi__release(own->next);
  dvi__release(own->q);
  dvi__release(own->offset);
  dvi__release(own);
  *sensitivity = NULL;
}

/* ---- steps ---- */

dvi_status dvi_sensitivity_start(dvi_sensitivity *own, double t, const double *q, const double *p)
{
  if (own == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "sensitivity: no run to start");
  DVI_TRY(dvi_integrator_start(own->integrator, t, q, p));
  const size_t rows = 2 * (size_t)own->n, all = rows * (rows + (size_t)own->parameters);
  memset(own->tangent, 0, all * sizeof(double));
  for (size_t i = 0; i < rows; i++) own->tangent[i * rows + i] = 1;
  own->has_tangents = 1;
  return DVI_OK;
}

/* Fit Y to the path of the integrator's last step. A straight path is known by its ends. */
static dvi_status fit_path(dvi_sensitivity *own, const dvi__step_path *path, double *Y)
{
  const size_t n = (size_t)own->n, s = (size_t)own->s;
  const dvi__action *action = dvi__linear_step_action(own->linear);
  const double *tau = dvi__action_fit_points(action), *end = dvi_integrator_q(own->integrator);
  double *q = own->offset + n * s;
  for (size_t k = 0; k < s; k++) {
    const int last = k + 1 == s;
    if (!last)
      DVI_TRY(dvi_integrator_interpolate(own->integrator, path->t + tau[k] * path->h, q, NULL));
    for (size_t i = 0; i < n; i++) own->offset[i * s + k] = (last ? end : q)[i] - path->q[i];
  }
  dvi__action_fit(action, own->offset, Y);
  return DVI_OK;
}

dvi_status dvi__sensitivity_advance(dvi_sensitivity *own, double h, double *numbers,
                                    dvi__step_path *path)
{
  const size_t n = (size_t)own->n;
  *path = (dvi__step_path){dvi_integrator_time(own->integrator), h, numbers, numbers + n};
  const double *q = dvi_integrator_q(own->integrator);
  memcpy(numbers, q, n * sizeof(double));
  DVI_TRY(dvi_integrator_step(own->integrator, h));
  return fit_path(own, path, numbers + n);
}

static dvi_status push_all(dvi_sensitivity *own, const dvi__step_path *path)
{
  const size_t rows = 2 * (size_t)own->n, columns = rows + (size_t)own->parameters;
  DVI_TRY(dvi__linear_step_at(own->linear, path, 0));
  memcpy(own->next, own->tangent, rows * columns * sizeof(double));
  for (size_t c = 0; c < columns; c++) {
    double *column = own->next + c * rows;
    DVI_TRY(dvi__linear_step_push(own->linear, (int)c - (int)rows, column, column + own->n));
  }
  if (dvi__first_not_finite(rows * columns, own->next) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "a tangent is not finite at t = %g", path->t);
  double *last = own->tangent;
  own->tangent = own->next;
  own->next = last;
  return DVI_OK;
}

/* After a failure of the tangents the integrator is a step ahead of them, and the run has to start
 * anew. */
dvi_status dvi_sensitivity_step(dvi_sensitivity *own, double h)
{
  dvi__step_path path;
  if (own == NULL || !own->has_tangents)
    return dvi__fail(DVI_BAD_STATE, "sensitivity: a step before the start");
  DVI_TRY(dvi__sensitivity_advance(own, h, own->q, &path));
  const dvi_status status = push_all(own, &path);
  if (status == DVI_OK) return DVI_OK;
  own->has_tangents = 0;
  return dvi__fail_in(status, "sensitivity");
}

/* ---- queries ---- */

const double *dvi_sensitivity_tangent(const dvi_sensitivity *own)
{
  return own != NULL && own->has_tangents ? own->tangent : NULL;
}

double dvi_sensitivity_time(const dvi_sensitivity *own)
{
  return own != NULL && own->has_tangents ? dvi_integrator_time(own->integrator) : (double)NAN;
}

const double *dvi_sensitivity_q(const dvi_sensitivity *own)
{
  return own != NULL && own->has_tangents ? dvi_integrator_q(own->integrator) : NULL;
}

const double *dvi_sensitivity_p(const dvi_sensitivity *own)
{
  return own != NULL && own->has_tangents ? dvi_integrator_p(own->integrator) : NULL;
}

const char *dvi_sensitivity_method(const dvi_sensitivity *own)
{
  return own != NULL ? own->method : NULL;
}
