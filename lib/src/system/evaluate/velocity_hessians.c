#include "system/evaluate/velocity_hessians.h"

#include "system/evaluate/evaluator_struct.h"

dvi_status dvi__velocity_hessians(dvi__evaluator *e, int count, const double *t, const double *q,
                                  const double *v, double *L_qq, double *L_qv, double *L_vv)
{
  return dvi__general_hessian(e->system->lagrangian, &e->scratch, count, t, q, v, L_qq, L_qv, L_vv);
}

int dvi__system_has_smooth_lagrangian(const dvi_system *system)
{
  const dvi__lagrangian_term *l = system->lagrangian;
  return l != NULL && l->computed == NULL && l->callbacks.admit == NULL &&
         (system->terms & DVI__ONE_FORM) == 0 && dvi__general_has_gradient(l) &&
         dvi__general_has_hessian(l);
}
