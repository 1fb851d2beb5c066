/* Galerkin variational integrators in a space of the user's own (dvi/shapes.h).
 *
 * Space: polynomials of degree d, and in the coordinates that have them the user's functions.
 * Quadrature: a rule of galerkin's with r points, at least as many as there are functions, or the
 * user's.
 *   Ld(q0,q1) = ext over such paths q from q0 to q1 of  h sum_j b_j L(t0 + c_j h, q_j, q'_j/h),
 *   p0 = -D1 Ld, p1 = D2 Ld.
 * The rows are those of step/element/action.h in another space (step/element/user_element.h).
 *
 * Symplectic; symmetric where space and quadrature are. The polynomials guarantee order min(2d, u,
 * 2(u-d+1)) for a quadrature of order u. The functions may do better, and the user may say so.
 *
 * Source: Marsden and West 2001, sec. 2.2.6; Hall and Leok 2015 (spaces other than polynomials). */
#include <math.h>
#include <string.h>

#include "step/element/user_element.h"
#include "core/hash.h"
#include "core/memory.h"
#include "method/element/element_step.h"
#include "method/one_step.h"
#include "num/compensated.h"
#include "space/user_basis.h"

enum { DEGREE, QUADRATURE, NODES, DEGREE_MOST = 20 };

enum { RULES = DVI_SIMPSON + 1 };

static const char *shaped_rule_name(int index)
{
  return index == RULES ? "own" : dvi_rule_name((dvi_rule)index);
}

static const dvi__key shaped_keys[] = {
    {"degree", NULL, 1, DEGREE_MOST, 1,
     "degree of the polynomials that all coordinates have, 1 to 20; default: 1"},
    {"quadrature", shaped_rule_name, 0, 0, DVI__LEFT_OUT,
     "as of galerkin; own: the program's; default: the program's, or gauss"},
    {"nodes", NULL, 1, DVI_SHAPES_POINTS_MOST, DVI__LEFT_OUT,
     "quadrature points, at least as many as there are functions with those of the polynomials, at "
     "most 80; default: the fewest of that number"},
    {0},
};

/* Memory beside that of the step, which is the space's fingerprint at the last step's length, or at
 * its own before the first. */
enum { FINGERPRINT = DVI__CARRIED, CARRIED = 1 };

typedef struct shaped_options {
  int degree, rule, nodes; /* rule is a dvi_rule, or RULES for the program's own */
} shaped_options;

static shaped_options shaped_options_of(const dvi__stepper *self)
{
  const int *value = self->settings.value;
  return (shaped_options){
      .degree = value[DEGREE], .rule = value[QUADRATURE], .nodes = value[NODES]};
}

typedef struct shaped_galerkin {
  dvi__one_step one;
  dvi__user_basis *space;
  int coordinates;    /* number of coordinates with the functions */
  double fingerprint; /* fingerprint of the space at its own length */
} shaped_galerkin;

/* ---- coordinates with the functions ---- */

static dvi_status mark_listed_coordinates(const dvi_shapes *shapes, int n, char *has)
{
  for (int k = 0; k < shapes->coordinate_count; k++) {
    const int i = shapes->coordinates[k];
    if (i < 0 || i >= n)
      return dvi__fail(DVI_BAD_ARGUMENT,
                       "shapes %s: there is no coordinate %d; they are counted from 0 to %d",
                       shapes->name, i, n - 1);
    if (has[i])
      return dvi__fail(DVI_BAD_ARGUMENT, "shapes %s: coordinate %d is listed twice", shapes->name,
                       i);
    has[i] = 1;
  }
  if (shapes->coordinates == NULL) memset(has, 1, (size_t)n);
  return DVI_OK;
}

/* ---- specification ---- */

/* Take the space's name, a key that the program's struct gives. A name in the specification must be
 * the same. */
static dvi_status shaped_take_name(dvi__stepper *self)
{
  char **rest = &self->settings.rest;
  char *wanted = dvi__written("space=%s", self->shapes->name);
  if (wanted == NULL)
    return dvi__fail(DVI_NO_MEMORY, "shaped-galerkin: no memory for its specification");
  if (*rest != NULL && strcmp(*rest, wanted) != 0) {
    dvi__release(wanted);
    return dvi__fail(DVI_BAD_OPTION,
                     "shaped-galerkin: '%s' is not possible; it takes degree, quadrature, nodes, "
                     "and as space the name of its shapes, %s",
                     *rest, self->shapes->name);
  }
  dvi__release(*rest);
  *rest = wanted;
  return DVI_OK;
}

