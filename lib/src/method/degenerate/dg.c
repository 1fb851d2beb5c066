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

static dvi_status dg_choose(int *value)
{
  if (value[NODES] == DVI__LEFT_OUT) value[NODES] = value[DEGREE] + 1;
  if (value[POINTS] == DVI__LEFT_OUT) value[POINTS] = value[FLUX] == DVI__PATH_FLUX ? 2 : 1;
  if (value[NODES] <= value[DEGREE])
    return dvi__fail(DVI_BAD_OPTION,
                     "dg: nodes=%d leave a polynomial of degree %d undetermined; take %d or more",
                     value[NODES], value[DEGREE], value[DEGREE] + 1);
  if (value[POINTS] == 1 || value[FLUX] == DVI__PATH_FLUX) return DVI_OK;
  return dvi__fail(DVI_BAD_OPTION, "dg: flux=%s has one point; points=%d goes with flux=path",
                   flux_name(value[FLUX]), value[POINTS]);
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
static int dg_order_of(const dvi__settings *settings)
{
  const int S = settings->value[DEGREE] + 1, flux = settings->value[FLUX];
  if (settings->listed > 0 || flux == DVI__LEFT_FLUX || flux == DVI__RIGHT_FLUX) return 2 * S - 1;
  return S % 2 == 1 ? 2 * S : 2 * S - 2;
}

static dvi_status dg_create(dvi__stepper *self)
{
  int *value = self->settings.value;
  DVI_TRY(dg_choose(value));
  DVI_TRY(check_stiffness(&self->settings, self->system->n));
  self->order = dg_order_of(&self->settings);
  const dvi__dg_space space = {.degree = value[DEGREE],
                               .nodes = value[NODES],
                               .flux = (dvi__flux)value[FLUX],
                               .points = value[POINTS],
                               .stiffness_count = self->settings.listed,
                               .stiffness = self->settings.list};
  return dvi__dg_create(self, &space, value[ALARM],
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
