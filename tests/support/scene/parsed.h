/* The scene of a test case, which is parsed from its text, and the message about the text. */
#ifndef TESTS_SUPPORT_PARSED_H
#define TESTS_SUPPORT_PARSED_H
#include <dvi/scene.h>

enum { MESSAGE_SIZE = 1024 };

extern dvi_scene *scene;
extern char message[MESSAGE_SIZE];

/* Destroys the scene, as the fixture after each case. */
void release_scene(void);

/* Parses a text under the name test.yaml, in place of the scene before. */
dvi_status parse_scene(const char *text);

/* Does the same with so many settings, NAME=VALUE. */
dvi_status parse_with(const char *text, int setting_count, const char *const *settings);

/* Parses a text that must be right, and returns its system. */
const dvi_system *open_scene(const char *text);

/* Requires that a text is refused with this status, by a message with these words, and with the
 * place behind the name of the file. */
void check_refused(const char *text, dvi_status status, const char *place, const char *words);

#endif
