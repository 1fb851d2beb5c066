#include "field/mesh/file/sink.h"

#include <dvi/number.h>
#include <stdarg.h>
#include <string.h>

#include "core/memory.h"
#include "march/whole_file.h"

enum { ROOM = 1 << 16 };

dvi_status dvi__sink_begin(dvi__sink *sink, const char *path)
{
  *sink = (dvi__sink){.at = DVI_NEW(unsigned char, ROOM)};
  if (sink->at == NULL) return dvi__fail(DVI_NO_MEMORY, "%.300s: no memory for the file", path);
  return dvi__whole_begin(path, &sink->file);
}

static void empty(dvi__sink *sink)
{
  dvi__whole_put(sink->file, sink->at, sink->count);
  sink->count = 0;
}

void dvi__put_bytes(dvi__sink *sink, const void *bytes, size_t count)
{
  if (sink->file == NULL || count == 0) return;
  if (sink->count + count > ROOM) empty(sink);
  if (count > ROOM) {
    dvi__whole_put(sink->file, bytes, count);
    return;
  }
  memcpy(sink->at + sink->count, bytes, count);
  sink->count += count;
}

void dvi__put(dvi__sink *sink, const char *format, ...)
{
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  (void)dvi_number_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  dvi__put_bytes(sink, text, strlen(text));
}

void dvi__put_real(dvi__sink *sink, char before, double number)
{
  char text[DVI_NUMBER_SIZE + 1] = {before};
  dvi_number_write(number, text + 1);
  dvi__put_bytes(sink, text, strlen(text));
}

void dvi__put_xml(dvi__sink *sink, const char *text)
{
  static const char special[] = "&<>\"'";
  static const char *const escape[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"};
  for (; *text != 0; text++) {
    const char *found = strchr(special, *text);
    if (found != NULL)
      dvi__put_bytes(sink, escape[found - special], strlen(escape[found - special]));
    else
      dvi__put_bytes(sink, text, 1);
  }
}

void dvi__put_little_endian(dvi__sink *sink, uint64_t value, int width)
{
  unsigned char byte[8];
  for (int i = 0; i < width; i++) byte[i] = (unsigned char)(value >> (8 * i) & 255);
  dvi__put_bytes(sink, byte, (size_t)width);
}

void dvi__put_double(dvi__sink *sink, double value)
{
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  dvi__put_little_endian(sink, bits, 8);
}

dvi_status dvi__sink_finish(dvi__sink *sink, dvi_status status)
{
  if (sink->file != NULL && status == DVI_OK) empty(sink);
  status = dvi__whole_end(&sink->file, status);
  dvi__release(sink->at);
  *sink = (dvi__sink){.at = NULL};
  return status;
}
