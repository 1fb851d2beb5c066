/* Characters of UTF-8. */
#ifndef DVI_TEXT_UTF8_H
#define DVI_TEXT_UTF8_H
#include <stddef.h>

/* How many bytes the character at the head of the text takes, with its code; 0 if it is none
 * (overlong, a surrogate, cut short, above U+10FFFF), or if size is 0. */
size_t dvi__utf8(const char *text, size_t size, unsigned *code);

/* Whether it may stand in a scene: no control character but tab, LF and CR, and no other break of
 * lines: YAML 1.1 has them, 1.2 has not. */
int dvi__utf8_printable(unsigned code);

/* Whether it is a blank, a tab, or part of a break of lines. */
int dvi__is_blank(char c);

#endif
