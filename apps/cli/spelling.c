#include "cli/spelling.h"

#include <stdio.h>
#include <string.h>

enum { WORD_MAX = 63 };

static int least_of_three(int a, int b, int c)
{
  const int ab = a < b ? a : b;
  return ab < c ? ab : c;
}

/* Count the insertions, deletions and replacements between two words (Levenshtein), one row of the
 * table at a time. */
static int edit_distance(const char *from, const char *to)
{
  const int columns = (int)strlen(to);
  int row[WORD_MAX + 1];
  for (int j = 0; j <= columns; j++) row[j] = j;
  for (int i = 1; from[i - 1] != '\0'; i++) {
    int diagonal = row[0];
    row[0] = i;
    for (int j = 1; j <= columns; j++) {
      const int above = row[j];
      row[j] = least_of_three(above + 1, row[j - 1] + 1, diagonal + (from[i - 1] != to[j - 1]));
      diagonal = above;
    }
  }
  return row[columns];
}

const char *nearest_word(const char *word, word_at known, const void *list)
{
  const size_t length = strlen(word);
  if (length > WORD_MAX) return NULL;
  /* with more edits the word is another word, not a slip */
  int best = length < 3 ? (int)length : length < 6 ? 3 : 4;
  const char *nearest = NULL;
  const char *candidate;
  for (int k = 0; (candidate = known(k, list)) != NULL; k++) {
    if (strlen(candidate) > WORD_MAX) continue;
    const int distance = strncmp(candidate, word, length) == 0 && length > 1
                             ? 1
                             : edit_distance(word, candidate);
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

const char *suggestion(const char *word, word_at known, const void *list, char *text, size_t size)
{
  const char *nearest = nearest_word(word, known, list);
  if (nearest == NULL)
    text[0] = '\0';
  else
    (void)snprintf(text, size, " (did you mean '%s'?)", nearest);
  return text;
}
