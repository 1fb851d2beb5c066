#include "support/scene/scene_text.h"

#include "core/memory.h"
#include "text/heap.h"
#include "text/utf8.h"
#include "support/suite.h"

#include <string.h>

void open_text(scene_text *scene, const char *text, size_t size)
{
  *scene = (scene_text){.source = {.name = "s.yaml", .text = text, .size = size}};
  scene->complaint = (dvi__complaint){
      .source = &scene->source, .message = scene->message, .size = sizeof scene->message};
}

void close_text(scene_text *scene)
{
  dvi__fail_allocations_after(-1);
  dvi__arena_free(&scene->arena);
}

void limit_memory(scene_text *scene, size_t size)
{
  enum { BLOCK = 65536 };
  ck_assert_ptr_nonnull(dvi__arena_take(&scene->arena, BLOCK - size, 1));
  dvi__fail_allocations_after(0); /* no second block */
}

void check_complaint(const scene_text *scene, dvi_status status, const char *message)
{
  ck_assert_str_eq(scene->message, message);
  ck_assert_int_eq(scene->complaint.status, status);
}

void check_printable(const scene_text *scene)
{
  if (strncmp(scene->message, "s.yaml:", 7) != 0) ck_abort_msg("%s", scene->message);
  const size_t length = strlen(scene->message);
  unsigned code = 0;
  for (size_t k = 0, width = 0; k < length; k += width) {
    width = dvi__utf8(scene->message + k, length - k, &code);
    if (width == 0 || !dvi__utf8_printable(code)) ck_abort_msg("byte %zu of %s", k, scene->message);
  }
}

void check_span(const scene_text *scene, dvi__span span, const char *characters)
{
  ck_assert_uint_le(span.first + span.size, scene->source.size);
  ck_assert_uint_eq(span.size, strlen(characters));
  ck_assert_mem_eq(scene->source.text + span.first, characters, span.size);
}
