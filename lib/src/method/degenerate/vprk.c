/* Variational partitioned Runge-Kutta methods for degenerate Lagrangians alpha(q).v - H(q),
 * projected onto p = alpha(q).
 *
 *     Ld = h sum_i b_i L(Q_i, V_i) with the stages of step/degenerate/partitioned.h,
 *     stationary under q1 = q0 + h sum_i b_i V_i
 *
 * Without a projection the momenta leave p = alpha(q), and the order is lost. Each projection kicks
 * (q, p) along Omega^-1 grad phi, with phi = p - alpha(q).
 *     symmetric   the same multiplier before and after the step, solved with the step;
 *                 symmetric, order 2s (Gauss)
 *     midpoint    the same, with grad alpha at the mean of both ends; symmetric, lower order
 *     symplectic  the last step's multiplier before the step, its own after the step; the
 *                 multiplier is carried, and its alternating part is a parasite
 *     post        after the step alone
 *     none        for comparison
 *
 * Source: Kraus 2017, arXiv:1708.07356. */
#include "core/status.h"
#include "method/degenerate/partitioned_step.h"

enum { NODES, TABLEAU, PROJECTION };

static const char *tableau_name(int index)
{
  static const char *const name[] = {"gauss", "lobatto-iiie"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

static const char *projection_name(int index)
{
  static const char *const name[] = {"symmetric", "midpoint", "symplectic", "post", "none"};
  return index >= 0 && index < 5 ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"nodes", NULL, 1, 6, 2, "the stages, 1 to 6; default: 2"},
    {"tableau", tableau_name, 0, 0, DVI__GAUSS,
     "gauss or lobatto-iiie (2 stages or more); default: gauss"},
    {"projection", projection_name, 0, 0, DVI__SYMMETRIC,
     "symmetric, midpoint, symplectic, post or none; default: symmetric"},
    {0},
};

/* These orders were measured where the projections differ, on massless-particle and vortices
 * (tests/method/degenerate/test_vprk.c). A projection on one side alone, or along directions that
 * are accurate to O(h), reduces the order of the tableau. */
static int vprk_order_of(dvi__tableau tableau, int s, dvi__projection projection)
{
  const int gauss = tableau == DVI__GAUSS, full = gauss ? 2 * s : 2 * s - 2;
  switch (projection) {
  case DVI__NO_PROJECTION: return gauss ? 2 * ((s + 1) / 2) : s > 2 ? 2 * ((s - 1) / 2) : 2;
  case DVI__MIDPOINT_PROJECTION: return gauss ? 2 * (s / 2) + 2 : s > 2 ? 2 * (s / 2) : 2;
  case DVI__POST_PROJECTION: return gauss || s == 2 ? full : full - 1;
  default: return full;
  }
}

static dvi_status vprk_create(dvi__stepper *self)
{
  const int *value = self->settings.value, nodes = value[NODES];
  const dvi__tableau tableau = (dvi__tableau)value[TABLEAU];
  const dvi__projection projection = (dvi__projection)value[PROJECTION];
  if (tableau == DVI__LOBATTO_IIIE && nodes < 2)
    return dvi__fail(
        DVI_BAD_OPTION,
        "vprk: tableau=lobatto-iiie has its nodes at both ends; nodes=2 or more is needed");
  self->order = vprk_order_of(tableau, nodes, projection);
  self->symmetric = projection == DVI__SYMMETRIC || projection == DVI__MIDPOINT_PROJECTION;
  return dvi__partitioned_step_create(self, tableau, nodes, projection);
}

const dvi__method dvi__vprk = {
    .name = "vprk",
    .summary = "partitioned Runge-Kutta, projected onto p = alpha(q); order 2s; degenerate "
               "Lagrangians only",
    .cite = "Kraus2017",
    .keys = keys,
    .needs = DVI__ONE_FORM,
    .uses = DVI__ONE_FORM | DVI__POTENTIAL,
    .create = vprk_create,
    DVI__PARTITIONED_OPERATIONS,
    DVI__PARTITIONED_LANES,
};
