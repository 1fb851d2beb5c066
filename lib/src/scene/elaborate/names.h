/* The names of a scene: parameters, coordinates and definitions, and what each of them is. */
#ifndef DVI_SCENE_NAMES_H
#define DVI_SCENE_NAMES_H
#include "text/arena.h"
#include "text/complaint.h"
#include "scene/text/syntax.h"

/* rank 0: a number; 1: a vector of `rows`; 2: a matrix. rank -1: none, an error was told. */
typedef struct dvi__shape {
  int rank, rows, columns;
} dvi__shape;

/* Where a parameter stands: in an initial value, or in any other section but `parameters`. */
enum { DVI__IN_PARAMETERS = 0, DVI__IN_START = 1, DVI__ELSEWHERE = 2 };

/* The parameters that another one is made of. */
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
  unsigned stands;              /* DVI__IN_START, DVI__ELSEWHERE: complete when the scene is read */
  const dvi__source_of *source; /* what it is made of */
  int last_made;                /* the number + 1 of the last parameter that is made of it */
} dvi__parameter;

typedef enum dvi__kind {
  DVI__LINES,
  DVI__ROTATION,
  DVI__MOTION,
  DVI__DIRECTION,
  DVI__ANGLE
} dvi__kind;

/* The numbers of a coordinate in q, or in v and p: member m has `components` from first + m *
 * stride on. */
typedef struct dvi__slots {
  int first, stride, components;
} dvi__slots;

typedef struct dvi__coordinate {
  const char *name;
  dvi__span span;
  dvi__kind kind;
  int family;  /* how many indices it has, at most 2 */
  int size;    /* members of the family; 1 */
  int columns; /* values of the last one of two indices, which members are counted by first; 1 */
  dvi__shape shape; /* of a member */
  dvi__slots q, v;
  const struct dvi__coordinate *part; /* of a motion: [2], its rotation and its place */
  char part_name;                     /* of such a part: R or x; else 0 */
} dvi__coordinate;

/* Values of index k, from 0, of a family. */
static inline int dvi__extent(const dvi__coordinate *x, int k)
{
  return k == 0 ? x->size / x->columns : x->columns;
}

/* The indices of a member of a family, none of what is no family. */
typedef struct dvi__subscripts {
  int count;
  const dvi__expression *of[2];
} dvi__subscripts;

/* What an expression mentions, definitions seen through. */
enum { DVI__SAYS_Q = 1, DVI__SAYS_V = 2, DVI__SAYS_P = 4, DVI__SAYS_T = 8, DVI__SAYS_SUM = 16 };

/* Beside what may stand somewhere: velocities there are those of a state, v, and not the rates of
 * what is stored. */
enum { DVI__OF_STATE = 32 };

typedef struct dvi__definition {
  const char *name;
  dvi__span span;
  const dvi__expression *is;
  dvi__shape shape;
  unsigned says;
  int stands; /* 1: something mentions it */
} dvi__definition;

typedef enum dvi__sort { DVI__PARAMETER, DVI__COORDINATE, DVI__DEFINITION } dvi__sort;

typedef struct dvi__name {
  const char *text;
  dvi__sort sort;
  int number; /* in the list of its sort */
} dvi__name;

/* Zero: empty. Its memory is the arena's. */
typedef struct dvi__names {
  dvi__name *name;
  int count;
  int *table; /* hash table of places + 1 */
  int table_size;
} dvi__names;

/* The name of this text, or NULL. */
const dvi__name *dvi__names_find(const dvi__names *names, const char *text);

/* Add a name; refused if it is no identifier, a word of the language, or there already. */
bool dvi__names_add(dvi__names *names, dvi__arena *arena, dvi__complaint *complaint,
                    const char *text, dvi__span span, dvi__sort sort, int number);

/* Letters, digits and _, a letter first. */
bool dvi__is_identifier(const char *text);

/* Complain of an unknown name, with the nearest known one. */
bool dvi__names_unknown(const dvi__names *names, dvi__arena *arena, dvi__complaint *complaint,
                        const char *text, dvi__span span);

/* "parameter", "coordinate" or "definition". */
const char *dvi__sort_name(dvi__sort sort);

/* "a number", "a vector of 3" or "a 3 x 3 matrix", into text [size], which is returned. */
const char *dvi__shape_text(dvi__shape shape, char *text, size_t size);

#endif
