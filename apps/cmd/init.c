/* dvi init, which writes an example of a scene. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/file.h"
#include "cli/options.h"
#include "load/catalogue.h"
#include "load/scene.h"

typedef struct init_request {
  const char *template;
} init_request;

/* Return the template of a name, or complain and return NULL. */
static const catalogue_text *find_template(const char *name)
{
  const catalogue_text *text = template_texts;
  while (text->name != NULL && strcmp(text->name, name) != 0) text++;
  if (text->name != NULL) return text;
  (void)usage_error("init: there is no template '%s'; templates: cart, crane, field, mechanism",
                    name);
  return NULL;
}

static int write_template(const catalogue_text *text, const char *path)
{
  whole_file file;
  if (!file_open(&file, path)) return FAILED;
  (void)fwrite(text->text, 1, text->length, file.stream);
  return file_keep(&file) ? DONE : FAILED;
}

static const char *const details[] = {
    "Templates: cart, a pendulum on a cart; mechanism, a slider-crank of parts that constraints "
    "hold together, with a motor\n"
    "and friction; crane, a controlled machine for dvi control. docs/scenes.md explains all that a "
    "scene may hold.\n",
    "Examples:\n"
    "  dvi init cart.yaml\n"
    "  dvi run cart.yaml --final\n"
    "  dvi init machine.yaml --template mechanism\n",
    NULL,
};

static const option command_options[] = {
    {.name = "template",
     OPTION_AT(init_request, template),
     .value = "NAME",
     .help = "cart, mechanism, crane or field; default: cart"},
    {.name = NULL},
};

static const command_line command = {
    .name = "init",
    .synopsis = "FILE.yaml [OPTIONS]",
    .operand = "FILE",
    .summary = "Write an example of a scene, with comments, to be changed into one's own; - is "
               "standard output. A file that is\n"
               "there is not overwritten.\n",
    .options = command_options,
    .details = details,
};

int init_command(int argc, char **argv)
{
  init_request r = {.template = "cart"};
  const char *path;
  int code;
  if (!options_parse(&command, argc, argv, &r, &path, &code)) return code;
  const catalogue_text *text = find_template(r.template);
  if (text == NULL) return USAGE;
  if (strcmp(path, "-") == 0) return write_template(text, path);
  if (!scene_is_path(path))
    return usage_error("init: '%s' is no name of a scene: those end in .yaml or .yml", path);
  if (access(path, F_OK) == 0) {
    complain("init: '%s' is there already; give another name, or remove it", path);
    return FAILED;
  }
  return write_template(text, path);
}
