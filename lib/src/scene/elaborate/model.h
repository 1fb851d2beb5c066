/* A scene, from the start of its reading on. The parts of the reader fill in one object in turn. */
#ifndef DVI_SCENE_ELABORATE_MODEL_H
#define DVI_SCENE_ELABORATE_MODEL_H
#include <dvi/contact.h>
#include <dvi/joint.h>
#include <dvi/noise.h>
#include <dvi/scene.h>
#include <pthread.h>

#include "scene/elaborate/blocks.h"
#include "scene/elaborate/names.h"
#include "scene/text/tree.h"
#include "text/heap.h"

/* The role of a function. It may belong to the motion, or be watched, as symmetries and invariants
 * are. Events and constant masses stand beside, where the system does not evaluate them. */
typedef enum dvi__role { DVI__ROLE_MOTION, DVI__ROLE_WATCHED, DVI__ROLE_AUXILIARY } dvi__role;

/* Settings "name=value" from outside the scene. */
typedef struct dvi__scene_settings {
  int count;
  const char *const *text;
  char *used; /* [count] */
} dvi__scene_settings;

/* The functions that callbacks evaluate, in a list that the scene frees. */
typedef struct dvi__scene_term {
  dvi__function *function;
  const dvi_scene *scene;
  int n, count;       /* numbers of coordinates and multipliers */
  const double *none; /* as many zeros as the longest block has */
  dvi_pattern qw, vw; /* patterns of d phi/dq and d phi/dp, of which the gradients are made */
  dvi_pattern tw;     /* of d phi/dt, for holonomic constraints */
  struct dvi__scene_term *beside; /* the tangent beside a contact's gap, or NULL */
  dvi__role role;
  struct dvi__scene_term *next;
} dvi__scene_term;

/* While the sections of a density are read, the coordinates of the scene are those of one place:
 * its position, and the derivatives in space of each component of the fields, to some order along
 * each axis. Those of order 0, the components themselves, come first. */
enum { DVI__JET_ORDER_MAX = 4 };
typedef struct dvi__jets {
  int dimension, components;
  /* Components 0 to 8 are the entries of a rotation R. The others, of which no value is taken, turn
   * with the body: their rates are omega(R), and their derivatives along an axis kappa(R,x). */
  bool is_rotation;
  const char *axis[3];
} dvi__jets;

/* Return the number of a derivative, with `order` [3] along each axis, and find component and
 * orders of a number. Returns false for a position. dvi__jet_count counts all numbers. */
int dvi__jet_number(const dvi__jets *jets, int component, const int *order);
bool dvi__jet_at(const dvi__jets *jets, int number, int *component, int *order);
int dvi__jet_count(const dvi__jets *jets);

struct dvi_scene {
  dvi__ledger ledger;
  dvi__arena arena;
  dvi__source source; /* a copy, for messages of callbacks */
  dvi__complaint *complaint;
  const dvi__tree *tree;
  const dvi__scene_settings *settings; /* settings while the scene is read */
  const dvi_scene_division *division;  /* while the scene is read, NULL for the whole mesh */
  dvi__names names;
  dvi__parameter *parameter;
  dvi__coordinate *coordinate;
  dvi__definition *definition;
  int parameter_count, coordinate_count, definition_count;
  unsigned reads; /* place where parameters are being read */
  int n, nv;      /* numbers of q, and of v and p */
  int velocities; /* numbers in their block, n, or with factors n + nv (rates of q first) */
  long work;      /* parts of expressions elaborated so far */

  /* The controls, their cost, and the force in which they stand, or NULL. `inputs` [controls and
   * parameters] has zeros for controls, and the parameters' values. */
  int control_count;
  const char **control_name;
  double *control_least, *control_most;
  dvi_controls controls;
  dvi__scene_term *cost, *control_force;
  double *inputs;
  /* L(t,q,v), F(t,q,v).w, minus the dissipation, and the start q.w and v.w or p.w, as functions of
   * the parameters. NULL until derived, or where there is none. */
  dvi__scene_term *varied_L, *varied_F, *varied_R, *varied_q, *varied_second;
  dvi__scene_term *objective_end, *objective_rate;
  dvi_objective objective;
  int start_overlaps; /* numbers of the start are given by a formula and one by one */
  double *room;       /* work of the callbacks of controls, which serve one thread at a time */

  const double *mass_diagonal; /* [n] divisors of momenta in invariants, or NULL */
  dvi_system_terms terms;
  dvi_lagrangian lagrangian;
  dvi_one_form one_form;
  dvi_hamiltonian hamiltonian;
  dvi_constraint constraint;
  dvi_vector_potential vector_potential;
  dvi_force force[2];        /* of the sections forces and dissipation */
  dvi_holonomic *holonomics; /* [terms.holonomic_count], those of joints last */
  dvi_nonholonomic *nonholonomics;
  dvi_joints *joints; /* NULL without joints */
  dvi_joint *joint;   /* [joint_count] as declared */
  dvi_factor *body;   /* [body_count] members of all coordinates, for the joints */
  int joint_count, body_count;
  dvi_contact *contacts; /* [terms.contact_count] */
  dvi_noise noise;
  dvi__scene_term *functions;
  /* the term from which a constant mass was read, with A(t,q).q' of a vector potential, or NULL */
  const dvi__scene_term *kinetic;
  struct dvi__scene_field *field;     /* NULL without a mesh (scene/field) */
  struct dvi__scene_density *density; /* NULL without a density (scene/density) */
  const dvi__jets *jets;              /* while its sections are read, and NULL otherwise */
  dvi_system *system;
  double *q, *v, *p;
  double *final_q, *final_v, *final_p; /* the end of a control problem, or NULL */
  char *free_q, *free_p;               /* 1 for its numbers that are not given */
  char *final_has_v;                   /* 1 for its velocities that are given */
  double *zeros;                       /* [2 n] */
  int depends_on_time, momenta_given;

  dvi_scene_plan plan;
  dvi_scene_parameter *shown; /* [parameter_count] */
  dvi_scene_event *event;
  dvi_scene_range *range;
  const char **unused; /* [unused_count] */
  int event_count, range_count, unused_count, bodies;
  const char *form, *mass;
  pthread_mutex_t labels_mutex;
  char **label[3]; /* labels of q, v, p, made when first asked for */
  dvi__arena label_arena;
};

/* Return true if a coordinate is neither a number nor a vector. */
static inline bool dvi__has_factors(const dvi_scene *scene)
{
  return scene->velocities > scene->n;
}

/* Return the coordinate to which a number of q, or of v, belongs. */
int dvi__coordinate_at(const dvi_scene *scene, int number, int of_v);

/* Refuse the scene with a place, or for want of memory. Returns false. */
bool dvi__scene_refuse(dvi_scene *scene, dvi__span span, const char *format, ...)
    DVI__TEXT_PRINTF(3, 4);
bool dvi__scene_no_memory(dvi_scene *scene);

#endif