/* Take the program's quadrature, which stands in the specification, too. */
static dvi_status shaped_take_own_rule(const dvi__stepper *self, shaped_options *o)
{
  const int points = self->shapes->points;
  if (o->rule == DVI__LEFT_OUT) o->rule = RULES;
  if (o->nodes == DVI__LEFT_OUT) o->nodes = points;
  if (o->rule == RULES && o->nodes == points) return DVI_OK;
  return dvi__fail(
      DVI_BAD_OPTION,
      "shaped-galerkin: the shapes %s have %d points of their own; leave quadrature and nodes out",
      self->shapes->name, points);
}

static dvi_status shaped_take_rule(const dvi__stepper *self, int functions, shaped_options *o)
{
  if (o->rule == DVI__LEFT_OUT) o->rule = DVI_GAUSS;
  const dvi_rule rule = (dvi_rule)o->rule;
  if (o->rule == RULES)
    return dvi__fail(
        DVI_BAD_OPTION,
        "shaped-galerkin: quadrature=own, but the shapes %s have no points of their own",
        self->shapes->name);
  if (o->nodes == DVI__LEFT_OUT) o->nodes = dvi__fewest_nodes(rule, functions);
  if (dvi_quadrature_order(rule, o->nodes) == 0)
    return dvi__fail(DVI_BAD_OPTION, "shaped-galerkin: quadrature %s has no rule with %d points",
                     dvi_rule_name(rule), o->nodes);
  return DVI_OK;
}

/* Settle the options. Rule and nodes that are chosen here become part of the specification. */
static dvi_status shaped_settle(dvi__stepper *self)
{
  shaped_options o = shaped_options_of(self);
  const int functions = o.degree + self->shapes->functions;
  DVI_TRY(shaped_take_name(self));
  DVI_TRY(self->shapes->point != NULL ? shaped_take_own_rule(self, &o)
                                      : shaped_take_rule(self, functions, &o));
  self->settings.value[QUADRATURE] = o.rule;
  self->settings.value[NODES] = o.nodes;
  if (o.nodes >= functions) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION,
                   "shaped-galerkin: %d quadrature points see at most %d of the %d velocity modes, "
                   "%d of polynomials and %d functions; there must be at least as many points",
                   o.nodes, o.nodes, functions, o.degree, self->shapes->functions);
}

/* ---- create ---- */

static void shaped_explain(const dvi__stepper *self, dvi__text *text)
{
  const shaped_galerkin *own = self->own;
  const shaped_options o = shaped_options_of(self);
  dvi__text_add(text,
                "space: polynomials of degree %d, and in %d of %d coordinates %d function%s of the "
                "program's, %s\n",
                o.degree, own->coordinates, self->system->n, self->shapes->functions,
                self->shapes->functions == 1 ? "" : "s", self->shapes->name);
  dvi__text_add(text, "quadrature: %s, %d points\n", shaped_rule_name(o.rule), o.nodes);
}

static dvi_status shaped_place(dvi__stepper *self, const dvi__state *state, double h, double part)
{
  const shaped_galerkin *own = self->own;
  (void)part;
  DVI_TRY(dvi__user_basis_prepare(own->space, h));
  dvi__user_element_place(own->one.of, state->t, h, state->q, state->p);
  return DVI_OK;
}

DVI__STEP_KIND(user_element, shaped_place, shaped_explain, .renewed = 1);

static int smaller_of_two(int a, int b)
{
  return a < b ? a : b;
}

static int shaped_order(const dvi__stepper *self, const dvi__user_basis *space)
{
  const int d = shaped_options_of(self).degree, u = dvi__user_basis_quadrature_order(space),
            order = smaller_of_two(smaller_of_two(2 * d, u), 2 * (u - d + 1));
  if (self->shapes->order > 0) return self->shapes->order;
  return order > 1 ? order : 1;
}

/* Make the parts of a stepper, which owns the space from the moment there is one. */
static dvi_status shaped_make(dvi__stepper *self, const char *has)
{
  const shaped_options o = shaped_options_of(self);
  dvi__user_element *element = NULL;
  dvi__user_basis *space = NULL;
  DVI_TRY(dvi__user_basis_create(self->shapes, o.degree, (dvi_rule)o.rule, o.nodes, &space));
  const dvi__shapes shapes = dvi__user_basis_shapes(space);
  dvi_status status = dvi__user_element_create(self->system, &shapes, has, o.degree, self->counters,
                                               &element);
  if (status == DVI_OK)
    status = dvi__one_step_create(self, sizeof(shaped_galerkin), &kind, element, CARRIED);
  shaped_galerkin *own = self->own;
  if (own == NULL) {
    dvi__user_basis_destroy(&space);
    return status;
  }
  own->space = space;
  for (int i = 0; i < self->system->n; i++) own->coordinates += has[i];
  own->fingerprint = dvi__user_basis_fingerprint_of(space).sum;
  self->fingerprint = dvi__hash(DVI__HASH_START, (size_t)self->system->n, has);
  self->fingerprinted = "coordinates that have the functions of its space";
  self->order = shaped_order(self, space);
  self->symmetric = dvi__user_basis_symmetric(space);
  return status;
}

