/** Files that are written whole or not at all. */
#ifndef FILE_H
#define FILE_H
#include <stdbool.h>
#include <stdio.h>

/** A file being written. Until it is kept, its content stands in a temporary file beside it. */
typedef struct whole_file {
  FILE *stream; /**< write here */
  char *path;   /**< where the content goes; NULL: standard output */
  /** where it stands meanwhile; NULL for devices and pipes, which are written directly */
  char *temporary;
} whole_file;

/** Begin a file; path "-" is standard output. False, with a complaint, if it cannot be written. */
bool file_open(whole_file *file, const char *path);

/** Put the content in place: flush, sync, rename. False, with a complaint, if any of it was lost;
 * then all is as before. */
bool file_keep(whole_file *file);

/** Whether two paths lead to the same file, or would if there were one: links and other spellings
 * are seen through. */
bool file_same(const char *path, const char *other);

/** Forget the content; what was at the path stays. Allowed after file_keep, and on a file that is
 * all zero. */
void file_discard(whole_file *file);

/** Remove the temporary files of the files being written: for a signal handler that ends the
 * process. */
void file_remove_unfinished(void);

/** Whether file_open is likely to succeed later: asked before long work. Complains if not. */
bool file_writable(const char *path);
#endif
