/* An integrator in mid-run, and the bytes of a checkpoint of its past. */
#ifndef TESTS_INTEGRATOR_MID_RUN_H
#define TESTS_INTEGRATOR_MID_RUN_H
#include <stdlib.h>

#include "support/files.h"
#include "support/runs.h"

typedef struct scene {
  problem *model;
  dvi_integrator *integrator;
  bytes past;
} scene;

static inline scene create_scene(void)
{
  scene s = {.model = create_problem("kepler", NULL)};
  s.integrator = start_integrator(s.model, "galerkin:degree=2");
  advance(s.integrator, 0.05, 2);
  s.past = read_state(s.integrator);
  advance(s.integrator, 0.05, 2);
  return s;
}

static inline void clear_scene(scene *s)
{
  dvi_integrator_destroy(&s->integrator);
  problem_destroy(&s->model);
  free(s->past.at);
}

#endif