static dvi_status shaped_create(dvi__stepper *self)
{
  if (self->shapes == NULL)
    return dvi__fail(DVI_BAD_OPTION, "shaped-galerkin: there are no shapes: a program gives them "
                                     "to dvi_integrator_options (dvi/shapes.h)");
  if (self->shapes->flow != NULL)
    return dvi__fail(DVI_BAD_OPTION,
                     "shaped-galerkin: the shapes %s are a flow; flow-galerkin takes it",
                     self->shapes->name);
  DVI_TRY(shaped_settle(self));
  char *has = DVI_NEW(char, self->system->n);
  if (has == NULL) return dvi__fail(DVI_NO_MEMORY, "shaped-galerkin: no memory");
  dvi_status status = mark_listed_coordinates(self->shapes, self->system->n, has);
  if (status == DVI_OK) status = shaped_make(self, has);
  dvi__release(has);
  return status;
}

static void shaped_destroy(dvi__stepper *self)
{
  shaped_galerkin *own = self->own;
  if (own == NULL) return;
  dvi__user_basis *space = own->space;
  dvi__one_step_destroy(self);
  dvi__user_basis_destroy(&space);
}

/* ---- step ---- */

static void shaped_start(dvi__stepper *self, const double *v)
{
  const shaped_galerkin *own = self->own;
  dvi__one_step_start(self, v);
  self->memory[FINGERPRINT] = own->fingerprint;
}

static dvi_status shaped_step(dvi__stepper *self, dvi__state *state, double h)
{
  const shaped_galerkin *own = self->own;
  const dvi__one_step *one = &own->one;
  DVI_TRY(dvi__one_step_solve(self, state, h));
  dvi__user_element_ends(one->of, one->x, one->dq, one->dp);
  DVI_TRY(dvi__one_step_move(self, state, h, one->x));
  dvi__add_compensated_all(self->system->n, state->p, state->p_compensation, one->dp);
  self->memory[FINGERPRINT] = dvi__user_basis_fingerprint_of(own->space).sum;
  return DVI_OK;
}

/* Evaluate the path, or NaN where a callback fails, which the driver reports. */
static void shaped_path(const dvi__stepper *self, const double *q0, double h, double tau, double *q,
                        double *v)
{
  const shaped_galerkin *own = self->own;
  const dvi__one_step *one = &own->one;
  if (dvi__user_basis_prepare(own->space, h) != DVI_OK) {
    for (int i = 0; i < self->system->n; i++) {
      if (q != NULL) q[i] = (double)NAN;
      if (v != NULL) v[i] = (double)NAN;
    }
    return;
  }
  dvi__user_element_path(one->of, self->memory + one->last, h, tau, q, v);
  for (int i = 0; q != NULL && i < self->system->n; i++) q[i] += q0[i];
}

/* Compare fingerprints to nine digits, as those of the system (checkpoint.c). */
static int shaped_recognizes(const dvi__stepper *self, const double *memory)
{
  const shaped_galerkin *own = self->own;
  const double h = memory[DVI__LENGTH];
  if (dvi__user_basis_prepare(own->space, h != 0 ? h : self->shapes->h) != DVI_OK) return 0;
  const dvi__user_basis_fingerprint here = dvi__user_basis_fingerprint_of(own->space);
  return fabs(here.sum - memory[FINGERPRINT]) <= 1e-9 * here.size;
}

const dvi__method dvi__shaped_galerkin = {
    .name = "shaped-galerkin",
    .summary = "polynomials and functions of the program's own, any quadrature; symplectic",
    .cite = "HallLeok2015",
    .keys = shaped_keys,
    .takes_rest = 1,
    .takes_shapes = 1,
    .uses = DVI__CONSTANT_MASS | DVI__LAGRANGIAN | DVI__POTENTIAL | DVI__VECTOR_POTENTIAL,
    .create = shaped_create,
    .destroy = shaped_destroy,
    .start = shaped_start,
    .step = shaped_step,
    .path = shaped_path,
    .recognizes = shaped_recognizes,
    .explain = dvi__one_step_explain,
};
