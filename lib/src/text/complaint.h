/* Errors with their place, which is the line, the column, the text of the line and a caret under
 * it. */
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

/* A file within a source. Its names get a prefix in front, but for those that `keeps` holds. */
typedef struct dvi__source_part {
  const char *name;
  size_t first, size;
  const char *prefix;
  bool (*keeps)(const char *name);
} dvi__source_part;

/* A file's name and its text, which need not end with NUL. The caller owns both. Where a text
 * consists of several files, with one letter between them, `part` [part_count] tells them apart. */
typedef struct dvi__source {
  const char *name, *text;
  size_t size;
  const dvi__source_part *part;
  int part_count;
} dvi__source;

/* A part of a source. It is nowhere if first > size of the source. */
typedef struct dvi__span {
  size_t first, size;
} dvi__span;

#define DVI__NOWHERE ((dvi__span){(size_t)-1, 0})

/* The first error of a scene. Later ones are dropped. */
typedef struct dvi__complaint {
  const dvi__source *source;
  dvi_status status; /* DVI_OK if there is none yet */
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

/* Complain of memory that was refused, by DVI_BAD_SIZE if it was too much, else by DVI_NO_MEMORY.
 * Returns false. */
bool dvi__complain_of_memory(dvi__complaint *complaint);

/* Print as snprintf, with a decimal point in all numbers. */
int dvi__print(char *text, size_t size, const char *format, ...) DVI__TEXT_PRINTF(3, 4);

/* Complain of a file that is no scene. The message tells what the file is, if that is known, and
 * what a scene is. Returns false. */
bool dvi__complain_of_file(dvi__complaint *complaint, dvi__span where, const char *is);

/* Return the part of a source in which a place is, or NULL if it has no parts. */
const dvi__source_part *dvi__source_part_at(const dvi__source *source, size_t offset);

/* Return the name of the file in which a place is. */
const char *dvi__source_name(const dvi__source *source, size_t offset);

/* Give the line and the column of a place in its file, from 1. Columns count characters of
 * UTF-8. */
void dvi__source_place(const dvi__source *source, size_t offset, int *line, int *column);

/* Write "; did you mean X?" to `hint` for the nearest of the candidates [count] if one is near,
 * else "". Returns `hint` [size]. */
const char *dvi__nearest(const char *word, int count, const char *const *candidate, char *hint,
                         size_t size);

/* Write the words [count] to `list` [size], with commas between them and `last`, such as " or ",
 * before the last one. What finds no room is cut. Returns `list`. */
const char *dvi__list_words(int count, const char *const *word, const char *last, char *list,
                            size_t size);

/* As dvi__nearest, but "; it has A, B and C" if none is near and they are no more than a dozen. */
const char *dvi__nearest_or_all(const char *word, int count, const char *const *candidate,
                                char *hint, size_t size);

#endif
