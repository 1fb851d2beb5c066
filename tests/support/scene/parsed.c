#include "support/scene/parsed.h"

#include "support/suite.h"

#include <string.h>

dvi_scene *scene;
char message[MESSAGE_SIZE];

void release_scene(void)
{
  dvi_scene_destroy(&scene);
}

dvi_status parse_with(const char *text, int setting_count, const char *const *settings)
{
  dvi_scene_destroy(&scene);
  return dvi_scene_parse("test.yaml", text, strlen(text), setting_count, settings, &scene, message,
                         sizeof message);
}

dvi_status parse_scene(const char *text)
{
  return parse_with(text, 0, NULL);
}

const dvi_system *open_scene(const char *text)
{
  ck_assert_msg(parse_scene(text) == DVI_OK, "%s", message);
  return dvi_scene_system(scene);
}

void check_refused(const char *text, dvi_status status, const char *place, const char *words)
{
  const dvi_status found = parse_scene(text);
  ck_assert_msg(found == status, "status %d instead of %d for\n%s\n%s", found, status, text,
                message);
  ck_assert_ptr_null(scene);
  ck_assert_msg(strncmp(message, "test.yaml", 9) == 0 &&
                    strncmp(message + 9, place, strlen(place)) == 0,
                "not at %s: %s", place, message);
  ck_assert_msg(strstr(message, words) != NULL, "\"%s\" is not in \"%s\"", words, message);
}
