/* Files that are there whole or not at all. */
#ifndef DVI_METHOD_WHOLE_FILE_H
#define DVI_METHOD_WHOLE_FILE_H
#include <dvi/status.h>
#include <stddef.h>

/* Write a file beside its place and move it there, each of which is on the disk before the next:
 * a full disk, or a machine that stops, leaves the old one. A link is followed, not replaced.
 * DVI_IO_ERROR. */
dvi_status dvi__write_whole(const char *path, const unsigned char *bytes, size_t count);

#endif
