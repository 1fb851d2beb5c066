/* The words of the language of expressions, functions and constants. */
#ifndef DVI_SCENE_ELABORATE_WORDS_H
#define DVI_SCENE_ELABORATE_WORDS_H
#include "expr/graph.h"

/* A function of one or two numbers. */
typedef struct dvi__function_word {
  const char *name;
  dvi__op op;
  int arguments;
} dvi__function_word;

/* Return the function of this name, or NULL. */
const dvi__function_word *dvi__function_word_of(const char *name);

/* List all words, for messages. dvi__is_word tells a text that no name may be. */
int dvi__word_count(void);
const char *dvi__word(int i);
bool dvi__is_word(const char *text);

#endif
