#define _POSIX_C_SOURCE 200809L
#include "plot/gnuplot.h"

#include <ctype.h>
#include <errno.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/file.h"

extern char **environ;

/* Write a gnuplot string in double quotes. gnuplot would run text between backquotes as a command,
 * and other characters have a meaning, too. ASCII characters other than letters, digits and blanks
 * are therefore written by their numbers. gnuplot reads four digits if the first is 0. An SVG file
 * must hold no control character. */
void gnuplot_quoted(FILE *script, const char *text)
{
  (void)fputc('"', script);
  for (const char *c = text; *c != '\0'; c++) {
    const unsigned char byte = (unsigned char)*c;
    if (byte < ' ' || byte == 0x7f)
      (void)fputc(' ', script);
    else if (byte == ' ' || isalnum(byte) || byte >= 0x80)
      (void)fputc(byte, script);
    else
      (void)fprintf(script, "\\%04o", byte);
  }
  (void)fputc('"', script);
}

void gnuplot_setting(FILE *script, const char *what, const char *text)
{
  (void)fprintf(script, "set %s ", what);
  gnuplot_quoted(script, text);
  (void)fputs(" noenhanced\n", script);
}

/* Redirect the child's input to the script and its output to the write end of the pipe. The pipe
 * has no other descriptors in the child. */
static int redirect_gnuplot(posix_spawn_file_actions_t *actions, int script, const int ends[2])
{
  int failure = posix_spawn_file_actions_adddup2(actions, script, STDIN_FILENO);
  if (failure == 0) failure = posix_spawn_file_actions_adddup2(actions, ends[1], STDOUT_FILENO);
  for (int k = 0; k < 2 && failure == 0; k++)
    if (ends[k] > STDERR_FILENO) failure = posix_spawn_file_actions_addclose(actions, ends[k]);
  return failure;
}

/* Start gnuplot, without the start-up files of the user. Returns 0 or an error number. */
static int spawn_gnuplot(int script, const int ends[2], pid_t *process)
{
  posix_spawn_file_actions_t actions;
  int failure = posix_spawn_file_actions_init(&actions);
  if (failure != 0) return failure;
  failure = redirect_gnuplot(&actions, script, ends);
  if (failure == 0) {
    char name[] = "gnuplot", alone[] = "--default-settings";
    char *arguments[] = {name, alone, NULL};
    failure = posix_spawnp(process, name, &actions, NULL, arguments, environ);
  }
  (void)posix_spawn_file_actions_destroy(&actions);
  return failure;
}

/* Start gnuplot with the script as its input. Returns the descriptor to read the picture from, or
 * -1 with errno set. */
static int start_gnuplot(FILE *script, pid_t *process)
{
  int ends[2];
  if (pipe(ends) != 0) return -1;
  const int failure = spawn_gnuplot(fileno(script), ends, process);
  (void)close(ends[1]);
  if (failure == 0) return ends[0];
  (void)close(ends[0]);
  errno = failure;
  return -1;
}

/* Copy the picture from a pipe. gnuplot does not report a full disk, but file_keep does. Returns
 * false if there is no picture. */
static bool copy_picture(int from, FILE *picture)
{
  char part[4096];
  bool any = false;
  ssize_t length;
  while ((length = read(from, part, sizeof part)) > 0 || (length < 0 && errno == EINTR)) {
    any = any || length > 0;
    if (length > 0) (void)fwrite(part, 1, (size_t)length, picture);
  }
  return any && length == 0;
}

static bool gnuplot_succeeded(pid_t process)
{
  int result = 0;
  pid_t ended;
  do ended = waitpid(process, &result, 0);
  while (ended < 0 && errno == EINTR);
  return ended == process && WIFEXITED(result) && WEXITSTATUS(result) == 0;
}

/* Draw the picture. Returns true if gnuplot succeeded. */
static bool draw_by_gnuplot(FILE *script, FILE *picture, const char *path)
{
  pid_t process;
  const int from = start_gnuplot(script, &process);
  if (from < 0) {
    complain("no plot in '%s': gnuplot cannot be started (%s); install the package gnuplot-nox",
             path, strerror(errno));
    return false;
  }
  const bool copied = copy_picture(from, picture);
  (void)close(from);
  if (gnuplot_succeeded(process) && copied) return true;
  complain("no plot in '%s': gnuplot failed", path);
  return false;
}

/* Write the script to a temporary file, to be read from its start. Complains and returns NULL if
 * that fails. */
static FILE *make_script(const char *path, gnuplot_writer *write, const void *drawing)
{
  FILE *script = tmpfile();
  if (script != NULL) {
    write(script, drawing);
    if (fflush(script) == 0 && !ferror(script) && fseek(script, 0, SEEK_SET) == 0) return script;
  }
  complain("no plot in '%s': no temporary file for gnuplot: %s", path, strerror(errno));
  if (script != NULL) (void)fclose(script);
  return NULL;
}

bool gnuplot_draw(const char *path, gnuplot_writer *write, const void *drawing)
{
  whole_file picture = {0};
  FILE *script = make_script(path, write, drawing);
  if (script == NULL) return false;
  bool good = file_open(&picture, path) && draw_by_gnuplot(script, picture.stream, path);
  if (good) good = file_keep(&picture);
  file_discard(&picture);
  (void)fclose(script);
  return good;
}
