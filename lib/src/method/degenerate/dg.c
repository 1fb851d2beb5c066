/* Discontinuous Galerkin variational integrators for degenerate Lagrangians alpha(q).v - H(q).
 *
 *     S = sum over elements of h sum_i b_i L(Q_i, V_i) + sum over nodes of N(q-, q+),
 *     N = [q].alpha({q}) + [q].c[q]/2 (average flux)
 *
 * Each element has polynomials of degree d, which jump between two elements. The state q is the q*
 * of step/degenerate/discontinuous.h, and p is alpha(q*). The method's memory holds the jump. The
 * oscillation of the jump is a parasite that can break a run, so that every step checks its size.
 * An alarm stops the run or is counted. */
#include "core/status.h"
#include "method/degenerate/dg_step.h"

enum { DEGREE, NODES, FLUX, POINTS, ALARM };

static const char *flux_name(int index)
{
  static const char *const name[] = {"average", "left", "right", "path"};
  return index >= 0 && index < 4 ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"degree", NULL, 0, DVI__DG_POINTS_MOST - 1, 2, "of the polynomials, 0 to 7; default: 2"},
    {"nodes", NULL, 1, DVI__DG_POINTS_MOST, DVI__LEFT_OUT,
     "Gauss points of an element, degree+1 to 8; default: degree+1"},
    {"flux", flux_name, 0, 0, DVI__AVERAGE_FLUX, "average, left, right or path; default: average"},
    {"points", NULL, 1, DVI__DG_POINTS_MOST, DVI__LEFT_OUT,
     "Gauss points of flux=path, 1 to 8; default: 2 (1 of other fluxes)"},
    DVI__ALARM_KEY,
    {0},
};

typedef struct dg_options {
  int degree, nodes, points, alarm;
  dvi__flux flux;
} dg_options;

/* Read the options. Numbers that are chosen here become part of the specification. */
static dg_options dg_read_options(dvi__settings *settings)
{
  int *value = settings->value;
  dg_options o = {.degree = value[DEGREE],
                  .nodes = value[NODES],
                  .points = value[POINTS],
                  .alarm = value[ALARM],
                  .flux = (dvi__flux)value[FLUX]};
  if (o.nodes == DVI__LEFT_OUT) o.nodes = value[NODES] = o.degree + 1;
  if (o.points == DVI__LEFT_OUT) o.points = value[POINTS] = o.flux == DVI__PATH_FLUX ? 2 : 1;
  return o;
}

static dvi_status dg_check_options(const dg_options *o)
{
  if (o->nodes <= o->degree)
    return dvi__fail(DVI_BAD_OPTION,
                     "dg: nodes=%d leave a polynomial of degree %d undetermined; take %d or more",
                     o->nodes, o->degree, o->degree + 1);
  if (o->points == 1 || o->flux == DVI__PATH_FLUX) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION, "dg: flux=%s has one point; points=%d goes with flux=path",
                   flux_name((int)o->flux), o->points);
}

static dvi_status check_stiffness(const dvi__settings *settings, int n)
{
  if (settings->listed > 1 && settings->listed != n)
    return dvi__fail(
        DVI_BAD_OPTION,
        n <= DVI__LIST_MOST
            ? "dg: stiffness has %d numbers; one, or one for each of the %d coordinates is needed"
            : "dg: stiffness has %d numbers; one is needed, for all of the %d coordinates",
        settings->listed, n);
  for (int i = 0; i < settings->listed; i++)
    if (settings->list[i] == 0)
      return dvi__fail(
          DVI_BAD_OPTION,
          "dg: number %d of stiffness is 0; positive ones are possible, or none at all", i + 1);
  return DVI_OK;
}

/* These orders were measured on massless-particle and vortices (tests/method/degenerate/test_dg.c).
 * For even S the solution and the jump share the multiplier 1, which costs two orders. A stiffness
 * that does not change with h adds c j^2/2 per node of the smooth jump j = O(h^S), that is
 * O(h^(2S-1)) to the energy. A flux at one side has the symmetric part of Dalpha as its
 * stiffness. */
static int dg_order_of(const dg_options *o, int has_stiffness)
{
  const int S = o->degree + 1;
  if (has_stiffness || o->flux == DVI__LEFT_FLUX || o->flux == DVI__RIGHT_FLUX) return 2 * S - 1;
  return S % 2 == 1 ? 2 * S : 2 * S - 2;
}

static dvi_status dg_create(dvi__stepper *self)
{
  const dg_options o = dg_read_options(&self->settings);
  DVI_TRY(dg_check_options(&o));
  DVI_TRY(check_stiffness(&self->settings, self->system->n));
  self->order = dg_order_of(&o, self->settings.listed > 0);
  const dvi__dg_space space = {.degree = o.degree,
                               .nodes = o.nodes,
                               .flux = o.flux,
                               .points = o.points,
                               .stiffness_count = self->settings.listed,
                               .stiffness = self->settings.list};
  return dvi__dg_create(self, &space, o.alarm,
                        "from the start on, a stiffness (dg:stiffness=c) keeps it small");
}

const dvi__method dvi__dg = {
    .name = "dg",
    .summary = "discontinuous Galerkin with a numerical flux; order up to 2 (degree+1); degenerate "
               "Lagrangians only",
    .cite = "KrausYoshimuraPeng",
    .keys = keys,
    .list = "stiffness",
    .list_help =
        "c of the jump, one for all coordinates or one for each (c1:c2:...); default: none",
    .create = dg_create,
    DVI__DG_OPERATIONS,
};
