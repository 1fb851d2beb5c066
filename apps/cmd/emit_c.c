/* dvi emit-c, which writes a scene as a C file. */
#include <dvi/scene.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"
#include "load/density.h"
#include "load/open.h"
#include "cli/options.h"
#include "load/scene.h"

enum { NAME_SIZE = 64 };

typedef struct emit_request {
  const char *name, *out;
  words settings;
} emit_request;

/* Make an identifier of the scene's name, with '-' as '_'. */
static int identifier_of(const problem *scene, char *name)
{
  if (strlen(scene->name) >= NAME_SIZE)
    return usage_error("emit-c: '%s' is too long for a C name; give --name", scene->name);
  (void)snprintf(name, NAME_SIZE, "%s", scene->name);
  for (char *c = name; *c != '\0'; c++)
    if (*c == '-') *c = '_';
  return DONE;
}

static int write_piece(const char *text, size_t size, void *user)
{
  return fwrite(text, 1, size, user) == size ? 0 : -1;
}

static int write_code(const problem *scene, const char *name, const char *path)
{
  whole_file file;
  if (!file_open(&file, path)) return FAILED;
  const dvi_status status = dvi_scene_emit_c(scene->scene, name, write_piece, file.stream);
  int code = DONE;
  if (status == DVI_BAD_ARGUMENT)
    code = usage_error("emit-c: '%s' is no name in C; give one by --name", name);
  else if (status == DVI_UNSUPPORTED && dvi_scene_control(scene->scene, 0) != NULL)
    code = usage_error("emit-c: the scene has controls, which C files do not have; declare them by "
                       "dvi_controls (dvi/control.h)");
  else if (status == DVI_UNSUPPORTED && scene->terms->contact_count > 0)
    code = usage_error("emit-c: the scene has contacts, which C files do not have yet; declare "
                       "them in a program (dvi_contact), or `dvi run` the scene");
  else if (status == DVI_UNSUPPORTED)
    code = usage_error("emit-c: the scene's method needs Taylor coefficients, and C files have "
                       "none; take another method, or `dvi run` the scene");
  /* file_keep reports this one with its reason */
  else if (status != DVI_OK && status != DVI_IO_ERROR)
    code = library_error(status);
  if (code == DONE && !file_keep(&file)) code = FAILED;
  file_discard(&file);
  return code;
}

static int emit_c(const emit_request *request, const char *path)
{
  char name[NAME_SIZE];
  problem *scene;
  int code = open_problem(path, &request->settings, &scene);
  if (code != DONE) return code;
  if (has_field(scene))
    code = usage_error("emit-c: %s is a field, which C files do not have; dvi/field.h and "
                       "dvi/density.h make one in a program",
                       scene->name);
  if (code == DONE && request->name == NULL) code = identifier_of(scene, name);
  if (code == DONE)
    code = write_code(scene, request->name != NULL ? request->name : name, request->out);
  problem_destroy(&scene);
  return code;
}

static const char *const details[] = {
    "The file needs <dvi/dvi.h> and libdvi alone. Parameters are numbers in it, as they are set "
    "here. Compiled with\n"
    "-DDVI_MAIN it is a program that runs the scene.\n",
    "Examples:\n"
    "  dvi init cart.yaml\n"
    "  dvi emit-c cart.yaml --out cart.c\n",
    NULL,
};

static const option command_options[] = {
    {.name = "out",
     OPTION_AT(emit_request, out),
     .value = "FILE.c",
     .help = "where the C file goes; -: standard output"},
    {.name = "name",
     OPTION_AT(emit_request, name),
     .value = "NAME",
     .help = "of the functions, NAME_create and so on; default: the "
             "scene's, with _ for -"},
    {.name = "set",
     OPTION_AT(emit_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the scene; may be repeated"},
    {.name = NULL},
};

static const command_line command = {
    .name = "emit-c",
    .synopsis = "SCENE.yaml --out FILE.c [OPTIONS]",
    .operand = "SCENE",
    .summary = "Write a C file that declares the same system by callbacks, with its start.\n",
    .options = command_options,
    .details = details,
};

int emit_c_command(int argc, char **argv)
{
  emit_request r = {.out = NULL};
  const char *path;
  int code;
  if (!options_parse(&command, argc, argv, &r, &path, &code)) return code;
  if (r.out == NULL)
    return usage_error("emit-c: --out is missing: where the C file goes, or - for standard output");
  if (!scene_is_path(path))
    return usage_error("emit-c: '%s' is no scene; the problems of the catalogue are C already",
                       path);
  const named_file out = {.option = "out", .path = r.out};
  code = scene_spared("emit-c", path, 1, &out);
  return code == DONE ? emit_c(&r, path) : code;
}
