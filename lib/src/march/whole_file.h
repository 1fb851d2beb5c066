/* Files that are written as a whole or not at all. */
#ifndef DVI_MARCH_WHOLE_FILE_H
#define DVI_MARCH_WHOLE_FILE_H
#include <dvi/status.h>
#include <stddef.h>

/* Write a file beside its place and move it there. The bytes are on the disk before the move, so a
 * full disk, or a machine that stops, leaves the old file. A link is followed, not replaced.
 * DVI_IO_ERROR. */
dvi_status dvi__write_whole(const char *path, const unsigned char *bytes, size_t count);

#endif
