/* The options of shooting are the one-step method, the quadrature and the type. They determine the
 * course of the shot. */
#include "method/shooting/shooting_options.h"

#include <dvi/quadrature.h>

#include "core/status.h"
#include "method/scheme.h"
#include "space/osculation.h"

enum { NODES_MOST = 16, STAGES_MOST = 20, TAYLOR = DVI__RK_NAMED, FROM_FILE };

/* Two quadratures are added to those of the core. */
enum { EULER_MACLAURIN = DVI_SIMPSON + 1, GAUSS_HERMITE };

static const char *one_step_name(int index)
{
  if (index == TAYLOR) return "taylor";
  return index == FROM_FILE ? "file" : dvi__runge_kutta_name(index);
}

static const char *shooting_rule_name(int index)
{
  if (index == EULER_MACLAURIN) return "euler-maclaurin";
  return index == GAUSS_HERMITE ? "gauss-hermite" : dvi_rule_name((dvi_rule)index);
}

static const char *composition_name(int index)
{
  return index == 0 ? "none" : dvi__scheme_name(index - 1);
}

static const char *shooting_solve_name(int index)
{
  static const char *const name[] = {"auto", "shot", "stages"};
  return index >= 0 && index < DVI__SHOOTING_SOLVES ? name[index] : NULL;
}

const dvi__key dvi__shooting_keys[] = {
    {"onestep", one_step_name, 0, 0, DVI__LEFT_OUT,
     "euler, explicit-midpoint, heun, kutta3, rk4, three-eighths, dormand-prince, butcher6, "
     "cooper-verner, backward-euler, implicit-midpoint, gauss, radau-iia, lobatto-iiia, sdirk, "
     "taylor, or file; default: rk4"},
    {"stages", NULL, 1, STAGES_MOST, DVI__LEFT_OUT,
     "of gauss, radau-iia, lobatto-iiia (2 to 8) and sdirk (2 or 3); of taylor the degree, 1 to "
     "20; default: 2, of taylor 4"},
    {"tableau", NULL, DVI__FILE, 0, 0, "the file of the one-step method's tableau"},
    {"composition", composition_name, 0, 0, 0,
     "none, 4, 6 or 8: the order to which a symmetric one-step method is composed; default: none"},
    {"quadrature", shooting_rule_name, 0, 0, DVI_SIMPSON,
     "trapezoid, simpson, lobatto, clenshaw-curtis, euler-maclaurin or gauss-hermite; default: "
     "simpson"},
    {"nodes", NULL, 2, NODES_MOST, DVI__LEFT_OUT,
     "of lobatto and clenshaw-curtis, 2 to 16; default: the fewest whose order reaches that of the "
     "one-step method"},
    {"terms", NULL, 0, STAGES_MOST, DVI__LEFT_OUT,
     "of euler-maclaurin, beside the trapezoid, and of gauss-hermite, at each end, up to 20; "
     "default: as nodes"},
    {"solve", shooting_solve_name, 0, 0, DVI__SHOOTING_AUTO,
     "shot: for the start, by dense derivatives of the shot; stages: for all stages, as one sparse "
     "system; auto: the cheaper; default: auto"},
    {"tolerance", NULL, DVI__POSITIVE, 0, 0,
     "the residual, relative to the coordinates, at which the search for v ends: to see what a "
     "loose one does; default: roundoff"},
    {"type", NULL, 1, 3, DVI__LEFT_OUT,
     "of generating functions: 1 (q0,q1), 2 (q0,p1) or 3 (p0,q1); default: 1, with a Hamiltonian "
     "2"},
    {0},
};

/* ---- one-step method ---- */

static dvi_status choose_built_in(dvi__settings *settings, dvi__runge_kutta *method)
{
  int fewest, most, *stages = &settings->value[DVI__SHOOTING_STAGES];
  const int choice = settings->value[DVI__SHOOTING_ONE_STEP];
  dvi__runge_kutta_range(choice, &fewest, &most);
  if (*stages == DVI__LEFT_OUT) *stages = fewest;
  if (*stages >= fewest && *stages <= most) return dvi__runge_kutta_named(choice, *stages, method);
  return dvi__fail(DVI_BAD_OPTION, "shooting: onestep=%s has %d%s stage%s, not stages=%d",
                   one_step_name(choice), fewest, most > fewest ? " or more" : "",
                   most == 1 ? "" : "s", *stages);
}

