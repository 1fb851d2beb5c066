/* Files of one mesh in all formats, made without the library's writers. The mesh is a square of two
 * triangles. In MSH the left side is the part "left wall", the upper triangle the part "group 5",
 * and there is a point that no triangle uses. */
#ifndef TESTS_SUPPORT_MESH_FILES_H
#define TESTS_SUPPORT_MESH_FILES_H
#include <stddef.h>

typedef struct mesh_file {
  const char *format;
  const unsigned char *at;
  size_t size;
  size_t spare; /* bytes at the end without which the file is still whole */
  int has_parts;
} mesh_file;

enum { MSH2_TEXT, MSH4_TEXT, OFF_TEXT, PLY_TEXT, MSH2_BINARY, MSH4_BINARY, PLY_BINARY, MESH_FILES };

/* Give a file. It is the same in each call. */
mesh_file file_of_square(int i);

#endif
