/* Files that are written as a whole or not at all. */
#ifndef DVI_MARCH_WHOLE_FILE_H
#define DVI_MARCH_WHOLE_FILE_H
#include <dvi/status.h>
#include <stddef.h>

/* Write a file beside its place and move it there. The bytes are on the disk before the move, so a
 * full disk, or a machine that stops, leaves the old file. A link is followed, not replaced.
 * DVI_IO_ERROR. */
dvi_status dvi__write_whole(const char *path, const unsigned char *bytes, size_t count);

/* The same of a file that is written piece by piece. */
typedef struct dvi__whole_file dvi__whole_file;

/* Begin a file beside its place. DVI_IO_ERROR, DVI_NO_MEMORY. */
dvi_status dvi__whole_begin(const char *path, dvi__whole_file **file);

/* Add bytes. A failure is told at the end. */
void dvi__whole_put(dvi__whole_file *file, const unsigned char *bytes, size_t count);

/* Move the file to its place if the status is DVI_OK, or remove it. Returns the first failure. The
 * pointer becomes NULL, as it may be before. */
dvi_status dvi__whole_end(dvi__whole_file **file, dvi_status status);

#endif
