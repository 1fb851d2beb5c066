/* Errors with their place: line, column, the line itself and a caret under it. */
#ifndef DVI_TEXT_COMPLAINT_H
#define DVI_TEXT_COMPLAINT_H
#include <dvi/status.h>
#include <stdbool.h>
#include <stddef.h>

#if defined(__GNUC__)
#define DVI__TEXT_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define DVI__TEXT_PRINTF(text, first)
#endif

/* A file's name and its text, which need not end with NUL. Owned by the caller. */
typedef struct dvi__source {
  const char *name, *text;
  size_t size;
} dvi__source;

/* A part of a source; first > size of the source: nowhere. */
typedef struct dvi__span {
  size_t first, size;
} dvi__span;

#define DVI__NOWHERE ((dvi__span){(size_t)-1, 0})

/* Where the first error of a scene goes; later ones are dropped. */
typedef struct dvi__complaint {
  const dvi__source *source;
  dvi_status status; /* DVI_OK: none yet */
  char *message;     /* [size], owned by the caller */
  size_t size;
} dvi__complaint;

/* Set status and message, as in
 *     cart.yaml:14:31: there is no 'thet'; did you mean theta?
 *       lagrangian: M/2*x'^2 + cos(thet)
 *                                  ^~~~
 * Returns false, always. */
bool dvi__complain(dvi__complaint *complaint, dvi_status status, dvi__span where,
                   const char *format, ...) DVI__TEXT_PRINTF(4, 5);

/* The same for memory that was refused: DVI_BAD_SIZE if it was too much, else DVI_NO_MEMORY.
 * Returns false. */
bool dvi__complain_of_memory(dvi__complaint *complaint);

/* As snprintf, with a decimal point in all numbers. */
int dvi__print(char *text, size_t size, const char *format, ...) DVI__TEXT_PRINTF(3, 4);

/* The same for a file that is no scene: what it is instead, if that is known, and what a scene
 * is. Returns false. */
bool dvi__complain_of_file(dvi__complaint *complaint, dvi__span where, const char *is);

/* The line and the column of a place, from 1; columns count characters of UTF-8. */
void dvi__source_place(const dvi__source *source, size_t offset, int *line, int *column);

/* "; did you mean X?" for the nearest of the candidates [count] if one is near, else "". `hint`
 * [size] is returned. */
const char *dvi__nearest(const char *word, int count, const char *const *candidate, char *hint,
                         size_t size);

#endif
