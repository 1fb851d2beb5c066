/** The nearest of some known words, for messages about unknown words. */
#ifndef SPELLING_H
#define SPELLING_H
#include <stddef.h>

/** Return word k of a list, or NULL at its end. */
typedef const char *(*word_at)(int k, const void *list);

/** Return the known word that takes the fewest edits from `word`, or NULL if these are too many for
 * a slip of the fingers. */
const char *nearest_word(const char *word, word_at known, const void *list);

/** Write " (did you mean 'galerkin'?)" to text, or "" if no known word is near. Returns text. */
const char *suggestion(const char *word, word_at known, const void *list, char *text, size_t size);
#endif
