/* A scene of a field on a mesh: what its sections say, and the field that is made of them.
 *
 * While the sections are read, the coordinates of the scene are those of one place: its position x,
 * y and so on, the normal of the boundary there, and the value u of the field. Expressions are
 * functions of these. Afterwards the scene's coordinates are the unknowns of the field. */
#ifndef DVI_SCENE_FIELD_SCENE_FIELD_H
#define DVI_SCENE_FIELD_SCENE_FIELD_H
#include <dvi/field.h>

#include "scene/elaborate/kernels.h"

enum { DVI__PLACE_SPACE = 4, DVI__PLACE_NUMBERS = 2 * DVI__PLACE_SPACE + 1 };

/* What a scene's field may be: wave, maxwell, elastic. */
enum { DVI__FIELD_WORDS = 3 };
extern const char *const dvi__field_word[DVI__FIELD_WORDS];

/* What of a place a function may have beside the position. */
enum { DVI__OF_NORMAL = 1, DVI__OF_VALUE = 2 };

/* A function of a place. */
typedef struct dvi__place {
  dvi__scene_term *term;
  int space;
} dvi__place;

struct dvi__scene_field {
  struct dvi__scene_maxwell *maxwell; /* NULL for others */
  struct dvi__scene_elastic *elastic; /* NULL for others (scene/elastic) */
  dvi_generator_options grid;         /* of boxes */
  bool is_grid;                       /* the mesh is one of boxes that were generated */
  dvi_mesh *drawn;                    /* that of a grid, once it is asked for */
  dvi_mesh *mesh;                     /* NULL for a grid that yee alone advances */
  const struct dvi_yee_ranks *ranks;  /* that share a grid. NULL for others */
  int dimension;
  dvi_star *star;
  dvi_field *field;
  int space;
  dvi_star_kind kind;
  double *factor[DVI_MESH_DIMENSION_MAX + 1]; /* [cells], NULL for 1 */
  double *centre;                             /* [cells*space], once needed */
  dvi_condition *condition;
  int conditions;
  dvi__place *source, *value, *rate; /* NULL for 0 */
  dvi_potential potential;           /* of a place, without a value if there is none */
  int u_u, entries;                  /* place of V_uu in its pattern, or -1, and the entries */
  dvi_field_potential density;
  dvi_field_solve_options solve;
  struct dvi__probe *probe; /* [probes] */
  int probes;
};

/* Read and make an integral over a part of cells, all if `over` is NULL, and the callback of its
 * value, whose `user` is the integral. */
typedef struct dvi__field_integral dvi__field_integral;
bool dvi__field_integral_read(dvi_scene *scene, const dvi__tree *tree, const dvi__tree *over,
                              dvi__field_integral **integral);
bool dvi__field_integral_make(dvi_scene *scene, dvi__field_integral *integral);
int dvi__field_integral_value(double t, const double *q, const double *p, double *value,
                              void *user);

/* Give dvi_field_sum as a callback of an invariant does, whose caller looks if it is finite. */
int dvi__field_sum_value(const dvi_field *field, int64_t count, const int *cell,
                         dvi_field_term *term, void *user, double *value);

/* Take an expression or, with `count` above 1, a list of so many as a function of place. */
typedef struct dvi__place_vector {
  int count;
  dvi__place *place[3];
} dvi__place_vector;
bool dvi__place_vector_read(dvi_scene *scene, const dvi__tree *tree, int count, const char *where,
                            dvi__place_vector **vector);

/* A callback that evaluates all of them. `user` is the vector. */
int dvi__place_vector_value(const double *x, double *value, void *user);

/* A number that each cell has: its name, and its value where nothing is said. */
typedef struct dvi__quantity {
  const char *name;
  bool may_vanish; /* 0 is possible, and otherwise a number above it is needed */
  double usual;
} dvi__quantity;

/* Give the cells of a part the function's values at their centres. Takes room for the values
 * [cells] if there is none yet. `span` is blamed. */
bool dvi__quantity_set(dvi_scene *scene, const dvi__quantity *of, const char *part, dvi__span span,
                       const dvi__place *place, double **values);

/* Complain with the library's last sentence, which names a source, a wall, a probe and so on, about
 * the section that it is of, or else `otherwise`. Returns false. */
bool dvi__complain_of_field(dvi_scene *scene, const dvi__tree *otherwise, dvi_status status);

/* Read what a section boundary says of each part, or of the part boundary if it is a word. `span`
 * is that of the part's name. */
typedef bool dvi__part_reader(dvi_scene *scene, const char *part, dvi__span span,
                              const dvi__tree *tree);
bool dvi__read_by_part(dvi_scene *scene, const dvi__tree *section, dvi__part_reader *read);

/* Read materials by part. "all" is read first, so that parts replace it. */
bool dvi__read_all_first(dvi_scene *scene, const dvi__tree *section, dvi__part_reader *read);

/* Tell if a mesh has a part of cells, of which a share may have none. */
bool dvi__has_part_of_cells(const dvi_mesh *mesh, const char *part);

/* Declare the mechanical system of the field. A share has none, and only counts its unknowns. */
dvi_status dvi__declare_system(dvi_scene *scene);

/* Refuse the name of a part that the mesh has not, and list those that it has. */
bool dvi__refuse_part(dvi_scene *scene, dvi__span span, const char *name, bool of_cells);

/* Let the unknowns be a family NAME_1, NAME_2 and so on. */
bool dvi__declare_unknowns(dvi_scene *scene, const dvi__tree *section, const char *name);

/* Tell if a name is that of an unknown or of its momentum: u_ or p_u_, and a number. */
bool dvi__is_unknown(const char *name, char letter);

/* What marches observe beside the probes. The last one is NULL. */
extern const char *const dvi__observable[];

/* Place the probes, and declare them as what is watched. */
bool dvi__probes_make(dvi_scene *scene);

/* Read an expression as a function of a place. `may` has the flags DVI__OF_.. */
bool dvi__place_read(dvi_scene *scene, const dvi__tree *tree, unsigned may, const char *where,
                     dvi__place **place);

/* Evaluate the function. `normal` may be NULL. Returns as callbacks do. */
int dvi__place_value(const dvi__place *place, const double *x, const double *normal, double *value);

/* Evaluate a function of position and value. */
int dvi__place_of_value(const dvi__place *place, const double *x, double u, double *value);

/* Callbacks of conditions and of sources. `user` is a place. */
int dvi__place_datum(const double *x, const double *normal, double *datum, void *user);
int dvi__place_source(const double *x, double *value, void *user);

/* Read a potential V(x, u). */
bool dvi__place_potential(dvi_scene *scene, const dvi__tree *tree);

#endif
