/* Expressions as they are written, as a tree of their parts, each with its place. docs/scenes.md
 * has the grammar. */
#ifndef DVI_SCENE_TEXT_SYNTAX_H
#define DVI_SCENE_TEXT_SYNTAX_H
#include "text/arena.h"
#include "text/complaint.h"

typedef enum dvi__form {
  DVI__FORM_NUMBER,   /* number */
  DVI__FORM_NAME,     /* name */
  DVI__FORM_INDEX,    /* part[0] is indexed by part[1] .. part[count-1] */
  DVI__FORM_MEMBER,   /* member `name` of part[0], as B.R or B.x */
  DVI__FORM_RATE,     /* part[0]' */
  DVI__FORM_NEGATIVE, /* -part[0] */
  DVI__FORM_ADD,      /* part[0] + part[1], and so on */
  DVI__FORM_SUBTRACT,
  DVI__FORM_MULTIPLY,
  DVI__FORM_DIVIDE,
  DVI__FORM_POWER,
  DVI__FORM_CALL, /* name(part[0], .., part[count-1]) */
  DVI__FORM_LIST, /* [part[0], ..] */
  /* The sum of part[0] over name, or over name < name2. Its range is from part[1] to part[2] if
   * count is 3, and that of a family or list if count is 1. */
  DVI__FORM_SUM,
  DVI__FORM_IF, /* if(part[0], part[1], part[2]), where part[0] is one of the conditions below */
  DVI__FORM_COMPARE, /* part[0] name part[1], name one of < <= > >= == != */
  DVI__FORM_NOT,     /* not part[0] */
  DVI__FORM_AND,     /* part[0] and part[1] and .. */
  DVI__FORM_OR
} dvi__form;

typedef struct dvi__expression {
  dvi__form form;
  dvi__span span;
  double number;
  const char *name, *name2;
  int count;
  struct dvi__expression *const *part;
} dvi__expression;

/* Parse a part of the source. Line breaks are blanks. More than 64 levels are refused. A chain of +
 * and -, or of * and /, counts as one level, and is nested to the left without recursion. */
bool dvi__expression_parse(const dvi__source *source, dvi__span span, dvi__arena *arena,
                           dvi__complaint *complaint, const dvi__expression **expression);

#endif
