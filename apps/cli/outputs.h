/** The output files that a command line names. They are checked before any work is done. */
#ifndef OUTPUTS_H
#define OUTPUTS_H

/** An option and the file that it names. The path is NULL or "-" for no file. */
typedef struct named_file {
  const char *option; /**< name without the dashes */
  const char *path;
} named_file;

/** Refuse two options that name the same file, in whatever spelling. Returns DONE, or complains and
 * returns USAGE. */
int outputs_distinct(const char *command, int count, const named_file *files);

/** Refuse a plot whose name, given by that option, does not end in .svg. The path is NULL for no
 * plot. Returns DONE, or complains and returns USAGE. */
int outputs_plot(const char *command, const char *option, const char *path);
#endif
