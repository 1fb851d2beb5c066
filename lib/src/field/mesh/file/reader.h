/* The bytes of a file, and the words and numbers in it. Every refusal names the place: a line of a
 * text, a byte of a binary file. */
#ifndef DVI_FIELD_MESH_FILE_READER_H
#define DVI_FIELD_MESH_FILE_READER_H
#include <dvi/status.h>
#include <stddef.h>
#include <stdint.h>

#include "core/status.h"

/* Where the reading of a file is. */
typedef struct dvi__reader {
  const char *path; /* for messages */
  const unsigned char *byte;
  size_t size, at;
  size_t mark;   /* where the last word or number began */
  int is_binary; /* numbers are little-endian bytes, and messages tell bytes instead of lines */
  char comment;  /* begins a comment up to the end of its line. 0 if there is none */
} dvi__reader;

/* A word with printable letters, cut after some of them. */
typedef struct dvi__word {
  char text[64];
  size_t length; /* of the whole word */
} dvi__word;

/* Load a file as a whole. The bytes are to be released with dvi__release. DVI_IO_ERROR. */
dvi_status dvi__load(const char *path, unsigned char **byte, size_t *size);

/* Fail with DVI_BAD_FILE, and the place in front of the sentence. */
dvi_status dvi__reject(const dvi__reader *r, size_t place, const char *format, ...)
    DVI_PRINTF(3, 4);

/* Refuse a count if the bytes that are left cannot hold so many things, of which each has at least
 * these bytes in a text, or in a binary file. */
dvi_status dvi__claim(const dvi__reader *r, const char *things, int64_t count, int64_t text_bytes,
                      int64_t binary_bytes);

/* Go to the next word, over blanks, line breaks and comments. Returns 0 at the end. */
int dvi__skip_blanks(dvi__reader *r);

/* Go behind the end of the line. */
void dvi__skip_line(dvi__reader *r);

/* Go to the next line, which must be the end of this one. */
dvi_status dvi__end_line(dvi__reader *r, const char *behind);

/* Read a word. `what` says in messages what is expected. */
dvi_status dvi__read_word(dvi__reader *r, const char *what, dvi__word *word);

/* Read a word that is known. */
dvi_status dvi__expect_word(dvi__reader *r, const char *known);

/* Read an integer that is a word. */
dvi_status dvi__read_text_integer(dvi__reader *r, const char *what, int64_t least, int64_t most,
                                  int64_t *value);

/* Read an integer, which has these bytes in a binary file, 4 or 8. */
dvi_status dvi__read_integer(dvi__reader *r, const char *what, int width, int64_t least,
                             int64_t most, int64_t *value);

/* Read a finite number, a double in a binary file. */
dvi_status dvi__read_real(dvi__reader *r, const char *what, double *value);

/* Take some bytes as they are. */
dvi_status dvi__read_bytes(dvi__reader *r, const char *what, size_t count,
                           const unsigned char **byte);

/* Give the unsigned integer in `width` little-endian bytes. */
uint64_t dvi__little_endian(const unsigned char *byte, int width);

#endif
