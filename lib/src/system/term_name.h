/* The terms of a system in words. */
#ifndef DVI_SYSTEM_TERM_NAME_H
#define DVI_SYSTEM_TERM_NAME_H

/* Return the name of the first of some terms (dvi__term), as it stands after "declares". */
const char *dvi__term_name(unsigned terms);

#endif
