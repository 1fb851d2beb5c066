/* The bytes of a file that is being written. The file stands beside its place until the end, so
 * that a failure leaves no half file. */
#ifndef DVI_FIELD_MESH_FILE_SINK_H
#define DVI_FIELD_MESH_FILE_SINK_H
#include <stddef.h>
#include <stdint.h>

#include "core/status.h"

/* Bytes on their way. A sink of zeros is of a process that does not write, and drops them. */
typedef struct dvi__sink {
  struct dvi__whole_file *file;
  unsigned char *at; /* [64 KiB] not in the file yet */
  size_t count;
} dvi__sink;

/* Begin a file, for dvi__sink_finish. DVI_IO_ERROR, DVI_NO_MEMORY. */
dvi_status dvi__sink_begin(dvi__sink *sink, const char *path);

/* Put bytes, or a text of up to 255 characters. */
void dvi__put_bytes(dvi__sink *sink, const void *bytes, size_t count);
void dvi__put(dvi__sink *sink, const char *format, ...) DVI_PRINTF(2, 3);

/* Put a number so that reading gives it back bit for bit, with a character before it. */
void dvi__put_real(dvi__sink *sink, char before, double number);

/* Put a text in which the special characters of XML are escaped. */
void dvi__put_xml(dvi__sink *sink, const char *text);

/* Put an unsigned integer of some bytes, or a double, little-endian. */
void dvi__put_little_endian(dvi__sink *sink, uint64_t value, int width);
void dvi__put_double(dvi__sink *sink, double value);

/* Keep the file if the status is DVI_OK, and otherwise the old one. Returns the first failure. */
dvi_status dvi__sink_finish(dvi__sink *sink, dvi_status status);

#endif
