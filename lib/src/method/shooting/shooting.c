/* Shooting: the discrete Lagrangian, or Hamiltonian, of a one-step method and a quadrature.
 *
 *     Ld(q0,q1) = h sum_i b_i L(q^i, v^i),   (q^{i+1},v^{i+1}) = Psi_{(c_{i+1}-c_i)h}(q^i,v^i),   q^0 = q0, q^n = q1,
 * p0 = -D1 Ld, p1 = D2 Ld: the v^0 is sought for which the shot meets both
 * (step/onestep/shot_step.h). The one-step method may be explicit: the step is symplectic and has
 * the symmetries that it is equivariant under. The quadrature has both ends among its nodes. Of
 * type 2 and 3 the discrete Hamiltonians H+(q0,p1) = p1.Q - S, of the shot that ends with the
 * momentum p1, and H-(p0,q1) = -p0.k0 - S, of the one that starts with p0, generate the step: for
 * Hamiltonians, which may be degenerate, too. Order min(p,q) of the one-step method's and the
 * quadrature's; type 1 is symmetric if both are, types 2 and 3 are each other's adjoint then.
 * Source: Leok and Shingel 2012, sec. 3; Patrick and Cuell 2009; Leok and Zhang 2011 (types 2 and
 * 3). */
#include <dvi/quadrature.h>
#include <string.h>

#include "step/onestep/shot_step.h"
#include "step/onestep/stacked_shot.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/scheme.h"
#include "method/stationary.h"
#include "num/compensated.h"
#include "num/finite.h"
#include "space/osculation.h"
#include "system/rescale/transformed.h"

enum { ONE_STEP, STAGES, TABLEAU, COMPOSITION, QUADRATURE, NODES, TERMS, SOLVE, TOLERANCE, TYPE };
enum {
  NODES_MOST = 16,
  STAGES_MOST = 20,
  SHOT_MOST = 2000 /* 128 MB a matrix */,
  TAYLOR = DVI__RK_NAMED,
  FROM_FILE
};

/* Quadratures: those of the core; Euler-Maclaurin and Gauss-Hermite. */
enum { EULER_MACLAURIN = DVI_SIMPSON + 1, GAUSS_HERMITE };

static const char *one_step_name(int index)
{
  if (index == TAYLOR) return "taylor";
  return index == FROM_FILE ? "file" : dvi__runge_kutta_name(index);
}

static const char *rule_name(int index)
{
  if (index == EULER_MACLAURIN) return "euler-maclaurin";
  return index == GAUSS_HERMITE ? "gauss-hermite" : dvi_rule_name((dvi_rule)index);
}

static const char *composition_name(int index)
{
  return index == 0 ? "none" : dvi__scheme_name(index - 1);
}

enum { AUTO, SHOT, STAGES_TOO, SOLVES };

static const char *solve_name(int index)
{
  static const char *const name[] = {"auto", "shot", "stages"};
  return index >= 0 && index < SOLVES ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"onestep", one_step_name, 0, 0, DVI__LEFT_OUT,
     "euler, explicit-midpoint, heun, kutta3, rk4, three-eighths, dormand-prince, butcher6, "
     "cooper-verner, backward-euler, "
     "implicit-midpoint, gauss, radau-iia, lobatto-iiia, sdirk, taylor, or file; default: rk4"},
    {"stages", NULL, 1, STAGES_MOST, DVI__LEFT_OUT,
     "of gauss, radau-iia, lobatto-iiia (2 to 8) and sdirk (2 or 3); of taylor the degree, 1 to "
     "20; default: 2, of taylor 4"},
    {"tableau", NULL, DVI__FILE, 0, 0, "the file of the one-step method's tableau"},
    {"composition", composition_name, 0, 0, 0,
     "none, 4, 6 or 8: the order to which a symmetric one-step method is composed; default: none"},
    {"quadrature", rule_name, 0, 0, DVI_SIMPSON,
     "trapezoid, simpson, lobatto, clenshaw-curtis, euler-maclaurin or gauss-hermite; default: "
     "simpson"},
    {"nodes", NULL, 2, NODES_MOST, DVI__LEFT_OUT,
     "of lobatto and clenshaw-curtis, 2 to 16; default: the fewest whose order reaches that of the "
     "one-step method"},
    {"terms", NULL, 0, STAGES_MOST, DVI__LEFT_OUT,
     "of euler-maclaurin, beside the trapezoid, and of gauss-hermite, at each end, up to 20; "
     "default: as nodes"},
    {"solve", solve_name, 0, 0, AUTO,
     "shot: for the start, by dense derivatives of the shot; stages: for all stages, as one sparse "
     "system; auto: the cheaper; left "
     "out: auto"},
    {"tolerance", NULL, DVI__POSITIVE, 0, 0,
     "the residual, relative to the coordinates, at which the search for v ends: to see what a "
     "loose one does; default: roundoff"},
    {"type", NULL, 1, 3, DVI__LEFT_OUT,
     "of generating functions: 1 (q0,q1), 2 (q0,p1) or 3 (p0,q1); default: 1, with a Hamiltonian "
     "2"},
    {0},
};

