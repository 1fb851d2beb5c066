/** Pages that show a run: an HTML file with the program that draws it and the numbers it draws. */
#ifndef VIEW_PAGE_H
#define VIEW_PAGE_H
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/** A page being written. Its numbers are JSON, in which long lists are bytes in base64. */
typedef struct page {
  FILE *stream;
  unsigned char rest[3]; /**< bytes that wait for more */
  int waiting;
} page;

/** Write the page's beginning, with its title. */
void page_begin(page *p, FILE *stream, const char *title);

/** Write the end, with the program. */
void page_end(page *p);

/** Write a text as a JSON string. */
void page_text(page *p, const char *text);

/** Write lists of numbers of 32 bits: begin one, add to it, end it. */
void page_floats_begin(page *p);
void page_float(page *p, double number);
void page_integers_begin(page *p);
void page_integer(page *p, int64_t number);
void page_list_end(page *p);
#endif
