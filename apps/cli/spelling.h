/** The nearest of some known words, for messages about unknown ones. */
#ifndef SPELLING_H
#define SPELLING_H
#include <stddef.h>

/** Word k of a list; NULL ends the list. */
typedef const char *(*word_at)(int k, const void *list);

/** The known word that takes the fewest edits from `word`, if they are few enough for a slip of the
 * fingers; else NULL. */
const char *nearest_word(const char *word, word_at known, const void *list);

/** " (did you mean 'galerkin'?)" in text, or "" if no known word is near. Returns text. */
const char *suggestion(const char *word, word_at known, const void *list, char *text, size_t size);
#endif