typedef struct shooter {
  /* The shot from the start, or all its stages: one of them; the other is NULL. */
  dvi__shot_step *shot;
  dvi__stacked_shot *stacked;
  const dvi__pattern *pattern;
  dvi__stationary equations;
  int unknowns, order; /* of the one-step method */
  double tolerance;    /* 0: roundoff */
  double *values;      /* [entries] of the Jacobian; NULL without a tolerance */
  double *guess, *R;   /* [unknowns]; the arrays below lie behind */
  double *v, *dq, *dp; /* [n] */
} shooter;

/* ---- what is asked for ---- */

static dvi_status choose_built_in(dvi__settings *settings, dvi__runge_kutta *method)
{
  int fewest, most, *stages = &settings->value[STAGES];
  const int choice = settings->value[ONE_STEP];
  dvi__runge_kutta_range(choice, &fewest, &most);
  if (*stages == DVI__LEFT_OUT) *stages = fewest;
  if (*stages >= fewest && *stages <= most) return dvi__runge_kutta_named(choice, *stages, method);
  return dvi__fail(DVI_BAD_OPTION, "shooting: onestep=%s has %d%s stage%s, not stages=%d",
                   one_step_name(choice), fewest, most > fewest ? " or more" : "",
                   most == 1 ? "" : "s", *stages);
}

/* Order 4 at its default degree, as rk4. */
static dvi_status choose_taylor(const dvi__stepper *self, int *degree, dvi__runge_kutta *method)
{
  if (*degree == DVI__LEFT_OUT) *degree = 4;
  *method = (dvi__runge_kutta){
      .stages = 1, .order = *degree, .is_explicit = 1, .series = *degree, .b = {1}};
  const dvi_status status = dvi__system_has_taylor(self->system);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "shooting: onestep=taylor");
}

static dvi_status choose_one_step(dvi__stepper *self, dvi__runge_kutta *method)
{
  dvi__settings *settings = &self->settings;
  int *choice = &settings->value[ONE_STEP];
  const int has_file = settings->file != NULL;
  if (*choice == DVI__LEFT_OUT) *choice = has_file ? FROM_FILE : DVI__RK_4;
  if (has_file != (*choice == FROM_FILE))
    return dvi__fail(
        DVI_BAD_OPTION,
        has_file ? "shooting: onestep=%s is built in; with tableau=%s only onestep=file is possible"
                 : "shooting: onestep=%s needs the name of the file, tableau=%s",
        one_step_name(*choice), has_file ? settings->file : "...");
  if (*choice == TAYLOR) return choose_taylor(self, &settings->value[STAGES], method);
  if (!has_file) return choose_built_in(settings, method);
  const dvi_status status = dvi__runge_kutta_read(settings->file, method);
  if (status != DVI_OK) return dvi__fail_in(status, "shooting");
  settings->value[STAGES] = method->stages;
  self->fingerprint = dvi__runge_kutta_fingerprint(method);
  self->fingerprinted = "coefficients of the tableau";
  return DVI_OK;
}

/* The composition's order takes the place of a lower one. */
static dvi_status choose_composition(const dvi__settings *settings, dvi__runge_kutta *method)
{
  const int choice = settings->value[COMPOSITION];
  if (choice == 0) return DVI_OK;
  if (!method->symmetric)
    return dvi__fail(DVI_BAD_OPTION,
                     "shooting: composition=%s raises the order of symmetric one-step methods "
                     "alone, and onestep=%s is none; "
                     "implicit-midpoint, gauss and lobatto-iiia are",
                     composition_name(choice), one_step_name(settings->value[ONE_STEP]));
  const int order = dvi__scheme_at(choice - 1)->order;
  method->order = method->order < order ? order : method->order;
  return DVI_OK;
}

