#define _POSIX_C_SOURCE 200809L
#include "store/facts.h"

#include <dvi/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "load/catalogue.h"
#include "load/open.h"

void facts_add_text(fact_list *list, const char *name, const char *text, bool decides)
{
  if (text == NULL || list->count == FACTS_MAX) return;
  list->fact[list->count++] = (hdf5_fact){.name = name, .text = text, .decides = decides};
}

void facts_add_number(fact_list *list, const char *name, double number, bool decides)
{
  if (list->count == FACTS_MAX) return;
  list->fact[list->count++] = (hdf5_fact){.name = name, .number = number, .decides = decides};
}

void facts_clear(fact_list *list)
{
  for (int i = 0; i < list->owned_count; i++) free(list->owned[i]);
  *list = (fact_list){.count = 0};
}

/* Add a deciding text that the list owns. */
static bool add_owned(fact_list *list, const char *name, char *text)
{
  if (text == NULL) {
    complain("out of memory");
    return false;
  }
  list->owned[list->owned_count++] = text;
  facts_add_text(list, name, text, true);
  return true;
}

/* Write the files of the components that a scene includes into one text. */
static char *spell_components(const dvi_scene *scene)
{
  char *text = NULL;
  size_t size;
  dvi_scene_file file;
  FILE *stream = open_memstream(&text, &size);
  if (stream == NULL) return NULL;
  for (int i = 1; dvi_scene_file_of(scene, i, &file); i++)
    (void)fprintf(stream, "# %s\n%.*s\n", file.name, (int)file.size, file.text);
  (void)fclose(stream);
  return text;
}

/* Add the text of a scene, or that of a problem of the catalogue, if it is one of expressions. */
static bool add_scene(fact_list *list, const problem *scene)
{
  dvi_scene_file file;
  if (scene->scene != NULL && dvi_scene_file_of(scene->scene, 0, &file))
    return add_owned(list, "scene", strndup(file.text, file.size)) &&
           (!dvi_scene_file_of(scene->scene, 1, &file) ||
            add_owned(list, "components", spell_components(scene->scene)));
  for (const catalogue_text *at = catalogue_texts; at->name != NULL; at++)
    if (strcmp(at->name, scene->name) == 0)
      return add_owned(list, "scene", strndup(at->text, at->length));
  return true;
}

bool facts_add_problem(fact_list *list, const problem *scene, const char *command)
{
  facts_add_text(list, "dvi", dvi_version(), false);
  facts_add_text(list, "sundials", dvi_reference_version(), false);
  facts_add_text(list, "command", command, false);
  facts_add_text(list, "problem", scene->name, true);
  return add_scene(list, scene);
}

bool facts_add_settings(fact_list *list, const problem *scene, const words *settings)
{
  char *text = NULL;
  size_t size;
  FILE *stream = open_memstream(&text, &size);
  for (int i = 0; i < settings->count && stream != NULL; i++) {
    const words one = {.count = 1, .word = {settings->word[i]}};
    if (start_setting(scene, &one) == NULL)
      (void)fprintf(stream, "%s%s", ftell(stream) > 0 ? "," : "", settings->word[i]);
  }
  if (stream != NULL) (void)fclose(stream);
  return add_owned(list, "settings", text);
}
