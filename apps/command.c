#include "command.h"

#include <dvi/scene.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { SENTENCE_SIZE = 2048 };

static void speak(const char *sentence)
{
  (void)fprintf(stderr, "dvi: %s\n", sentence);
}

void complain(const char *format, ...)
{
  char sentence[SENTENCE_SIZE];
  va_list arguments;
  va_start(arguments, format);
  (void)vsnprintf(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  speak(sentence);
}

int usage_error(const char *format, ...)
{
  char sentence[SENTENCE_SIZE];
  va_list arguments;
  va_start(arguments, format);
  (void)vsnprintf(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  speak(sentence);
  return USAGE;
}

void blame_scene(void)
{
  const char *part = dvi_scene_blame();
  if (part[0] != '\0') complain("%s", part);
}

int library_error(dvi_status status)
{
  const char *sentence = status == DVI_NO_MEMORY ? "" : dvi_last_error(); /* the command's own shortage left none */
  complain("%s", sentence[0] != '\0' ? sentence : dvi_status_meaning(status));
  if (status > DVI_OK || status == DVI_CALLBACK_FAILED || status == DVI_REFERENCE_FAILED) blame_scene();
  return status == DVI_BAD_OPTION || status == DVI_UNSUPPORTED ? USAGE : FAILED;
}

bool output_flushed(void)
{
  errno = 0;
  if (fflush(stdout) == 0 && !ferror(stdout)) return true;
  if (errno != EPIPE) complain("cannot write to standard output: %s", errno != 0 ? strerror(errno) : "an earlier write failed");
  return false;
}
