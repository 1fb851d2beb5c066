#define _POSIX_C_SOURCE 200809L
#include "cli/command.h"

#include <dvi/scene.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { SENTENCE_SIZE = 2048 };

/* Print a sentence. One that is too long for its memory is cut. */
static void print_sentence(const char *format, va_list arguments)
{
  char sentence[SENTENCE_SIZE];
  (void)vsnprintf(sentence, sizeof sentence, format, arguments);
  (void)fprintf(stderr, "dvi: %s\n", sentence);
}

/* Write a word in quotes unless it is plain. */
static void spell_word(FILE *stream, const char *word)
{
  static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                              "-_.,:/=+@%^";
  if (word[0] != '\0' && word[strspn(word, plain)] == '\0') {
    (void)fprintf(stream, " %s", word);
    return;
  }
  (void)fputs(" '", stream);
  for (; *word != '\0'; word++) (void)fprintf(stream, *word == '\'' ? "'\\'%c'" : "%c", *word);
  (void)fputc('\'', stream);
}

char *command_spelled(const char *name, int argc, char *const *argv)
{
  char *text = NULL;
  size_t size;
  FILE *stream = open_memstream(&text, &size);
  if (stream == NULL) return NULL;
  (void)fprintf(stream, "dvi %s", name);
  for (int i = 0; i < argc; i++) spell_word(stream, argv[i]);
  (void)fclose(stream);
  return text;
}

void complain(const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  print_sentence(format, arguments);
  va_end(arguments);
}

int usage_error(const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  print_sentence(format, arguments);
  va_end(arguments);
  return USAGE;
}

/* Return whether a sentence tells of a callback's failure. A method may have recovered from an
 * earlier failure, of which the sentence does not tell. */
static bool tells_of_callback(dvi_status status, const char *sentence)
{
  return status == DVI_CALLBACK_RETRY || status == DVI_CALLBACK_FAILED ||
         (status == DVI_REFERENCE_FAILED && strstr(sentence, " callback ") != NULL);
}

/* Cut the library's last words, which tell what a callback returned. The scene has told the
 * reason. */
static void cut_callback(char *sentence)
{
  static const char without[] = " has no value there";
  const char *last = strstr(sentence, " callback ");
  char *cut = NULL;
  for (char *colon = strstr(sentence, ": "); colon != NULL && colon < last;
       colon = strstr(colon + 1, ": "))
    cut = colon;
  if (cut != NULL) (void)snprintf(cut, SENTENCE_SIZE - (size_t)(cut - sentence), "%s", without);
}

void complain_of(dvi_status status, const char *before, const char *after)
{
  char sentence[SENTENCE_SIZE];
  /* the command's own lack of memory left no sentence */
  const char *said = status == DVI_NO_MEMORY ? "" : dvi_last_error();
  (void)snprintf(sentence, sizeof sentence, "%s",
                 said[0] != '\0' ? said : dvi_status_meaning(status));
  if (dvi_scene_fault()[0] != '\0' && tells_of_callback(status, sentence)) {
    complain("%s", dvi_scene_fault());
    cut_callback(sentence);
  }
  complain("%s%s%s", before, sentence, after);
}

bool library_failed_elsewhere(void)
{
  return strstr(dvi_last_error(), "sentence tells why") != NULL;
}

int library_error(dvi_status status)
{
  if (!library_failed_elsewhere()) complain_of(status, "", "");
  return status == DVI_BAD_OPTION || status == DVI_UNSUPPORTED ? USAGE : FAILED;
}

bool output_flushed(void)
{
  errno = 0;
  if (fflush(stdout) == 0 && !ferror(stdout)) return true;
  if (errno != EPIPE)
    complain("cannot write to standard output: %s",
             errno != 0 ? strerror(errno) : "an earlier write failed");
  return false;
}
