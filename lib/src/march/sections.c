#include "march/sections.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"

enum { ORDER_MARK = 0x01020304, FORMAT = 6, UNIT = 8 };

typedef struct file_header {
  char magic[8];
  uint32_t order_mark, format;
} file_header;

typedef struct section_header {
  char name[DVI__SECTION_NAME]; /* padded with zeros */
  uint32_t version, none;
  uint64_t size; /* size of the content without padding */
  uint64_t hash; /* hash of the fields above and of the content with padding */
} section_header;

static const char magic[8] = {'d', 'v', 'i', 's', 't', 'a', 't', 'e'};
static const char end_name[] = "end";

static size_t padded_size(size_t size)
{
  return (size + UNIT - 1) / UNIT * UNIT;
}

static uint64_t hash_section(const section_header *header, const unsigned char *content)
{
  const uint64_t hash = dvi__hash(DVI__HASH_START, offsetof(section_header, hash), header);
  return dvi__hash(hash, padded_size(header->size), content);
}

/* ---- write ---- */

static void release_writer(dvi__sections_writer *w)
{
  dvi__release(w->bytes);
  w->bytes = NULL;
}

static void writer_append(dvi__sections_writer *w, const void *content, size_t size)
{
  if (w->bytes == NULL) return;
  if (w->size + size > w->capacity) {
    const size_t capacity = 2 * (w->size + size);
    unsigned char *larger = DVI_NEW(unsigned char, capacity);
    if (larger != NULL) memcpy(larger, w->bytes, w->size);
    release_writer(w);
    w->bytes = larger;
    w->capacity = capacity;
    if (larger == NULL) return;
  }
  if (size > 0) memcpy(w->bytes + w->size, content, size);
  w->size += size;
}

void dvi__sections_start(dvi__sections_writer *w, size_t capacity)
{
  file_header header = {.order_mark = ORDER_MARK, .format = FORMAT};
  memcpy(header.magic, magic, sizeof magic);
  *w = (dvi__sections_writer){.bytes = DVI_NEW(unsigned char, capacity), .capacity = capacity};
  writer_append(w, &header, sizeof header);
}

/* Write the size and the hash of the section that ends here. */
static void close_section(dvi__sections_writer *w)
{
  static const unsigned char zeros[UNIT] = {0};
  section_header header;
  if (w->bytes == NULL || w->section == 0) return;
  const size_t size = w->size - w->section - sizeof header;
  writer_append(w, zeros, padded_size(size) - size);
  if (w->bytes == NULL) return;
  memcpy(&header, w->bytes + w->section, sizeof header);
  header.size = size;
  header.hash = hash_section(&header, w->bytes + w->section + sizeof header);
  memcpy(w->bytes + w->section, &header, sizeof header);
}

void dvi__section_open(dvi__sections_writer *w, const char *name, uint32_t version)
{
  section_header header = {.version = version};
  close_section(w);
  w->section = w->size;
  memcpy(header.name, name, strlen(name));
  writer_append(w, &header, sizeof header);
}

void dvi__section_put(dvi__sections_writer *w, const void *content, size_t size)
{
  writer_append(w, content, size);
}

dvi_status dvi__sections_finish(dvi__sections_writer *w)
{
  const size_t asked = w->capacity;
  dvi__section_open(w, end_name, 0);
  close_section(w);
  return w->bytes != NULL ? DVI_OK
                          : dvi__fail(DVI_NO_MEMORY, "checkpoint: no memory for %zu bytes", asked);
}

/* ---- check ---- */

static dvi_status refuse_cut(const dvi__sections *s)
{
  return dvi__fail(DVI_BAD_FILE, "%s: cut short, %zu bytes", s->name, s->size);
}

static dvi_status refuse_damage(const dvi__sections *s)
{
  return dvi__fail(DVI_BAD_FILE, "%s: damaged (a checksum is wrong)", s->name);
}

static dvi_status check_file_header(const dvi__sections *s)
{
  file_header header = {.magic = ""};
  memcpy(&header, s->bytes, s->size < sizeof header ? s->size : sizeof header);
  if (s->size >= sizeof magic && memcmp(header.magic, magic, sizeof magic) != 0)
    return dvi__fail(DVI_BAD_FILE, "%s: no saved state of libdvi", s->name);
  if (s->size < sizeof header) return refuse_cut(s);
  if (header.order_mark != ORDER_MARK)
    return dvi__fail(DVI_BAD_FILE, "%s: written on another kind of machine", s->name);
  if (header.format == FORMAT) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE,
                   "%s: written in format %" PRIu32
                   " by another version of libdvi; this one reads format %d. Finish the run "
                   "with the version that wrote it, or run it again from its start",
                   s->name, header.format, FORMAT);
}

