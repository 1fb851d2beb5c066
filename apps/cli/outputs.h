/** The files that a command line names: checked before any work is done. */
#ifndef OUTPUTS_H
#define OUTPUTS_H

/** An option and the file that it names; path NULL or "-": none. */
typedef struct named_file {
  const char *option; /**< without the dashes */
  const char *path;
} named_file;

/** Refuse two options that name the same file, however they spell it. Returns DONE, or complains
 * and returns USAGE. */
int outputs_distinct(const char *command, int count, const named_file *files);

/** Refuse a plot whose name, given by that option, does not say what it is: SVG. NULL: no plot.
 *  Returns DONE, or complains and returns USAGE. */
int outputs_plot(const char *command, const char *option, const char *path);
#endif
