/* A scene while it is read, and afterwards: one object that the parts of the reader fill in
 * turn. */
#ifndef DVI_SCENE_MODEL_H
#define DVI_SCENE_MODEL_H
#include <dvi/scene.h>
#include <pthread.h>

#include "scene/elaborate/blocks.h"
#include "scene/elaborate/names.h"
#include "scene/text/tree.h"
#include "text/heap.h"

/* What a function is for: the motion; symmetries and invariants; events and constant masses, which
 * the system does not evaluate. */
typedef enum dvi__role { DVI__MOVES, DVI__WATCHES, DVI__STANDS_BESIDE } dvi__role;

/* Settings "name=value" from outside. */
typedef struct dvi__scene_settings {
  int count;
  const char *const *text;
  char *used; /* [count] */
} dvi__scene_settings;

/* The functions that callbacks evaluate, in a list that the scene frees. */
typedef struct dvi__scene_term {
  dvi__function *function;
  const dvi_scene *scene;
  int n, count;       /* coordinates; multipliers */
  const double *none; /* zeros, as many as the longest block has */
  dvi_pattern qw, vw; /* of constraints: d phi/dq and d phi/dp, of which the gradients are made */
  dvi__role role;
  struct dvi__scene_term *next;
} dvi__scene_term;

struct dvi_scene {
  dvi__ledger ledger;
  dvi__arena arena;
  dvi__source source; /* a copy, for messages of callbacks */
  dvi__complaint *complaint;
  const dvi__tree *tree;
  const dvi__scene_settings *settings; /* while it is read */
  dvi__names names;
  dvi__parameter *parameter;
  dvi__coordinate *coordinate;
  dvi__definition *definition;
  int parameter_count, coordinate_count, definition_count;
  unsigned reads; /* where parameters that are met stand */
  int n, nv;      /* numbers of q; of v and p */
  int velocities; /* in the block of velocities: n, or with factors n rates of q and nv velocities
                     after them */
  long work;      /* parts of expressions that were elaborated */

  const double *mass_diagonal; /* [n] or NULL: divides momenta in invariants */
  dvi_system_terms terms;
  dvi_lagrangian lagrangian;
  dvi_one_form one_form;
  dvi_hamiltonian hamiltonian;
  dvi_constraint constraint;
  dvi__scene_term *functions;
  const dvi__scene_term *kinetic; /* what a constant mass was read from; NULL */
  dvi_system *system;
  double *q, *v, *p;
  double *zeros; /* [2 n] */
  int depends_on_time, momenta_given;

  dvi_scene_plan plan;
  dvi_scene_parameter *shown; /* [parameter_count] */
  dvi_scene_event *event;
  dvi_scene_range *range;
  const char **unused; /* [unused_count] */
  int event_count, range_count, unused_count, bodies;
  const char *form, *mass;
  pthread_mutex_t labels_mutex;
  char **label[3]; /* of q, v, p; made when first asked for */
  dvi__arena label_arena;
};

/* Whether a coordinate is neither a number nor a vector. */
static inline bool dvi__has_factors(const dvi_scene *scene)
{
  return scene->velocities > scene->n;
}

/* The number of the coordinate to which a number of q, or of v, belongs. */
int dvi__coordinate_at(const dvi_scene *scene, int number, int of_v);

/* Refuse something with a place, or for which there is no memory; false. */
bool dvi__scene_refuse(dvi_scene *scene, dvi__span span, const char *format, ...)
    DVI__TEXT_PRINTF(3, 4);
bool dvi__scene_no_memory(dvi_scene *scene);

#endif