static dvi_status choose_rule(dvi__settings *settings, int order)
{
  int *nodes = &settings->value[NODES];
  const dvi_rule rule = (dvi_rule)settings->value[QUADRATURE];
  const int fixed = rule == DVI_TRAPEZOID ? 2 : rule == DVI_SIMPSON ? 3 : 0;
  if (!fixed && rule != DVI_LOBATTO && rule != DVI_CLENSHAW_CURTIS)
    return dvi__fail(DVI_BAD_OPTION,
                     "shooting: quadrature=%s does not have both ends of the step among its nodes, "
                     "where the shot starts and meets "
                     "q1; possible are trapezoid, simpson, lobatto, clenshaw-curtis, "
                     "euler-maclaurin and gauss-hermite",
                     rule_name((int)rule));
  if (*nodes == DVI__LEFT_OUT)
    for (*nodes = fixed ? fixed : 2;
         !fixed && dvi_quadrature_order(rule, *nodes) < order && *nodes < NODES_MOST;)
      ++*nodes;
  if (fixed && *nodes != fixed)
    return dvi__fail(DVI_BAD_OPTION, "shooting: quadrature=%s has %d nodes, not nodes=%d",
                     rule_name((int)rule), fixed, *nodes);
  return DVI_OK;
}

static dvi__osculation osculation_of(const dvi__settings *settings)
{
  return settings->value[QUADRATURE] == EULER_MACLAURIN ? DVI__EULER_MACLAURIN : DVI__HERMITE;
}

static int is_osculation(const dvi__settings *settings)
{
  return settings->value[QUADRATURE] >= EULER_MACLAURIN;
}

static dvi_status choose_osculation(const dvi_system *system, dvi__settings *settings, int order)
{
  int *terms = &settings->value[TERMS], *nodes = &settings->value[NODES];
  const char *name = rule_name(settings->value[QUADRATURE]);
  if (*nodes != DVI__LEFT_OUT && *nodes != 2)
    return dvi__fail(DVI_BAD_OPTION,
                     "shooting: quadrature=%s has its 2 nodes at the ends, not nodes=%d", name,
                     *nodes);
  *nodes = 2;
  if (*terms == DVI__LEFT_OUT)
    for (*terms = 1; dvi__osculation_order(osculation_of(settings), *terms) < order;) ++*terms;
  if (*terms == 0)
    return dvi__fail(DVI_BAD_OPTION,
                     "shooting: quadrature=%s without terms is the trapezoid, if anything; terms=1 "
                     "to %d are possible",
                     name, STAGES_MOST);
  const dvi_status status = dvi__system_has_taylor(system);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "shooting: quadrature=%s", name);
}

static dvi_status choose_quadrature(const dvi_system *system, dvi__settings *settings, int order)
{
  int *terms = &settings->value[TERMS];
  if (is_osculation(settings)) return choose_osculation(system, settings, order);
  if (*terms > 0)
    return dvi__fail(DVI_BAD_OPTION,
                     "shooting: quadrature=%s has no terms; euler-maclaurin and gauss-hermite have",
                     rule_name(settings->value[QUADRATURE]));
  *terms = 0;
  return choose_rule(settings, order);
}

static int order_of_quadrature(const dvi__settings *settings)
{
  if (is_osculation(settings))
    return dvi__osculation_order(osculation_of(settings), settings->value[TERMS]);
  return dvi_quadrature_order((dvi_rule)settings->value[QUADRATURE], settings->value[NODES]);
}

/* A piece from node to node, in the substeps of the composition; nothing is summed at the points
 * between them. */
static void add_piece(const dvi__settings *settings, double from, double to, double weight,
                      dvi__course *course)
{
  const int choice = settings->value[COMPOSITION];
  const dvi__scheme *scheme = choice > 0 ? dvi__scheme_at(choice - 1) : NULL;
  double gone = 0;
  for (int i = 0; scheme != NULL && i + 1 < scheme->substeps; i++) {
    gone += dvi__scheme_part(scheme, i);
    course->c[++course->pieces] = from + gone * (to - from);
  }
  course->c[++course->pieces] = to;
  course->b[course->pieces] = weight;
}

