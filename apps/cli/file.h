/** Files that are written whole or not at all. */
#ifndef FILE_H
#define FILE_H
#include <stdbool.h>
#include <stdio.h>

/** A file being written. Until it is kept, its content stands in a temporary file beside it. */
typedef struct whole_file {
  FILE *stream; /**< write here */
  char *path;   /**< destination of the content, or NULL for standard output */
  /** path of the content until then, or NULL for devices and pipes, which are written directly */
  char *temporary;
} whole_file;

/** Open a file. The path "-" is standard output. Complains and returns false if the file cannot be
 * written. */
bool file_open(whole_file *file, const char *path);

/** Flush, sync and rename the content into its place. If any of it was lost, complains and returns
 * false, and all is as before. */
bool file_keep(whole_file *file);

/** Return whether two paths lead to the same file, or would if it existed. Links and other
 * spellings make no difference. */
bool file_same(const char *path, const char *other);

/** Discard the content. The old file at the path stays. Allowed after file_keep, and on a file that
 * is all zero. */
void file_discard(whole_file *file);

/** Remove the temporary files of all open files. A signal handler that ends the process calls this
 * function. */
void file_remove_unfinished(void);

/** Return whether file_open is likely to succeed later. Called before long work. Complains if
 * not. */
bool file_writable(const char *path);
#endif
