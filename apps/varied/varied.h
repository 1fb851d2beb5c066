/** Scenes whose runs are differentiated by their start and their parameters. */
#ifndef VARIED_H
#define VARIED_H
#include "cli/options.h"
#include "load/scene.h"
#include "problem.h"

/** A scene, its run with derivatives, and the derivatives of its start by the parameters. */
typedef struct varied {
  problem *scene;
  dvi_sensitivity *run;
  int n, count;         /**< coordinates and parameters */
  double *by_q, *by_p;  /**< [n*count] derivatives of the start's q and p */
  double *by_parameter; /**< [count] room */
} varied;

/** Read a scene from its text and derive it. Returns DONE, or complains and returns the exit
 * code. */
int varied_open(const char *command, const char *path, const scene_text *text,
                const words *settings, const char *method, varied *made);
void varied_close(varied *own);

/** Return the number of quantities by which there are derivatives: coordinates, momenta and
 * parameters. Return the name of quantity k, NULL for parameters that are lists or made of others,
 * and its value. */
int varied_count(const varied *own);
const char *varied_name(const varied *own, int k);
double varied_value(const varied *own, int k);

/** Compute the derivatives [2n] of the state of the run by quantity k, the change of the start by a
 * parameter included. */
void varied_tangent(const varied *own, int k, double *change);
#endif
