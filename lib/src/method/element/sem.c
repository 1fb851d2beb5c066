/* Symplectic-energy-momentum integrators. The times of the nodes are unknowns, too.
 *
 * Space: polynomials of degree s. Quadrature: Gauss with s points or Lobatto with s+1.
 * Ld(q0,t0,q1,t1) as galerkin's, stationary in q_k and t_k:
 *   D2 Ld(k-1) + D1 Ld(k) = 0,        E+_{k-1} = E-_k,
 *   E+ = -dLd/dt1, E- = dLd/dt0  (step/element/energy.h)
 *
 * The first step has the given length h0 and fixes the first E+. Where the energy equation has no
 * solution (energy_search.h) the step is the one with the least (E+ - E-)^2 within hmin <= |h| <=
 * hmax, all other rows exact. Order 2s in (t,q,p), symplectic in (t,E,q,p), conserves E of
 * autonomous systems and the momenta of symmetries.
 *
 * Source: Kane, Marsden and Ortiz 1999; Leok 2004, sec. 5.2 and 5.5. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/element/energy_search.h"
#include "num/compensated.h"

enum { DEGREE, QUADRATURE, HMIN, HMAX, SOLVER };

static const char *sem_rule_name(int index)
{
  static const char *const name[] = {"gauss", "lobatto"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

static const char *sem_solver_name(int index)
{
  static const char *const name[] = {"newton", "kinsol"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

static const dvi__key sem_keys[] = {
    {"degree", NULL, 1, DVI_DEGREE_MAX, 1,
     "degree of the path, 1 to 40; default: 1, the midpoint rule with Gauss"},
    {"quadrature", sem_rule_name, 0, 0, 0,
     "gauss (degree points) or lobatto (degree + 1 points); default: gauss"},
    {"hmin", NULL, DVI__POSITIVE, 0, 0,
     "the least length of a step, positive; auto, or default: a tenth of the first step"},
    {"hmax", NULL, DVI__POSITIVE, 0, 0,
     "the largest length of a step, positive; auto, or default: thirty times the first step"},
    {"solver", sem_solver_name, 0, 0, 0,
     "of rows and energy row together: newton, or kinsol, with line search; default: newton"},
    {0},
};

/* Default bounds, in units of the first step. */
static const double least_part = 0.1, largest_part = 30;

/* A length says nothing about the next one if a rounding of the energy moves it by more than a
 * ten-millionth of itself. */
static const double certain = 1e-9;

/* Largest ratio of a step to the last one. A length farther off may solve the equations, but it has
 * nothing to do with the steps before. */
static const double reach = 4;

/* Places of the memory, before the element's own. JUMPS and WORK are compensated sums. */
enum {
  FIRST_H,
  BEFORE_H,
  SLOPE,
  SIZE,
  FIRST,
  ENERGY,
  WORK,
  WORK_COMPENSATION,
  JUMPS,
  JUMPS_COMPENSATION,
  FALLBACKS,
  LAST_JUMP,
  LARGEST_JUMP,
  GIVEN,
  GIVEN_JUMPS,
  OWN
};

typedef struct sem {
  dvi__bordered bordered;
  dvi__energy_search search;
} sem;

typedef struct sem_options {
  int degree, lobatto, solver;
  double hmin, hmax; /* 0 for the default */
} sem_options;

static sem_options sem_options_of(const dvi__stepper *self)
{
  const dvi__settings *s = &self->settings;
  return (sem_options){.degree = s->value[DEGREE],
                       .lobatto = s->value[QUADRATURE],
                       .solver = s->value[SOLVER],
                       .hmin = s->number[HMIN],
                       .hmax = s->number[HMAX]};
}

static dvi_status sem_create(dvi__stepper *self)
{
  const sem_options o = sem_options_of(self);
  const dvi__action_space space = {.basis = DVI_LAGRANGE_LOBATTO,
                                   .degree = o.degree,
                                   .rule = o.lobatto ? DVI_LOBATTO : DVI_GAUSS,
                                   .nodes = o.degree + o.lobatto};
  if (o.hmax != 0 && o.hmin > o.hmax)
    return dvi__fail(DVI_BAD_OPTION,
                     "sem: hmin=%g is above hmax=%g; no step has a length between them", o.hmin,
                     o.hmax);
  sem *own = self->own = DVI_NEW(sem, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "sem: no memory");
  const dvi_status status = dvi__system_has_rates(self->system);
  if (status != DVI_OK) return dvi__fail_in(status, "sem");
  DVI_TRY(dvi__bordered_create(self, &space, &own->bordered));
  DVI_TRY(dvi__energy_search_create(&own->bordered, &own->search));
  self->order = own->bordered.element.order;
  self->follows = 1;
  self->memory_count = OWN + own->bordered.element.memory_count;
  return DVI_OK;
}

static void sem_destroy(dvi__stepper *self)
{
  sem *own = self->own;
  if (own == NULL) return;
  dvi__energy_search_clear(&own->search);
  dvi__bordered_clear(&own->bordered);
  dvi__release(own);
}