/* Set the Taylor method, whose default degree gives order 4, as rk4. */
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
  int *choice = &settings->value[DVI__SHOOTING_ONE_STEP];
  const int has_file = settings->file != NULL;
  if (*choice == DVI__LEFT_OUT) *choice = has_file ? FROM_FILE : DVI__RK_4;
  if (has_file != (*choice == FROM_FILE))
    return dvi__fail(
        DVI_BAD_OPTION,
        has_file ? "shooting: onestep=%s is built in; with tableau=%s only onestep=file is possible"
                 : "shooting: onestep=%s needs the name of the file, tableau=%s",
        one_step_name(*choice), has_file ? settings->file : "...");
  if (*choice == TAYLOR) return choose_taylor(self, &settings->value[DVI__SHOOTING_STAGES], method);
  if (!has_file) return choose_built_in(settings, method);
  const dvi_status status = dvi__runge_kutta_read(settings->file, method);
  if (status != DVI_OK) return dvi__fail_in(status, "shooting");
  settings->value[DVI__SHOOTING_STAGES] = method->stages;
  self->fingerprint = dvi__runge_kutta_fingerprint(method);
  self->fingerprinted = "coefficients of the tableau";
  return DVI_OK;
}

/* Raise the order of the one-step method to that of the composition. */
static dvi_status choose_composition(const dvi__settings *settings, dvi__runge_kutta *method)
{
  const int choice = settings->value[DVI__SHOOTING_COMPOSITION];
  if (choice == 0) return DVI_OK;
  if (!method->symmetric)
    return dvi__fail(DVI_BAD_OPTION,
                     "shooting: composition=%s raises the order of symmetric one-step methods "
                     "alone, and onestep=%s is none; implicit-midpoint, gauss and lobatto-iiia are",
                     composition_name(choice),
                     one_step_name(settings->value[DVI__SHOOTING_ONE_STEP]));
  const int order = dvi__scheme_at(choice - 1)->order;
  method->order = method->order < order ? order : method->order;
  return DVI_OK;
}

/* ---- quadrature ---- */

static dvi_status choose_rule(dvi__settings *settings, int order)
{
  int *nodes = &settings->value[DVI__SHOOTING_NODES];
  const dvi_rule rule = (dvi_rule)settings->value[DVI__SHOOTING_QUADRATURE];
  const int fixed = rule == DVI_TRAPEZOID ? 2 : rule == DVI_SIMPSON ? 3 : 0;
  if (!fixed && rule != DVI_LOBATTO && rule != DVI_CLENSHAW_CURTIS)
    return dvi__fail(DVI_BAD_OPTION,
                     "shooting: quadrature=%s does not have both ends of the step among its nodes, "
                     "where the shot starts and meets q1; possible are trapezoid, simpson, "
                     "lobatto, clenshaw-curtis, euler-maclaurin and gauss-hermite",
                     shooting_rule_name((int)rule));
  if (*nodes == DVI__LEFT_OUT)
    for (*nodes = fixed ? fixed : 2;
         !fixed && dvi_quadrature_order(rule, *nodes) < order && *nodes < NODES_MOST;)
      ++*nodes;
  if (fixed && *nodes != fixed)
    return dvi__fail(DVI_BAD_OPTION, "shooting: quadrature=%s has %d nodes, not nodes=%d",
                     shooting_rule_name((int)rule), fixed, *nodes);
  return DVI_OK;
}

static dvi__osculation osculation_of(const dvi__settings *settings)
{
  return settings->value[DVI__SHOOTING_QUADRATURE] == EULER_MACLAURIN ? DVI__EULER_MACLAURIN
                                                                      : DVI__HERMITE;
}

static int is_osculation(const dvi__settings *settings)
{
  return settings->value[DVI__SHOOTING_QUADRATURE] >= EULER_MACLAURIN;
}

static dvi_status choose_osculation(const dvi_system *system, dvi__settings *settings, int order)
{
  int *terms = &settings->value[DVI__SHOOTING_TERMS],
      *nodes = &settings->value[DVI__SHOOTING_NODES];
  const char *name = shooting_rule_name(settings->value[DVI__SHOOTING_QUADRATURE]);
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
  int *terms = &settings->value[DVI__SHOOTING_TERMS];
  if (is_osculation(settings)) return choose_osculation(system, settings, order);
  if (*terms > 0)
    return dvi__fail(DVI_BAD_OPTION,
                     "shooting: quadrature=%s has no terms; euler-maclaurin and gauss-hermite have",
                     shooting_rule_name(settings->value[DVI__SHOOTING_QUADRATURE]));
  *terms = 0;
  return choose_rule(settings, order);
}

