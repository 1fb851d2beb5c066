/* What asynchronous steps of a solid store, and the flight of a node from one event to the next.
 *
 * Every cell K has its own steps h_K, and every node its clock tau_a. The discrete action of a run
 * is
 *
 *     S = sum over nodes a and their intervals of  m_a |v_a|^2 (t_a^{i+1} - t_a^i)/2
 *       - sum over cells K and their times t_K^j = t_0 + j h_K of  h_K V_K W(F_K)
 *
 * with v_a constant between two events of the node, and a sum over j that begins with h_K/2. A node
 * has an event whenever one of its cells has. With f_K the forces of K, stationarity says
 *
 *     u_a += v_a (t - tau_a), tau_a = t, then v_a += h_K f_K,a/m_a  for each node a of the cell K.
 *
 * Events happen in the order of their times, and those of one time in the order of the cells' own
 * numbers. Events of cells without a common node commute to the last bit.
 *
 * Source: Lew, Marsden, Ortiz and West 2003, with the half kick at the start that it leaves out;
 * Kale and Lew 2007 for threads. */
#ifndef DVI_FIELD_ELASTIC_AVI_ENGINE_H
#define DVI_FIELD_ELASTIC_AVI_ENGINE_H
#include "field/elastic/cell.h"
#include "march/sections.h"

enum {
  DVI__SOLID_CLASSES = 31, /* steps are at most 2^30 times the shortest one */
  DVI__SOLID_AXES = 3,
  DVI__CELL_AHEAD = 24, /* events in advance when a cell is fetched, and its nodes */
  DVI__NODES_AHEAD = 10
};

/* A node, in a line of the cache. In a plane the third components are 0. */
typedef struct dvi__solid_node {
  double u[DVI__SOLID_AXES], v[DVI__SOLID_AXES]; /* u at tau, and v from then on */
  double tau;
  double inverse; /* 1/m */
} dvi__solid_node;

/* A cell, in two lines of the cache. */
typedef struct dvi__solid_cell {
  int corner[DVI__SOLID_NODES];
  double step, volume;
  double gradient[DVI__SOLID_ENTRIES]; /* [n*n] of the barycentric coordinates but the first one */
  int name;                            /* the mesh's number */
  int material, kind;
  int viscous; /* place in `stretch` of a cell with a damping */
  int meeting; /* place in `push` of a cell that meets obstacles */
  int edge;    /* number among the cells at edges of parts, or -1 */
} dvi__solid_cell;

/* What a node has beside a free flight. The first bits are the components that are given. */
enum {
  DVI__NODE_GIVEN = 7,
  DVI__NODE_DRIVEN = 8,  /* what is given depends on time */
  DVI__NODE_DECAYS = 16, /* a damping of its velocity */
  DVI__NODE_MEETS = 32   /* obstacles */
};

/* What a cell has beside its stored energy. */
enum {
  DVI__CELL_GUARDED = 1, /* one of its nodes does not fly freely */
  DVI__CELL_LOADED = 2,
  DVI__CELL_VISCOUS = 4,
  DVI__CELL_MEETS = 8 /* one of its nodes meets obstacles */
};

/* A node beside obstacles. */
typedef struct dvi__solid_touch {
  int64_t hits;
  int32_t rests;    /* 1 + the obstacle on which it rests, or 0 */
  int32_t is_stuck; /* friction holds it there */
} dvi__solid_touch;

/* The last event of a cell: its displacements, velocities after it, and forces [(n+1)*n]. */
typedef struct dvi__solid_push {
  double t, u[DVI__SOLID_NUMBERS], v[DVI__SOLID_NUMBERS], f[DVI__SOLID_NUMBERS];
} dvi__solid_push;

/* The clock of a run. */
typedef struct dvi__solid_clock {
  double t0, t;
  double start_energy, allowed; /* the band of the growth, doubled after each alarm */
  int64_t slot;                 /* shortest steps since t0, of classes */
  int64_t events, checks;
} dvi__solid_clock;

/* The numbers that change, in one block. Cells have their own numbers. */
typedef struct dvi__solid_state {
  dvi__solid_node *node;   /* [vertices] */
  int64_t *count;          /* [cells] of free steps: events so far */
  double *worked;          /* [vertices] sizes of works of loads and of given motion. Or empty */
  double *stretch;         /* [viscous*12] displacements that the damping has answered so far */
  dvi__solid_touch *touch; /* [vertices] with obstacles */
  dvi__solid_push *push;   /* [pushes] */
} dvi__solid_state;

/* What an observation computed beside the state. */
typedef struct dvi__solid_view {
  double t;         /* NaN if nothing is valid */
  double *u, *rate; /* [vertices*n] */
  dvi_elastic_energies energies;
  double growth, hits;
} dvi__solid_view;

typedef struct dvi__solid_avi {
  const dvi_elastic *solid;
  const char *method;
  int n;
  int64_t vertices, cells, active; /* cells with events have the first numbers */
  dvi__solid_cell *cell;           /* [cells] */
  uint8_t *node_kind;              /* [vertices] */
  double *step;                    /* [cells] those of `cell` */
  double *decay;                   /* [vertices] rates, or empty */
  int64_t viscous_count, pushes;
  int64_t *cell_start; /* [vertices+1] */
  int *cell_of;        /* own numbers of the cells of a vertex, ascending */
  int is_equal;        /* one step for all */
  int is_free;         /* events are taken from a calendar */
  int is_linear;       /* forces are those of small strains at rest */
  int classes;
  int64_t class_end[DVI__SOLID_CLASSES];
  int64_t class_events[DVI__SOLID_CLASSES]; /* events of a slot on all processes */
  double shortest, longest, bound, band;
  int threads;
  struct dvi__solid_parts *parts;     /* NULL for classes on a single thread */
  struct dvi__solid_borders *borders; /* of a share, or NULL */
  int is_lost;                        /* processes could not give each other their values */
  size_t size;                        /* bytes of the block */
  void *block, *kept;                 /* the state, and that of an earlier time */
  dvi__solid_state state;
  dvi__solid_clock clock, kept_clock;
  dvi__solid_view *view;
} dvi__solid_avi;