static dvi_status plot(const dvi__settings *settings, dvi__course *course)
{
  double c[NODES_MOST], b[NODES_MOST];
  const int nodes = settings->value[NODES];
  *course = (dvi__course){0};
  if (is_osculation(settings)) {
    dvi__osculation_weights(osculation_of(settings), settings->value[TERMS], course->weight);
    course->count = dvi__osculation_count(osculation_of(settings), settings->value[TERMS]);
  }
  DVI_TRY(dvi_quadrature(course->count > 0 ? DVI_TRAPEZOID : (dvi_rule)settings->value[QUADRATURE],
                         nodes, c, b));
  course->b[0] = b[0];
  for (int i = 1; i < nodes; i++) add_piece(settings, c[i - 1], c[i], b[i], course);
  return DVI_OK;
}

/* ---- making it ---- */

static int allocate(shooter *own, size_t n)
{
  const size_t z = (size_t)own->unknowns;
  double *at = own->guess = DVI_NEW(double, 2 * z + 3 * n);
  if (own->tolerance > 0) own->values = DVI_NEW(double, dvi__pattern_entries(own->pattern));
  if (at == NULL || (own->values == NULL && own->tolerance > 0)) return 0;
  own->R = at + z;
  own->v = own->R + z;
  own->dq = own->v + n;
  own->dp = own->dq + n;
  return 1;
}

/* Unknowns and rows come in units of q. */
static dvi_status row_scale(void *of, double *scale, int *unchanged)
{
  const shooter *own = of;
  for (int i = 0; i < own->unknowns; i++) scale[i] = 1;
  *unchanged = 1;
  return DVI_OK;
}

static dvi_status residual(void *of, const double *x, double *R)
{
  const shooter *own = of;
  return own->stacked != NULL ? dvi__stacked_shot_residual(own->stacked, x, R)
                              : dvi__shot_step_residual(own->shot, x, R);
}

static dvi_status jacobian(void *of, const double *x, double *values)
{
  const shooter *own = of;
  return own->stacked != NULL ? dvi__stacked_shot_jacobian(own->stacked, x, values)
                              : dvi__shot_step_jacobian(own->shot, x, values);
}

/* Sparse, and of more coordinates than the system of all stages has blocks of 2n: six times as many
 * of an explicit method, whose shot solves nothing (measured with chains of masses). */
static int stages_are_cheaper(const dvi_system *system, const dvi__runge_kutta *method,
                              const dvi__course *course)
{
  enum { EXPLICIT_GAIN = 6, LEAST_EMPTY = 4 };
  const int blocks = 2 * (method->stages + 1) * course->pieces + 1;
  if (system->n > SHOT_MOST) return 1;
  return system->mass_diagonal != NULL &&
         system->n > (method->is_explicit ? EXPLICIT_GAIN : 1) * blocks &&
         (double)LEAST_EMPTY * dvi__pattern_entries(&system->qq) <= (double)system->n * system->n;
}

static dvi_status choose_solve(dvi__stepper *self, const dvi__runge_kutta *method,
                               const dvi__course *course)
{
  int *choice = &self->settings.value[SOLVE];
  const int possible = self->settings.value[TYPE] == 1 && method->series == 0 && course->count == 0;
  if (*choice != AUTO) return DVI_OK;
  DVI_TRY(dvi__system_prepare_hessian(self->system));
  *choice = possible && stages_are_cheaper(self->system, method, course) ? STAGES_TOO : SHOT;
  return DVI_OK;
}

static dvi_status make_step(dvi__stepper *self, const dvi__runge_kutta *method,
                            const dvi__course *course)
{
  shooter *own = self->own;
  DVI_TRY(choose_solve(self, method, course));
  const int choice = self->settings.value[SOLVE];
  if (choice == SHOT) {
    if (self->system->n > SHOT_MOST)
      return dvi__fail(DVI_UNSUPPORTED,
                       "solve=shot has full matrices of 2n = %d unknowns, and is for up to %d "
                       "coordinates; solve=stages, with type=1, a "
                       "tableau and a quadrature by values, is sparse",
                       2 * self->system->n, SHOT_MOST);
    DVI_TRY(dvi__shot_step_create(self->system, self->settings.value[TYPE], method, course,
                                  self->counters, &own->shot));
    own->pattern = dvi__shot_step_pattern(own->shot);
    return DVI_OK;
  }
  if (self->settings.value[TYPE] != 1)
    return dvi__fail(DVI_BAD_OPTION, "solve=stages is for type=1; leave it out");
  if (method->series > 0 || course->count > 0)
    return dvi__fail(DVI_BAD_OPTION, "solve=stages is for one-step methods with a tableau and "
                                     "quadratures by values; leave it out");
  DVI_TRY(dvi__stacked_shot_create(self->system, method, course, self->counters, &own->stacked));
  own->pattern = dvi__stacked_shot_pattern(own->stacked);
  return DVI_OK;
}