static int order_of_quadrature(const dvi__settings *settings)
{
  if (is_osculation(settings))
    return dvi__osculation_order(osculation_of(settings), settings->value[DVI__SHOOTING_TERMS]);
  return dvi_quadrature_order((dvi_rule)settings->value[DVI__SHOOTING_QUADRATURE],
                              settings->value[DVI__SHOOTING_NODES]);
}

/* ---- course ---- */

/* Add the piece from one node to the next, in the substeps of the composition. The points between
 * the substeps have the weight 0. */
static void shooting_add_piece(const dvi__settings *settings, double from, double to, double weight,
                               dvi__course *course)
{
  const int choice = settings->value[DVI__SHOOTING_COMPOSITION];
  const dvi__scheme *scheme = choice > 0 ? dvi__scheme_at(choice - 1) : NULL;
  double gone = 0;
  for (int i = 0; scheme != NULL && i + 1 < scheme->substeps; i++) {
    gone += dvi__scheme_part(scheme, i);
    course->c[++course->pieces] = from + gone * (to - from);
  }
  course->c[++course->pieces] = to;
  course->b[course->pieces] = weight;
}

static dvi_status shooting_plot_course(const dvi__settings *settings, dvi__course *course)
{
  double c[NODES_MOST], b[NODES_MOST];
  const int nodes = settings->value[DVI__SHOOTING_NODES];
  *course = (dvi__course){0};
  if (is_osculation(settings)) {
    dvi__osculation_weights(osculation_of(settings), settings->value[DVI__SHOOTING_TERMS],
                            course->weight);
    course->count = dvi__osculation_count(osculation_of(settings),
                                          settings->value[DVI__SHOOTING_TERMS]);
  }
  DVI_TRY(dvi_quadrature(course->count > 0 ? DVI_TRAPEZOID
                                           : (dvi_rule)settings->value[DVI__SHOOTING_QUADRATURE],
                         nodes, c, b));
  course->b[0] = b[0];
  for (int i = 1; i < nodes; i++) shooting_add_piece(settings, c[i - 1], c[i], b[i], course);
  return DVI_OK;
}

/* ---- all options ---- */

static dvi_status choose_type(const dvi_system *system, int *type)
{
  const int on_H = (system->terms & DVI__HAMILTONIAN) != 0;
  if (*type == DVI__LEFT_OUT) *type = on_H ? 2 : 1;
  if (*type != 1 || !on_H) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED,
                   "shooting: type=1 shoots for a discrete Lagrangian, and the system declares a "
                   "Hamiltonian, which may have none; type=2 and 3 can, and hamiltonian:type=1");
}

dvi_status dvi__shooting_choose(dvi__stepper *self, dvi__shooting_plan *plan)
{
  dvi__settings *settings = &self->settings;
  *plan = (dvi__shooting_plan){0};
  DVI_TRY(choose_type(self->system, &settings->value[DVI__SHOOTING_TYPE]));
  DVI_TRY(choose_one_step(self, &plan->method));
  DVI_TRY(choose_composition(settings, &plan->method));
  DVI_TRY(choose_quadrature(self->system, settings, plan->method.order));
  plan->quadrature_order = order_of_quadrature(settings);
  return shooting_plot_course(settings, &plan->course);
}

void dvi__shooting_explain_options(const dvi__settings *settings, int order, dvi__text *text)
{
  const int *value = settings->value;
  dvi__text_add(text, "one-step method: %s%s of order %d, %d stage%s\n",
                one_step_name(value[DVI__SHOOTING_ONE_STEP]),
                value[DVI__SHOOTING_COMPOSITION] > 0 ? ", composed," : "", order,
                value[DVI__SHOOTING_STAGES], value[DVI__SHOOTING_STAGES] == 1 ? "" : "s");
  dvi__text_add(text, "quadrature: %s of %d nodes\n",
                shooting_rule_name(value[DVI__SHOOTING_QUADRATURE]), value[DVI__SHOOTING_NODES]);
}
