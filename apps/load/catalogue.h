/** The catalogue's problems as scenes: the texts of apps/scenes, which the build puts into the
 * command. */
#ifndef CATALOGUE_H
#define CATALOGUE_H
#include <stddef.h>

/** One of them. */
typedef struct catalogue_text {
  const char *name, *text;
  size_t length;
} catalogue_text;

/** Ended by one without a name. */
extern const catalogue_text catalogue_texts[];
#endif
