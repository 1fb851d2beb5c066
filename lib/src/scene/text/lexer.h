/* The words of expressions. */
#ifndef DVI_SCENE_TEXT_LEXER_H
#define DVI_SCENE_TEXT_LEXER_H
#include "text/complaint.h"

/* Kinds of tokens. A mark of one character has that character's code as its kind. */
typedef enum dvi__token_kind {
  DVI__TOKEN_END = 0,
  DVI__TOKEN_NUMBER = 256, /* digits, point and exponent, not read yet */
  DVI__TOKEN_NAME,
  DVI__TOKEN_RANGE,    /* .. */
  DVI__TOKEN_AT_MOST,  /* <= */
  DVI__TOKEN_AT_LEAST, /* >= */
  DVI__TOKEN_EQUALS,   /* == */
  DVI__TOKEN_DIFFERS   /* != */
} dvi__token_kind;

typedef struct dvi__token {
  int kind; /* a dvi__token_kind, or one of + - * / ^ ( ) [ ] , . ' < > = */
  dvi__span span;
} dvi__token;

/* Read the token at `offset` or behind blanks and comments (# to the end of the line), before
 * `end`. Returns false, with a complaint, if something else stands there. */
bool dvi__token_read(const dvi__source *source, size_t offset, size_t end,
                     dvi__complaint *complaint, dvi__token *token);

#endif
