/* Forces at the nodes of a path in a chart that is centred at its start. The rows have them beside
 * L_q already. A force adds to the angular momentum what it has at its node, so that the momentum
 * f = h b_j F_j is f + more at the end of the path (system/chart/centring.h). */
#include "core/memory.h"
#include "core/status.h"
#include "step/element/action_struct.h"

struct dvi__carried_forces {
  dvi__action *action;
  double *F;      /* [n*r] */
  double *f, *xi; /* [n] the momentum and the point of one node */
  double *change; /* [joint entries] a column of derivatives of f */
};

typedef dvi__carried_forces forces_term;

/* Gather the momentum that the force adds at node j, and the point. */
static void momentum_of_node(const forces_term *x, const dvi__row_path *p, int j)
{
  for (int i = 0; i < p->n; i++) {
    x->f[i] = p->h * p->weight[j] * x->F[i * p->r + j];
    x->xi[i] = p->Q[i * p->r + j];
  }
}

static dvi_status forces_rows(void *of, const dvi__row_path *p, const double *own, double *R,
                              double *dp, double *own_R)
{
  forces_term *x = of;
  (void)own, (void)own_R;
  DVI_TRY(dvi__forces(x->action->evaluator, DVI__FORCES, p->r, p->t, p->Q, p->V, x->F));
  for (int j = 0; j < p->r; j++) {
    momentum_of_node(x, p, j);
    dvi__action_carry_force(x->action, x->xi, x->f, R, dp);
  }
  return DVI_OK;
}

/* Add the change of `more` by one column of F_q, or of F_v, at node j. */
static void add_changes(const forces_term *x, const dvi__row_path *p, const dvi__carried *carried,
                        const dvi__pattern *pattern, const double *values, double factor, int j,
                        const double *table, const dvi__row_jacobian *J)
{
  for (int column = 0; column < p->n; column++) {
    for (int e = pattern->start[column]; e < pattern->start[column + 1]; e++)
      x->change[e] = factor * p->weight[j] * values[e * p->r + j];
    for (int e = pattern->start[column]; e < pattern->start[column + 1]; e++) {
      const double more = dvi__carried_entry(carried, pattern->row[e], x->change, e);
      for (int l = 0; l < p->s; l++) {
        double *rows = dvi__row_block(J, pattern->row[e], column, l);
        for (int k = 0; k < p->s; k++) rows[k] -= p->end[k] * more * table[l * p->lanes + j];
      }
    }
  }
}

static dvi_status forces_derivatives(void *of, const dvi__row_path *p, const double *own,
                                     const dvi__row_jacobian *J)
{
  forces_term *x = of;
  dvi__action *a = x->action;
  (void)own;
  DVI_TRY(dvi__forces(a->evaluator, DVI__FORCES, p->r, p->t, p->Q, p->V, x->F));
  for (int j = 0; j < p->r; j++) {
    momentum_of_node(x, p, j);
    const dvi__carried carried = dvi__action_carried(a, x->xi, x->f);
    for (int l = 0; l < p->s; l++) a->line[l] = p->psi[l * p->lanes + j];
    dvi__action_carry_movements(a, &carried, a->line, J);
    add_changes(x, p, &carried, &a->system->by_q, a->F_q, p->h, j, p->psi, J);
    add_changes(x, p, &carried, &a->system->by_v, a->F_v, 1, j, p->dpsi, J);
  }
  return DVI_OK;
}

dvi_status dvi__action_carry_forces(dvi__action *a)
{
  if (a->system->force_count == 0 || a->centred == NULL) return DVI_OK;
  forces_term *x = a->carried_forces = DVI_NEW(forces_term, 1);
  if (x == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for forces in charts");
  DVI_TRY(dvi__system_prepare_hessian(a->system));
  const int by_q = dvi__pattern_entries(&a->system->by_q),
            by_v = dvi__pattern_entries(&a->system->by_v);
  x->action = a;
  x->F = DVI_NEW(double, a->n *(a->r + 2) + (by_q > by_v ? by_q : by_v));
  if (x->F == NULL) return dvi__fail(DVI_NO_MEMORY, "action: no memory for forces in charts");
  x->f = x->F + a->n * a->r;
  x->xi = x->f + a->n;
  x->change = x->xi + a->n;
  return dvi__action_add_term(a, &(dvi__row_term){.name = "forces in charts",
                                                  .of = x,
                                                  .rows = forces_rows,
                                                  .derivatives = forces_derivatives});
}

void dvi__action_clear_carried_forces(dvi__action *a)
{
  if (a->carried_forces != NULL) dvi__release(a->carried_forces->F);
  dvi__release(a->carried_forces);
}