static dvi_status make(dvi__stepper *self, const dvi__runge_kutta *method,
                       const dvi__course *course)
{
  shooter *own = self->own;
  DVI_TRY(make_step(self, method, course));
  own->unknowns = own->pattern->columns;
  dvi__equations equations = {.unknowns = own->unknowns,
                              .pattern = own->pattern,
                              .of = own,
                              .residual = residual,
                              .jacobian = jacobian,
                              .row_scale = row_scale,
                              .noise = dvi__hessian_noise(self->system),
                              .ahead = own->shot != NULL};
  DVI_TRY(dvi__stationary_create(self, &equations, &own->equations));
  return allocate(own, (size_t)self->system->n) ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "no memory");
}

static dvi_status choose_type(const dvi_system *system, int *type)
{
  const int on_H = (system->terms & DVI__HAMILTONIAN) != 0;
  if (*type == DVI__LEFT_OUT) *type = on_H ? 2 : 1;
  if (*type != 1 || !on_H) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "shooting: type=1 shoots for a discrete Lagrangian, and the "
                                    "system declares a Hamiltonian, which may have none; "
                                    "type=2 and 3 can, and hamiltonian:type=1");
}

static dvi_status create(dvi__stepper *self)
{
  dvi__settings *settings = &self->settings;
  dvi__runge_kutta method = {0};
  dvi__course course = {0};
  DVI_TRY(choose_type(self->system, &settings->value[TYPE]));
  DVI_TRY(choose_one_step(self, &method));
  DVI_TRY(choose_composition(settings, &method));
  DVI_TRY(choose_quadrature(self->system, settings, method.order));
  DVI_TRY(plot(settings, &course));
  const int order = order_of_quadrature(settings);
  shooter *own = self->own = DVI_NEW(shooter, 1);
  if (own == NULL) return dvi__fail(DVI_NO_MEMORY, "shooting: no memory");
  own->tolerance = settings->number[TOLERANCE];
  own->order = method.order;
  self->order = method.order < order ? method.order : order;
  self->symmetric = method.symmetric && settings->value[TYPE] == 1;
  self->memory_count = (size_t)self->system->n;
  const dvi_status status = make(self, &method, &course);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "shooting");
}

static void destroy(dvi__stepper *self)
{
  shooter *own = self->own;
  if (own == NULL) return;
  dvi__stationary_clear(&own->equations);
  dvi__shot_step_destroy(&own->shot);
  dvi__stacked_shot_destroy(&own->stacked);
  dvi__release(own->guess);
  dvi__release(own->values);
  dvi__release(own);
}

/* ---- the step ---- */

/* The memory is a guess for the velocity. */
static void start(dvi__stepper *self, const double *v)
{
  memcpy(self->memory, v, (size_t)self->system->n * sizeof *v);
}

/* Newton's method until the residual is as small as was asked for. */
static dvi_status solve_loosely(shooter *own, double size)
{
  enum { MOST = 40 };
  double correction = 0, *x = own->equations.x;
  memcpy(x, own->guess, (size_t)own->unknowns * sizeof *x);
  DVI_TRY(dvi__solver_jacobian(own->equations.solver, x, own->values));
  DVI_TRY(dvi__solver_take_jacobian(own->equations.solver, own->values));
  for (int i = 0; i < MOST; i++) {
    DVI_TRY(residual(own, x, own->R));
    if (dvi__largest((size_t)own->unknowns, own->R) <= own->tolerance * size) return DVI_OK;
    dvi__solver_apply_factor(own->equations.solver, own->R);
    for (int k = 0; k < own->unknowns; k++) x[k] -= own->R[k];
    correction = dvi__largest((size_t)own->unknowns, own->R);
  }
  return dvi__fail(DVI_NOT_CONVERGED, "Newton's method does not reach the tolerance (change %.1e)",
                   correction);
}

