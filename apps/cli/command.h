/** The subcommands of dvi, their exit codes, and their messages to the user. */
#ifndef COMMAND_H
#define COMMAND_H
#include <dvi/dvi.h>
#include <stdbool.h>

/** The exit codes. A run that a signal ended returns 128 and the signal's number, as shells do. */
enum {
  DONE = 0,
  FAILED = 1,      /**< a numerical failure, or a file that cannot be read or written */
  USAGE = 2,       /**< the command line makes no sense */
  CHECK_FAILED = 3 /**< everything ran, but a check did not hold */
};

int list_command(int argc, char **argv);
int explain_command(int argc, char **argv);
int run_command(int argc, char **argv);
int order_command(int argc, char **argv);
int bench_command(int argc, char **argv);
int path_command(int argc, char **argv);
int control_command(int argc, char **argv);
int gradient_command(int argc, char **argv);
int fit_command(int argc, char **argv);
int check_command(int argc, char **argv);
int init_command(int argc, char **argv);
int sweep_command(int argc, char **argv);
int resonance_command(int argc, char **argv);
int emit_c_command(int argc, char **argv);
int mesh_command(int argc, char **argv);
int regge_command(int argc, char **argv);
int curvature_command(int argc, char **argv);
int modes_command(int argc, char **argv);
int stability_command(int argc, char **argv);
int solve_command(int argc, char **argv);
int spectrum_command(int argc, char **argv);
int plot_command(int argc, char **argv);
int view_command(int argc, char **argv);

/** Spell a command line, "dvi NAME ARGUMENTS..", as a shell takes it. To be freed, NULL without
 * memory. */
char *command_spelled(const char *name, int argc, char *const *argv);

/** Print "dvi: <sentence>" to standard error. */
void complain(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** Complain, and return USAGE. */
int usage_error(const char *format, ...) __attribute__((format(printf, 1, 2)));

/** Tell if the library's last sentence is that another process has failed, whose own tells why. */
bool library_failed_elsewhere(void);

/** Complain with the library's last sentence, unless another process's tells why, and return the
 * exit code that fits the status. */
int library_error(dvi_status status);

/** Complain with the library's last sentence between two texts. If an expression of a scene is the
 * cause, its place comes first. */
void complain_of(dvi_status status, const char *before, const char *after);

/** Flush standard output. Returns false if any output was lost. Complains then, unless the reader
 * has merely gone away. */
bool output_flushed(void);
#endif
