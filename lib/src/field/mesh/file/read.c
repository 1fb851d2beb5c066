/* Reading a mesh: which format a file has, and the options. */
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "field/mesh/file/formats.h"

/* A format with the word with which its files begin. */
typedef struct format {
  const char *name, *begin;
  char comment; /* may stand before it */
  dvi_status (*read)(dvi__reader *r, dvi__raw *raw);
} format;
static const format formats[] = {
    {"msh", "$MeshFormat", 0, dvi__read_msh},
    {"off", "OFF", '#', dvi__read_off},
    {"ply", "ply", 0, dvi__read_ply},
};
enum { FORMATS = sizeof formats / sizeof *formats };

static dvi_status find_by_name(const char *name, const format **found)
{
  for (int i = 0; i < FORMATS; i++)
    if (strcmp(formats[i].name, name) == 0) {
      *found = formats + i;
      return DVI_OK;
    }
  return dvi__fail(DVI_BAD_OPTION,
                   "mesh file: there is no format \"%.64s\"; there are msh, off, ply, and NULL to "
                   "look into the file",
                   name);
}

/* Each format begins with a word of its own. */
static dvi_status find_by_content(const dvi__reader *r, const format **found)
{
  dvi__word word;
  for (int i = 0; i < FORMATS; i++) {
    dvi__reader ahead = *r;
    ahead.comment = formats[i].comment;
    if (dvi__skip_blanks(&ahead) && dvi__read_word(&ahead, "a format", &word) == DVI_OK &&
        strcmp(word.text, formats[i].begin) == 0) {
      *found = formats + i;
      return DVI_OK;
    }
  }
  dvi__reader ahead = *r;
  DVI_TRY(dvi__read_word(&ahead, "$MeshFormat (MSH), OFF or ply", &word));
  return dvi__reject(&ahead, ahead.mark,
                     "found \"%s\" where $MeshFormat (MSH), OFF or ply is expected", word.text);
}

static dvi_status check_options(const dvi_mesh_read_options *options)
{
  if (options->size != sizeof *options)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "mesh file: set options.size to sizeof(dvi_mesh_read_options)");
  if (options->space < 0 || options->space > DVI_MESH_SPACE_MAX)
    return dvi__fail(DVI_BAD_OPTION, "mesh file: space is %d, and must be 1 to %d", options->space,
                     (int)DVI_MESH_SPACE_MAX);
  if (options->space == 0 && (options->metric != NULL || options->period != NULL))
    return dvi__fail(DVI_BAD_OPTION,
                     "mesh file: a metric and periods need `space`, which tells their number");
  return DVI_OK;
}

dvi_status dvi__mesh_parse(const char *path, const unsigned char *byte, size_t size,
                           const dvi_mesh_read_options *options, dvi_mesh **mesh)
{
  const dvi_mesh_read_options defaults = {.size = sizeof defaults},
                              *given = options != NULL ? options : &defaults;
  dvi__reader reader = {.path = path, .byte = byte, .size = size};
  dvi__raw raw = {.reader = &reader};
  const format *found = formats;
  *mesh = NULL;
  DVI_TRY(check_options(given));
  DVI_TRY(given->format != NULL ? find_by_name(given->format, &found)
                                : find_by_content(&reader, &found));
  dvi_status status = found->read(&reader, &raw);
  if (status == DVI_OK) status = dvi__raw_mesh(&raw, given, mesh);
  dvi__raw_clear(&raw);
  return status;
}

dvi_status dvi_mesh_read(const char *path, const dvi_mesh_read_options *options, dvi_mesh **mesh)
{
  unsigned char *byte = NULL;
  size_t size = 0;
  if (mesh != NULL) *mesh = NULL;
  if (path == NULL || mesh == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "mesh file: a path and a mesh are needed");
  DVI_TRY(dvi__load(path, &byte, &size));
  const dvi_status status = dvi__mesh_parse(path, byte, size, options, mesh);
  dvi__release(byte);
  return status;
}
