/* A path's checks of options, creation, destruction and queries. */
#include <math.h>
#include <string.h>

#include "step/element/energy.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/element/element_step.h"
#include "num/finite.h"
#include "boundary/path_struct.h"

/* ---- options ---- */

/* Check an array that these ends require (wanted) or refuse. */
static dvi_status check_array(const dvi_path_options *options, const double *array,
                              const char *name, int wanted)
{
  if (wanted && array == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: %s is missing for these ends", name);
  if (!wanted && array != NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: %s is given, but these ends have no use for it",
                     name);
  if (array == NULL) return DVI_OK;
  const ptrdiff_t bad = dvi__first_not_finite((size_t)options->dimension, array);
  return bad < 0
             ? DVI_OK
             : dvi__fail(DVI_BAD_ARGUMENT, "path: number %td of %s is %g", bad, name, array[bad]);
}

static dvi_status check_arrays(const dvi_system *system, const dvi_path_options *o)
{
  const int periodic = o->ends == DVI_ENDS_PERIODIC, mixed = o->ends == DVI_ENDS_MIXED;
  if ((o->q0 || o->q1 || o->p0 || o->p1 || o->symmetry || o->shift || o->dimension != 0) &&
      o->dimension != system->n)
    return dvi__fail(DVI_BAD_SIZE, "path: the ends have %d coordinates, the system %d",
                     o->dimension, system->n);
  DVI_TRY(check_array(o, o->q0, "the first node q0", !periodic));
  DVI_TRY(check_array(o, o->q1, "the last node q1", o->ends == DVI_ENDS_FIXED || mixed));
  DVI_TRY(check_array(o, o->p0, "the first momentum p0", o->ends == DVI_ENDS_INITIAL || mixed));
  DVI_TRY(check_array(o, o->p1, "the last momentum p1", mixed));
  if (!mixed && (o->free0 != NULL || o->free1 != NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "path: coordinates are free, but these ends give all");
  if (o->shift != NULL) DVI_TRY(check_array(o, o->shift, "the shift", periodic));
  if (o->symmetry == NULL && (o->symmetry_pattern.start != NULL || o->symmetry_pattern.row != NULL))
    return dvi__fail(DVI_BAD_ARGUMENT, "path: a pattern of the symmetry is given, but no symmetry");
  if (o->symmetry == NULL || periodic) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT,
                   "path: a symmetry is given, but only periodic ends have a use for it");
}

static dvi_status path_check(const dvi_system *system, const dvi_path_options *o)
{
  if (o->ends < DVI_ENDS_FIXED || o->ends > DVI_ENDS_MIXED)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: unknown ends %d", (int)o->ends);
  if (system->terms & (DVI__ONE_FORM | DVI__PHASE_SPACE))
    return dvi__fail(DVI_UNSUPPORTED,
                     "path: the system declares a %s: its equations are of first order, and two "
                     "ends are too many",
                     system->lagrangian->name);
  if (system->terms & DVI__FACTORS)
    return dvi__fail(DVI_UNSUPPORTED, "path: the system has factors, and paths are found between "
                                      "ends in R^n; an integrator goes forward from a start");
  if (system->force_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "path: the system declares forces without a potential, and the "
                     "action alone determines paths");
  if (system->damping > 0)
    return dvi__fail(DVI_UNSUPPORTED, "path: the system declares damping, and the action alone "
                                      "determines paths");
  if (system->row_count > 0)
    return dvi__fail(
        DVI_UNSUPPORTED,
        "path: the system declares %sholonomic constraints, and paths are found in all "
        "of R^n",
        system->place_rows > 0 ? "" : "non");
  if (system->contact_count > 0)
    return dvi__fail(DVI_UNSUPPORTED,
                     "path: the system declares contacts, at which paths bend, and "
                     "the action of a path is smooth here");
  if (system->terms & DVI__NOISE)
    return dvi__fail(DVI_UNSUPPORTED,
                     "path: the system declares noise, and a path between two ends has none");
  if (o->steps < 1)
    return dvi__fail(DVI_BAD_SIZE, "path: %d steps; at least 1 is needed", o->steps);
  if (!isfinite(o->start))
    return dvi__fail(DVI_BAD_ARGUMENT, "path: the start %g is no time", o->start);
  if (!(o->span > 0) || !isfinite(o->span))
    return dvi__fail(DVI_BAD_ARGUMENT, "path: the %s %g is not a positive time",
                     o->ends == DVI_ENDS_PERIODIC ? "period" : "span", o->span);
  if (!(o->span / o->steps > fabs(o->start) * 0x1p-50) || !(o->steps / o->span < HUGE_VAL))
    return dvi__fail(DVI_BAD_ARGUMENT, "path: steps of %g from t = %g are too short for the clock",
                     o->span / o->steps, o->start);
  if (o->free_span && o->ends != DVI_ENDS_PERIODIC)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: only periodic ends can have a free period");
  if (o->free_span && !system->autonomous)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "path: a free period needs a system that is declared autonomous");
  if (!o->free_span && o->energy != 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: the energy %g is given, but the period is not free",
                     o->energy);
  if (o->free_span && !isfinite(o->energy))
    return dvi__fail(DVI_BAD_ARGUMENT, "path: the energy %g is no number", o->energy);
  return check_arrays(system, o);
}