/* Give the element's stepper, which works on this method's memory. */
static dvi__stepper *sem_element(const dvi__stepper *self)
{
  sem *own = self->own;
  own->bordered.element.memory = self->memory + OWN;
  return &own->bordered.element;
}

static void sem_start(dvi__stepper *self, const double *v)
{
  dvi__element_start(sem_element(self), v);
}

/* ---- bounds ---- */

static double least_length(const dvi__stepper *self, double first)
{
  const sem_options o = sem_options_of(self);
  if (o.hmin > 0) return o.hmin;
  return fmin(least_part * fabs(first), o.hmax > 0 ? o.hmax : HUGE_VAL);
}

static double largest_length(const dvi__stepper *self, double first)
{
  const sem_options o = sem_options_of(self);
  return o.hmax > 0 ? o.hmax : largest_part * fabs(first);
}

static dvi_status check_first(const dvi__stepper *self, double h)
{
  const double least = least_length(self, h), most = largest_length(self, h);
  if (fabs(h) >= least && fabs(h) <= most) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION,
                   "sem: the first step h = %g is %s %s=%g; the bounds must include it", h,
                   fabs(h) < least ? "below" : "above", fabs(h) < least ? "hmin" : "hmax",
                   fabs(h) < least ? least : most);
}

/* ---- energy ---- */

/* Give E+ of the last step as the sum of all changes since the start. */
static double sem_target(const dvi__stepper *self)
{
  const double *m = self->memory;
  return m[FIRST] + ((m[WORK] - m[WORK_COMPENSATION]) + (m[JUMPS] - m[JUMPS_COMPENSATION]));
}

static void sem_note(dvi__stepper *self, const dvi__mismatch *taken)
{
  double *m = self->memory;
  dvi__add_compensated(&m[WORK], &m[WORK_COMPENSATION], taken->E.end - taken->E.start);
  m[ENERGY] = taken->E.end;
  m[SLOPE] = taken->slope;
  m[SIZE] = taken->E.size;
  self->taken = taken->h;
}

/* Note a step that does not solve the energy equation. */
static void note_jump(dvi__stepper *self, double jump)
{
  dvi__add_compensated(&self->memory[JUMPS], &self->memory[JUMPS_COMPENSATION], jump);
}

static void sem_balance(const dvi__stepper *self, dvi_energy_balance *b)
{
  const double *m = self->memory;
  *b = (dvi_energy_balance){.first = m[FIRST],
                            .energy = m[ENERGY],
                            .work = m[WORK],
                            .jumps = m[JUMPS],
                            .fallbacks = (long)m[FALLBACKS],
                            .last_jump = m[LAST_JUMP],
                            .largest_jump = m[LARGEST_JUMP],
                            .given_steps = (long)m[GIVEN],
                            .given_jumps = m[GIVEN_JUMPS]};
}

/* ---- steps ---- */

/* Take an ordinary step of length h, which begins a sequence, or ends a run. */
static dvi_status sem_step_of_given_length(dvi__stepper *self, dvi__state *state, double h)
{
  dvi__energy_search *search = &((sem *)self->own)->search;
  double *m = self->memory;
  const int continues = sem_element(self)->memory[DVI__LAST_H] != 0;
  dvi__mismatch found;
  if (!self->exact) DVI_TRY(check_first(self, h));
  dvi__energy_search_begin(search, state, sem_target(self));
  DVI_TRY(dvi__energy_search_try(search, h, 1, &found));
  dvi__energy_search_take(search, state);
  if (continues) {
    note_jump(self, found.value);
    m[GIVEN]++;
    m[GIVEN_JUMPS] += found.value;
  } else {
    m[FIRST] = found.E.start;
  }
  m[FIRST_H] = self->exact ? 0 : h;
  m[BEFORE_H] = 0;
  sem_note(self, &found);
  return DVI_OK;
}

static int is_within(double h, double last, double least, double most)
{
  return h / last > 0 && fabs(h) >= least && fabs(h) <= most;
}

static dvi_status fail_far_off(const dvi__mismatch *found)
{
  return dvi__fail(DVI_NOT_CONVERGED, "the step found, %g, is far off, or misses the energy by %g",
                   found->h, found->value);
}

/* Continue the lengths of the last steps. Where h hardly shows in the energy there is nothing to
 * continue. */
static double likely_length(const dvi__stepper *self, double last, double least, double most)
{
  const double *m = self->memory;
  if (m[BEFORE_H] == 0 || fabs(last * m[SLOPE]) <= certain * m[SIZE]) return last;
  const double growth = fmin(fmax(last / m[BEFORE_H], 0.8), 1.25);
  return copysign(fmin(fmax(fabs(growth * last), least), most), last);
}

/* Solve rows and energy row in one system, from the path of a likely length. They give the length
 * alone. The step is an ordinary one, whose roundings do not add up. That step decides, also where
 * noise of h keeps Newton's method from settling. After a positive status the search has to tell
 * whether there is a solution. */
