/* Characters of UTF-8. */
#ifndef DVI_TEXT_UTF8_H
#define DVI_TEXT_UTF8_H
#include <stddef.h>

/* Give the number of bytes of the character at the head of the text, and its code. 0 if there is
 * none (overlong, a surrogate, cut short, above U+10FFFF), or if size is 0. */
size_t dvi__utf8(const char *text, size_t size, unsigned *code);

/* Tell whether a character may stand in a scene. Control characters other than tab, LF and CR, and
 * other line breaks, may not. YAML 1.1 has such line breaks, 1.2 has not. */
int dvi__utf8_printable(unsigned code);

/* Tell whether a character is a blank, a tab, or part of a line break. */
int dvi__is_blank(char c);

#endif