/* Check the section at an offset, and return its header and the offset of the next section.
 * DVI_BAD_FILE if the section is not whole. */
static dvi_status check_section(const dvi__sections *s, size_t at, section_header *header,
                                size_t *next)
{
  if (s->size - at < sizeof *header) return refuse_cut(s);
  memcpy(header, s->bytes + at, sizeof *header);
  const size_t content = at + sizeof *header;
  if (header->size > s->size - content || padded_size(header->size) > s->size - content)
    return refuse_cut(s);
  *next = content + padded_size(header->size);
  return hash_section(header, s->bytes + content) == header->hash ? DVI_OK : refuse_damage(s);
}

static int section_is_named(const section_header *header, const char *name)
{
  return strncmp(header->name, name, sizeof header->name) == 0;
}

dvi_status dvi__sections_check(dvi__sections *s, const char *name, const void *bytes, size_t size)
{
  section_header header = {.name = ""};
  size_t at = sizeof(file_header);
  *s = (dvi__sections){
      .name = name, .bytes = bytes, .size = size, .own = s->own, .parts = s->parts};
  DVI_TRY(check_file_header(s));
  while (!section_is_named(&header, end_name)) DVI_TRY(check_section(s, at, &header, &at));
  if (at == size) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "%s: too long, %zu bytes instead of %zu", name, size, at);
}

/* ---- read ---- */

/* Read a stream until its end, since the size of a stream is not reliable. Reading stops early at
 * a wrong header. */
static dvi_status read_stream(FILE *stream, dvi__sections *s)
{
  size_t capacity = 4096;
  s->own = DVI_NEW(unsigned char, capacity);
  while (s->own != NULL) {
    s->bytes = s->own;
    s->size += fread(s->own + s->size, 1, capacity - s->size, stream);
    if (ferror(stream))
      return dvi__fail(DVI_IO_ERROR, "%s: cannot read it: %s", s->name, strerror(errno));
    DVI_TRY(check_file_header(s));
    if (s->size < capacity) return DVI_OK;
    unsigned char *larger = DVI_NEW(unsigned char, 2 * capacity);
    if (larger != NULL) memcpy(larger, s->own, s->size);
    dvi__release(s->own);
    s->own = larger;
    capacity *= 2;
  }
  return dvi__fail(DVI_NO_MEMORY, "%s: no memory for %zu bytes", s->name, capacity);
}

dvi_status dvi__sections_read(const char *path, dvi__sections *s)
{
  FILE *stream = fopen(path, "rb");
  if (stream == NULL)
    return dvi__fail(DVI_IO_ERROR, "%s: cannot read it: %s", s->name, strerror(errno));
  const dvi_status status = read_stream(stream, s);
  (void)fclose(stream);
  return status == DVI_OK ? dvi__sections_check(s, s->name, s->own, s->size) : status;
}

void dvi__sections_clear(dvi__sections *s)
{
  dvi__release(s->own);
  *s = (dvi__sections){0};
}

/* ---- find ---- */

int dvi__sections_have(const dvi__sections *s, const char *name)
{
  section_header header;
  size_t at = sizeof(file_header), next;
  for (; check_section(s, at, &header, &next) == DVI_OK; at = next) {
    if (section_is_named(&header, name)) return 1;
    if (section_is_named(&header, end_name)) return 0;
  }
  return 0;
}

dvi_status dvi__section_find(const dvi__sections *s, const char *name, uint32_t version,
                             size_t size, dvi__section *found)
{
  section_header header;
  size_t at = sizeof(file_header), next;
  for (;; at = next) {
    DVI_TRY(check_section(s, at, &header, &next));
    if (section_is_named(&header, name)) break;
    if (section_is_named(&header, end_name))
      return dvi__fail(DVI_BAD_FILE, "%s: it has no section '%s': another method has saved it",
                       s->name, name);
  }
  if (header.version != version)
    return dvi__fail(DVI_BAD_FILE,
                     "%s: section '%s' is of version %" PRIu32
                     "; this libdvi reads version %" PRIu32,
                     s->name, name, header.version, version);
  if (size != DVI__ANY_SIZE && header.size != size)
    return dvi__fail(DVI_BAD_FILE, "%s: section '%s' has %" PRIu64 " bytes instead of %zu", s->name,
                     name, header.size, size);
  *found = (dvi__section){header.version, s->bytes + at + sizeof header, header.size};
  return DVI_OK;
}
