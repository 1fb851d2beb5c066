/* The names of a scene. A name is a parameter, a coordinate, a definition or a control. */
#ifndef DVI_SCENE_ELABORATE_NAMES_H
#define DVI_SCENE_ELABORATE_NAMES_H
#include "text/arena.h"
#include "text/complaint.h"
#include "scene/text/syntax.h"

/* The shape of a value. Rank 0 is a number, 1 a vector of `rows`, 2 a matrix. Rank -1 is none,
 * after a complaint. */
typedef struct dvi__shape {
  int rank, rows, columns;
} dvi__shape;

/* The place of a parameter, in an initial value or in any other section but `parameters`. */
enum { DVI__IN_PARAMETERS = 0, DVI__IN_START = 1, DVI__ELSEWHERE = 2 };

/* The parameters of which another one is made. */
typedef struct dvi__source_of {
  struct dvi__parameter *parameter;
  const struct dvi__source_of *next;
} dvi__source_of;

typedef struct dvi__parameter {
  const char *name;
  dvi__span span;
  dvi__shape shape;
  double *value; /* [rows * columns], row by row */
  int settable;
  const dvi__expression *is;    /* NULL if a setting replaces it */
  unsigned used_in;             /* flags DVI__IN_START, DVI__ELSEWHERE after reading */
  const dvi__source_of *source; /* the parameters of which it is made */
  int last_made;                /* number + 1 of the last parameter that is made of it */
} dvi__parameter;

typedef enum dvi__kind {
  DVI__LINES,
  DVI__ROTATION,
  DVI__MOTION,
  DVI__DIRECTION,
  DVI__ANGLE
} dvi__kind;

/* The numbers of a coordinate in q, or in v and p. Member m has `components` from first + m *
 * stride on, or from place[m] on if there is such a list. */
typedef struct dvi__slots {
  int first, stride, components;
  const int *place;
} dvi__slots;

/* Return the first number of member m. */
static inline int dvi__slots_at(const dvi__slots *slots, int m)
{
  return slots->place != NULL ? slots->place[m] : slots->first + m * slots->stride;
}

typedef struct dvi__coordinate {
  const char *name;
  dvi__span span;
  dvi__kind kind;
  int family;  /* number of indices, at most 2 */
  int size;    /* members of the family, or 1 */
  int columns; /* values of the last of two indices, by which members are counted first, or 1 */
  dvi__shape shape; /* shape of a member */
  dvi__slots q, v;
  const struct dvi__coordinate *part; /* [2] rotation and place of a motion */
  char part_name;                     /* R or x for such a part, else 0 */
} dvi__coordinate;

/* Return the number of values of index k, from 0, of a family. */
static inline int dvi__extent(const dvi__coordinate *x, int k)
{
  return k == 0 ? x->size / x->columns : x->columns;
}

/* The indices of a member of a family. A coordinate without a family has none. */
typedef struct dvi__subscripts {
  int count;
  const dvi__expression *of[2];
} dvi__subscripts;

/* The sorts of variables that an expression mentions, definitions included. */
enum {
  DVI__MENTIONS_Q = 1,
  DVI__MENTIONS_V = 2,
  DVI__MENTIONS_P = 4,
  DVI__MENTIONS_T = 8,
  DVI__MENTIONS_SUM = 16,
  DVI__MENTIONS_U = 64
};

/* Flags beside these. Velocities are then those of a state, v, and not the rates of stored numbers.
 * Parameters that are numbers are then variables. */
enum { DVI__OF_STATE = 32, DVI__OF_PARAMETERS = 128 };

typedef struct dvi__definition {
  const char *name;
  dvi__span span;
  const dvi__expression *is;
  dvi__shape shape;
  unsigned mentions;
  int used; /* 1 if something mentions it */
} dvi__definition;

typedef enum dvi__sort { DVI__PARAMETER, DVI__COORDINATE, DVI__DEFINITION, DVI__CONTROL } dvi__sort;

typedef struct dvi__name {
  const char *text;
  dvi__sort sort;
  int number; /* number in the list of its sort */
} dvi__name;

/* The names of a scene. Zero is empty. The arena owns the memory. */
typedef struct dvi__names {
  dvi__name *name;
  int count;
  int *table; /* hash table of places + 1 */
  int table_size;
} dvi__names;

/* Return the name of this text, or NULL. */
const dvi__name *dvi__names_find(const dvi__names *names, const char *text);

/* Add a name. Refuses a text that is no identifier, a word of the language, or taken. */
bool dvi__names_add(dvi__names *names, dvi__arena *arena, dvi__complaint *complaint,
                    const char *text, dvi__span span, dvi__sort sort, int number);

/* Return true for letters, digits and _, with a letter first. */
bool dvi__is_identifier(const char *text);

/* Complain of an unknown name, with the nearest known one. */
bool dvi__names_unknown(const dvi__names *names, dvi__arena *arena, dvi__complaint *complaint,
                        const char *text, dvi__span span);

/* Return "parameter", "coordinate", "definition" or "control". */
const char *dvi__sort_name(dvi__sort sort);

/* Write "a number", "a vector of 3" or "a 3 x 3 matrix" to text [size], and return it. */
const char *dvi__shape_text(dvi__shape shape, char *text, size_t size);

#endif
