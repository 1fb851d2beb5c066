#include "support/accepted.h"

#include "support/runs.h"
#include "support/suite.h"

void find_accepted_cases(int total, int (*is_accepted)(int number), accepted_cases *found)
{
  found->count = 0;
  for (int i = 0; i < total; i++)
    if (is_accepted(i)) {
      ck_assert_int_lt(found->count, ACCEPTED_MOST);
      found->which[found->count++] = i;
    }
}

void check_accepted_cases(const accepted_cases *found, int count, int methods,
                          const char *const *method)
{
  for (int m = 0; m < methods; m++) {
    int accepted = 0;
    for (int i = 0; i < found->count; i++) accepted += found->which[i] % methods == m;
    ck_assert_msg(accepted > 0, "%s has no case", method[m]);
  }
  ck_assert_int_eq(found->count, count);
}

int method_accepts(const dvi_system *system, const char *method)
{
  dvi_integrator *integrator = NULL;
  const dvi_status status = dvi_integrator_create(system, method, &integrator);
  dvi_integrator_destroy(&integrator);
  return status != DVI_UNSUPPORTED;
}

int method_accepts_problem(const char *name, const char *setting, const char *method)
{
  problem *model = create_problem(name, setting);
  const int accepts = method_accepts(model->system, method);
  problem_destroy(&model);
  return accepts;
}
