/* Saved states: tagged sections in one block of bytes, of a file or in memory.
 *
 * The layout begins with a header of magic, byte order mark and format. Sections follow, each with
 * a name, a version, the length of its content, a hash of both, and the content, padded by zeros to
 * a multiple of 8 bytes. A section "end" without content comes last. Numbers have the machine's own
 * byte order. A reader of a section refuses versions that it does not know. Sections that are not
 * read are no error. */
#ifndef DVI_MARCH_SECTIONS_H
#define DVI_MARCH_SECTIONS_H
#include <dvi/status.h>
#include <stddef.h>
#include <stdint.h>

enum { DVI__SECTION_NAME = 16 };

/* ---- write ---- */

/* Bytes in the course of writing. After a failed allocation `bytes` is NULL, and all calls do
 * nothing. */
typedef struct dvi__sections_writer {
  unsigned char *bytes; /* owned, free by dvi__release */
  size_t size, capacity;
  size_t section;                 /* where the open section begins */
  const struct dvi__parts *parts; /* what holds the large arrays, or NULL (march/parts.h) */
} dvi__sections_writer;

/* Start writing, with memory for `capacity` bytes, which grows. */
void dvi__sections_start(dvi__sections_writer *writer, size_t capacity);

/* Open a section, and put its content in parts. The next section or the end closes it. */
void dvi__section_open(dvi__sections_writer *writer, const char *name, uint32_t version);
void dvi__section_put(dvi__sections_writer *writer, const void *content, size_t size);

/* Close the last section. DVI_NO_MEMORY if an allocation failed. The bytes are released then. */
dvi_status dvi__sections_finish(dvi__sections_writer *writer);

/* ---- read ---- */

/* Bytes in the course of reading. */
typedef struct dvi__sections {
  const char *name;           /* name in sentences, such as "checkpoint run.state" */
  const unsigned char *bytes; /* aligned as for any number */
  size_t size;
  unsigned char *own; /* bytes owned, freed by dvi__sections_clear. NULL for the caller's bytes */
  const struct dvi__parts *parts; /* what holds the large arrays, or NULL (march/parts.h) */
} dvi__sections;

/* A section's content. The pointers point into the bytes. */
typedef struct dvi__section {
  uint32_t version;
  const unsigned char *content;
  size_t size;
} dvi__section;

/* Read a whole file, and check it as below. DVI_IO_ERROR. */
dvi_status dvi__sections_read(const char *path, dvi__sections *sections);

/* Check bytes in memory. DVI_BAD_FILE, with a sentence, if they are no saved state, are cut short,
 * go on behind the end, are damaged, or are of another format or kind of machine. */
dvi_status dvi__sections_check(dvi__sections *sections, const char *name, const void *bytes,
                               size_t size);

void dvi__sections_clear(dvi__sections *sections);

/* Tell if there is a section of a name. */
int dvi__sections_have(const dvi__sections *sections, const char *name);

/* Find a section. DVI_BAD_FILE if there is none, if its version is another one, or if its content
 * has another number of bytes than `size`. */
#define DVI__ANY_SIZE SIZE_MAX
dvi_status dvi__section_find(const dvi__sections *sections, const char *name, uint32_t version,
                             size_t size, dvi__section *found);

#endif
