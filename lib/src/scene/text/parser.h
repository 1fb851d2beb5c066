/* The parser of expressions below its grammar. It gives the words of the text one after the other,
 * and makes nodes of them. Functions that return bool return false after a complaint. */
#ifndef DVI_SCENE_TEXT_PARSER_H
#define DVI_SCENE_TEXT_PARSER_H
#include "scene/text/lexer.h"
#include "scene/text/syntax.h"

typedef struct dvi__parser {
  const dvi__source *source;
  dvi__arena *arena;
  dvi__complaint *complaint;
  size_t end;       /* end of the part that is parsed */
  dvi__token token; /* the next token */
  size_t last;      /* the end of the token before */
  int depth;        /* levels of nesting, 0 outside of all brackets */
} dvi__parser;

/* Parts of a node, a list that grows. */
typedef struct dvi__row {
  dvi__expression **part;
  size_t count;
} dvi__row;

/* Format words as "found ')'" for a sentence, with at most 40 letters of the text. */
#define DVI__FOUND_FORMAT "%s%.*s%s"
#define DVI__FOUND(p)                                               \
  (p)->token.kind == DVI__TOKEN_END ? "the end" : "'",              \
      (int)((p)->token.span.size < 40 ? (p)->token.span.size : 40), \
      (p)->source->text + (p)->token.span.first, (p)->token.kind == DVI__TOKEN_END ? "" : "'"

/* Read the next token. */
bool dvi__parser_next(dvi__parser *p);

/* Count one more level of nesting. The caller takes it back. */
bool dvi__parser_enter(dvi__parser *p);

/* Read one token of this kind. `open` is the bracket that it closes, or nowhere. */
bool dvi__parser_expect(dvi__parser *p, int kind, const char *spelling, dvi__span open);

/* Read a name. */
bool dvi__parser_name(dvi__parser *p, const char **name);

/* Put the prefix of the file in which a place is in front of a name. Names that are kept stay as
 * they are. Returns NULL if there is no memory. */
const char *dvi__prefixed_name(const dvi__source *source, dvi__arena *arena, size_t place,
                               const char *name);

/* Return true if the next token is this word. */
bool dvi__parser_is_at(const dvi__parser *p, const char *word);

/* Return the text of the next token, ended by NUL, or NULL after a complaint. */
const char *dvi__parser_copy(const dvi__parser *p);

/* Make a node that ends with the last token. */
bool dvi__parser_node(const dvi__parser *p, dvi__form form, size_t first, const dvi__row *parts,
                      dvi__expression **result);

/* Make a node of one part (right is NULL) or of two, which begins with the first of them. */
bool dvi__parser_join(const dvi__parser *p, dvi__form form, dvi__expression *left,
                      dvi__expression *right, dvi__expression **result);

/* Add a part to a list of parts. */
bool dvi__row_add(const dvi__parser *p, dvi__row *parts, dvi__expression *part);

#endif
