/* Fields on moving meshes under way. */
#ifndef TESTS_SUPPORT_FIELD_JOURNEYS_H
#define TESTS_SUPPORT_FIELD_JOURNEYS_H
#include <dvi/integrator.h>
#include <dvi/moving.h>

enum { JOURNEY_MOST = 8192 /* coordinates */ };

/* A field under way. */
typedef struct journey {
  dvi_moving *moving;
  dvi_system *system;
  dvi_integrator *integrator;
  double q[JOURNEY_MOST], v[JOURNEY_MOST], p[JOURNEY_MOST], x[JOURNEY_MOST], u[JOURNEY_MOST];
  double first[4], drift[4]; /* of the invariants */
  double error;              /* for the caller */
} journey;

/* Create the field, its system and an integrator, and start with a wave. */
void depart(const dvi_moving_terms *terms, dvi_moving_wave *wave, void *user, const char *method,
            journey *j);

/* Take steps. x, u and the drifts are those at the end. */
void travel(journey *j, int steps, double dt);

void arrive(journey *j);

#endif