/* And the guess, which shots give. */
static dvi_status place(dvi__stepper *self, const dvi__state *state, double h, double part)
{
  const shooter *own = self->own;
  if (own->stacked != NULL)
    return dvi__stacked_shot_place(own->stacked, state->t, h, h / part, state->q, state->p, own->v,
                                   own->guess);
  return dvi__shot_step_place(own->shot, state->t, h, h / part, state->q, state->p, own->v,
                              own->guess);
}

static dvi_status guess(dvi__stepper *self, double h, double *x)
{
  const shooter *own = self->own;
  (void)h;
  memcpy(x, own->guess, (size_t)own->unknowns * sizeof *x);
  return DVI_OK;
}

static dvi_status solve(dvi__stepper *self, const dvi__state *state, double h)
{
  shooter *own = self->own;
  if (own->tolerance > 0) {
    DVI_TRY(place(self, state, h, 1));
    return solve_loosely(own, dvi__largest((size_t)self->system->n, state->q));
  }
  const dvi__stationary_step step = {self, state, h, place, guess};
  DVI_TRY(dvi__stationary_solve(&own->equations, &step));
  /* A shot's ends are taken from its last one. */
  return own->stacked != NULL ? residual(own, own->equations.x, own->R) : DVI_OK;
}

static void find_ends(const shooter *own)
{
  if (own->stacked != NULL)
    dvi__stacked_shot_ends(own->stacked, own->dq, own->dp);
  else
    dvi__shot_step_ends(own->shot, own->equations.x, own->dq, own->dp);
}

static dvi_status find_duration(const dvi__stepper *self, double h, double *duration)
{
  const shooter *own = self->own;
  *duration = h;
  if (dvi__transformed_of(self->system) == NULL) return DVI_OK;
  if (own->stacked != NULL) return dvi__stacked_shot_duration(own->stacked, duration);
  return dvi__shot_step_duration(own->shot, own->equations.x, duration);
}

static dvi_status step(dvi__stepper *self, dvi__state *state, double h)
{
  const shooter *own = self->own;
  double duration;
  memcpy(own->v, self->memory, (size_t)self->system->n * sizeof *own->v);
  DVI_TRY(solve(self, state, h));
  find_ends(own);
  DVI_TRY(find_duration(self, h, &duration));
  memcpy(self->memory, own->v, (size_t)self->system->n * sizeof *own->v);
  dvi__add_compensated_all(self->system->n, state->q, state->q_compensation, own->dq);
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, own->dp);
  dvi__add_compensated(&state->t, &state->t_compensation, duration);
  return DVI_OK;
}

static void explain(const dvi__stepper *self, dvi__text *text)
{
  const shooter *own = self->own;
  const dvi__settings *set = &self->settings;
  dvi__text_add(text, "one-step method: %s%s of order %d, %d stage%s\n",
                one_step_name(set->value[ONE_STEP]),
                set->value[COMPOSITION] > 0 ? ", composed," : "", own->order, set->value[STAGES],
                set->value[STAGES] == 1 ? "" : "s");
  dvi__text_add(text, "quadrature: %s of %d nodes\n", rule_name(set->value[QUADRATURE]),
                set->value[NODES]);
  if (own->stacked != NULL)
    dvi__text_add(text,
                  "kernel: stages and their costates; %d unknowns a step, Jacobian with %d entries "
                  "(%.3g %% of a full one)\n",
                  own->unknowns, dvi__pattern_entries(own->pattern),
                  100.0 * dvi__pattern_entries(own->pattern) / own->unknowns / own->unknowns);
  else
    dvi__text_add(text,
                  "kernel: shots from the start, their derivatives by costates; %d unknowns a "
                  "step, full Jacobian\n",
                  own->unknowns);
  dvi__text_add(text, "solver: Newton's method, last a path followed from shorter steps\n");
}

const dvi__method dvi__shooting = {
    .name = "shooting",
    .summary =
        "any one-step method and a quadrature with both ends; order that of the lower of both",
    .cite = "LeokShingel2012",
    .keys = keys,
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL | DVI__HAMILTONIAN,
    .create = create,
    .destroy = destroy,
    .start = start,
    .step = step,
    .explain = explain,
};
