/* What the mechanical system of a solid needs. */
#ifndef DVI_FIELD_ELASTIC_SYSTEM_H
#define DVI_FIELD_ELASTIC_SYSTEM_H
#include "field/elastic/assemble.h"

enum { DVI__SOLID_SYMMETRIES = 2 * DVI_ELASTIC_DIMENSION_MAX };

/* A potential of cells. `kind` tells which part of the energy it has. */
typedef enum dvi__solid_share {
  DVI__SOLID_STORED,    /* all */
  DVI__SOLID_STIFFNESS, /* u.K u/2 with the stiffness at rest */
  DVI__SOLID_REST       /* the difference of both */
} dvi__solid_share;

typedef struct dvi__solid_potential {
  const struct dvi__solid_system *system;
  dvi__solid_share share;
} dvi__solid_potential;

/* A translation, or a turn of positions X + u about the origin. */
typedef struct dvi__solid_symmetry {
  const dvi_elastic *elastic;
  int axis, is_turn;
  int is_small; /* a turn of X alone, which is the symmetry of the linear law */
  char name[16];
} dvi__solid_symmetry;

/* A contact of a node with an obstacle. */
typedef struct dvi__solid_contact {
  const dvi_elastic *elastic;
  const dvi_obstacle *obstacle;
  int64_t vertex;
  int count;                                /* of the node's unknowns */
  int start[DVI_ELASTIC_DIMENSION_MAX + 1]; /* of the columns of gradient and tangents */
  int row[DVI_ELASTIC_DIMENSION_MAX * DVI_ELASTIC_DIMENSION_MAX];
  char name[96];
} dvi__solid_contact;

typedef struct dvi__solid_system {
  const dvi_elastic *elastic;
  dvi__solid_pattern pattern; /* its matrix is the stiffness at rest */
  int *start;                 /* [unknowns+1] of the pattern */
  int *no_start;              /* [unknowns+1] of an empty one */
  double *mass;               /* [unknowns] */
  double *pull;               /* [unknowns] K u of the displacements that are given and steady */
  double held;                /* their energy u.K u/2 */
  double *load;               /* [unknowns] steady loads, or NULL */
  double held_load;           /* minus the work of those on nodes that are held */
  double *damping;            /* of the pattern, or NULL */
  dvi__solid_potential part[2];
  dvi_potential potential[3];
  dvi_force force;
  int symmetries, contacts;
  dvi__solid_symmetry symmetry[DVI__SOLID_SYMMETRIES];
  dvi_symmetry symmetry_term[DVI__SOLID_SYMMETRIES];
  dvi__solid_contact *contact;
  dvi_contact *contact_term;
  dvi_system_terms terms;
} dvi__solid_system;

void dvi__solid_system_destroy(dvi__solid_system **system);

/* Make Rayleigh's damping, the symmetries and the contacts. */
dvi_status dvi__solid_make_damping(dvi__solid_system *s);
dvi_status dvi__solid_find_symmetries(dvi__solid_system *s);
dvi_status dvi__solid_make_contacts(dvi__solid_system *s);

/* Keep the bound of the frequencies at rest, by the stiffness and the masses of the unknowns. */
dvi_status dvi__solid_find_fastest(const dvi_elastic *e, const dvi__csr *K, const double *mass);

/* Tell if all laws are linear. */
int dvi__solid_is_linear(const dvi_elastic *e);

/* Tell if all laws have turns: of X if all are linear, and of X + u if none is. */
int dvi__solid_has_turns(const dvi_elastic *e);

#endif
