/* Discontinuous Galerkin variational integrators on the cotangent bundle, with the Dirac constraint phi = p - alpha(q) = 0 at the averages.
 *
 *     S = sum over elements of h sum_i b_i (P_i.Q'_i/h - H(Q_i)) + sum over nodes of [q].{p} - h lambda.phi({q}, {p})
 *
 * with polynomials q and p of degree d. Varying p_j gives, for every quadrature that is exact for phi_j q',
 *     integral of phi_j q' + phi_j(0) ([q] - h lambda)/2 + phi_j(1) ([q'] - h lambda')/2 = 0,
 * whose component along the Legendre polynomial of degree d says that h lambda' - [q'] = (-1)^(d+1) (h lambda - [q]). It is 0 at the start, and so everywhere:
 * q is constant in the elements, lambda = [q]/h, and sum_j of the rows of q is, for every degree and quadrature,
 *     alpha({q'}) = alpha({q}) - h H_q({q} + [q]/2) + (Dalpha({q}))^T [q]/2 + (Dalpha({q'}))^T [q']/2,    {q'} = {q} + [q]/2 + [q']/2:
 * the element of degree 0 of action/discontinuous.h. That is so because H has no momenta. Order 2, symmetric.
 * Source: Kraus, Yoshimura and Peng (talk), with the halves of the multipliers. */
#include "core/status.h"
#include "method/dg_step.h"

enum { DEGREE, NODES, ALARM };

static const dvi__key keys[] = {
    {"degree", NULL, 1, DVI__DG_POINTS_MOST, 1, "of the polynomials, 1 to 8; all give the same steps; left out: 1"},
    {"nodes", NULL, 1, DVI__DG_POINTS_MOST, DVI__LEFT_OUT, "Gauss points, degree to 8; all give the same steps; left out: degree"},
    DVI__ALARM_KEY,
    {0},
};

static dvi_status create(dvi__stepper *self)
{
  int *value = self->settings.value;
  const dvi__dg_space space = {.degree = 0, .nodes = 1, .flux = DVI__AVERAGE_FLUX, .points = 1};
  if (value[NODES] == DVI__LEFT_OUT) value[NODES] = value[DEGREE];
  if (value[NODES] < value[DEGREE])
    return dvi__fail(DVI_BAD_OPTION, "dg-phase: nodes=%d are too few for degree %d; take %d or more", value[NODES], value[DEGREE],
                     value[DEGREE]);
  self->order = 2;
  return dvi__dg_create(self, &space, value[ALARM]);
}

const dvi__method dvi__dg_phase = {
    .name = "dg-phase",
    .summary = "discontinuous Galerkin with the constraint p = alpha(q) at the averages; order 2; degenerate Lagrangians only",
    .cite = "KrausYoshimuraPeng",
    .keys = keys,
    .create = create,
    DVI__DG_OPERATIONS,
};
