#include "support/paced.h"

#include "support/suite.h"

static dvi_status create_paced(const dvi_system *system, const dvi_monitor *monitor,
                               const char *method, dvi_pacing pacing, dvi_integrator **integrator)
{
  const dvi_integrator_options options = {
      .size = sizeof options, .method = method, .pacing = pacing, .monitor = monitor};
  return dvi_integrator_create_with(system, &options, integrator);
}

dvi_status create_transformed(const dvi_system *system, const dvi_monitor *monitor,
                              const char *method, dvi_integrator **integrator)
{
  return create_paced(system, monitor, method, DVI_TIME_TRANSFORM, integrator);
}

dvi_status create_controlled(const dvi_system *system, const dvi_monitor *monitor,
                             const char *method, dvi_integrator **integrator)
{
  return create_paced(system, monitor, method, DVI_STEP_CONTROL, integrator);
}

dvi_monitor read_monitor(const char *specification)
{
  dvi_monitor monitor = {0};
  ck_assert_msg(dvi_monitor_read(specification, &monitor) == DVI_OK, "%s", dvi_last_error());
  return monitor;
}

dvi_integrator *start_paced_integrator(const problem *model, paced_create create,
                                       const char *monitor, const char *method)
{
  dvi_integrator *made = NULL;
  const dvi_monitor chosen = read_monitor(monitor);
  ck_assert_msg(create(model->system, &chosen, method, &made) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi_integrator_start(made, 0, model->q, model->p) == DVI_OK, "%s",
                dvi_last_error());
  return made;
}

void run_to(dvi_integrator *integrator, double h, double t_end)
{
  dvi_run_report report;
  const dvi_status status = dvi_run(integrator, &(dvi_run_options){.h = h, .t_end = t_end},
                                    &report);
  ck_assert_msg(status == DVI_OK && report.end == DVI_RUN_COMPLETE, "%s", dvi_last_error());
}
