/* dvi view, which writes a page that shows a run in a browser. */
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "load/open.h"
#include "load/scene.h"
#include "module/store.h"
#include "view/rerun.h"
#include "view/source.h"

/* More frames look the same in a browser, and load slowly. */
enum { FRAMES_USUAL = 600, FRAMES_MOST = 20000, MADE_SIZE = 512 };

typedef struct view_request {
  const char *out, *method, *scene, *rows, *title;
  double h, t_end;
  long frames;
  words settings, fields, links, points;
} view_request;

static bool ends_with(const char *path, const char *ending)
{
  const size_t length = strlen(path), end = strlen(ending);
  return length > end && strcmp(path + length - end, ending) == 0;
}

static const char *point_name_at(int k, const void *list)
{
  const view_layout *layout = list;
  return k < layout->points ? layout->point[k].name : NULL;
}

/* ---- links ---- */

/* Find a point, or the origin. */
static int find_end(const view_layout *layout, const char *word, const char *name, int *point)
{
  char near[2 * VIEW_NAME];
  *point = layout_point(layout, name);
  if (*point != VIEW_NONE || strcmp(name, "origin") == 0) return DONE;
  return usage_error("view: --link %s: there is no point '%s'%s", word, name,
                     suggestion(name, point_name_at, layout, near, sizeof near));
}

/* Link the points that are asked for, "A:B". */
static int add_links(const words *links, view_layout *layout)
{
  int code = DONE;
  for (int k = 0; k < links->count && code == DONE; k++) {
    const char *word = links->word[k], *colon = strchr(word, ':');
    char name[VIEW_NAME];
    int from, to = VIEW_NONE;
    if (colon == NULL || colon - word >= VIEW_NAME)
      return usage_error("view: --link %s: two points are wanted, as in origin:bob", word);
    (void)snprintf(name, sizeof name, "%.*s", (int)(colon - word), word);
    code = find_end(layout, word, name, &from);
    if (code == DONE) code = find_end(layout, word, colon + 1, &to);
    if (code == DONE && !layout_link(layout, from, to)) code = library_error(DVI_NO_MEMORY);
  }
  return code;
}

/* ---- sources ---- */

static int refuse_of_run(const view_request *r)
{
  const struct {
    bool given;
    const char *name;
  } list[] = {{r->method != NULL, "method"}, {!isnan(r->h), "h"}, {!isnan(r->t_end), "t-end"}};
  for (size_t k = 0; k < sizeof list / sizeof *list; k++)
    if (list[k].given)
      return usage_error("view: --%s is for scenes, which are run; a file has its run already",
                         list[k].name);
  return DONE;
}

/* Take a run of the scene. After Ctrl-C *ended is the exit code that it wants, and the page shows
 * what there is. */
static int take_scene(const view_request *r, const char *name, view_source *source, int *ended)
{
  const view_rerun run = {.name = name,
                          .method = r->method,
                          .h = r->h,
                          .t_end = r->t_end,
                          .frames = r->frames,
                          .settings = &r->settings};
  view_files files = {.folder = ""};
  if (r->scene != NULL || r->rows != NULL)
    return usage_error("view: --%s is for files of runs, and %s is a scene",
                       r->scene != NULL ? "scene" : "rows", name);
  int code = open_any(name, &r->settings, &source->scene);
  if (code != DONE) return code;
  code = view_run_scene(&run, source->scene, &files);
  if (code > 128) {
    *ended = code;
    code = DONE;
  }
  if (code == DONE && files.has_grids)
    code = view_source_grids(source, files.grids, files.rows, r->frames, r->fields.count,
                             r->fields.word);
  else if (code == DONE)
    code = view_source_rows(source, files.rows, r->frames, &r->settings, &r->points);
  view_files_remove(&files);
  return code;
}

static int take_rows(const view_request *r, const char *path, view_source *source)
{
  int code = refuse_of_run(r);
  if (code == DONE && r->rows != NULL)
    return usage_error("view: --rows is for .pvd and .vtkhdf files, and %s has rows itself", path);
  if (code == DONE && r->scene == NULL && (r->settings.count > 0 || r->points.count > 0))
    return usage_error("view: --%s is for scenes; give --scene",
                       r->settings.count > 0 ? "set" : "point");
  if (code == DONE && r->scene != NULL) code = open_problem(r->scene, &r->settings, &source->scene);
  return code == DONE ? view_source_rows(source, path, r->frames, &r->settings, &r->points) : code;
}

static int take_grids(const view_request *r, const char *path, view_source *source)
{
  const int code = refuse_of_run(r);
  if (code != DONE) return code;
  if (r->scene != NULL || r->settings.count > 0)
    return usage_error("view: --scene and --set are for rows of mechanical systems");
  return view_source_grids(source, path, r->rows, r->frames, r->fields.count, r->fields.word);
}

/* ---- the page ---- */

static int check_request(const view_request *r, const char *path)
{
  const named_file files[] = {{.option = "out", .path = r->out}};
  if (r->out == NULL) return usage_error("view: --out PAGE.html is missing");
  if (!ends_with(r->out, ".html") && strcmp(r->out, "-") != 0)
    return usage_error("view: --out %s: the name of a page ends in .html", r->out);
  if (r->frames < 2 || r->frames > FRAMES_MOST)
    return usage_error("view: --frames %ld: 2 to %d are wanted", r->frames, (int)FRAMES_MOST);
  if (scene_spared("view", path, 1, files) != DONE) return USAGE;
  return file_writable(r->out) ? DONE : FAILED;
}

