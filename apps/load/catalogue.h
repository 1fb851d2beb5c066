/** The catalogue's problems as scenes. The build puts the texts of apps/scenes into the command. */
#ifndef CATALOGUE_H
#define CATALOGUE_H
#include <stddef.h>

/** One of these scenes. */
typedef struct catalogue_text {
  const char *name, *text;
  size_t length;
} catalogue_text;

/** The problems of the catalogue, and the templates of dvi init (apps/templates). Both end with an
 * element without a name. */
extern const catalogue_text catalogue_texts[], template_texts[];
#endif