/* ---- memory ---- */

static dvi_status copy_turn(dvi_path *path, const dvi_path_options *o)
{
  dvi__pattern pattern;
  if (o->symmetry == NULL) return DVI_OK;
  DVI_TRY(dvi__pattern_copy(&o->symmetry_pattern, path->n, "path: the symmetry", &pattern));
  const int entries = dvi__pattern_entries(&pattern);
  path->turn_values = DVI_NEW(double, entries);
  dvi_status status = path->turn_values != NULL
                          ? dvi__pattern_transpose(&pattern, &path->turn)
                          : dvi__fail(DVI_NO_MEMORY, "path: no memory for a symmetry of %d entries",
                                      entries);
  for (int j = 0; status == DVI_OK && j < path->n; j++)
    for (int e = pattern.start[j]; e < pattern.start[j + 1]; e++)
      path->turn_values[dvi__pattern_find(&path->turn, j, pattern.row[e])] = o->symmetry[e];
  dvi__pattern_clear(&pattern);
  if (status != DVI_OK) return status;
  const ptrdiff_t bad = dvi__first_not_finite((size_t)entries, o->symmetry);
  return bad < 0 ? DVI_OK
                 : dvi__fail(DVI_BAD_ARGUMENT, "path: entry %td of the symmetry is %g", bad,
                             o->symmetry[bad]);
}

static int copy_array(const dvi_path *path, const double *given, double **copy)
{
  if (given != NULL) *copy = dvi__duplicate(given, (size_t)path->n, sizeof(double));
  return given == NULL || *copy != NULL;
}

/* Copy which coordinates of an end are free. */
static int copy_free(const dvi_path *path, const char *given, char **copy)
{
  if (path->ends != DVI_ENDS_MIXED) return 1;
  *copy = given != NULL ? dvi__duplicate(given, (size_t)path->n, 1) : DVI_NEW(char, path->n);
  return *copy != NULL;
}

static int copy_arrays(dvi_path *path, const dvi_path_options *o)
{
  return copy_free(path, o->free0, &path->free[0]) && copy_free(path, o->free1, &path->free[1]) &&
         copy_array(path, o->p1, &path->p1) && copy_array(path, o->q0, &path->q0) &&
         copy_array(path, o->q1, &path->q1) && copy_array(path, o->p0, &path->p0) &&
         copy_array(path, o->shift, &path->shift);
}

static dvi_status path_allocate(dvi_path *path)
{
  const size_t n = (size_t)path->n, s = (size_t)path->s, nodes = (size_t)path->steps + 1,
               gauges = (size_t)path->gauges;
  const size_t entries = (size_t)dvi__pattern_entries(dvi__action_coupling(path->action));
  const struct {
    double **array;
    size_t count;
  } wanted[] = {{&path->x, (size_t)path->unknowns},
                {&path->trial, (size_t)path->unknowns},
                {&path->q, nodes * n},
                {&path->p, nodes * n},
                {&path->trial_p, nodes * n},
                {&path->Y, n * s},
                {&path->in_ends[0], n},
                {&path->in_ends[1], n},
                {&path->in_Z, n * (s - 1)},
                {&path->wrapped, n},
                {&path->rest, n},
                {&path->block, entries * (s + 1) * (s + 1)},
                {&path->kinetic, n},
                {&path->row_scale, n * s},
                {&path->rows, (size_t)path->core},
                {&path->energy_Y, n * s},
                {&path->energy_q0, n},
                {&path->probe, 7 * n},
                {&path->gauge, gauges * (nodes - 1) * n},
                {&path->origin, gauges > 0 ? (nodes - 1) * n : 0},
                {&path->defect, gauges * n}};
  path->broken = DVI_NEW(int, gauges);
  int all = path->broken != NULL;
  for (size_t k = 0; k < sizeof wanted / sizeof *wanted && all; k++)
    all = (*wanted[k].array = DVI_NEW(double, wanted[k].count)) != NULL;
  return all ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "path: no memory for %d steps in %d coordinates",
                         path->steps, path->n);
}

static dvi_status path_make_action(dvi_path *path, const char *method)
{
  dvi__action_space space;
  DVI_TRY(dvi__element_space(path->system, method, "path", &space,
                             &(dvi__text){path->method, sizeof path->method, 0}));
  DVI_TRY(dvi__action_create(path->system, &space, &path->counters, &path->action));
  DVI_TRY(dvi__action_prepare_jacobian(path->action));
  DVI_TRY(dvi__action_prepare_two_point(path->action));
  path->s = space.degree;
  path->order = dvi__element_order(&space);
  if (!path->system->autonomous) return DVI_OK;
  DVI_TRY(dvi__action_prepare_energy(path->action));
  return dvi__evaluator_create(path->system, 1, DVI__STATES, &path->counters, &path->energies);
}