static int take_source(const view_request *r, const char *path, view_source *source, int *ended)
{
  const bool has_grids = ends_with(path, ".pvd") || ends_with(path, ".vtkhdf") ||
                         ends_with(path, ".vtu");
  if (has_grids) return take_grids(r, path, source);
  if (ends_with(path, ".csv") || store_is_wanted(path) || strcmp(path, "-") == 0)
    return take_rows(r, path, source);
  return take_scene(r, path, source, ended);
}

/* Return the title of a scene or else its name, the summary of a problem, or the path of a file. */
static const char *title_of(const problem *scene, const char *path)
{
  if (scene == NULL) return path;
  const int untitled = scene->scene != NULL && dvi_scene_plan_of(scene->scene)->title == NULL;
  return untitled ? scene->name : scene->summary;
}

static int view_file(const view_request *r, const char *path)
{
  view_source source = {.scene = NULL};
  char made[MADE_SIZE];
  int ended = DONE, code = check_request(r, path);
  if (code != DONE) return code;
  code = take_source(r, path, &source, &ended);
  if (code == DONE && source.run.layout == NULL && (r->links.count > 0 || r->points.count > 0))
    code = usage_error("view: --%s is for points, and fields have none",
                       r->links.count > 0 ? "link" : "point");
  if (code == DONE && source.run.layout != NULL && r->fields.count > 0)
    code = usage_error("view: --field is for fields, and %s has none", path);
  if (code == DONE) code = add_links(&r->links, &source.layout);
  source.run.title = r->title != NULL ? r->title : title_of(source.scene, path);
  (void)snprintf(made, sizeof made, "dvi view %s%s%s", path, r->method != NULL ? " --method " : "",
                 r->method != NULL ? r->method : "");
  source.run.made = made;
  if (code == DONE) code = view_write(&source.run, r->out);
  view_source_clear(&source);
  return code == DONE ? ended : code;
}

static const char *const details[] = {
    "A scene, or a problem of the catalogue, is run as by dvi run, with --method, --h, --t-end and "
    "--set. Of a run that was\n"
    "made before, the rows of dvi run --out are shown, and --scene tells what they mean, or the "
    "grids of --pvd, with the\n"
    "curves of --rows.\n",
    "Drawn are vectors x, y and z as points, rotations and motions as bodies, whose axes follow "
    "from their inertia, angles\n"
    "and directions as unit vectors, chains and nets of numbers as heights, and of other systems "
    "the first two or three\n"
    "numbers, or a number and its momentum. Constraints, joints and springs are lines. Fields are "
    "drawn on their meshes.\n",
    "The page is one file, which any browser shows from the disk: it plays the run, draws trails, "
    "turns, and shows how far\n"
    "invariants and other columns are from their start. Numbers have 32 bits. It has the program "
    "three.js in it (MIT).\n",
    "Examples:\n"
    "  dvi view heavy-top --out top.html\n"
    "  dvi view figure-eight --method galerkin:degree=4 --out eight.html\n"
    "  dvi run kepler --method verlet --h 0.01 --t-end 20 --out orbit.csv\n"
    "  dvi view orbit.csv --link origin:point --out orbit.html\n"
    "  dvi view membrane.yaml --field u --out membrane.html\n",
    NULL,
};

static const option command_options[] = {
    {.name = "out", OPTION_AT(view_request, out), .value = "PAGE.html", .help = "the page"},
    {.name = "method",
     OPTION_AT(view_request, method),
     .value = "SPEC",
     .help = "of a scene: the method; default: the scene's"},
    {.name = "h",
     OPTION_AT(view_request, h),
     .value = "H",
     .help = "of a scene: the step; default: the scene's"},
    {.name = "t-end",
     OPTION_AT(view_request, t_end),
     .value = "T",
     .help = "of a scene: the end; default: the scene's"},
    {.name = "set",
     OPTION_AT(view_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the scene; may be repeated"},
    {.name = "scene",
     OPTION_AT(view_request, scene),
     .value = "SCENE",
     .help = "of rows: the scene or problem that they are of"},
    {.name = "rows",
     OPTION_AT(view_request, rows),
     .value = "FILE.csv",
     .help = "of grids: the rows of the same run, for curves"},
    {.name = "field",
     OPTION_AT(view_request, fields),
     .value = "NAME",
     .help = "a field to choose from, as u or E_z; may be repeated; default: the first few"},
    {.name = "point",
     OPTION_AT(view_request, points),
     .value = "NAME",
     .help = "draw a definition of the scene as a point; may be repeated; default: all, of a scene "
             "without points"},
    {.name = "link",
     OPTION_AT(view_request, links),
     .value = "A:B",
     .help = "draw a line between two points, or origin and a point; may be repeated"},
    {.name = "frames",
     OPTION_AT(view_request, frames),
     .value = "N",
     .help = "show at most N times of the run; default: 600"},
    {.name = "title",
     OPTION_AT(view_request, title),
     .value = "TEXT",
     .help = "what stands above it; default: the scene's title"},
    {.name = NULL},
};

static const command_line command = {
    .name = "view",
    .synopsis =
        "PROBLEM|SCENE.yaml|FILE.csv|FILE.h5|FILE.pvd|FILE.vtkhdf --out PAGE.html [OPTIONS]",
    .operand = "FILE",
    .summary = "Write a page that shows a run in a browser: what moves in space, fields in "
               "colours, and curves over time.\n",
    .options = command_options,
    .details = details,
};

int view_command(int argc, char **argv)
{
  view_request r = {.h = (double)NAN, .t_end = (double)NAN, .frames = FRAMES_USUAL};
  const char *path;
  int code;
  if (!options_parse(&command, argc, argv, &r, &path, &code)) return code;
  return view_file(&r, path);
}
