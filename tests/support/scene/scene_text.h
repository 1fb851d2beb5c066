/* The text of a scene in a test, the memory that it is read into, and the complaint about it. */
#ifndef TESTS_SUPPORT_SCENE_TEXT_H
#define TESTS_SUPPORT_SCENE_TEXT_H
#include "text/arena.h"
#include "text/complaint.h"

/* Its address must not change while it is open. */
typedef struct scene_text {
  dvi__source source;
  dvi__arena arena;
  dvi__complaint complaint;
  char message[1024];
} scene_text;

/* Opens a text by the name s.yaml. The text stays the caller's. */
void open_text(scene_text *scene, const char *text, size_t size);
void close_text(scene_text *scene);

/* Lets an opened text take so many bytes and no more, at most 65536. */
void limit_memory(scene_text *scene, size_t size);

/* Requires a complaint with this status and this whole message. */
void check_complaint(const scene_text *scene, dvi_status status, const char *message);

/* Requires a message with the name of the file, of characters that can be printed. */
void check_printable(const scene_text *scene);

/* Requires these characters at the span. */
void check_span(const scene_text *scene, dvi__span span, const char *characters);

#endif
