/** The page and its program, which the build puts into the command (apps/view/page). */
#ifndef VIEW_TEXTS_H
#define VIEW_TEXTS_H
#include "load/catalogue.h"

/** "page", with marks for the title, the run and the program, and "program". Ends with an element
 * without a name. */
extern const catalogue_text page_texts[];
#endif
