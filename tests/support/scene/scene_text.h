/* The text of a scene in a test: what it is read into, and what is said of it. */
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

/* Named s.yaml; the text stays the caller's. */
void open_text(scene_text *scene, const char *text, size_t size);
void close_text(scene_text *scene);

/* After open_text: let the scene take so many bytes and no more; at most 65536. */
void limit_memory(scene_text *scene, size_t size);

/* The complaint must have this status and must be this message, whole. */
void check_complaint(const scene_text *scene, dvi_status status, const char *message);

/* There must be a message, with the name of the file, of characters that can be printed. */
void check_printable(const scene_text *scene);

/* These characters must stand at the span. */
void check_span(const scene_text *scene, dvi__span span, const char *characters);

#endif