/* Guess the straight line between fixed ends, else a path at rest, because nothing better is
 * known. */
static dvi_status first_guess(dvi_path *path)
{
  const size_t n = (size_t)path->n;
  const double t[] = {0, 1};
  double *line = DVI_NEW(double, 2 * n);
  if (line == NULL) return dvi__fail(DVI_NO_MEMORY, "path: no memory for %d coordinates", path->n);
  if (path->q0 != NULL)
    memcpy(line, path->q0, n * sizeof(double)), memcpy(line + n, path->q0, n * sizeof(double));
  if (path->q1 != NULL) memcpy(line + n, path->q1, n * sizeof(double));
  const dvi_status status = dvi_path_guess(path, 2, path->n, t, line);
  dvi__release(line);
  return status;
}

static dvi_status path_assemble(dvi_path *path, const char *method, const dvi_path_options *o)
{
  path->ends = o->ends;
  path->n = path->system->n;
  path->steps = o->steps;
  path->start = o->start;
  path->span = o->span;
  path->free_span = o->free_span != 0;
  path->energy = o->energy;
  path->gauges = o->ends == DVI_ENDS_PERIODIC
                     ? path->system->symmetry_count + (path->system->autonomous != 0)
                     : 0;
  DVI_TRY(path_make_action(path, method));
  DVI_TRY(copy_turn(path, o));
  if (!copy_arrays(path, o)) return dvi__fail(DVI_NO_MEMORY, "path: no memory for the ends");
  DVI_TRY(dvi__path_lay_out(path));
  DVI_TRY(path_allocate(path));
  DVI_TRY(dvi__path_make_solver(path));
  return first_guess(path);
}

dvi_status dvi_path_create(const dvi_system *system, const char *method,
                           const dvi_path_options *options, dvi_path **path)
{
  if (path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "path: no place for the result");
  *path = NULL;
  if (system == NULL || method == NULL || options == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "path: the system, the method or the options are NULL");
  DVI_TRY(path_check(system, options));
  const long before = dvi__allocation_count();
  dvi_path *made = DVI_NEW(dvi_path, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "path: no memory");
  made->system = system;
  const dvi_status status = path_assemble(made, method, options);
  made->counters.allocations = dvi__allocation_count() - before;
  if (status != DVI_OK) dvi_path_destroy(&made);
  *path = made;
  return status;
}

void dvi_path_destroy(dvi_path **path)
{
  if (path == NULL || *path == NULL) return;
  dvi_path *own = *path;
  double *const owned[] = {
      own->q0,         own->q1,    own->p0,       own->shift,     own->turn_values, own->x,
      own->trial,      own->q,     own->p,        own->trial_p,   own->Y,           own->in_ends[0],
      own->in_ends[1], own->in_Z,  own->wrapped,  own->rest,      own->block,       own->kinetic,
      own->row_scale,  own->rows,  own->energy_Y, own->energy_q0, own->probe,       own->gauge,
      own->origin,     own->defect};
  dvi__solver_destroy(&own->solver);
  dvi__action_destroy(&own->action);
  dvi__evaluator_destroy(&own->energies);
  dvi__pattern_clear(&own->turn);
  dvi__pattern_clear(&own->pattern);
  for (size_t k = 0; k < sizeof owned / sizeof *owned; k++) dvi__release(owned[k]);
  dvi__release(own->broken);
  dvi__release(own->p1);
  for (int end = 0; end < 2; end++) dvi__release(own->free[end]);
  dvi__release(own);
  *path = NULL;
}

/* ---- queries ---- */

int dvi_path_steps(const dvi_path *path)
{
  return path != NULL ? path->steps : 0;
}

static int has_node(const dvi_path *path, int k)
{
  return path != NULL && k >= 0 && k <= path->steps;
}

double dvi_path_time(const dvi_path *path, int k)
{
  return has_node(path, k) ? path->start + k * (dvi__path_span(path, path->x) / path->steps)
                           : (double)NAN;
}

const double *dvi_path_q(const dvi_path *path, int k)
{
  return has_node(path, k) ? path->q + (size_t)k * (size_t)path->n : NULL;
}

const double *dvi_path_p(const dvi_path *path, int k)
{
  return has_node(path, k) && path->solved ? path->p + (size_t)k * (size_t)path->n : NULL;
}

const char *dvi_path_method(const dvi_path *path)
{
  return path != NULL ? path->method : NULL;
}

void dvi_path_counters(const dvi_path *path, dvi_counters *counters)
{
  *counters = path != NULL ? path->counters : (dvi_counters){0};
}