static dvi_status solve_together(dvi__stepper *self, dvi__state *state, double least, double most,
                                 dvi__mismatch *found)
{
  sem *own = self->own;
  dvi__bordered *b = &own->bordered;
  const dvi__rung rung = sem_options_of(self).solver == 0 ? DVI__NEWTON : DVI__KINSOL;
  const double last = b->element.memory[DVI__LAST_H], target = sem_target(self);
  DVI_TRY(dvi__energy_search_try(&own->search, likely_length(self, last, least, most), 0, found));
  found->slope = self->memory[SLOPE];
  if (dvi__energy_solved(found)) {
    dvi__energy_search_take(&own->search, state);
    return DVI_OK;
  }
  const dvi_status status = dvi__bordered_solve(b, state, target, rung,
                                                dvi__element_last_path(&b->element), found);
  if (status < 0 || !is_within(found->h, last, least, most))
    return status != DVI_OK ? status : fail_far_off(found);
  DVI_TRY(dvi__energy_search_try(&own->search, found->h, status != DVI_OK, found));
  if (!dvi__energy_solved(found)) return fail_far_off(found);
  dvi__energy_search_take(&own->search, state);
  return DVI_OK;
}

/* Search the length. Without a solution the step is the best that the search has found. */
static dvi_status search_length(dvi__stepper *self, dvi__state *state, double last, double least,
                                double most, dvi__mismatch *found)
{
  dvi__energy_search *search = &((sem *)self->own)->search;
  double *m = self->memory;
  DVI_TRY(dvi__energy_search_find(search, last, least, most, found));
  dvi__energy_search_take(search, state);
  if (dvi__energy_solved(found)) return DVI_OK;
  note_jump(self, found->value);
  m[FALLBACKS]++;
  m[LAST_JUMP] = found->value;
  if (fabs(found->value) > fabs(m[LARGEST_JUMP])) m[LARGEST_JUMP] = found->value;
  self->counters->energy_fallbacks++;
  return DVI_OK;
}

static dvi_status sem_step_of_chosen_length(dvi__stepper *self, dvi__state *state)
{
  const double first = self->memory[FIRST_H], last = sem_element(self)->memory[DVI__LAST_H];
  const double least = fmax(least_length(self, first), fabs(last) / reach);
  const double most = fmin(largest_length(self, first), fabs(last) * reach);
  dvi__mismatch found = {0};
  dvi__energy_search_begin(&((sem *)self->own)->search, state, sem_target(self));
  dvi_status status = solve_together(self, state, least, most, &found);
  if (status > 0) status = search_length(self, state, last, least, most, &found);
  if (status == DVI_OK) sem_note(self, &found);
  if (status == DVI_OK) self->memory[BEFORE_H] = last;
  return status;
}

static dvi_status sem_step(dvi__stepper *self, dvi__state *state, double h)
{
  dvi__stepper *element = sem_element(self);
  element->follow = self->follow;
  element->doubt = DVI__SURE;
  element->bend = 0;
  const int given = self->exact || self->memory[FIRST_H] != h;
  const dvi_status status = given ? sem_step_of_given_length(self, state, h)
                                  : sem_step_of_chosen_length(self, state);
  self->doubt = element->doubt;
  self->bend = element->bend;
  return status;
}

static void sem_path(const dvi__stepper *self, const double *q0, double h, double tau, double *q,
                     double *v)
{
  dvi__element_path(sem_element(self), q0, h, tau, q, v);
}

static void sem_explain(const dvi__stepper *self, dvi__text *text)
{
  const sem *own = self->own;
  const sem_options o = sem_options_of(self);
  const int unknowns = own->bordered.rows + 1;
  dvi__text_add(
      text,
      "steps: chosen by the method after the first one, whose length --h is; bounds %s to %s\n",
      o.hmin > 0 ? "hmin" : "a tenth of it", o.hmax > 0 ? "hmax" : "thirty times it");
  dvi__text_add(text, "kernel: implicit; %d unknowns a step, the last one its length; ", unknowns);
  if (dvi__solver_prepare(own->bordered.solver) == DVI_OK)
    dvi__explain_entries(unknowns, dvi__pattern_entries(&own->bordered.pattern), text);
  else
    dvi__text_add(text, "no Jacobian: %s\n", dvi_last_error());
  dvi__text_add(text, "energy: %s\n",
                self->system->autonomous ? "conserved; the system is declared autonomous"
                                         : "balanced with the work of the time dependence; rates "
                                           "are given, what they need beside is differenced");
  dvi__text_add(text,
                "solver: %s for rows and energy row together; where it finds no step, a search "
                "tells whether there is one, and else takes the least-squares step\n",
                sem_solver_name(o.solver));
  dvi__explain_linear(own->bordered.solver, text);
}

const dvi__method dvi__sem = {
    .name = "sem",
    .summary = "symplectic-energy-momentum: chooses its steps so that a discrete energy is "
               "conserved; order 2 degree; any Lagrangian",
    .cite = "KaneMarsdenOrtiz1999",
    .keys = sem_keys,
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL | DVI__VECTOR_POTENTIAL,
    .chooses_steps = 1,
    .create = sem_create,
    .destroy = sem_destroy,
    .start = sem_start,
    .step = sem_step,
    .path = sem_path,
    .explain = sem_explain,
    .balance = sem_balance,
};
