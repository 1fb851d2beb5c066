/* The options of shooting are the one-step method, the quadrature and the type. They determine the
 * course of the shot. */
#ifndef DVI_METHOD_SHOOTING_SHOOTING_OPTIONS_H
#define DVI_METHOD_SHOOTING_SHOOTING_OPTIONS_H
#include "step/onestep/shot.h"
#include "method/method.h"

/* The keys, ended by one without a name. */
extern const dvi__key dvi__shooting_keys[];

/* The indices of the values in dvi__settings. */
enum {
  DVI__SHOOTING_ONE_STEP,
  DVI__SHOOTING_STAGES,
  DVI__SHOOTING_TABLEAU,
  DVI__SHOOTING_COMPOSITION,
  DVI__SHOOTING_QUADRATURE,
  DVI__SHOOTING_NODES,
  DVI__SHOOTING_TERMS,
  DVI__SHOOTING_SOLVE,
  DVI__SHOOTING_TOLERANCE,
  DVI__SHOOTING_TYPE
};

/* The values of the key `solve`. */
enum { DVI__SHOOTING_AUTO, DVI__SHOOTING_BY_SHOT, DVI__SHOOTING_BY_STAGES, DVI__SHOOTING_SOLVES };

typedef struct dvi__shooting_plan {
  dvi__runge_kutta method; /* its order is that of the composition */
  dvi__course course;
  int quadrature_order;
} dvi__shooting_plan;

/* Check the options, put the defaults into the stepper's settings, and make the plan. Sets the
 * stepper's fingerprint for a tableau from a file. */
dvi_status dvi__shooting_choose(dvi__stepper *self, dvi__shooting_plan *plan);

/* `order` is that of the one-step method. */
void dvi__shooting_explain_options(const dvi__settings *settings, int order, dvi__text *text);

#endif