/* Fetch a cell before it is needed. These are macros, because compilers take functions that only
 * fetch for ones that do nothing. */
#define DVI__FETCH(place) __builtin_prefetch(place, 1)
#define DVI__FETCH_CELL(cell) (DVI__FETCH(cell), DVI__FETCH(&(cell)->gradient[4]))

/* Carry a node that has a kind to the time t. `touch` is NULL without obstacles. Returns 0, or as
 * dvi__solid_given. */
int dvi__solid_guide(const dvi__solid_avi *avi, int vertex, double t, dvi__solid_node *node,
                     dvi__solid_touch *touch);

/* Carry a node to the time t. Returns as dvi__solid_guide. */
static inline int dvi__solid_fly(const dvi__solid_avi *avi, int vertex, double t,
                                 dvi__solid_node *node, dvi__solid_touch *touch)
{
  if (avi->node_kind[vertex] != 0) return dvi__solid_guide(avi, vertex, t, node, touch);
  const double span = t - node->tau;
  for (int i = 0; i < DVI__SOLID_AXES; i++) node->u[i] += node->v[i] * span;
  node->tau = t;
  return 0;
}

/* The kinetic energy of what is given at a driven node, 0 at others. */
static inline double dvi__solid_driven_energy(const dvi__solid_avi *avi, int64_t vertex,
                                              const dvi__solid_node *node)
{
  const int kind = avi->node_kind[vertex];
  double square = 0;
  if (!(kind & DVI__NODE_DRIVEN)) return 0;
  for (int i = 0; i < avi->n; i++)
    if (kind & 1 << i) square += node->v[i] * node->v[i];
  return 0.5 * square / node->inverse;
}

/* Fly among obstacles from the time t for the length s, in units of v. */
void dvi__solid_bounce(const dvi__solid_avi *avi, int vertex, double t, double length,
                       dvi__solid_node *node, dvi__solid_touch *touch);

/* Take from a velocity [n] of a node what the obstacle takes on which it rests. */
void dvi__solid_rest(const dvi__solid_avi *avi, int vertex, const dvi__solid_node *node,
                     const dvi__solid_touch *touch, double *rate);

/* Keep an event of a cell at displacements u [(n+1)*n], with forces f, for hits of its nodes. */
void dvi__solid_note(dvi__solid_avi *avi, int64_t c, double t, const double *u, const double *f);

/* The touch of a node, or NULL without obstacles. */
static inline dvi__solid_touch *dvi__solid_touch_of(const dvi__solid_avi *avi, int64_t vertex)
{
  return avi->state.touch != NULL ? avi->state.touch + vertex : NULL;
}

/* Give the forces of a cell's stored energy and its loads at displacements u [(n+1)*n], and those
 * of the loads alone, 0 without. Returns as dvi__solid_force. */
int dvi__solid_pull(const dvi__solid_avi *avi, int64_t c, double t, const double *u, double *f,
                    double *load);

/* Give beta times the stiffness at rest times w [(n+1)*n]. */
void dvi__solid_resist(const dvi__solid_avi *avi, int64_t c, const double *w, double *f);

/* Let an event of a cell happen. Returns as dvi__solid_force. */
int dvi__solid_act(dvi__solid_avi *avi, int64_t c, double t);

/* The time of a slot, and of an event of a cell. */
static inline double dvi__solid_slot_time(const dvi__solid_avi *avi, int64_t slot)
{
  return avi->clock.t0 + (double)slot * avi->shortest;
}

static inline double dvi__solid_event_time(const dvi__solid_avi *avi, int64_t c, int64_t count)
{
  return avi->clock.t0 + (double)count * avi->cell[c].step;
}

/* The class of a cell. */
static inline int dvi__solid_class_of(const dvi__solid_avi *avi, int64_t c)
{
  int j = 0;
  while (c >= avi->class_end[j]) j++;
  return j;
}

/* The largest class whose steps end in a slot. */
int dvi__solid_class_of_slot(const dvi__solid_avi *avi, int64_t slot);

/* A run up to a time, and what stopped it. */
typedef struct dvi__solid_halt {
  int returned; /* 0, or as dvi__solid_force */
  int64_t cell;
  double t;
} dvi__solid_halt;

/* Let the events up to a time happen. Which event stops them is left open with parts. */
dvi__solid_halt dvi__solid_run(dvi__solid_avi *avi, double limit);
dvi__solid_halt dvi__solid_run_slots(dvi__solid_avi *avi, double limit);
dvi__solid_halt dvi__solid_run_parts(dvi__solid_avi *avi, double limit);

/* The same in the order by time, on a single thread. The parts have to be ordered after it. */
dvi__solid_halt dvi__solid_run_in_order(dvi__solid_avi *avi, double limit);

/* Order the events of the parts after the clock and the counts. */
void dvi__solid_order(dvi__solid_avi *avi);

/* Keep the state, and take it back. */
void dvi__solid_keep(dvi__solid_avi *avi);
void dvi__solid_take_back(dvi__solid_avi *avi);

#endif
