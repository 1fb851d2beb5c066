/* The state of a march in files, which is that of the whole mesh: several processes put it together
 * from the values of the cells that they own, and each takes those of its cells from it. */
#ifndef DVI_FIELD_STEP_SAVED_H
#define DVI_FIELD_STEP_SAVED_H
#include "field/model/field.h"
#include "march/sections.h"

/* A form [cells of a degree], or numbers that are the same on all processes. */
typedef struct dvi__piece {
  int degree; /* -1 of the latter */
  int64_t count;
  double *value;
} dvi__piece;

/* What identifies a march of equal steps in a file, and where it stands. */
typedef struct dvi__march_place {
  int64_t n;
  uint64_t hash; /* of the coefficients */
  double dt, t0, t;
} dvi__march_place;

/* All that is saved of a march of equal steps. */
typedef struct dvi__saved_march {
  const char *method; /* the name of its section */
  uint32_t version;
  const dvi_mesh *mesh;
  dvi__march_place *at;
  int pieces;
  const dvi__piece *piece; /* [pieces] the section "forms" */
} dvi__saved_march;

/* Put the march of the whole mesh into a file, as dvi__march_kind has it. */
dvi_status dvi__saved_march_put(const dvi__saved_march *march, dvi__sections_writer *writer);

/* Replace place and pieces by those in a file. One of another field or step is refused, on all
 * processes, and changes nothing. */
dvi_status dvi__saved_march_take(const dvi__saved_march *march, const dvi__sections *sections);

/* Return how many numbers of 8 bytes the pieces have in a section. Of a form that parts hold it has
 * a hash alone. */
int64_t dvi__pieces_size(const dvi_mesh *mesh, int pieces, const dvi__piece *piece,
                         const struct dvi__parts *parts);

/* Put the pieces' numbers of the whole mesh into the open section, every bit as it is. Called on
 * all processes, of which those may have a writer without memory that do not need the file. */
dvi_status dvi__pieces_put(const dvi_mesh *mesh, int pieces, const dvi__piece *piece,
                           dvi__sections_writer *writer);

/* Fill the pieces with numbers of the whole mesh [dvi__pieces_size], or of the parts of sections.
 * Called on all processes. After a failure nothing is changed. */
dvi_status dvi__pieces_take(const dvi_mesh *mesh, int pieces, const dvi__piece *piece,
                            const dvi__sections *sections, const unsigned char *numbers);

/* Give a hash of what distinguishes a field from others, its coefficients cell by cell. It is the
 * same for all divisions of the mesh. Called on all processes. */
dvi_status dvi__field_hash(const dvi_field *field, uint64_t *hash);

/* Replace a number by the sum of all processes' numbers modulo 2^64. */
dvi_status dvi__sum_modulo(const dvi_mesh *mesh, uint64_t *number);

/* Refuse sections of which the processes have different ones. Called on all of them. */
dvi_status dvi__check_same(const dvi_mesh *mesh, const char *name, size_t size,
                           const unsigned char *content);

#endif
