/** gnuplot, which draws a script into an SVG file. */
#ifndef GNUPLOT_H
#define GNUPLOT_H
#include <stdbool.h>
#include <stdio.h>

/** Write the script of a drawing. */
typedef void gnuplot_writer(FILE *script, const void *drawing);

/** Draw a script into an SVG file that is whole or not there.
 *
 *  @return false, with a complaint, if gnuplot is missing or failed, or the file cannot be written.
 *          An old file at the path is then still there. */
bool gnuplot_draw(const char *path, gnuplot_writer *write, const void *drawing);

/** Write a text as a string of gnuplot's, which stands for itself whatever it contains. */
void gnuplot_quoted(FILE *script, const char *text);

/** Write "set WHAT TEXT". */
void gnuplot_setting(FILE *script, const char *what, const char *text);
#endif
