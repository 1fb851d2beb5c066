/* The memory of steps with hits, for hits.c, hits_search.c and impact.c. */
#ifndef DVI_INTEGRATOR_HITS_STRUCT_H
#define DVI_INTEGRATOR_HITS_STRUCT_H
#include "integrator/held.h"
#include "integrator/hits.h"

/* The least and the most room for hits in a step. Contacts that may be held have as much as their
 * hits need to accumulate. */
enum { DVI__HITS_LEAST = 100, DVI__HITS_MOST = 4000 };

/* A step with its hits. */
typedef struct dvi__hit_step {
  double h;
  int count;
  dvi_hit *hit;          /* [most] */
  double *elapsed, *t;   /* [most] since the step's start, and the time of the state there */
  double *q, *v, *after; /* [n] of each hit, and the velocities before and after it */
  double *start;         /* [n] the velocity at the step's start */
  /* what the integrator had at the step's start */
  dvi__state now, last;
  double *memory, last_h;
  int held;
} dvi__hit_step;

struct dvi__hits {
  int divide;               /* the driver divides steps. Else the method takes contacts itself */
  int most;                 /* room for hits in a step */
  dvi__hit_step kept, made; /* the last step, and the step that is being made */
  double elapsed;           /* part of the step that is made so far */
  dvi__bodies bodies;       /* what steps while a contact is held (held.h) */
  int let_go;               /* the contact that was released at the present state, or -1 */
  dvi_hit *records;         /* storage of the hits of both steps */
  double *numbers;
  double *v, *moved;       /* [n] velocities */
  double *v_start, *v_end; /* [n] at the ends of the last smooth step */
  double *q;               /* [n] a point of a path */
  double *G, *full, *dual; /* [n] entries of a gradient, all of it, and M^-1 times it */
  double *p;               /* [n] momenta */
  /* [contacts] at one point of a path, and at the one before it, which change places */
  dvi__touch *touch, *touch_before, *touches;
  /* [contacts] the gap at the start of the piece where it is 0 up to roundings, and there 1 if it
   * opens, 0 if it neither opens nor closes, DVI__IS_HELD for that which is held. Else 0, and -1 */
  double *offset;
  int *opens;
};

enum { DVI__IS_HELD = 2 };

/* Test a contact at a state. A gap is closed if it is 0 up to roundings, or if a rate that was too
 * small for a hit has made it negative. The rate counts along the step's direction. */
int dvi__touch_is_closed(const dvi__touch *touch, double h);
int dvi__touch_is_grazing(const dvi__touch *touch);

/* Hits of a contact that follow each other within this part of a step accumulate. */
extern const double dvi__accumulation;

/* Part of the speed below which a rate counts as 0. */
extern const double dvi__grazing;

/* Evaluate all contacts at a point. */
dvi_status dvi__touches(dvi_integrator *integrator, double t, const double *q, const double *v,
                        dvi__touch *touch);

/* Find the first zero of a gap on the path of the last smooth step. *contact is -1 if there is
 * none. */
typedef struct dvi__found {
  int contact;
  double tau; /* the zero on the path */
  int dips;   /* the gap opens again in the same part of the path */
} dvi__found;

/* Evaluate the path of the last smooth step where hits are searched. q, v [n]. */
dvi_status dvi__searched_path(dvi_integrator *integrator, double tau, double *q, double *v);

dvi_status dvi__find_hit(dvi_integrator *integrator, dvi__found *found);

/* Replace the last smooth step, of this length, by the one that ends at the zero. Its length may
 * become 0. *hits is 0 if the gap does not close there after all, or too slowly for a hit. */
dvi_status dvi__locate_hit(dvi_integrator *integrator, const dvi__found *found, double *length,
                           int *hits);

/* Reflect the momentum of the present state at a contact, and record the hit. A contact whose hits
 * accumulate is held instead, if it may be. */
dvi_status dvi__impact(dvi_integrator *integrator, int contact);

/* Refuse a contact that stays closed from t on. The remedy is the last part of the sentence. */
dvi_status dvi__refuse_closed(const dvi_integrator *integrator, int contact, double t);
const char *dvi__closed_remedy(const dvi_integrator *integrator, int contact);

/* Add the change of the energy and of the momenta of symmetries, from a state q, v, p [n] to the
 * present one with the velocity `moved`, to what is supplied. */
dvi_status dvi__supply_jump(dvi_integrator *integrator, const double *q, const double *v,
                            const double *p);

/* Add what happens at the present state to the step's hits. q, v and after [n] are the place, and
 * the velocities before and after. DVI_UNSUPPORTED if there is no room. */
dvi_status dvi__record(dvi_integrator *integrator, const dvi_hit *hit, const double *q,
                       const double *v, const double *after);

#endif
